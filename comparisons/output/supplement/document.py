r"""The document of a supplement: Methods, figures, tables and references, which pdflatex and bibtex typeset."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from comparisons.output.latex import escaped

#: Names of the document, of the folders beside it, and of the references.
DOCUMENT, TABLES, FIGURES, DATA, REFERENCES = "supplement.tex", "tables", "figures", "data", "used.bib"

_HEAD = r"""\documentclass[a4paper]{article}
\usepackage{array,booktabs,graphicx,longtable,pdflscape,siunitx}
\renewcommand{\thetable}{S\arabic{table}}
\renewcommand{\thefigure}{S\arabic{figure}}
\begin{document}
\section*{Supplement}
"""


def document(paragraph: str, figures: Sequence[str], tables: Iterable[str]) -> str:
    r"""Return the text of the document.

    Parameters
    ----------
    paragraph : str
        For the section Methods, in plain text.
    figures, tables : sequence of str
        Names of the files.

    Examples
    --------
    >>> text = document("50 % of it.", [], ["ranking.tex"])
    >>> [line for line in text.splitlines() if "ranking" in line or "50" in line]
    ['50 \\% of it.', '\\input{tables/ranking.tex}']
    """
    parts = [_HEAD, r"\subsection*{Methods}", escaped(paragraph), ""]
    parts += [line for name in figures for line in (*_figure(name), "")]
    parts += [rf"\input{{{TABLES}/{name}}}" for name in tables]
    parts += ["", r"\nocite{*}", r"\bibliographystyle{unsrt}", rf"\bibliography{{{REFERENCES.removesuffix('.bib')}}}"]
    return "\n".join([*parts, r"\end{document}", ""])


def _figure(name: str) -> list[str]:
    """Return the lines of a figure, which is not wider than the text."""
    return [
        r"\begin{figure}[htbp]\centering",
        rf"\includegraphics[width=\linewidth,height=0.8\textheight,keepaspectratio]{{{FIGURES}/{name}}}",
        rf"\caption{{{escaped(_CAPTIONS.get(name, name))}}}",
        r"\end{figure}",
    ]


_CAPTIONS = {
    "comparison.pdf": "Relative errors of the models against the reference.",
    "fig16b_kappa.pdf": "Relative errors of the pull-off force over the Tabor number.",
    "agreement.pdf": "Differences of the two references beside their bounds.",
    "references.pdf": "Values of the two references.",
}
