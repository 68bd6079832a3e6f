"""Finding: between two critical Tabor numbers the gradient exponent decides whether there is hysteresis."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import near_critical
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity

__all__ = ["ONSET"]

_N, _MU = 2.0, 0.74
_GRADIENTS = (0.0, 0.2, 0.4, 0.6)
_CHECKED = (0.0, 0.4)
#: Tabor numbers of Fig. 6.
_SHOWN = (0.5, 1.0)


def _energy(model: str, k: float) -> CachedCall:
    return CachedCall.of(quantity, model, "hysteresis_energy", _N, k, _MU)


def _tasks() -> Sequence[CachedCall]:
    critical = [CachedCall.of(near_critical, _N, k) for k in _GRADIENTS]
    return [*critical, *(_energy(model, k) for model in ("fscm", "fem") for k in _CHECKED)]


def _tables(results: Results) -> Tables:
    critical = [results[CachedCall.of(near_critical, _N, k)] for k in _GRADIENTS]
    rows = [
        {"n": _N, "k": k, "mu": found["mu"], "u_mu": found["u_mu"]}
        for k, found in zip(_GRADIENTS, critical, strict=True)
    ]
    energies = [
        {"model": model, "n": _N, "k": k, "mu": _MU} | results[_energy(model, k)]
        for model in ("fscm", "fem")
        for k in _CHECKED
    ]
    return {"": pd.DataFrame(rows), "energies": pd.DataFrame(energies)}


def _draw(tables: Tables) -> Figure:
    critical = tables[""]
    with styled():
        figure = Figure(figsize=(5.0, 3.6), layout="constrained")
        axes = figure.subplots()
        axes.plot(critical["k"], critical["mu"], color=COLOURS[0], marker="o", ms=4, label="critical Tabor number")
        low, high = critical["mu"].min(), critical["mu"].max()
        axes.axhspan(low, high, color=COLOURS[1], alpha=0.15, lw=0, label="the gradient exponent decides")
        for mu in _SHOWN:
            axes.axhline(mu, color="0.5", lw=0.8, ls=":")
            axes.annotate(f"Fig. 6: μ = {mu:g}", (0.6, mu), (0, 3), textcoords="offset points", ha="right", fontsize=8)
        fem = tables["energies"][tables["energies"]["model"] == "fem"]
        for status, face, label in (
            ("ok", COLOURS[2], "jumps (both references)"),
            ("not-applicable", "white", "no jump (both references)"),
        ):
            part = fem[fem["status"] == status]
            axes.plot(part["k"], part["mu"], ls="none", marker="s", ms=7, color=COLOURS[2], mfc=face, label=label)
        axes.set(xlabel="gradient exponent $k$", ylabel=r"Tabor number $\mu$", ylim=(0.2, 1.1), xlim=(-0.03, 0.63))
        axes.legend(loc="lower left", fontsize=8)
    return figure


ONSET = PaperFigure(
    name="finding-onset",
    stem="finding_onset",
    title="Onset of hysteresis over the gradient exponent at n = 2",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
