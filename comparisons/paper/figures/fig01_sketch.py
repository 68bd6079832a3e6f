"""Fig. 1: sketch of the punch and the graded half-space, without computed data."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS
from comparisons.paper.paper_figure import Plan, Tables, paper_figure

__all__ = ["fig01_sketch"]

#: The state drawn: a paraboloid pressed in by delta, in contact up to a radius, with a small gap inside.
_DELTA, _CONTACT, _GAP = 0.75, 1.5, 0.09
_WIDTH, _DEPTH, _HEIGHT = 4.2, 2.9, 3.1
#: How fast the pile-up falls beyond the contact.
_FALL = 0.6
_SHADES = LinearSegmentedColormap.from_list("graded", ["#f3f6f9", "#6f8fae"])


def _punch(r: np.ndarray) -> np.ndarray:
    return 0.5 * r**2 - _DELTA


def _surface(r: np.ndarray) -> np.ndarray:
    """Height -w of the surface: on the punch in contact, and beyond it falling from the pile-up."""
    rim = _punch(np.array(_CONTACT)) - _GAP
    beyond = np.maximum(np.abs(r) - _CONTACT, 0.0)
    return np.where(beyond > 0.0, rim / (1.0 + beyond / _FALL) ** 1.5, _punch(r) - _GAP)


def _picture(figure: Figure) -> None:
    axes = figure.subplots()
    r, share = np.linspace(-_WIDTH, _WIDTH, 841), np.linspace(0.0, 1.0, 128)[:, None]
    depth = share * -_DEPTH + (1.0 - share) * _surface(r)
    axes.pcolormesh(np.broadcast_to(r, depth.shape), depth, -depth, cmap=_SHADES, shading="gouraud", rasterized=True)
    axes.plot(r, _surface(r), color=COLOURS[1])
    punch = r[_punch(r) <= _HEIGHT]
    axes.fill_between(punch, _punch(punch), _HEIGHT, color="#d9d9d9", lw=0)
    axes.plot(punch, _punch(punch), color=COLOURS[0])
    axes.plot([-_WIDTH, _WIDTH], [0.0, 0.0], color="0.35", lw=0.7, ls=(0, (6, 3)))
    axes.plot([-3.4, 2.2], [-_DELTA, -_DELTA], color="0.35", lw=0.7, ls=":")
    _arrows(axes)
    for x, y, words in (
        (-1.1, 2.4, "rigid punch"),
        (-2.25, -2.1, r"$E = E_0\,(z/c_0)^k$, Poisson's ratio $\nu$"),
        (-2.25, -2.5, "power-law graded elastic half-space"),
    ):
        axes.annotate(words, (x, y), ha="center")
    axes.set(xlim=(-_WIDTH, _WIDTH + 0.4), ylim=(-_DEPTH - 0.3, _HEIGHT + 0.25))
    axes.set_axis_off()


def _arrows(axes: Axes) -> None:
    at = {x: float(_surface(np.array(x))) for x in (-0.55, 2.45)}
    # Tail, head, style, text, and its place along the arrow.
    for tail, head, style, text, share in (
        ((-3.2, -_DELTA), (-3.2, 0.0), "<->", r"$\delta$", 0.5),
        ((-0.55, at[-0.55]), (-0.55, 0.0), "<->", r"$w(r)$", 0.5),
        # Its name stands above the surface, which passes the middle of the length.
        ((2.0, -_DELTA), (2.0, _punch(np.array(2.0))), "<->", r"$f(r)$", 0.65),
        ((2.45, at[2.45]), (2.45, _punch(np.array(2.45))), "<->", r"$H(r)$", 0.5),
        ((_WIDTH - 0.5, 0.0), (_WIDTH + 0.35, 0.0), "-|>", "$r$", 1.0),
        ((0.0, 0.0), (0.0, -_DEPTH - 0.25), "-|>", "$z$", 0.95),
        ((0.0, _HEIGHT + 0.2), (0.0, 1.75), "-|>", "$P$", 0.6),
    ):
        arrow = {"arrowstyle": style, "color": "black", "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", head, tail, arrowprops=arrow, annotation_clip=False)
        position = np.array(tail) + share * (np.array(head) - np.array(tail))
        axes.annotate(text, position, (5, 0), textcoords="offset points", va="center", annotation_clip=False)


@paper_figure(_picture, size=(7.2, 4.9))
def fig01_sketch() -> Plan[Tables]:
    """A rigid punch on a power-law graded half-space."""
    yield {}
    return {}
