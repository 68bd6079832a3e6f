"""Tables as GitHub's Markdown, and as HTML.

In HTML a number stands in an element `data` with all its digits, by which scripts sort.
"""

from __future__ import annotations

import re

import pandas as pd
from markupsafe import Markup, escape

from comparisons.data.file_names import REPORT
from comparisons.judging.decision import Verdict
from comparisons.output.style import VERDICT_SYMBOLS
from comparisons.output.table import Column, Record, Table

#: What a table, HTML or Markdown takes for its own, and the starts of addresses that become links without any mark.
_OWN = {
    **{"&": "&amp;", "<": "&lt;", ">": "&gt;", "|": "\\|", "\n": " "},
    **{character: f"&#{ord(character)};" for character in "\\`*[]!~"},
    **{"://": "&#58;//", "www.": "www&#46;", "@": "&#64;<!-- -->"},
}
_OWN_TEXT = re.compile("|".join(map(re.escape, _OWN)), re.IGNORECASE)

_BADGE = Markup('<span class="verdict v-{}"><span aria-hidden="true">{}</span> {}</span>')
_DATA, _RANK = Markup('<data value="{}">{}</data>'), Markup('<data class="rank" value="{}">{}</data>')
_COMMAND = Markup('<span class="command"><code>{}</code> <button type="button" class="copy">copy</button></span>')


def markdown(texts: pd.DataFrame, title: str) -> str:
    r"""Return a table of texts as Markdown.

    Examples
    --------
    >>> print(markdown(pd.DataFrame({"gate": ["A|B"], "verdict": ["PASS"]}), "Verdicts"), end="")
    ## Verdicts
    <BLANKLINE>
    | gate | verdict |
    | --- | --- |
    | A\|B | PASS |
    """
    head, *rows = ([_escaped(str(cell)) for cell in row] for row in [list(texts), *texts.to_numpy().tolist()])
    lines = [f"| {' | '.join(cells)} |" for cells in (head, ["---"] * len(head), *rows)]
    return "\n".join([f"## {_escaped(title)}", "", *lines, ""])


def _escaped(text: str) -> str:
    """Text that neither a table nor HTML nor Markdown takes for its own."""
    return _OWN_TEXT.sub(lambda match: _OWN.get(match[0]) or f"{match[0][:-1]}&#46;", text)


def badge(verdict: str) -> Markup:
    """Return a verdict with its symbol.

    Examples
    --------
    >>> print(badge("NOT-APPLICABLE"))
    <span class="verdict v-not-applicable"><span aria-hidden="true">–</span> NOT-APPLICABLE</span>
    """
    return _BADGE.format(verdict.lower(), VERDICT_SYMBOLS[Verdict(verdict)], verdict)


def html_table(table: Table) -> Markup:
    """Return a table as HTML.

    Examples
    --------
    >>> from comparisons.output.table import column
    >>> html = html_table(Table("t", "Cases", [column("n", form=".2g")], pd.DataFrame({"n": [1 / 3]})))
    >>> "<caption>Cases</caption>" in html, '<td><data value="0.3333333333333333">0.33</data></td>' in html
    (True, True)
    """
    cells = {
        escape(column.heading): [
            _cell(column, row, text) for row, text in zip(table.records, table.texts[column.heading], strict=True)
        ]
        for column in table.filled
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
        cell = _RANK.format(Verdict(text).rank, badge(text))
    elif column.kind == "code":
        cell = _COMMAND.format(text)
    elif column.kind == "link" and row["folder"]:
        cell = Markup('<a href="{}/{}">{}</a>').format(row["folder"], REPORT, text)
    elif column.kind == "prose":
        cell = Markup('<span class="prose">{}</span>').format(text)
    elif column.number and not pd.isna(row[column.number]):
        cell = _DATA.format(repr(float(row[column.number])), text)
    small = column.small(row) if column.small else ""
    return cell + Markup("<small>{}</small>").format(small) if small else cell
