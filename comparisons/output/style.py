"""Styles of models, verdicts, figures and the report.

They are legible in print and in grey: models differ by colour, line style and marker.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.judging.decision import Verdict
from comparisons.runs.atomic_files import atomic

# A command that draws nothing does not wait for Matplotlib.
if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "COLOURS",
    "FORMATS",
    "LINES",
    "MARKERS",
    "MODEL_LINES",
    "MODEL_NAMES",
    "VERDICT_SYMBOLS",
    "ModelStyle",
    "empty_figure",
    "first_shown",
    "lettered",
    "model_label",
    "model_styles",
    "picture_path",
    "save",
    "styled",
    "verdict_class",
]

#: Okabe and Ito's colours that stay apart for every kind of colour vision and, in this order, in grey.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666")
#: Markers of the points, in the order of `COLOURS`.
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
#: Dashes of the lines, in the order of `COLOURS`.
LINES: tuple[Any, ...] = (
    "-",
    "--",
    "-.",
    ":",
    (0, (5, 1, 1, 1, 1, 1)),
    (0, (8, 2)),
    (0, (4, 1, 4, 1, 1, 1)),
    (0, (2, 2)),
)

#: Dashes: line style of Matplotlib, name in Bokeh, dash array of SVG.
_SOLID, _DASHED, _DASHDOT, _DOTTED = (
    ("-", "solid", ""),
    ("--", "dashed", "6 3"),
    ("-.", "dotdash", "2 4 6 4"),
    (":", "dotted", "2 3"),
)
_DASHES = (_SOLID, _DASHED, _DASHDOT, _DOTTED)

#: Markers in the order of `MARKERS`: name in Bokeh, and path of SVG in a box of -5 to 5.
_PAGE_MARKERS = (
    ("circle", "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z"),
    ("square", "M-4 -4h8v8h-8z"),
    ("triangle", "M0 -4.5l4.5 8h-9z"),
    ("diamond", "M0 -5l4 5l-4 5l-4 -5z"),
    ("inverted_triangle", "M0 4.5l4.5 -8h-9z"),
    ("hex", "M-5 0l2.5 -4.3h5l2.5 4.3l-2.5 4.3h-5z"),
    ("square_pin", "M-4 -4q4 2 8 0q-2 4 0 8q-4 -2 -8 0q2 -4 0 -8z"),
    ("star", "M0 -5l1.3 3.4h3.7l-3 2.2l1.2 3.6l-3.2 -2.2l-3.2 2.2l1.2 -3.6l-3 -2.2h3.7z"),
)

#: Model -> (label as in the paper, dash), in the order of the colours and markers; a model needs no row here.
_MODELS = {
    "fscm": ("FSCM", _SOLID),
    "md-improved": (r"improved M-D-$n$-$k$", _SOLID),
    "md-original": (r"original M-D-$n$-$k$", _DASHED),
    "fem": ("FEM", _DASHED),
    "jkr": (r"JKR-$n$-$k$", _DASHDOT),
    "bradley": (r"Bradley-$n$", _DOTTED),
    "double-hertz-n-k": (r"double-Hertz-$n$-$k$", _DASHDOT),
    "semi-rigid": ("semi-rigid", _SOLID),
    "fscm-stieltjes": ("fscm-stieltjes", _DOTTED),
    "fscm-stieltjes-400": ("fscm-stieltjes-400", _DOTTED),
    "dmt": ("dmt", _DOTTED),
    "md-jin": (r"M-D-$n$-$k$, $\sigma_0 = 1$", _DOTTED),
    "dmt-strength": (r"dmt, $\sigma_0 = \sigma_{th}$", _DOTTED),
    "carpick-ogletree-salmeron": ("Carpick-Ogletree-Salmeron", _DASHDOT),
    "pietrement-troyon": ("Pietrement-Troyon", _DOTTED),
    "schwarz": ("Schwarz", _DASHDOT),
    "jump-asymptotes": ("jump asymptotes", _DASHDOT),
    "atlas": ("atlas", _DASHED),
}

#: The model whose curve is broad and pale, below the others: where they are right they cover it.
_BROAD = "fscm"


#: Models that a plot of a page shows at first: more lines hide each other.
_SHOWN_AT_FIRST = 5


@dataclass(frozen=True, slots=True)
class ModelStyle:
    """How a model is drawn in figures and on a page.

    Attributes
    ----------
    label : str
        Its name in figures.
    colour : str
        In hexadecimal digits.
    line, dash, array : str
        Its dashes in Matplotlib, Bokeh and SVG.
    symbol, marker, path : str
        Its marker in Matplotlib, Bokeh and SVG.
    broad : bool
        Whether its line is broad and pale, below the others.
    """

    label: str
    colour: str
    line: str
    dash: str
    array: str
    symbol: str
    marker: str
    path: str
    broad: bool

    @property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments of its line in Matplotlib."""
        return {"color": self.colour, "ls": self.line} | ({"lw": 2.6, "alpha": 0.35} if self.broad else {})


