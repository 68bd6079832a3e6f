"""Tables in LaTeX with booktabs, to be input into a paper."""

from __future__ import annotations

import pandas as pd

__all__ = ["latex"]

_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}


def latex(table: pd.DataFrame, caption: str) -> str:
    r"""Return a table of texts as a booktabs table; the document needs \usepackage{booktabs}.

    Examples
    --------
    >>> print(latex(pd.DataFrame({"gate": ["A_1"], "$E$": ["1.788482(3)"]}), "Verdicts").splitlines()[4])
    A\_1 & 1.788482(3) \\
    """
    rows = [" & ".join(map(_escaped, row)) + r" \\" for row in table.astype(str).values.tolist()]
    return "\n".join(
        [
            rf"\begin{{tabular}}{{{'l' * len(table.columns)}}} % {_comment(caption)}",
            r"\toprule",
            " & ".join(map(_escaped, table.columns)) + r" \\",
            r"\midrule",
            *([] if rows else [r"\multicolumn{" + str(len(table.columns)) + r"}{l}{none} \\"]),
            *rows,
            r"\bottomrule",
            r"\end{tabular}",
            "",
        ]
    )


def _escaped(text: str) -> str:
    return "".join(_SPECIAL.get(character, character) for character in text.replace("\n", " "))


def _comment(text: str) -> str:
    return text.replace("\n", " ")
