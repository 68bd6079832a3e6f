"""Maps of the errors of the closed forms: pull-off force over (n, mu) and (k, mu), and the two jumps over both."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from comparisons.output.figures.contour_labels import label_lines
from comparisons.output.style import lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.studies.error_grid import (
    GRADIENT_SLICES,
    GRADIENTS,
    SHAPE_SLICES,
    SHAPES,
    TABOR,
    errors,
    gradient_cases,
    onset_calls,
    onset_errors,
    shape_cases,
    tasks,
)

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
_JUMP_NAMES = tuple(name for name, _, _ in _JUMPS)


def _shape_tasks() -> Sequence[CachedCall]:
    return tasks(shape_cases())


def _gradient_tasks() -> Sequence[CachedCall]:
    return tasks(gradient_cases())


def _jump_tasks() -> Sequence[CachedCall]:
    cases = dict.fromkeys(shape_cases() + gradient_cases())
    return [*onset_calls(cases), *tasks(cases)]


def _shape_tables(results: Results) -> Tables:
    return {"": errors(results, shape_cases(), ("pull_off_force",))}


def _gradient_tables(results: Results) -> Tables:
    return {"": errors(results, gradient_cases(), ("pull_off_force",))}


def _jump_tables(results: Results) -> Tables:
    cases = dict.fromkeys(shape_cases() + gradient_cases())
    table = errors(results, cases, _JUMP_NAMES)
    shown = [table[(table["quantity"] == name) & (table["model"] == model)] for name, model, _ in _JUMPS]
    onset = onset_errors(results, cases, [(name, model) for name, model, _ in _JUMPS])
    return {"": pd.concat(shown, ignore_index=True), "onset": onset}


def lattice(table: pd.DataFrame, across: str) -> tuple[Array, Array, Array]:
    """Return the values of `across` and of mu, and kappa in per cent, shape (mu, across), NaN where unknown.

    Examples
    --------
    >>> table = pd.DataFrame({"n": [1.0, 2.0], "mu": [0.1, 0.1], "kappa": [0.01, -0.5]})
    >>> lattice(table, "n")[2]
    array([[  1., -50.]])
    """
    square = 100.0 * table.pivot(index="mu", columns=across, values="kappa")
    return square.columns.to_numpy(float), square.index.to_numpy(float), square.to_numpy(float)


def from_onset(table: pd.DataFrame, onset: pd.DataFrame, across: str) -> tuple[Array, Array, Array, Array]:
    """Return `lattice` from the first jump on, mu of the same shape as kappa, and the critical Tabor numbers.

    Points below the critical Tabor number lie on it, with the error just above it: the lattice ends at that line.
    """
    x, mu, kappa = lattice(table, across)
    first = onset.set_index(across).loc[x]
    critical = first["critical"].to_numpy(float)
    below = mu[:, None] <= critical
    return (
        x,
        np.where(below, critical, mu[:, None]),
        np.where(below, 100.0 * first["kappa"].to_numpy(float), kappa),
        critical,
    )


def _map(axes: Axes, table: pd.DataFrame, across: str, onset: pd.DataFrame | None = None) -> None:
    # What is not computed stays grey.
    axes.set_facecolor("0.95")
    if onset is None:
        x, mu, kappa = lattice(table, across)
    else:
        x, mu, kappa, critical = from_onset(table, onset, across)
        axes.fill_between(x, TABOR[0], critical, fc="0.95", hatch="////", ec="0.75", lw=0.0)
        axes.plot(x, critical, color="black", lw=0.8, ls=":")
        x = np.broadcast_to(x, kappa.shape)
    axes.contourf(x, mu, kappa, levels=_SIGNED_BANDS, colors=_SIGNED_GREYS)
    axes.set_yscale("log")
    axes.grid(visible=False)
    if across == "n":
        axes.set_xscale("log")
        axes.set_xticks([1, 2, 3, 5, 8], labels=["1", "2", "3", "5", "8"])
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


def _draw_pull_off(tables: Tables, across: str, held: str, slices: Sequence[float]) -> Figure:
    table = tables[""]
    label = {"n": r"shape index $n$", "k": r"gradient exponent $k$"}[across]
    with styled():
        figure = Figure(figsize=(7.2, 10.4), layout="constrained")
        grid = figure.subplots(len(_PULL_OFF), 2, sharex=True, sharey=True)
        letters = iter("abcdefgh")
        for row, model in zip(grid, _PULL_OFF, strict=True):
            for axes, value in zip(row, slices, strict=True):
                _map(axes, table[(table["model"] == model) & (table[held] == value)], across)
                lettered(axes, next(letters), rf"{_NAMES[model]}, ${held}$ = {value:g}")
        for axes in grid[:, 0]:
            axes.set_ylabel(r"Tabor number $\mu$")
        for axes in grid[-1]:
            axes.set_xlabel(label)
        _finish(figure, "pull-off force")
    return figure


def _draw_jumps(tables: Tables) -> Figure:
    table = tables[""]
    columns = [("n", "k", value) for value in SHAPE_SLICES] + [("k", "n", value) for value in GRADIENT_SLICES]
    with styled():
        figure = Figure(figsize=(7.2, 10.4), layout="constrained")
        grid = figure.subplots(len(columns), 2, sharey=True)
        letters = iter("abcdefgh")
        for row, (across, held, value) in zip(grid, columns, strict=True):
            for axes, (_, model, event) in zip(row, _JUMPS, strict=True):
                part = table[(table["model"] == model) & (table[held] == value)]
                part = part[part[across].isin(SHAPES if across == "n" else GRADIENTS)]
                onset = tables["onset"]
                _map(axes, part, across, onset[(onset["model"] == model) & (onset[held] == value)])
                lettered(axes, next(letters), rf"{_NAMES[model]} {event}, ${held}$ = {value:g}")
                axes.set_xlabel({"n": r"shape index $n$", "k": r"gradient exponent $k$"}[across])
                axes.set_ylim(0.5, 5.0)
                axes.set_yticks([0.5, 1, 2, 5], labels=["0.5", "1", "2", "5"])
                axes.minorticks_off()
            row[0].set_ylabel(r"Tabor number $\mu$")
        _finish(figure, "displacement", "\nhatched: no jump, up to the critical Tabor number (dotted)")
    return figure


ERROR_MAPS_SHAPE = PaperFigure(
    name="error-maps-shape",
    stem="error_maps_shape",
    title="Error of the pull-off force of the closed forms over shape index and Tabor number",
    tasks=_shape_tasks,
    tables=_shape_tables,
    draw=partial(_draw_pull_off, across="n", held="k", slices=SHAPE_SLICES),
)
ERROR_MAPS_GRADIENT = PaperFigure(
    name="error-maps-gradient",
    stem="error_maps_gradient",
    title="Error of the pull-off force of the closed forms over gradient exponent and Tabor number",
    tasks=_gradient_tasks,
    tables=_gradient_tables,
    draw=partial(_draw_pull_off, across="k", held="n", slices=GRADIENT_SLICES),
)
ERROR_MAPS_JUMPS = PaperFigure(
    name="error-maps-jumps",
    stem="error_maps_jumps",
    title="Errors of the semi-rigid jump-in and of JKR's jump-out; none where there is no jump",
    tasks=_jump_tasks,
    tables=_jump_tables,
    draw=_draw_jumps,
)
