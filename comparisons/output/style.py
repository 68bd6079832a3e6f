"""Styles of models, verdicts and figures.

They are legible in print and in grey: models differ by colour, line style and marker.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import accumulate, chain, count, cycle, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.judging.decision import Verdict
from comparisons.registry import MODELS
from comparisons.runs.atomic_files import atomic

# A command that draws nothing does not wait for Matplotlib.
if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Okabe and Ito's colours that stay apart for every kind of colour vision and, in this order, in grey.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#666666")
#: Those of them that are no colour for an external model: black, which is that of `fscm`, and grey.
_COLOURLESS = {COLOURS.index("#000000"), COLOURS.index("#666666")}
#: Colours that a dark page has in place of those that are too dark for it; the others are used on both.
_ON_DARK = {"#000000": "#f2f4f6", "#0072b2": "#3f9fe0", "#d55e00": "#f07a24", "#666666": "#a8afb7"}
#: Markers of the points, in the order of `COLOURS`; the same in Bokeh, and as characters.
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
_BOKEH_MARKERS = ("circle", "square", "triangle", "diamond", "inverted_triangle", "hex", "square_pin", "star")
_SIGNS = "○□△◇▽⬡▣☆"
#: Dashes of the lines, in the order of `COLOURS`.
LINES: tuple[Any, ...] = ("-", "--", "-.", ":")
LINES += ((0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (4, 1, 4, 1, 1, 1)), (0, (2, 2)))

#: Dashes in Matplotlib -> the lengths of marks and gaps on a page, in pixels; none for a whole line.
_DASHES: dict[Any, tuple[int, ...]] = {"-": (), "--": (6, 4), "-.": (7, 3, 2, 3), ":": (2, 3)}
_DASHES |= {line: tuple(2 * length for length in line[1]) for line in LINES[len(_DASHES) :]}

#: Dashes of the two branches of a cycle, in place of those of the model.
BRANCHES = {"approach": "--", "retreat": "-"}

#: The model whose curve is broad and pale, below the others: where they are right they cover it.
BROAD = "fscm"


@dataclass(frozen=True, slots=True)
class ModelStyle:
    """How a model is drawn in figures and on a page.

    Attributes
    ----------
    colour : str
        In hexadecimal digits.
    line : str or tuple
        Its dashes in Matplotlib.
    dashes : tuple of int
        The same on a page: lengths of marks and gaps in pixels, none for a whole line.
    symbol, marker, sign : str
        Its marker in Matplotlib, in Bokeh and as a character.
    broad : bool
        Whether its line is broad and pale, below the others.
    """

    colour: str
    line: Any
    dashes: tuple[int, ...]
    symbol: str
    marker: str
    sign: str
    broad: bool

    @property
    def on_dark(self) -> str:
        """Its colour on a dark page."""
        return _ON_DARK.get(self.colour, self.colour)

    @property
    def background(self) -> str:
        """A piece of its line as the background of an element, in CSS."""
        ends = list(accumulate(self.dashes, initial=0))
        colours = cycle(("currentColor", "transparent"))
        parts = [f"{colour} {start}px {end}px" for colour, (start, end) in zip(colours, pairwise(ends), strict=False)]
        return f"repeating-linear-gradient(90deg, {', '.join(parts or ['currentColor 0 100%'])})"

    @property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments of its line in Matplotlib."""
        return {"color": self.colour, "ls": self.line} | ({"lw": 2.6, "alpha": 0.35} if self.broad else {})


def model_styles(names: Iterable[str]) -> dict[str, ModelStyle]:
    """Return the style of each model; external models have what is free beside ours, but neither black nor grey.

    Examples
    --------
    >>> styles = model_styles(["fscm", "mine"])
    >>> styles["fscm"].colour, styles["mine"].colour
    ('#000000', '#0072b2')
    """
    present = sorted(set(names))
    positions = {name: position for position, name in enumerate(MODELS) if name in present}
    taken = {*positions.values()}
    # First the colours that no model of ours has here.
    hues = _COLOURLESS | {at % len(COLOURS) for at in taken}
    unused = [at for at in range(len(COLOURS)) if at not in hues]
    others = (at for at in count() if at not in (*taken, *unused) and at % len(COLOURS) not in _COLOURLESS)
    free = chain(unused, others)
    return {name: _style(positions[name] if name in positions else next(free), broad=name == BROAD) for name in present}


def _style(position: int, *, broad: bool = False) -> ModelStyle:
    """Return the style of a position in a list of models; no two share colour and marker, or colour and dashes."""
    turn, hue = divmod(position, len(COLOURS))
    # With every turn of the colours the markers move on by one, the dashes by five of eight: each pair with a colour
    # comes back after 64 positions, where the colours are paler.
    paler, turn = divmod(turn, len(MARKERS))
    line = LINES[(hue // 2 + 5 * turn) % len(LINES)]
    shape = (hue + turn) % len(MARKERS)
    markers = MARKERS[shape], _BOKEH_MARKERS[shape], _SIGNS[shape]
    return ModelStyle(_paler(COLOURS[hue], paler), line, _DASHES[line], *markers, broad=broad)


def _paler(colour: str, times: int) -> str:
    """Return a colour in hexadecimal digits after its distance to white was shortened by a quarter some times."""
    channels = (int(colour[start : start + 2], 16) for start in (1, 3, 5))
    return "#" + "".join(f"{round(255 - (255 - channel) * 0.75**times):02x}" for channel in channels)


#: Lines of the models that the figures of the paper draw side by side.
MODEL_LINES = {name: model_styles([name])[name].arguments for name in ("fscm", "md-original", "md-improved")}

#: Verdict -> symbol, read beside the colour, and where there is none.
VERDICT_SYMBOLS = dict(zip(Verdict, "!✗*?~✓–", strict=True))

#: File formats of a figure, by suffix, with what keeps the clock and the program out of the files, so that the same
#: data give the same bytes.
_METADATA: dict[str, Any] = {
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
    ".svg": {"Date": None, "Creator": None},
}
#: Formats of pictures, as endings of their files.
FORMATS = tuple(_METADATA)

#: Settings of Matplotlib.
_SETTINGS = Path(__file__).with_name("figures.mplstyle")


def styled() -> Any:
    """Return the context in which figures are drawn and saved."""
    from matplotlib import rc_context

    return rc_context(fname=_SETTINGS)


def new_figure(width: float, height: float) -> Figure:
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


def save(figure: Figure, *paths: Path) -> None:
    """Write a figure; the suffix of each path, one of `FORMATS`, chooses the format.

    Raises
    ------
    ValueError
        If a suffix is another one, or a file cannot be written.
    """
    suffixes = [picture_path(path).suffix.lower() for path in paths]
    with styled():
        # One layout for all formats.
        if engine := figure.get_layout_engine():
            engine.execute(figure)
            figure.set_layout_engine("none")
        for path, suffix in zip(paths, suffixes, strict=True):
            with atomic(path) as file:
                figure.savefig(file, format=suffix[1:], metadata=_METADATA[suffix])
