"""Figs. 2 and 12: functions inside the models: the kernel of the integral equation, and the surface laws."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import fscm
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.output.style import COLOURS
from comparisons.paper.drawing import LABELS, by_model, held, legend_below, level, lines_by, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, rows_of, together
from comparisons.paper.tasks import SHAPES, TRACTION

#: Gradient exponents; at k = 1, the Gibson limit, both functions are steps at s = 1.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
_FARTHEST = 3.0
#: Near s = 0, where Psi_k falls like -s^(1-k), and on both sides of s = 1, where the derivative is singular.
_NEAR = np.geomspace(1e-6, 0.02, 24)
#: Ratios of radii s = t/r.
RATIOS = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, 151), _NEAR, 1.0 + _NEAR, 1.0 - _NEAR]))

_GAPS = np.linspace(-0.08, 4.0, 409)
#: Shape index whose improved law is drawn.
_DRAWN = 2.0


def kernel_functions(k: float) -> dict[str, list[float | None]]:
    """Return Phi_k (Eq. 18), its derivative (Eq. 19) and Psi_k (Eq. 22) over s = t/r; None where infinite.

    At k = 1 they are the limits k -> 1 at every s: a step, zero but for a delta function at s = 1, and a step.

    Examples
    --------
    >>> kernel_functions(0.4)["psi"][0], kernel_functions(1.0)["phi"][-1]
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
    return {"s": RATIOS.tolist(), "phi": phi.tolist(), "slope": finite, "psi": psi.tolist()}


def _kernel(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, 1, 2, ("", ""), "ratio of radii $s = t/r$")
    lines_by(left, table, "k", "s", "phi")
    lines_by(left, table[table["k"] < 1.0], "k", "s", "slope", lw=0.7, label="_")
    # At k = 1 Psi jumps at s = 0, too.
    lines_by(right, table[(table["k"] < 1.0) | (table["s"] > 0.0)], "k", "s", "psi")
    left.set(ylabel=r"$\Phi_k(s)$ (thick), $\Phi_k'(s)$ (thin)", xlim=(0.0, _FARTHEST), ylim=(0.0, 2.5))
    right.set(ylabel=r"$\Psi_k(s)$", xlim=(0.0, _FARTHEST), ylim=(-1.05, 0.05))
    legend_below(figure, len(_GRADIENTS))


@paper_figure(_kernel, size=(7.2, 3.8))
def fig02_kernel_functions() -> Plan[Tables]:
    """The functions Phi_k, its derivative, and Psi_k."""
    return together({"": rows_of(keyed(kernel_functions, k=k) for k in _GRADIENTS)})


def dugdale(stress: float) -> pd.DataFrame:
    """Return the corners of Dugdale's law: -stress up to the gap 1 / stress, so that its area is dgamma.

    Examples
    --------
    >>> dugdale(0.5).values.tolist()
    [[0.0, 0.0], [0.0, -0.5], [2.0, -0.5], [2.0, 0.0], [4.0, 0.0]]
    """
    ends = [0.0, 0.0, 1.0 / stress, 1.0 / stress, float(_GAPS[-1])]
    return pd.DataFrame({"gap": ends, "pressure": [0.0, -stress, -stress, 0.0, 0.0]})


def _laws(figure: Figure, table: pd.DataFrame, laws: pd.DataFrame) -> None:
    left, right = panels(figure, 1, 2, ("", f"{held(n=_DRAWN)} (improved M-D)"))
    left.plot("n", "eta", data=table[np.isfinite(table["n"])], color=COLOURS[0], label=r"$\eta(n)$")
    strength = rf"theoretical strength $\sigma_{{\mathrm{{th}}}}$ = {THEORETICAL_STRENGTH:.3f}"
    left.axhline(THEORETICAL_STRENGTH, color=COLOURS[2], ls=":", label=strength)
    left.set(xscale="log", xlim=(0.7, 100), ylim=(0, 1.15))
    left.set(xlabel=LABELS["n"], ylabel=r"cohesive stress $\sigma_0 z_0/\Delta\gamma$")
    left.xaxis.set_major_formatter("{x:g}")
    left.legend(loc="lower right")
    by_model(right, laws, "gap", "pressure")
    level(right)
    right.set(xlabel=r"gap $H/z_0$", ylabel=r"pressure $p_s z_0/\Delta\gamma$", xlim=(-0.1, 4), ylim=(-1.15, 0.9))
    right.legend(loc="upper right")


@paper_figure(_laws)
def fig12_surface_laws() -> Plan[Tables]:
    """The cohesive stress eta(n), and the surface laws of the FSCM and both Maugis-Dugdale models."""
    yield {}
    shapes = [*np.unique(np.concatenate([np.geomspace(0.7, 100.0, 200), SHAPES])).tolist(), math.inf]
    laws = {
        "fscm": pd.DataFrame({"gap": _GAPS, "pressure": TRACTION(_GAPS)}),
        "md-original": dugdale(THEORETICAL_STRENGTH),
        "md-improved": dugdale(eta(_DRAWN)),
    }
    parts = [law.assign(model=model)[["model", "gap", "pressure"]] for model, law in laws.items()]
    stresses = pd.DataFrame({"n": shapes, "eta": [eta(n) for n in shapes]})
    return {"": stresses, "laws": pd.concat(parts, ignore_index=True)}
