"""Table of the report cards of the given models."""

from __future__ import annotations

from comparisons.domain import Domain
from comparisons.judging.report_card import card_lines, given_models
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.table import Cell, Column, Row, Table

__all__ = ["cards"]


def cards(stored: Stored) -> Table:
    """Return the lines of the card of each given model; the table has no rows if none is given."""
    record = stored.record
    found, domains = record.get("cards", {}), record.get("domains", {})
    rows = [
        Row((Cell(name), Cell(label), Cell(text)))
        for name in given_models(record["arguments"].get("model"), stored.verdicts)
        for label, text in card_lines(
            name, stored.verdicts, found.get(name), Domain.of_json(domains[name]) if name in domains else None
        )
    ]
    columns = (Column("model", "head"), Column("item"), Column("found", "prose"))
    return Table("cards", "Report cards of the given models", columns, rows, "cards.csv")
