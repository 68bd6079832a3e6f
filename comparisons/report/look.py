"""One look for each model in every plot of a page, and one for each verdict."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from comparisons.figures.style import COLOURS
from comparisons.models import MODELS
from comparisons.verdict import Verdict

__all__ = ["SYMBOLS", "Look", "looks", "verdict_class"]

#: Read beside the colour, and where there is none.
SYMBOLS = {
    Verdict.PASS: "✓",
    Verdict.FAIL: "✗",
    Verdict.ERROR: "!",
    Verdict.INCONCLUSIVE: "?",
    Verdict.XFAIL: "~",
    Verdict.XPASS: "*",
    Verdict.NOT_APPLICABLE: "–",
}

#: Names of Bokeh's dashes, the same as SVG's dash array, and Bokeh's markers.
_DASHES = (("solid", ""), ("dashed", "6 3"), ("dotted", "2 3"), ("dotdash", "2 4 6 4"))
_MARKERS = ("circle", "square", "triangle", "diamond", "inverted_triangle", "plus", "x", "star")


@dataclass(frozen=True, slots=True)
class Look:
    """How a model is drawn."""

    colour: str
    dash: str
    array: str
    marker: str


def looks(names: Iterable[str]) -> dict[str, Look]:
    """Return the look of each model: those of the register first, in its order, so that the first is black.

    Examples
    --------
    >>> looks(["mine", "jkr"])["mine"].dash
    'dotted'
    """
    register = list(MODELS)
    outside = sorted(set(names) - set(register))
    made = {}
    for index, name in enumerate(register + outside):
        dash, array = _DASHES[(index // 2) % len(_DASHES)] if name in register else _DASHES[2 + index % 2]
        colour = COLOURS[index % len(COLOURS)]
        made[name] = Look(colour, dash, array, _MARKERS[index % len(_MARKERS)])
    return {name: made[name] for name in sorted(set(names))}


def verdict_class(verdict: str) -> str:
    """Return the CSS class of a verdict.

    Examples
    --------
    >>> verdict_class("NOT-APPLICABLE")
    'v-not-applicable'
    """
    return f"v-{Verdict(verdict).value.lower()}"
