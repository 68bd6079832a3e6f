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
    found = verdicts()
    order = sorted(range(len(found)), key=lambda place: _ORDER.index(found[place]["verdict"]))
    rows = [
        Row(
            (
                Cell(row["verdict"], float(_ORDER.index(row["verdict"]))),
                Cell(row["statement"], more=f"{row['section']}; {row['range']}"),
                Cell(row["test"], more=row["evidence"]),
                Cell(row["fails_for"], more=f"beyond the paper: {row['beyond_paper']}" if row["beyond_paper"] else ""),
                Cell(row["command"]),
            )
        )
        for row in (found[place] for place in order)
    ]
    columns = (
        Column("verdict"),
        Column("statement, in words of our own", "prose"),
        Column("test and evidence", "prose"),
        Column("fails for", "prose"),
        Column("computed again by", "code"),
    )
    counts = ", ".join(
        f"{sum(row['verdict'] == verdict for row in found)} {verdict}"
        for verdict in _ORDER
        if any(row["verdict"] == verdict for row in found)
    )
    note = f"{len(found)} statements: {counts}. The verdicts are those of fscm-bench paper, shipped with this version."
    caption = "Statements of the paper and their verdicts"
    return Table("statements", caption, columns, rows, "paper_statements.csv", note, tuple(order))
