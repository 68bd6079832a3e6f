"""Maps of the errors of the closed forms: pull-off force over (n, mu) and (k, mu), and the two jumps over both.

The error is relative, kappa = (model - FSCM) / |FSCM|, also for the jumps: wherever a jump exists its displacement is
beyond -z0, so no divisor is small, and an experiment measures this displacement.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from comparisons.numerics.bounds import relative_difference, relative_uncertainty
from comparisons.paper.drawing import LABELS, held, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, rows_of, together
from comparisons.paper.tasks import quantity
from fscm.interpolation.atlas import atlas

__all__ = ["errors_along", "line_errors", "with_kappa"]

#: Lines of constant n and k: shape indices at two gradient exponents and gradient exponents at two shape indices, over
#: the range of the atlas.
_SHAPES = [(float(f"{n:.4g}"), k) for k in (0.0, 0.4) for n in np.geomspace(1.0, 6.0, 21)]
_GRADIENTS = [(n, float(f"{k:.4g}")) for n in (1.5, 2.0) for k in np.linspace(0.0, 0.8, 17)]

#: Bands of |kappa| in per cent, white to dark; the last is open.
_BANDS = (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 1e9)
_GREYS = ("#ffffff", "#ebebeb", "#d0d0d0", "#adadad", "#868686", "#5c5c5c")
#: The same for kappa with its sign, so that between two points it passes zero where it does.
_SIGNED_BANDS = (*(-band for band in _BANDS[:0:-1]), *_BANDS[1:])
_SIGNED_GREYS = (*_GREYS[:0:-1], *_GREYS)
#: Lines of kappa in per cent: overestimates full, underestimates dashed.
_LINES = (-20.0, -10.0, -5.0, -2.0, -1.0, 1.0, 2.0, 5.0, 10.0, 20.0)

#: Closed forms of the pull-off force and of the jumps, and their names.  DMT has Bradley's pull-off force by the choice
#: of its cohesive stress (Eq. 74).
_PULL_OFF = {"md-improved": "improved M-D", "md-original": "original M-D", "jkr": "JKR", "bradley": "Bradley = DMT"}
_JUMPS = {"semi-rigid": "semi-rigid jump-in", "jkr": "JKR jump-out"}
_CLOSED_FORMS = {
    "pull_off_force": tuple(_PULL_OFF),
    "jump_in_displacement": ("semi-rigid",),
    "jump_out_displacement": ("jkr",),
}

#: Tabor numbers of a line, from nearly rigid to nearly JKR; jumps begin at the critical one, where they merge.
_TABOR_RANGE, _ONSET_EXCESS = (0.01, 5.0), 1e-3
#: So many points that straight lines between them look like curves in a panel of 3 inches.
_TABOR_NUMBERS, _AT_JUMPS = 28, 18


def line_errors(n: float, k: float) -> dict[str, Any]:
    """Return reference values of the atlas and those of the closed forms over the Tabor number.

    Returns
    -------
    dict
        ``critical`` and ``u_critical``, the critical Tabor number; lists with an entry for each point, quantity and
        closed form: ``point`` (its number on the line), ``mu``, ``quantity``, ``model``, ``fscm``, ``u_fscm``,
        ``value`` and ``u_num`` (None where the closed form has no value).

    Examples
    --------
    >>> line = line_errors(2.0, 0.4)
    >>> round(line["critical"], 4), line["model"][3], round(line["value"][3], 9)
    (0.7825, 'bradley', 2.0)
    """
    critical = atlas(n, k, _TABOR_RANGE[1], "critical_tabor_number")
    above = np.geomspace(critical.value * (1.0 + _ONSET_EXCESS), _TABOR_RANGE[1], _AT_JUMPS)
    rows = []
    for name, models in _CLOSED_FORMS.items():
        numbers = np.geomspace(*_TABOR_RANGE, _TABOR_NUMBERS) if name == "pull_off_force" else above
        points = np.column_stack([numbers, *atlas(n, k, numbers, name)]).tolist()
        for (point, (mu, fscm, u_fscm)), model in product(enumerate(points), models):
            closed = quantity(model, name, n, k, mu)
            rows.append((point, mu, name, model, fscm, u_fscm, closed["value"], closed["u_num"]))
    names = ("point", "mu", "quantity", "model", "fscm", "u_fscm", "value", "u_num")
    columns = dict(zip(names, map(list, zip(*rows, strict=True)), strict=True))
    return columns | {"critical": critical.value, "u_critical": critical.bound}


def with_kappa(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with kappa and its uncertainty, NaN where a value is missing."""
    value, u_num, fscm, u_fscm = (table[name].astype(float) for name in ("value", "u_num", "fscm", "u_fscm"))
    kappa, u_kappa = relative_difference(value, fscm), relative_uncertainty(value, u_num, fscm, u_fscm)
    return table.assign(kappa=kappa, u_kappa=u_kappa)


def errors_along(lines: Iterable[tuple[float, float]], names: Sequence[str]) -> Plan[pd.DataFrame]:
    """Plan a table of one row a point, quantity and closed form.

    Returns
    -------
    DataFrame
        ``n``, ``k``, ``point`` (its number on the line), ``mu``, ``quantity``, ``model``, ``fscm``, ``u_fscm`` (from
        the atlas), ``kappa`` and ``u_kappa``; for jumps also ``critical`` and ``u_critical``.
    """
    table = yield from rows_of(keyed(line_errors, n=n, k=k) for n, k in lines)
    columns = ["n", "k", "point", "mu", "quantity", "model", "fscm", "u_fscm", "kappa", "u_kappa"]
    critical = ["critical", "u_critical"] if "pull_off_force" not in names else []
    return with_kappa(table[table["quantity"].isin(names)])[[*columns, *critical]].reset_index(drop=True)


