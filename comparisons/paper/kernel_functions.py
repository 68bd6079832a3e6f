"""Fig. 2: the functions that take the singularity out of the integral equation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.figures.style import COLOURS, LINES, styled
from comparisons.paper.plate import Plate, Tables
from comparisons.paper.workshop import Answers, Call
from fscm import kernel

__all__ = ["KERNEL_FUNCTIONS"]

#: Gradient exponents; at k = 1 both functions are steps at s = 1.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 0.8)
#: The derivative is singular at s = 1, where the curve is cut.
_RATIOS = np.unique(
    np.concatenate([np.linspace(0.0, 3.0, 151), 1.0 + np.geomspace(1e-4, 0.02, 12), 1.0 - np.geomspace(1e-4, 0.02, 12)])
)


def values(k: float) -> dict[str, list[float | None]]:
    """Return Phi_k (Eq. 18), its derivative (Eq. 19) and Psi_k (Eq. 22) at `_RATIOS`; None where infinite.

    Examples
    --------
    >>> values(0.4)["psi"][0]
    0.0
    """
    away = _RATIOS != 1.0
    slope = np.full(_RATIOS.shape, np.nan)
    # Eq. 19 is (1-k) times the ring response at unit radius.
    slope[away] = (1.0 - k) * kernel.ring_response(k, np.ones(away.sum()), _RATIOS[away])
    return {
        "phi": kernel.Phi(k, _RATIOS).tolist(),
        "slope": [None if np.isnan(value) else float(value) for value in slope],
        "psi": kernel.Psi(k, _RATIOS).tolist(),
    }


def _calls() -> Sequence[Call]:
    return [Call.of(values, k) for k in _GRADIENTS]


def _tables(answers: Answers) -> Tables:
    parts = [pd.DataFrame({"k": k, "s": _RATIOS} | answers[Call.of(values, k)]).astype(float) for k in _GRADIENTS]
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 3.4), layout="constrained")
        left, right = figure.subplots(1, 2)
        for index, (k, part) in enumerate(tables[""].groupby("k")):
            colour, line = COLOURS[index], LINES[index]
            left.plot(part["s"], part["phi"], color=colour, ls=line, label=f"k = {k:g}")
            left.plot(part["s"], part["slope"], color=colour, ls=line, lw=0.7)
            right.plot(part["s"], part["psi"], color=colour, ls=line, label=f"k = {k:g}")
        left.set(xlabel="s = t/r", ylabel=r"$\Phi_k$ (thick), $\Phi_k'$ (thin)", xlim=(0, 3), ylim=(0, 3), title="(a)")
        right.set(xlabel="s = t/r", ylabel=r"$\Psi_k$", xlim=(0, 3), title="(b)")
        left.legend()
        right.legend()
    return figure


KERNEL_FUNCTIONS = Plate(
    name="2",
    stem="fig02_kernel_functions",
    title="The functions Phi_k, its derivative, and Psi_k",
    calls=_calls,
    tables=_tables,
    draw=_draw,
)
