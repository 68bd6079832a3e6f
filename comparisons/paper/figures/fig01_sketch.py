"""Fig. 1: sketch of the punch and the graded half-space, without computed data."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from scipy.ndimage import gaussian_filter1d

from comparisons.output.style import COLOURS
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables

__all__ = ["SKETCH"]

#: The state drawn: a paraboloid pressed in by delta, in contact up to a radius, with a small gap inside.
_DELTA, _CONTACT, _GAP = 0.75, 1.5, 0.09
_WIDTH, _DEPTH, _HEIGHT = 4.2, 2.9, 3.1
#: How fast the pile-up falls beyond the contact, and over how many points its peak is rounded.
_FALL, _ROUNDING = 0.6, 7.0
_SHADES = LinearSegmentedColormap.from_list("graded", ["#f3f6f9", "#6f8fae"])


def _punch(r: np.ndarray) -> np.ndarray:
    return 0.5 * r**2 - _DELTA


def _surface(r: np.ndarray) -> np.ndarray:
    """Height -w of the surface: on the punch in contact, and beyond it falling from the pile-up."""
    rim = _punch(np.array(_CONTACT)) - _GAP
    beyond = np.maximum(np.abs(r) - _CONTACT, 0.0)
    height = np.where(beyond > 0.0, rim / (1.0 + beyond / _FALL) ** 1.5, _punch(r) - _GAP)
    return gaussian_filter1d(height, _ROUNDING, mode="nearest")


def _picture(figure: Figure, tables: Tables) -> None:
    r = np.linspace(-_WIDTH, _WIDTH, 841)
    punch, surface = _punch(r), _surface(r)
    axes = figure.subplots()
    drawn = punch <= _HEIGHT
    axes.fill_between(r[drawn], punch[drawn], _HEIGHT, color="#d9d9d9", lw=0)
    axes.plot(r[drawn], punch[drawn], color=COLOURS[0])
    shade = axes.imshow(
        np.linspace(0.0, 1.0, 128)[:, None],
        cmap=_SHADES,
        extent=(-_WIDTH, _WIDTH, -_DEPTH, surface.max()),
        aspect="auto",
        interpolation="bilinear",
    )
    body = axes.fill_between(r, -_DEPTH, surface, facecolor="none", lw=0)
    shade.set_clip_path(body.get_paths()[0], axes.transData)
    axes.plot(r, surface, color=COLOURS[1])
    axes.plot([-_WIDTH, _WIDTH], [0.0, 0.0], color="0.35", lw=0.7, ls=(0, (6, 3)))
    _lengths(axes, lambda at: float(np.interp(at, r, surface)))
    _frame(axes)


def _lengths(axes: Axes, surface: Callable[[float], float]) -> None:
    arrow = {"arrowstyle": "<->", "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    axes.plot([-3.4, 2.2], [-_DELTA, -_DELTA], color="0.35", lw=0.7, ls=":")
    for at, low, high, text, share in (
        (-3.2, -_DELTA, 0.0, r"$\delta$", 0.5),
        (-0.55, surface(-0.55), 0.0, r"$w(r)$", 0.5),
        # Its name stands above the surface, which passes the middle of the length.
        (2.0, -_DELTA, 2.0**2 / 2.0 - _DELTA, r"$f(r)$", 0.65),
        (2.45, surface(2.45), 2.45**2 / 2.0 - _DELTA, r"$H(r)$", 0.5),
    ):
        axes.annotate("", (at, low), (at, high), arrowprops=arrow)
        axes.annotate(text, (at, low + share * (high - low)), (5, 0), textcoords="offset points", va="center")


def _frame(axes: Axes) -> None:
    arrow = {"arrowstyle": "-|>", "lw": 1.0, "color": "black", "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (_WIDTH + 0.35, 0.0), (_WIDTH - 0.5, 0.0), arrowprops=arrow, annotation_clip=False)
    axes.annotate("$r$", (_WIDTH + 0.35, 0.12), ha="center", annotation_clip=False)
    axes.annotate("", (0.0, -_DEPTH - 0.25), (0.0, 0.0), arrowprops=arrow, annotation_clip=False)
    axes.annotate("$z$", (0.12, -_DEPTH - 0.2), annotation_clip=False)
    axes.annotate("", (0.0, 1.75), (0.0, _HEIGHT + 0.2), arrowprops=arrow | {"lw": 1.6}, annotation_clip=False)
    axes.annotate("$P$", (0.12, 2.15), fontsize=11)
    axes.annotate("rigid punch", (-1.1, 2.4), ha="center")
    axes.annotate(r"$E = E_0\,(z/c_0)^k$, Poisson's ratio $\nu$", (-2.25, -2.1), ha="center", fontsize=11)
    axes.annotate("power-law graded elastic half-space", (-2.25, -2.5), ha="center")
    axes.set(xlim=(-_WIDTH, _WIDTH + 0.4), ylim=(-_DEPTH - 0.3, _HEIGHT + 0.25))
    axes.set_axis_off()


def _plan() -> Plan[Tables]:
    yield ()
    return {}


SKETCH = PaperFigure(
    name="1",
    stem="fig01_sketch",
    title="A rigid punch on a power-law graded half-space",
    plan=_plan,
    picture=_picture,
    size=(7.2, 4.9),
)
