"""Finding: the printed end 6.219 of the range of small chi is that of k up to 0.999."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.values.sampling import LAST_K

__all__ = ["CHI_RANGE"]

_SHAPES = np.linspace(6.213, 6.223, 11)
_LAST = (1.0, 0.9995, LAST_K)
_PRINTED, _LIMIT = 6.219, 10.0


def near_the_end(up_to: float) -> list[float]:
    """Return the largest chi over k, up to a last k, at the shapes of the figure.

    Examples
    --------
    >>> bool(near_the_end(1.0)[0] < 0.1 < near_the_end(1.0)[-1])
    True
    """
    return [largest_chi(float(n), up_to)[0] for n in _SHAPES]


def _tasks() -> Sequence[CachedCall]:
    return [CachedCall.of(function, last) for last in _LAST for function in (near_the_end, insensitive_regions)]


def _tables(results: Results) -> Tables:
    parts = [
        pd.DataFrame({"last_k": last, "n": _SHAPES, "chi_max": results[CachedCall.of(near_the_end, last)]})
        for last in _LAST
    ]
    ends = [{"last_k": last, "n_to": results[CachedCall.of(insensitive_regions, last)][3]} for last in _LAST]
    return {"": pd.concat(parts, ignore_index=True), "ends": pd.DataFrame(ends)}


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(5.0, 3.4), layout="constrained")
        axes = figure.subplots()
        for index, (last, end) in enumerate(tables["ends"].to_numpy()):
            part = tables[""][tables[""]["last_k"] == last]
            style = {"color": COLOURS[index], "ls": LINES[index], "marker": "o", "ms": 3}
            axes.plot(part["n"], 100.0 * part["chi_max"], label=rf"$k \leq$ {last:g}: 10 % at $n$ = {end:.4f}", **style)
        axes.axhline(_LIMIT, color="0.4", lw=0.8, ls="--")
        axes.axvline(_PRINTED, color="0.4", lw=0.8, ls=":", label=f"printed: {_PRINTED}")
        axes.set(xlabel="shape index $n$", ylabel=r"largest deviation $\chi_{\max}$ (%)")
        axes.legend()
    return figure


CHI_RANGE = PaperFigure(
    name="finding-chi-range",
    stem="finding_chi_range",
    title="End of the second range of small chi, for three largest gradient exponents",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
