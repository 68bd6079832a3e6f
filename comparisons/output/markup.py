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

#: Verdicts on declared deviations, in words.
_WORDS = {"XFAIL": "EXPECTED DEVIATION", "XPASS": "UNEXPECTED PASS"}
_DECLARED = re.compile(rf"\b({'|'.join(_WORDS)})\b")

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


def in_words(text: str) -> str:
    """Return a text in which the names of verdicts on declared deviations are words for people.

    Examples
    --------
    >>> in_words("2 XFAIL, 1 XPASS")
    '2 EXPECTED DEVIATION, 1 UNEXPECTED PASS'
    """
    return _DECLARED.sub(lambda match: _WORDS[match[0]], text)


def badge(verdict: str) -> Markup:
    """Return a verdict with its symbol, in words for people.

    Examples
    --------
    >>> print(badge("NOT-APPLICABLE"))
    <span class="verdict v-not-applicable"><span aria-hidden="true">–</span> NOT-APPLICABLE</span>
    """
    return _BADGE.format(verdict.lower(), VERDICT_SYMBOLS[Verdict(verdict)], in_words(verdict))


def html_table(table: Table, most: int | None = None) -> Markup:
    """Return a table as HTML.

    Parameters
    ----------
    table : Table
    most : int, optional
        Rows that are written; a script adds the others.

    Examples
    --------
    >>> from comparisons.output.table import column
    >>> html = html_table(Table("t", "Cases", [column("n", form=".2g")], pd.DataFrame({"n": [1 / 3]})))
    >>> "<caption>Cases</caption>" in html, '<td><data value="0.3333333333333333">0.33</data></td>' in html
    (True, True)
    """
    heads = Markup("").join(Markup('<th scope="col">{}</th>').format(column.heading) for column in table.filled)
    rows = html_rows(table)
    body = Markup("\n").join(
        Markup("<tr>{}</tr>").format(Markup("").join(Markup("<td>{}</td>").format(cell) for cell in row))
        for row in (rows if most is None else rows[:most])
    )
    frame = Markup("<table>\n<caption>{}</caption>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}\n</tbody>\n</table>")
    return frame.format(table.caption, heads, body)


def html_rows(table: Table) -> list[list[Markup]]:
    """Return the cells of each row of a table."""
    columns = [
        [_cell(column, row, text) for row, text in zip(table.records, table.texts[column.heading], strict=True)]
        for column in table.filled
    ]
    return [list(cells) for cells in zip(*columns, strict=True)]


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