def _map(axes: Axes, table: pd.DataFrame, across: str) -> None:
    # What is not computed stays grey.
    axes.set_facecolor("0.95")
    mu, kappa = (table.pivot(index="point", columns=across, values=name) for name in ("mu", "kappa"))
    x = np.broadcast_to(kappa.columns.to_numpy(float), kappa.shape)
    percent = 100.0 * kappa.to_numpy(float)
    if "critical" in table:
        critical = table.drop_duplicates(across).set_index(across)["critical"].loc[x[0]]
        axes.fill_between(x[0], _TABOR_RANGE[0], critical, fc="0.95", hatch="////", ec="0.75", lw=0.0)
        axes.plot(x[0], critical, color="black", lw=1.4, ls=":")
    axes.contourf(x, mu, percent, levels=_SIGNED_BANDS, colors=_SIGNED_GREYS)
    levels = [level for level in _LINES if np.nanmin(percent) < level < np.nanmax(percent)]
    if levels:
        styles = ["--" if level < 0 else "-" for level in levels]
        axes.contour(x, mu, percent, levels=levels, colors="black", linewidths=0.8, linestyles=styles)
    axes.set(yscale="log", xlabel=LABELS[across])
    axes.grid(visible=False)
    if across == "n":
        axes.set_xscale("log")
        axes.set_xticks([1, 1.5, 2, 3, 4, 6], labels=["1", "1.5", "2", "3", "4", "6"])
        axes.minorticks_off()


def _finish(figure: Figure, name: str, more: str = "") -> None:
    """Add the scale, and the labels of the lines once the layout is known."""
    maps = list(figure.axes)
    colours = ListedColormap(_GREYS[:-1]).with_extremes(over=_GREYS[-1])
    scale = ScalarMappable(BoundaryNorm(_BANDS[:-1], len(_GREYS) - 1), colours)
    shape: Any = {"location": "bottom", "fraction": 0.03, "pad": 0.02, "aspect": 50}
    bar = figure.colorbar(scale, ax=maps, spacing="uniform", extend="max", **shape)
    bar.set_ticks(list(_BANDS[:-1]), labels=[f"{band:g}" for band in _BANDS[:-1]])
    bar.set_label(
        rf"$|\kappa|$ of the {name} (%); lines: $\kappa$, full where the model is above the FSCM, dashed below{more}"
    )
    figure.draw_without_rendering()
    contours = [artist for axes in maps for artist in axes.collections if isinstance(artist, ContourSet)]
    for lines in contours:
        if not lines.filled:
            lines.axes.clabel(lines, fmt=lambda level: f"{level:+g} %", fontsize=7)


def _draw_pull_off(figure: Figure, table: pd.DataFrame, across: str, fixed: str, values: Sequence[float]) -> None:
    places = list(product(_PULL_OFF, values))
    words = [f"{_PULL_OFF[model]}, {held(**{fixed: value})}" for model, value in places]
    lattice = panels(figure, len(_PULL_OFF), 2, words, y=LABELS["mu"], sharex=True, sharey=True)
    for axes, (model, value) in zip(lattice, places, strict=True):
        _map(axes, table[(table["model"] == model) & (table[fixed] == value)], across)
        axes.label_outer()
    _finish(figure, "pull-off force")


@paper_figure(partial(_draw_pull_off, across="n", fixed="k", values=(0.0, 0.4)), size=(7.2, 10.4))
def error_maps_shape() -> Plan[Tables]:
    """Error of the pull-off force of the closed forms over shape index and Tabor number."""
    return together({"": errors_along(_SHAPES, ["pull_off_force"])})


@paper_figure(partial(_draw_pull_off, across="k", fixed="n", values=(1.5, 2.0)), size=(7.2, 10.4))
def error_maps_gradient() -> Plan[Tables]:
    """Error of the pull-off force of the closed forms over gradient exponent and Tabor number."""
    return together({"": errors_along(_GRADIENTS, ["pull_off_force"])})


def _draw_jumps(figure: Figure, table: pd.DataFrame) -> None:
    rows = [("n", "k", k, _SHAPES) for k in (0.0, 0.4)] + [("k", "n", n, _GRADIENTS) for n in (1.5, 2.0)]
    words = [f"{name}, {held(**{fixed: value})}" for _, fixed, value, _ in rows for name in _JUMPS.values()]
    lattice = panels(figure, len(rows), 2, words, y=LABELS["mu"], sharey=True)
    for axes, ((across, fixed, value, lines), model) in zip(lattice, product(rows, _JUMPS), strict=True):
        on_lines = pd.MultiIndex.from_frame(table[["n", "k"]]).isin(lines)
        _map(axes, table[on_lines & (table[fixed] == value) & (table["model"] == model)], across)
        axes.set_ylim(0.5, 5.0)
        axes.set_yticks([0.5, 1, 2, 5], labels=["0.5", "1", "2", "5"])
        axes.minorticks_off()
    _finish(figure, "displacement", "\nhatched: no jump, below the critical Tabor number $\\mu_c$ (dotted)")


@paper_figure(_draw_jumps, size=(7.2, 10.4))
def error_maps_jumps() -> Plan[Tables]:
    """Errors of the semi-rigid jump-in and of JKR's jump-out; none where there is no jump."""
    return together({"": errors_along(_SHAPES + _GRADIENTS, ["jump_in_displacement", "jump_out_displacement"])})
