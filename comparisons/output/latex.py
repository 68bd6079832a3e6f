"""Tables in LaTeX with booktabs and siunitx, to be input into a paper."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from comparisons.output.latex_layout import NUMBER, Column, Size, fitted
from comparisons.output.latex_text import breakable, escaped, number_text

__all__ = ["NUMBER_KIND", "TEXT_KIND", "WRAPPED_KIND", "LatexParts", "latex", "latex_parts"]

#: Kinds of columns.
NUMBER_KIND, TEXT_KIND, WRAPPED_KIND = "number", "text", "wrapped"

#: Lines of a table that floats; a longer one is a longtable, which goes on on the next page.
_FLOAT_LINES = 36

_PACKAGES = r"% The document needs \usepackage{array,booktabs,longtable,pdflscape,siunitx}"


@dataclass(frozen=True, slots=True)
class LatexParts:
    """What stands around the rows of a table.

    Attributes
    ----------
    kinds : tuple of str
        Of each column: `NUMBER_KIND`, `TEXT_KIND` or `WRAPPED_KIND`.
    floating, long : tuple of str
        The lines before and after the rows, of a table that floats and of one that continues on the next page.
    most : int
        Rows that a table that floats has room for.
    """

    kinds: tuple[str, ...]
    floating: tuple[str, str]
    long: tuple[str, str]
    most: int

    def text(self, rows: Sequence[Sequence[str]]) -> str:
        """Return the table with these rows of texts."""
        before, after = self.floating if len(rows) <= self.most else self.long
        lines = [" & ".join(map(_cell, row, self.kinds)) + r" \\" for row in rows]
        nothing = [] if lines else [r"\multicolumn{" + str(len(self.kinds)) + r"}{l}{none} \\"]
        return "\n".join([before, *nothing, *lines, after, ""])


def latex(table: pd.DataFrame, caption: str, label: str) -> str:
    r"""Return a table of texts in LaTeX that fits a page of A4.

    Every character is one that LaTeX can typeset without further packages, whatever the texts hold.  Columns of numbers
    are aligned at the decimal marker by siunitx; texts wrap where there is no room for them; a wide table is on its
    side, and a long one continues on the next page.

    Parameters
    ----------
    table : DataFrame
    caption, label : str
        A reference is to ``tab:`` and the label.

    Examples
    --------
    >>> print(latex(pd.DataFrame({"gate": ["A_1"], "E": ["1.788482(3)"]}), "Verdicts", "verdicts"), end="")
    % The document needs \usepackage{array,booktabs,longtable,pdflscape,siunitx}
    \begin{table}
    \centering
    \caption{Verdicts}
    \label{tab:verdicts}
    \small\setlength{\tabcolsep}{4pt}
    \begin{tabular}{@{}lS[table-format=1.6(1)]@{}}
    \toprule
    gate & {$E$} \\
    \midrule
    A\_1 & 1.788482(3) \\
    \bottomrule
    \end{tabular}
    \end{table}
    """
    rows = [[str(cell) for cell in row] for row in table.to_numpy(object).tolist()]
    return latex_parts(list(map(str, table.columns)), rows, caption, label).text(rows)


def latex_parts(headings: Sequence[str], rows: Sequence[Sequence[str]], caption: str, label: str) -> LatexParts:
    """Return what stands around the rows of a table: the layout has room for any of the given rows.

    Parameters
    ----------
    headings : sequence of str
    rows : sequence of sequence of str
        One text for each heading.
    caption, label : str
    """
    cells = [" ".join(text.split()) for row in rows for text in row]
    texts = [cells[place :: len(headings)] for place in range(len(headings))]
    size, columns, lines = fitted([Column(*pair) for pair in zip(headings, texts, strict=True)])
    named = rf"\label{{tab:{re.sub('[^A-Za-z0-9-]+', '-', label)}}}"
    columned = f"{{@{{}}{''.join(one.specification for one in columns)}@{{}}}}"
    head = "\n".join([r"\toprule", " & ".join(one.head for one in columns) + r" \\", r"\midrule"])
    font = rf"\{size.name}\setlength{{\tabcolsep}}{{{size.gap:g}pt}}"
    described = rf"\caption{{{escaped(caption)}}}"
    return LatexParts(
        tuple(_kind(one) for one in columns),
        (
            "\n".join(
                [
                    _PACKAGES,
                    r"\begin{table}",
                    r"\centering",
                    described,
                    named,
                    font,
                    rf"\begin{{tabular}}{columned}",
                    head,
                ]
            ),
            "\n".join([r"\bottomrule", r"\end{tabular}", r"\end{table}"]),
        ),
        _long(size, font, columned, head, described + named),
        0 if size.sideways else _FLOAT_LINES // lines,
    )


def _long(size: Size, font: str, columned: str, head: str, described: str) -> tuple[str, str]:
    """Return the lines around the rows of a table that continues on the next page."""
    page = (r"\begin{landscape}", r"\end{landscape}") if size.sideways else (r"\begingroup", r"\endgroup")
    before = [
        *(_PACKAGES, page[0], rf"{font}\setlength{{\LTcapwidth}}{{\linewidth}}"),
        *(rf"\begin{{longtable}}{columned}", rf"{described}\\", head, r"\endfirsthead", head, r"\endhead"),
        *(r"\bottomrule", r"\endfoot"),
    ]
    return "\n".join(before), "\n".join([r"\end{longtable}", page[1]])


def _kind(column: Column) -> str:
    if column.number:
        return NUMBER_KIND
    return WRAPPED_KIND if column.width else TEXT_KIND


def _cell(text: str, kind: str) -> str:
    if kind != NUMBER_KIND:
        return breakable(escaped(text)) if kind == WRAPPED_KIND else escaped(text)
    return number_text(text) if not text or re.fullmatch(NUMBER, text) else f"{{{escaped(text)}}}"
