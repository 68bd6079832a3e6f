"""Tables in LaTeX with booktabs, to be input into a paper."""

from __future__ import annotations

import pandas as pd

from comparisons.output.latex_text import comment, escaped

__all__ = ["latex"]


def latex(table: pd.DataFrame, caption: str) -> str:
    r"""Return a table of texts as a booktabs table; the document needs \usepackage{booktabs}.

    Every character is one that LaTeX can typeset without further packages, whatever the texts hold.

    Examples
    --------
    >>> print(latex(pd.DataFrame({"gate": ["A_1"], "$E$": ["1.788482(3)"]}), "Verdicts").splitlines()[4])
    A\_1 & 1.788482(3) \\
    """
    rows = [" & ".join(escaped(str(cell)) for cell in row) + r" \\" for row in table.to_numpy(object).tolist()]
    return "\n".join(
        [
            rf"\begin{{tabular}}{{{'l' * len(table.columns)}}} % {comment(caption)}",
            r"\toprule",
            " & ".join(map(escaped, table.columns)) + r" \\",
            r"\midrule",
            *([] if rows else [r"\multicolumn{" + str(len(table.columns)) + r"}{l}{none} \\"]),
            *rows,
            r"\bottomrule",
            r"\end{tabular}",
            "",
        ]
    )