def model_styles(names: Iterable[str]) -> dict[str, ModelStyle]:
    """Return the style of each model; external models have what is free beside ours.

    Examples
    --------
    >>> styles = model_styles(["fscm", "mine"])
    >>> styles["fscm"].colour, styles["mine"].colour, styles["mine"].label
    ('#000000', '#0072b2', 'mine')
    """
    present = sorted(set(names))
    known = {name: index for index, name in enumerate(_MODELS) if name in present}
    free = (index for index in count() if index not in known.values())
    indices = {name: known[name] if name in known else next(free) for name in present}
    styles: dict[str, ModelStyle] = {}
    # Ours first: the dashes of the others are those that their colour has left.
    for name in sorted(present, key=lambda name: name not in known):
        turn, colour = indices[name] // len(COLOURS), COLOURS[indices[name] % len(COLOURS)]
        taken = {style.dash for style in styles.values() if style.colour == colour}
        left = [dashes for dashes in _DASHES if dashes[1] not in taken] or _DASHES
        label, (line, dash, array) = _MODELS.get(name, (name, left[indices[name] % len(left)]))
        # With every turn of the colours the markers move on by one: a pair of both comes back after 64 models.
        shape = (indices[name] + turn) % len(MARKERS)
        markers = MARKERS[shape], *_PAGE_MARKERS[shape]
        styles[name] = ModelStyle(label, colour, line, dash, array, *markers, broad=name == _BROAD)
    return {name: styles[name] for name in present}


def first_shown(names: Iterable[str]) -> list[str]:
    """Return the models that a plot of a page shows at first: external ones, then ours in the order of the table.

    Examples
    --------
    >>> first_shown(["schwarz", "dmt", "bradley", "jkr", "md-original", "md-improved", "mine"])
    ['mine', 'md-improved', 'md-original', 'jkr', 'bradley']
    """
    order = list(_MODELS)
    ranked = sorted(names, key=lambda name: order.index(name) if name in order else -1)
    return ranked[:_SHOWN_AT_FIRST]


def model_label(name: str) -> str:
    """Return the name of a model in figures.

    Examples
    --------
    >>> model_label("fem"), model_label("mine")
    ('FEM', 'mine')
    """
    return _MODELS[name][0] if name in _MODELS else name


#: Labels of our models.
MODEL_NAMES = {name: label for name, (label, _) in _MODELS.items()}
#: Lines of the models that the figures of the paper draw side by side.
MODEL_LINES = {name: model_styles([name])[name].arguments for name in ("fscm", "md-original", "md-improved")}

#: Verdict -> symbol, read beside the colour, and where there is none.
VERDICT_SYMBOLS = {
    Verdict.PASS: "✓",
    Verdict.FAIL: "✗",
    Verdict.ERROR: "!",
    Verdict.INCONCLUSIVE: "?",
    Verdict.XFAIL: "~",
    Verdict.XPASS: "*",
    Verdict.NOT_APPLICABLE: "–",
}


def verdict_class(verdict: str) -> str:
    """Return the CSS class of a verdict.

    Examples
    --------
    >>> verdict_class("NOT-APPLICABLE")
    'v-not-applicable'
    """
    return f"v-{Verdict(verdict).value.lower()}"


#: File formats of a figure, by suffix.
FORMATS = (".png", ".pdf", ".svg")

_SETTINGS: Any = {
    "font.size": 9,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.3,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "figure.dpi": 100,
    "savefig.dpi": 150,
    "pdf.fonttype": 42,
    "svg.hashsalt": "fscm-bench",
}

#: The clock and the program stay out of the files, so that the same data give the same bytes.
_METADATA = {
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
    ".svg": {"Date": None, "Creator": None},
}


def styled() -> Any:
    """Return the context in which figures are drawn and saved."""
    from matplotlib import rc_context

    return rc_context(_SETTINGS)


def empty_figure(width: float, height: float) -> Figure:
    """Return a figure without panels, of this size in inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def lettered(axes: Axes, letter: str, words: str = "") -> None:
    """Write the letter of a panel, and what it alone shows, above its left corner."""
    axes.set_title(f"({letter}) {words}".rstrip(), loc="left", fontsize=10)


def picture_path(path: Path) -> Path:
    """Return `path` if its suffix is one of `FORMATS`, else raise `ValueError`."""
    if path.suffix.lower() not in FORMATS:
        raise ValueError(f"the picture {path} must end in one of {', '.join(FORMATS)}, which chooses its format")
    return path


def save(figure: Figure, path: Path) -> None:
    """Write a figure; the suffix of `path`, one of `FORMATS`, chooses the format.

    Raises
    ------
    ValueError
        If the suffix is another one, or the file cannot be written.
    """
    suffix = picture_path(path).suffix.lower()
    with styled(), atomic(path) as file:
        figure.savefig(file, format=suffix[1:], metadata=_METADATA[suffix])
