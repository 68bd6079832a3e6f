"""Fig. 12: the cohesive stress eta(n), and the surface laws of the three models."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.output.style import COLOURS, MODEL_LINES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, level, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.solver_tasks import TRACTION

__all__ = ["dugdale", "fig12_surface_laws"]

_MARKED = (1.0, 1.5, 2.0, 5.0)
_SHAPES = np.unique(np.concatenate([np.geomspace(0.7, 100.0, 200), _MARKED]))
_GAPS = np.linspace(-0.08, 4.0, 409)
#: Shape index whose improved law is drawn.
_DRAWN = 2.0


def stresses() -> list[float]:
    """Return eta (Eq. 77) at `_SHAPES`."""
    return [eta(float(n)) for n in _SHAPES]


def dugdale(stress: float) -> pd.DataFrame:
    """Return the corners of Dugdale's law: -stress up to the gap 1 / stress, so that its area is dgamma.

    Examples
    --------
    >>> dugdale(0.5).values.tolist()
    [[0.0, 0.0], [0.0, -0.5], [2.0, -0.5], [2.0, 0.0], [4.0, 0.0]]
    """
    ends = [0.0, 0.0, 1.0 / stress, 1.0 / stress, float(_GAPS[-1])]
    return pd.DataFrame({"gap": ends, "pressure": [0.0, -stress, -stress, 0.0, 0.0]})


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, ("", ""))
    _stresses(left, tables[""][np.isfinite(tables[""]["n"])])
    names = {
        "fscm": "FSCM (9-3 law)",
        "md-original": rf"original M-D: $\sigma_0$ = {THEORETICAL_STRENGTH:.3f}",
        "md-improved": rf"improved M-D, $n$ = {_DRAWN:g}: $\sigma_0$ = {eta(_DRAWN):.3f}",
    }
    for model, law in zip(names, of_model(tables["laws"], *names), strict=True):
        right.plot(law["gap"], law["pressure"], label=names[model], **MODEL_LINES[model])
    level(right)
    right.set(xlabel=r"gap $H/z_0$", ylabel=r"pressure $p_s z_0/\Delta\gamma$", xlim=(-0.1, 4), ylim=(-1.15, 0.9))
    right.legend(loc="upper right")


def _stresses(axes: Axes, table: pd.DataFrame) -> None:
    axes.plot(table["n"], table["eta"], color=COLOURS[0], label=r"$\eta(n)$")
    axes.axhline(THEORETICAL_STRENGTH, color=COLOURS[2], ls=":", label=r"theoretical strength $\sigma_{\mathrm{th}}$")
    for n in _MARKED:
        axes.plot(n, eta(n), "o", color=COLOURS[0], ms=4)
        axes.annotate(f"({n:g}, {eta(n):.3f})", (n, eta(n)), (6, -9), textcoords="offset points", fontsize=8)
    axes.annotate(f"{THEORETICAL_STRENGTH:.3f}", (1.0, THEORETICAL_STRENGTH), (0, 3), textcoords="offset points")
    ticks = (1, 2, 5, 10, 20, 50, 100)
    axes.set(xscale="log", xlim=(0.7, 100), ylim=(0, 1.15))
    axes.set(xlabel=LABELS["n"], ylabel=r"cohesive stress $\sigma_0 z_0/\Delta\gamma$")
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.legend(loc="lower right")


@paper_figure(_picture)
def fig12_surface_laws() -> Plan[Tables]:
    """The cohesive stress eta(n), and the surface laws of the FSCM and both Maugis-Dugdale models."""
    results = yield {"eta": CachedCall.of(stresses)}
    laws = {
        "fscm": pd.DataFrame({"gap": _GAPS, "pressure": TRACTION(_GAPS)}),
        "md-original": dugdale(THEORETICAL_STRENGTH),
        "md-improved": dugdale(eta(_DRAWN)),
    }
    parts = [law.assign(model=model)[["model", "gap", "pressure"]] for model, law in laws.items()]
    return {
        "": pd.DataFrame({"n": [*_SHAPES, math.inf], "eta": [*results["eta"], eta(math.inf)]}),
        "laws": pd.concat(parts, ignore_index=True),
    }
