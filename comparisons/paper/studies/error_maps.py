"""Maps of the errors of the closed forms: pull-off force over (n, mu) and (k, mu), and the two jumps over both."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from comparisons.output.figures.contour_labels import label_lines
from comparisons.output.style import lettered
from comparisons.paper.drawing import LABELS
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
from comparisons.paper.studies.error_grid import GRADIENT_SLICES, SHAPE_SLICES
from comparisons.paper.studies.error_lines import TABOR_RANGE, Line, along_gradients, along_shapes, errors_along

__all__ = ["ERROR_MAPS_GRADIENT", "ERROR_MAPS_JUMPS", "ERROR_MAPS_SHAPE"]

Array = NDArray[np.float64]

#: Bands of |kappa| in per cent, white to dark; the last is open.
_BANDS = (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 1e9)
_GREYS = ("#ffffff", "#ebebeb", "#d0d0d0", "#adadad", "#868686", "#5c5c5c")
#: The same for kappa with its sign, so that between two points it passes zero where it does.
_SIGNED_BANDS = (*(-band for band in _BANDS[:0:-1]), *_BANDS[1:])
_SIGNED_GREYS = (*_GREYS[:0:-1], *_GREYS)
#: Lines of kappa in per cent: overestimates full, underestimates dashed.
_LINES = (-20.0, -10.0, -5.0, -2.0, -1.0, 1.0, 2.0, 5.0, 10.0, 20.0)

_NAMES = {
    "md-improved": "improved M-D",
    "md-original": "original M-D",
    "jkr": "JKR",
    "bradley": "Bradley = DMT",
    "semi-rigid": "semi-rigid",
}
_PULL_OFF = ("md-improved", "md-original", "jkr", "bradley")
_JUMPS = (("jump_in_displacement", "semi-rigid", "jump-in"), ("jump_out_displacement", "jkr", "jump-out"))


def _plan(lines: Iterable[Line], names: Sequence[str]) -> Plan[Tables]:
    table = yield from errors_along(lines, names)
    return {"": table}


def lattice(table: pd.DataFrame, across: str) -> tuple[Array, Array, Array]:
    """Return the values of `across`, mu, and kappa in per cent, each of shape (points, lines).

    Examples
    --------
    >>> table = pd.DataFrame({"n": [1.0, 2.0], "point": 0, "mu": [0.1, 0.2], "kappa": [0.01, -0.5]})
    >>> [values.tolist() for values in lattice(table, "n")]
    [[[1.0, 2.0]], [[0.1, 0.2]], [[1.0, -50.0]]]
    """
    mu, kappa = (table.pivot(index="point", columns=across, values=name) for name in ("mu", "kappa"))
    x = np.broadcast_to(kappa.columns.to_numpy(float), kappa.shape)
    return x, mu.to_numpy(float), 100.0 * kappa.to_numpy(float)


def _map(axes: Axes, table: pd.DataFrame, across: str) -> None:
    # What is not computed stays grey.
    axes.set_facecolor("0.95")
    x, mu, kappa = lattice(table, across)
    if "critical" in table:
        critical = table.drop_duplicates(across).set_index(across)["critical"].loc[x[0]]
        axes.fill_between(x[0], TABOR_RANGE[0], critical, fc="0.95", hatch="////", ec="0.75", lw=0.0)
        axes.plot(x[0], critical, color="black", lw=1.4, ls=":")
    axes.contourf(x, mu, kappa, levels=_SIGNED_BANDS, colors=_SIGNED_GREYS)
    axes.set_yscale("log")
    axes.grid(visible=False)
    if across == "n":
        axes.set_xscale("log")
        axes.set_xticks([1, 1.5, 2, 3, 4, 6], labels=["1", "1.5", "2", "3", "4", "6"])
        axes.minorticks_off()
    known = kappa[np.isfinite(kappa)]
    levels = [level for level in _LINES if known.min() < level < known.max()]
    if levels:
        styles = ["--" if level < 0 else "-" for level in levels]
        axes.contour(x, mu, kappa, levels=levels, colors="black", linewidths=0.8, linestyles=styles)


def _finish(figure: Figure, name: str, more: str = "") -> None:
    """Add the scale, and the labels of the lines once the layout is known."""
    maps = list(figure.axes)
    colours = ScalarMappable(
        BoundaryNorm(_BANDS[:-1], len(_GREYS) - 1), ListedColormap(_GREYS[:-1]).with_extremes(over=_GREYS[-1])
    )
    bar = figure.colorbar(
        colours, ax=maps, location="bottom", fraction=0.03, pad=0.02, aspect=50, spacing="uniform", extend="max"
    )
    bar.set_ticks(list(_BANDS[:-1]), labels=[f"{band:g}" for band in _BANDS[:-1]])
    bar.set_label(
        rf"$|\kappa|$ of the {name} (%); lines: $\kappa$, full where the model is above the FSCM, dashed below{more}"
    )
    figure.draw_without_rendering()
    for axes in maps:
        label_lines(axes)


def _draw_pull_off(figure: Figure, tables: Tables, across: str, held: str, slices: Sequence[float]) -> None:
    table = tables[""]
    grid = figure.subplots(len(_PULL_OFF), 2, sharex=True, sharey=True)
    letters = iter("abcdefgh")
    for row, model in zip(grid, _PULL_OFF, strict=True):
        for axes, value in zip(row, slices, strict=True):
            _map(axes, table[(table["model"] == model) & (table[held] == value)], across)
            lettered(axes, next(letters), rf"{_NAMES[model]}, ${held}$ = {value:g}")
        row[0].set_ylabel(LABELS["mu"])
    for axes in grid[-1]:
        axes.set_xlabel(LABELS[across])
    _finish(figure, "pull-off force")


def _draw_jumps(figure: Figure, tables: Tables) -> None:
    table = tables[""]
    columns = [("n", "k", value) for value in SHAPE_SLICES] + [("k", "n", value) for value in GRADIENT_SLICES]
    grid = figure.subplots(len(columns), 2, sharey=True)
    letters = iter("abcdefgh")
    for row, (across, held, value) in zip(grid, columns, strict=True):
        lines = along_shapes() if across == "n" else along_gradients()
        of_row = table[(table[held] == value) & pd.MultiIndex.from_frame(table[["n", "k"]]).isin(lines)]
        for axes, (_, model, event) in zip(row, _JUMPS, strict=True):
            _map(axes, of_row[of_row["model"] == model], across)
            lettered(axes, next(letters), rf"{_NAMES[model]} {event}, ${held}$ = {value:g}")
            axes.set_xlabel(LABELS[across])
            axes.set_ylim(0.5, 5.0)
            axes.set_yticks([0.5, 1, 2, 5], labels=["0.5", "1", "2", "5"])
            axes.minorticks_off()
        row[0].set_ylabel(LABELS["mu"])
    _finish(figure, "displacement", "\nhatched: no jump, below the critical Tabor number $\\mu_c$ (dotted)")


ERROR_MAPS_SHAPE = PaperFigure(
    name="error-maps-shape",
    stem="error_maps_shape",
    title="Error of the pull-off force of the closed forms over shape index and Tabor number",
    plan=lambda: _plan(along_shapes(), ["pull_off_force"]),
    picture=partial(_draw_pull_off, across="n", held="k", slices=SHAPE_SLICES),
    size=(7.2, 10.4),
)
ERROR_MAPS_GRADIENT = PaperFigure(
    name="error-maps-gradient",
    stem="error_maps_gradient",
    title="Error of the pull-off force of the closed forms over gradient exponent and Tabor number",
    plan=lambda: _plan(along_gradients(), ["pull_off_force"]),
    picture=partial(_draw_pull_off, across="k", held="n", slices=GRADIENT_SLICES),
    size=(7.2, 10.4),
)
ERROR_MAPS_JUMPS = PaperFigure(
    name="error-maps-jumps",
    stem="error_maps_jumps",
    title="Errors of the semi-rigid jump-in and of JKR's jump-out; none where there is no jump",
    plan=lambda: _plan(along_shapes() + along_gradients(), [name for name, _, _ in _JUMPS]),
    picture=_draw_jumps,
    size=(7.2, 10.4),
)
