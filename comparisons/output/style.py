"""One look for every figure: legible in print and in grey, told apart by colour, line style and marker."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.runs.atomic_files import atomic

__all__ = [
    "COLOURS",
    "FORMATS",
    "LINES",
    "MARKERS",
    "MODEL_LINES",
    "MODEL_NAMES",
    "lettered",
    "picture_path",
    "save",
    "styled",
]

#: Okabe and Ito's colours that stay apart for every kind of colour vision and, in this order, in grey.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
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

#: How models are written in pictures, as in the paper; others under the name they are asked by.
MODEL_NAMES = {
    "fscm": "FSCM",
    "fem": "FEM",
    "bradley": r"Bradley-$n$",
    "jkr": r"JKR-$n$-$k$",
    "md-original": r"original M-D-$n$-$k$",
    "md-improved": r"improved M-D-$n$-$k$",
}
#: How they are drawn side by side: the FSCM broad and pale below; the lines of the others as in the paper.
MODEL_LINES: dict[str, dict[str, Any]] = {
    "fscm": {"color": COLOURS[0], "ls": "-", "lw": 2.6, "alpha": 0.35},
    "md-original": {"color": COLOURS[2], "ls": "--"},
    "md-improved": {"color": COLOURS[1], "ls": "-"},
}

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
    return rc_context(_SETTINGS)


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
