"""The table of the statements of the paper, from the verdicts that are shipped with the package."""

from __future__ import annotations

from comparisons.data.paper_statements import verdicts
from comparisons.output.report.table import Cell, Column, Row, Table

__all__ = ["statements"]

#: Verdicts in the order of the table: what does not hold is first.
_ORDER = ("false", "true in part", "not decided", "true")


def statements() -> Table:
    """Return one row a statement, those that do not hold first.

    Examples
    --------
    >>> [row.cells[0].text for row in statements().rows][0]
    'false'
    """
    stored = verdicts()
    order = sorted(range(len(stored)), key=lambda index: _ORDER.index(stored[index]["verdict"]))
    rows = [
        Row(
            (
                Cell(row["verdict"], float(_ORDER.index(row["verdict"]))),
                Cell(row["holds_in"], more=f"of the paper's own cases: {row['own_cases']}" if row["own_cases"] else ""),
                Cell(row["statement"], more=f"{row['section']}; {row['range']}"),
                Cell(row["test"], more=row["evidence"]),
                Cell(row["fails_for"], more=f"beyond the paper: {row['beyond_paper']}" if row["beyond_paper"] else ""),
                Cell(row["flips"], more=f"the number is {row['number']}" if row["number"] else ""),
                Cell(row["command"]),
            )
        )
        for row in (stored[index] for index in order)
    ]
    columns = (
        Column("verdict"),
        Column("holds in"),
        Column("statement, in words of our own", "prose"),
        Column("test and evidence", "prose"),
        Column("fails for", "prose"),
        Column("other verdict, with the number times a factor", "prose"),
        Column("computed again by", "code"),
    )
    counts = ", ".join(
        f"{sum(row['verdict'] == verdict for row in stored)} {verdict}"
        for verdict in _ORDER
        if any(row["verdict"] == verdict for row in stored)
    )
    note = f"{len(stored)} statements: {counts}. The verdicts are those of fscm-bench paper, shipped with this version."
    caption = "Statements of the paper and their verdicts"
    return Table("statements", caption, columns, rows, "paper_statements.csv", note, tuple(order))
