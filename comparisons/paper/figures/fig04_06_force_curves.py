"""Figs. 4 and 6: families of force-displacement curves, over Tabor numbers and over gradient exponents."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, gradient, legend_below, level
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, lines_of
from comparisons.paper.tasks import curve

__all__ = ["OVER_GRADIENTS", "OVER_TABOR_NUMBERS", "curves"]

Case = tuple[float, float, float]
Range = tuple[float, float]

#: Ranges of displacement and load of each panel, by shape index.
_SHAPES: dict[float, tuple[Range, Range]] = {
    1.0: ((-5.0, 13.0), (-17.5, 2.5)),
    1.5: ((-5.0, 6.0), (-3.6, 1.0)),
    2.0: ((-6.0, 6.0), (-2.15, 0.6)),
    5.0: ((-7.0, 4.0), (-1.75, 0.5)),
}
_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
#: Ranges of displacement and load of each panel, by Tabor number.
_PANELS_6: dict[float, tuple[Range, Range]] = {
    0.5: ((-4.0, 1.5), (-2.15, 0.8)),
    1.0: ((-4.0, 2.5), (-2.15, 0.8)),
}


def curves(cases: Iterable[Case]) -> Plan[Tables]:
    """Plan the table of the curves of the FSCM in these cases."""
    calls = {case: CachedCall.of(curve, "fscm", *case) for case in cases}
    # The cone and large Tabor numbers take longest.
    results = yield [calls[case] for case in sorted(calls, key=lambda case: (case[0], -case[2]))]
    parts = []
    for (n, k, mu), call in calls.items():
        key = {"n": n, "k": k, "mu": mu, "status": results[call]["status"]}
        parts.append(lines_of(key, results[call], ["displacement", "u_displacement", "load", "u_load"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _family(axes: Axes, table: pd.DataFrame, name: str, labels: Sequence[str], ranges: tuple[Range, Range]) -> None:
    for index, (label, (_, part)) in enumerate(zip(labels, table.groupby(name), strict=True)):
        # Dashes would hide folds; markers at equal distances tell the curves apart in grey.
        axes.plot(
            part["displacement"],
            part["load"],
            color=COLOURS[index],
            marker=MARKERS[index],
            ms=3.0,
            mfc="white",
            lw=1.0,
            markevery=(0.03 * (1 + index), 0.24),
            label=label,
        )
    level(axes)
    axes.set(xlim=ranges[0], ylim=ranges[1])


def _finish(figure: Figure, columns: int) -> None:
    # Two panels a row.
    for axes in figure.axes[-2:]:
        axes.set_xlabel(LABELS["displacement"])
    for axes in figure.axes[::2]:
        axes.set_ylabel(LABELS["load"])
    legend_below(figure, columns)


def _picture_4(figure: Figure, tables: Tables) -> None:
    labels = [rf"$\mu$ = {mu:g}" for mu in _TABOR_NUMBERS]
    for letter, axes, (n, ranges) in zip("abcd", figure.subplots(2, 2).flat, _SHAPES.items(), strict=True):
        _family(axes, tables[""][tables[""]["n"] == n], "mu", labels, ranges)
        lettered(axes, letter, f"$n$ = {n:g}, $k$ = 0.4")
    _finish(figure, len(labels))


def _picture_6(figure: Figure, tables: Tables) -> None:
    labels = [gradient(k) for k in _GRADIENTS]
    for letter, axes, (mu, ranges) in zip("ab", figure.subplots(1, 2), _PANELS_6.items(), strict=True):
        _family(axes, tables[""][tables[""]["mu"] == mu], "k", labels, ranges)
        lettered(axes, letter, rf"$n$ = 2, $\mu$ = {mu:g}")
    _finish(figure, len(labels))


OVER_TABOR_NUMBERS = PaperFigure(
    name="4",
    stem="fig04_force_curves_over_tabor_numbers",
    title="Force-displacement curves for k = 0.4 and four shapes, over the Tabor number",
    plan=lambda: curves((n, 0.4, mu) for n in _SHAPES for mu in _TABOR_NUMBERS),
    picture=_picture_4,
    size=(7.2, 6.0),
    follows_path=True,
)

OVER_GRADIENTS = PaperFigure(
    name="6",
    stem="fig06_force_curves_over_gradients",
    title="Force-displacement curves for n = 2, mu = 0.5 and 1, over the gradient exponent",
    plan=lambda: curves((2.0, k, mu) for mu in _PANELS_6 for k in _GRADIENTS),
    picture=_picture_6,
    size=(7.2, 3.6),
    follows_path=True,
)
