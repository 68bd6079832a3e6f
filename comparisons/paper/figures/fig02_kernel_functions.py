"""Fig. 2: primitives of the ring response, which remove the singularity of the integral equation."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import fscm
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import legend_below, line_a_value, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure

__all__ = ["RATIOS", "values"]

#: Gradient exponents; at k = 1, the Gibson limit, both functions are steps at s = 1.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
_FARTHEST = 3.0
#: Near s = 0, where Psi_k falls like -s^(1-k), and on both sides of s = 1, where the derivative is singular.
_NEAR = np.geomspace(1e-6, 0.02, 24)
#: Ratios of radii s = t/r.
RATIOS = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, 151), _NEAR, 1.0 + _NEAR, 1.0 - _NEAR]))


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
        phi = np.heaviside(RATIOS - 1.0, 0.5)
        slope = np.where(RATIOS == 1.0, np.inf, 0.0)
        psi = np.where(RATIOS > 0.0, phi - 1.0, 0.0)
    else:
        phi, psi = fscm.Phi(k, RATIOS), fscm.Psi(k, RATIOS)
        away = RATIOS != 1.0
        slope = np.full(RATIOS.shape, np.inf)
        # Eq. 19 is (1-k) times the ring response at unit radius.
        slope[away] = (1.0 - k) * fscm.ring_response(k, np.ones(away.sum()), RATIOS[away])
    finite = [float(value) if np.isfinite(value) else None for value in slope]
    return {"phi": phi.tolist(), "slope": finite, "psi": psi.tolist()}


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, ("", ""), "ratio of radii $s = t/r$")
    table = tables[""]
    line_a_value(left, table, "k", "s", "phi")
    line_a_value(left, table[table["k"] < 1.0], "k", "s", "slope", lw=0.7, label="_")
    # At k = 1 Psi jumps at s = 0, too.
    line_a_value(right, table[(table["k"] < 1.0) | (table["s"] > 0.0)], "k", "s", "psi")
    left.set(ylabel=r"$\Phi_k(s)$ (thick), $\Phi_k'(s)$ (thin)", xlim=(0.0, _FARTHEST), ylim=(0.0, 2.5))
    right.set(ylabel=r"$\Psi_k(s)$", xlim=(0.0, _FARTHEST), ylim=(-1.05, 0.05))
    legend_below(figure, len(_GRADIENTS))


@paper_figure(_picture, size=(7.2, 3.8))
def fig02_kernel_functions() -> Plan[Tables]:
    """The functions Phi_k, its derivative, and Psi_k."""
    results = yield {k: CachedCall.of(values, k) for k in _GRADIENTS}
    parts = [pd.DataFrame({"k": k, "s": RATIOS} | columns).astype(float) for k, columns in results.items()]
    return {"": pd.concat(parts, ignore_index=True)}
