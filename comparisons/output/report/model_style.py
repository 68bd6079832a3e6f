"""One look for each model in every plot of a page, and one for each verdict."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import count

from comparisons.judging.decision import Verdict
from comparisons.output.style import COLOURS

__all__ = ["SYMBOLS", "ModelStyle", "model_styles", "verdict_class"]

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

#: Bokeh's dashes with the dash array of SVG, and Bokeh's markers with their path in a box of -5 to 5.
_SOLID, _DASHED, _DOTTED, _MIXED = ("solid", ""), ("dashed", "6 3"), ("dotted", "2 3"), ("dotdash", "2 4 6 4")
_MARKERS = {
    "circle": "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
    "square": "M-4 -4h8v8h-8z",
    "triangle": "M0 -4.5l4.5 8h-9z",
    "diamond": "M0 -5l4 5l-4 5l-4 -5z",
    "inverted_triangle": "M0 4.5l4.5 -8h-9z",
    "hex": "M-5 0l2.5 -4.3h5l2.5 4.3l-2.5 4.3h-5z",
    "square_pin": "M-4 -4q4 2 8 0q-2 4 0 8q-4 -2 -8 0q2 -4 0 -8z",
    "star": "M0 -5l1.3 3.4h3.7l-3 2.2l1.2 3.6l-3.2 -2.2l-3.2 2.2l1.2 -3.6l-3 -2.2h3.7z",
}

#: Ours in the order of the colours, the same on every page; the original dashed and the improved solid as in
#: the paper.
_OURS = {
    "fscm": _SOLID,
    "md-improved": _SOLID,
    "md-original": _DASHED,
    "fem": _DASHED,
    "jkr": _MIXED,
    "bradley": _DOTTED,
    "dmt": _DASHED,
    "semi-rigid": _SOLID,
    "fscm-stieltjes": _DOTTED,
    "fscm-stieltjes-400": _DOTTED,
}


@dataclass(frozen=True, slots=True)
class ModelStyle:
    """How a model is drawn: colour, names of dash and marker, and both as SVG for the key."""

    colour: str
    dash: str
    array: str
    marker: str
    path: str


def model_styles(names: Iterable[str]) -> dict[str, ModelStyle]:
    """Return the look of each model; those from outside have what ours on the same page leave them.

    Examples
    --------
    >>> model_styles(["fscm", "mine"])["fscm"].colour, model_styles(["fscm", "mine"])["mine"].colour
    ('#000000', '#0072b2')
    """
    present = sorted(set(names))
    places = {name: place for place, name in enumerate(_OURS) if name in present}
    taken = set(places.values())
    free = (place for place in count() if place not in taken)
    dashes = dict(_OURS)
    for name in present:
        if name not in places:
            places[name], dashes[name] = next(free), _SOLID
    return {name: _look(places[name], dashes[name]) for name in present}


def _look(place: int, dash: tuple[str, str]) -> ModelStyle:
    marker, path = list(_MARKERS.items())[place % len(_MARKERS)]
    return ModelStyle(COLOURS[place % len(COLOURS)], *dash, marker, path)


def verdict_class(verdict: str) -> str:
    """Return the CSS class of a verdict.

    Examples
    --------
    >>> verdict_class("NOT-APPLICABLE")
    'v-not-applicable'
    """
    return f"v-{Verdict(verdict).value.lower()}"
