"""Equations as MathML, which a browser draws without a script and without a network."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.errors import SphinxError


def mathml(latex: str, *, block: bool = False) -> str:
    """MathML of a formula in LaTeX.

    Parameters
    ----------
    latex : str
    block : bool
        Whether the formula stands on lines of its own.

    Raises
    ------
    sphinx.errors.SphinxError
        If docutils does not know a command of the formula.

    Examples
    --------
    >>> "<msup>" in mathml("r^2")
    True
    """
    try:
        text = str(tex2mathml(latex.strip(), as_block=block))
    except MathError as problem:
        raise SphinxError(f"the formula {latex!r} cannot be written as MathML: {problem}") from problem
    # An operator has space around it, an identifier has none.
    return re.sub(r"<mi>(cos|sin|log|exp)</mi>", r'<mo lspace="0.17em" rspace="0.17em">\1</mo>', text)


def _visit_inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def _visit_block(translator: Any, node: nodes.math_block) -> None:
    # A wide formula scrolls in its own box on a narrow screen.
    translator.body.append(f'<div class="math" tabindex="0">{mathml(node.astext(), block=True)}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the writer of equations."""
    app.add_html_math_renderer("mathml", (_visit_inline, None), (_visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
