"""Fig. 2: primitives of the ring response, which remove the singularity of the integral equation."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import fscm
from comparisons.output.style import lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import dashed, gradient, legend_below
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables

__all__ = ["KERNEL_FUNCTIONS", "values"]

#: Gradient exponents; at k = 1, the Gibson limit, both functions are steps at s = 1.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
_FARTHEST = 3.0
#: Near s = 0, where Psi_k falls like -s^(1-k), and on both sides of s = 1, where the derivative is singular.
_NEAR = np.geomspace(1e-6, 0.02, 24)
_RATIOS = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, 151), _NEAR, 1.0 + _NEAR, 1.0 - _NEAR]))


def values(k: float) -> dict[str, list[float | None]]:
    """Return Phi_k (Eq. 18), its derivative (Eq. 19) and Psi_k (Eq. 22) over s = t/r; None where infinite.

    At k = 1 they are the limits k -> 1 at every s: a step, zero but for a delta function at s = 1, and a step.

    Examples
    --------
    >>> values(0.4)["psi"][0], values(1.0)["phi"][-1]
    (0.0, 1.0)
    """
    if k == 1.0:
        # Phi_k(1) = Gamma(1-k) / [Gamma((1-k)/2) Gamma((3-k)/2)] -> 1/2, and Psi_k(0) = 0 for every k < 1.
        phi = np.heaviside(_RATIOS - 1.0, 0.5)
        slope = np.where(_RATIOS == 1.0, np.inf, 0.0)
        psi = np.where(_RATIOS > 0.0, phi - 1.0, 0.0)
    else:
        phi, psi = fscm.Phi(k, _RATIOS), fscm.Psi(k, _RATIOS)
        away = _RATIOS != 1.0
        slope = np.full(_RATIOS.shape, np.inf)
        # Eq. 19 is (1-k) times the ring response at unit radius.
        slope[away] = (1.0 - k) * fscm.ring_response(k, np.ones(away.sum()), _RATIOS[away])
    return {
        "phi": phi.tolist(),
        "slope": [float(value) if np.isfinite(value) else None for value in slope],
        "psi": psi.tolist(),
    }


def _plan() -> Plan[Tables]:
    calls = {k: CachedCall.of(values, k) for k in _GRADIENTS}
    results = yield list(calls.values())
    parts = [pd.DataFrame({"k": k, "s": _RATIOS} | results[call]).astype(float) for k, call in calls.items()]
    return {"": pd.concat(parts, ignore_index=True)}


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    for index, (k, part) in enumerate(tables[""].groupby("k")):
        left.plot(part["s"], part["phi"], label=gradient(k), **dashed(index))
        if k < 1.0:
            left.plot(part["s"], part["slope"], lw=0.7, **dashed(index))
        shown = part[part["s"] > 0.0] if k == 1.0 else part
        right.plot(shown["s"], shown["psi"], **dashed(index))
    left.set(ylabel=r"$\Phi_k(s)$ (thick), $\Phi_k'(s)$ (thin)", ylim=(0.0, 2.5))
    right.set(ylabel=r"$\Psi_k(s)$", ylim=(-1.05, 0.05))
    for axes, letter in ((left, "a"), (right, "b")):
        axes.set(xlabel="ratio of radii $s = t/r$", xlim=(0.0, _FARTHEST))
        lettered(axes, letter)
    legend_below(figure, len(_GRADIENTS))


KERNEL_FUNCTIONS = PaperFigure(
    name="2",
    stem="fig02_kernel_functions",
    title="The functions Phi_k, its derivative, and Psi_k",
    plan=_plan,
    picture=_picture,
    size=(7.2, 3.8),
)
