"""The picture of a map: fitted values, their uncertainties and the quality of the fits over x and y."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import scipy

from comparisons.model import Array
from comparisons.output.style import new_figure, styled
from comparisons.problem.units import prefixed_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_map"]

#: Names of the position of a curve, in the order in which they are preferred for the axes.
_AXES = (("x", "y"), ("column", "row"))

#: Share of the values beyond each end of the colours: a few outliers leave the others apart.
_BEYOND = 0.02

#: Width of a panel in inches, the share of it without the scale of colours, limits of its height, the room for title
#: and labels, and the area of the largest mark in square points.
_WIDTH, _SHARE, _HEIGHTS, _MARGIN, _MARK = 3.6, 0.7, (0.6, 4.0), 0.8, 60.0

#: Colour of a cell without a value.
_EMPTY = "#dddddd"


def draw_map(items: Sequence[Mapping[str, Any]], free: Sequence[str]) -> Figure | None:
    """Draw each free key, its relative uncertainty, and the residuals over the noise, at the positions of a map.

    Parameters
    ----------
    items : sequence of mapping
        Curves of one file, as of `comparisons.fitting.folder.fit_files`.
    free : sequence of str
        The keys.

    Returns
    -------
    Figure or None
        None if the curves were not measured at several positions, or these are unknown.
    """
    names = _axes(items)
    if names is None:
        return None
    grid, labels = _grid(items, names)
    fits = [item["fits"][0] if item["fits"] else None for item in items]
    quality = np.array([math.nan if each is None else each["residual"] / each["noise"] for each in fits])
    lack = np.isnan(quality)
    with styled():
        width, height = np.ptp(grid.positions, axis=0) + grid.cell
        figure = new_figure(
            _WIDTH * (len(free) + 1), 2.0 * float(np.clip(_SHARE * _WIDTH * height / width, *_HEIGHTS) + _MARGIN)
        )
        # The layout does not see the numbers of the last scale of colours.
        figure.set_layout_engine("constrained", rect=(0.0, 0.0, 0.98, 1.0))
        panels = figure.subplots(2, len(free) + 1, sharex=True, sharey=True, squeeze=False)
        letters = iter("abcdefghijklmnopqrstuvwxyz")
        for (upper, lower), key in zip(panels.T, free, strict=False):
            values, shares, text = _values(fits, key)
            undetermined = np.isnan(values) & ~lack
            for axes, shown, title in ((upper, values, text), (lower, shares, f"u of {key} (%)")):
                _panel(axes, grid, shown, f"({next(letters)}) {title}")
                _mark(axes, grid, undetermined, "o", "not determined")
                _mark(axes, grid, lack, "x", "no fit")
        best = panels[0, -1]
        _panel(best, grid, quality, f"({next(letters)}) residuals / noise")
        _mark(best, grid, lack, "x", "no fit")
        best.tick_params(labelbottom=True)
        for axes in (*panels[-1, :-1], best):
            axes.set_xlabel(labels[0])
        for axes in panels[:, 0]:
            axes.set_ylabel(labels[1])
        _legend(panels)
    return figure


def _axes(items: Sequence[Mapping[str, Any]]) -> tuple[str, str] | None:
    """Return the names of positions that every curve has, and that are not the same for all."""
    for names in _AXES:
        positions = {tuple(item["position"][name] for name in names) for item in items}
        if len(positions) > 1 and not any(None in position for position in positions):
            return names
    return None


class _Grid(NamedTuple):
    """Centres of the cells of the curves, shape (m, 2), and width and height of a cell."""

    positions: Array
    cell: Array


def _grid(items: Sequence[Mapping[str, Any]], names: tuple[str, str]) -> tuple[_Grid, list[str]]:
    """Return the cells, and the labels of the axes."""
    positions = np.array([[item["position"][name] for name in names] for item in items], float)
    labels = list(names)
    if names == _AXES[0]:
        power, unit = prefixed_unit(float(np.ptp(positions, axis=0).max()), "m")
        positions *= 10.0**-power
        labels = [f"{name} ({unit})" for name in names]
    return _Grid(positions, _cell(items, positions)), labels


def _cell(items: Sequence[Mapping[str, Any]], positions: Array) -> Array:
    """Return width and height of a cell: the step of the grid, or the usual distance of neighbours."""
    spans, sizes = np.ptp(positions, axis=0), np.zeros(2)
    for axis, name in enumerate(_AXES[1]):
        numbers = [item["position"][name] for item in items]
        if None not in numbers and (count := max(numbers) - min(numbers)):
            sizes[axis] = spans[axis] / count
    if not sizes.any():
        apart = np.unique(positions, axis=0)
        sizes[:] = np.median(scipy.spatial.KDTree(apart).query(apart, k=2)[0][:, 1])
    # A line has cells as high as they are wide.
    return np.where(sizes > 0.0, sizes, sizes.max())


def _values(fits: Sequence[Mapping[str, Any] | None], key: str) -> tuple[Array, Array, str]:
    """Return the determined values of a key, their uncertainties in percent, and the name with the unit."""
    rows = [None if each is None else each["parameters"][key] for each in fits]
    values = np.array([row["value"] if row is not None and row["determined"] else math.nan for row in rows], float)
    deviations = np.array([row["u"] if row is not None and row["determined"] else math.nan for row in rows], float)
    shares = 100.0 * deviations / np.abs(values)
    own = next((str(row["unit"]) for row in rows if row is not None), "1")
    sizes = np.abs(values[np.isfinite(values)])
    power, unit = prefixed_unit(float(np.median(sizes)) if sizes.size else 0.0, own)
    name = key if unit == "1" else f"{key} ({unit.replace('^2', '²')})"
    return values * 10.0**-power, shares, name


def _panel(axes: Axes, grid: _Grid, values: Array, title: str) -> None:
    """Draw a cell at each position; one without a value is grey."""
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import Normalize

    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) * grid.cell
    colours = colormaps["viridis"].with_extremes(bad=_EMPTY)
    cells = PolyCollection(
        list(grid.positions[:, None] + corners), array=np.ma.masked_invalid(values), cmap=colours, linewidth=0.0
    )
    axes.add_collection(cells)
    axes.grid(False)
    low, high = grid.positions.min(axis=0) - 0.5 * grid.cell, grid.positions.max(axis=0) + 0.5 * grid.cell
    axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set_title(title, loc="left", fontsize=10)
    known = values[np.isfinite(values)]
    if not known.size:
        return
    known.sort()
    beyond = int(_BEYOND * known.size)
    least, most = float(known[beyond]), float(known[-1 - beyond])
    cells.set_norm(Normalize(least, most if most > least else least + max(abs(least), 1.0) * 1e-3))
    ends = {(True, True): "both", (True, False): "min", (False, True): "max", (False, False): "neither"}
    axes.figure.colorbar(cells, ax=axes, extend=ends[bool(known.min() < least), bool(known.max() > most)])


def _mark(axes: Axes, grid: _Grid, where: Array, marker: str, label: str) -> None:
    """Mark curves that have no value."""
    if where.any():
        size = float(np.clip(_MARK * 100.0 / len(where), 0.05 * _MARK, _MARK))
        x, y = grid.positions[where].T
        axes.plot(x, y, marker, color="#000000", mfc="none", ms=math.sqrt(size), mew=0.8, label=label)


def _legend(panels: Any) -> None:
    """Say in the empty panel what the marks mean."""
    marks: dict[str, Any] = {}
    for axes in panels.flat[:-1]:
        handles, labels = axes.get_legend_handles_labels()
        marks |= dict(zip(labels, handles, strict=True))
    panels[-1, -1].axis("off")
    if marks:
        panels[-1, -1].legend(marks.values(), marks.keys(), loc="center")
