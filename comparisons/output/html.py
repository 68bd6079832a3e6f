"""Tables as HTML; a number stands in an element `data` with all its digits, by which scripts sort."""

from __future__ import annotations

import pandas as pd
from markupsafe import Markup, escape

from comparisons.judging.decision import Verdict
from comparisons.output.style import VERDICT_SYMBOLS
from comparisons.output.table import Column, Record, Table

__all__ = ["badge", "html_table"]

_DATA = Markup('<data value="{}">{}</data>')
_COMMAND = Markup('<span class="command"><code>{}</code> <button type="button" class="copy">copy</button></span>')


def badge(verdict: str) -> Markup:
    """Return a verdict with its symbol.

    Examples
    --------
    >>> print(badge("NOT-APPLICABLE"))
    <span class="verdict v-not-applicable"><span aria-hidden="true">–</span> NOT-APPLICABLE</span>
    """
    form = Markup('<span class="verdict v-{}"><span aria-hidden="true">{}</span> {}</span>')
    return form.format(verdict.lower(), VERDICT_SYMBOLS[Verdict(verdict)], verdict)


def html_table(table: Table) -> Markup:
    """Return a table as HTML.

    Examples
    --------
    >>> from comparisons.output.table import numbers
    >>> made = html_table(Table("t", "Cases", [numbers("n", "n", ".2g")], pd.DataFrame({"n": [1 / 3]})))
    >>> "<caption>Cases</caption>" in made, '<td><data value="0.3333333333333333">0.33</data></td>' in made
    (True, True)
    """
    cells = {
        escape(column.heading): [
            _cell(column, row, text) for row, text in zip(table.records, table.texts[column.heading], strict=True)
        ]
        for column in table.seen
    }
    # A cell longer than this option would be cut.
    with pd.option_context("display.max_colwidth", None):
        html = pd.DataFrame(cells, dtype=object).to_html(index=False, escape=False, border=0, classes=[])
    head, body = html.replace("<th>", '<th scope="col">').split("<thead>", 1)
    return Markup(head) + Markup("<caption>{}</caption><thead>").format(table.caption) + Markup(body)


def _cell(column: Column, row: Record, text: str) -> Markup:
    if not text:
        return Markup("")
    cell = escape(text)
    if column.kind == "verdict" and text in set(Verdict):
        cell = _DATA.format(Verdict(text).rank, badge(text))
    elif column.kind == "code":
        cell = _COMMAND.format(text)
    elif column.kind == "prose":
        cell = Markup('<span class="prose">{}</span>').format(text)
    elif column.number and not pd.isna(row[column.number]):
        cell = _DATA.format(repr(float(row[column.number])), text)
    small = column.small(row) if column.small else ""
    return cell + Markup("<small>{}</small>").format(small) if small else cell
