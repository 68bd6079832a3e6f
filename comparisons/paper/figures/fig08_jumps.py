"""Fig. 8: displacement and central gap at the two jumps, over the Tabor number."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.solver import translated
from comparisons.output.style import COLOURS, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, dashed, legend_below
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
from fscm import Analysis, NoSuchEvent, NotConverged, solve
from fscm.problem import Problem

__all__ = ["JUMPS", "QUANTITIES", "TABOR_NUMBERS", "jumps", "near_critical"]

_GRADIENTS = (0.0, 0.2, 0.4, 0.6)
#: Above the critical Tabor numbers, which are between 0.69 and 0.79.
TABOR_NUMBERS = (0.85, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
#: The gaps of the two jumps part like the square root of the excess over the critical Tabor number.
_EXCESSES = (1e-4, 1e-3, 4e-3, 1e-2, 2e-2, 4e-2, 7e-2, 0.12)
#: Where the two branches are named.
_LABEL_AT = 3.5
_LABELS = {
    ("displacement", "in"): (12, 10),
    ("displacement", "out"): (32, 2),
    ("gap", "in"): (-28, 10),
    ("gap", "out"): (-75, 6),
}
#: Places of the insets and what they show.
_INSETS = {"displacement": (0.13, 0.08, 0.38, 0.4), "gap": (0.52, 0.16, 0.45, 0.33)}
_NEAR, _NEAR_RANGES = (0.65, 0.95), {"displacement": (-1.7, -1.1), "gap": (0.0, 0.6)}
#: Quantities at both jumps.
QUANTITIES = ("jump_in_displacement", "jump_in_gap", "jump_out_displacement", "jump_out_gap")


def jumps(n: float, k: float, mu: float) -> dict[str, float]:
    """Return the displacement and the central gap at both jumps, by quantity, each with its ``u_``.

    Raises
    ------
    comparisons.model.NotApplicable
        Below the critical Tabor number.
    comparisons.model.ComputationFailed
        If a fold was not reached.

    Examples
    --------
    >>> found = jumps(2, 0.4, 1)
    >>> found["jump_out_displacement"] < found["jump_in_displacement"] < 0
    True
    """
    analysis = Analysis(Problem(n, k, mu))
    found: dict[str, float] = {}
    with translated(NoSuchEvent, NotConverged):
        for name in QUANTITIES:
            solution = analysis.solution(name)
            found |= {name: float(solution.value), f"u_{name}": float(solution.u_num)}
    return found


def near_critical(n: float, k: float) -> dict[str, Any]:
    """Return the critical Tabor number, ``mu`` and ``u_mu``, and ``jumps`` just above it, each with its ``mu``.

    Raises
    ------
    comparisons.model.NotApplicable, comparisons.model.ComputationFailed
        As `jumps`.
    """
    with translated(NoSuchEvent, NotConverged):
        critical = solve(Problem(n, k, 1.0), "critical_tabor_number")
    above = [float(critical.value) * (1.0 + excess) for excess in _EXCESSES]
    found = [{"mu": mu} | jumps(n, k, mu) for mu in above]
    return {"mu": float(critical.value), "u_mu": float(critical.u_num), "jumps": found}


def _plan() -> Plan[Tables]:
    onsets = {k: CachedCall.of(near_critical, 2.0, k) for k in _GRADIENTS}
    beyond = {(k, mu): CachedCall.of(jumps, 2.0, k, mu) for mu in reversed(TABOR_NUMBERS) for k in _GRADIENTS}
    results = yield [*onsets.values(), *beyond.values()]
    critical = pd.DataFrame([{"n": 2.0, "k": k} | results[call] for k, call in onsets.items()])
    rows = [{"n": 2.0, "k": k} | row for k, call in onsets.items() for row in results[call]["jumps"]]
    rows += [{"n": 2.0, "k": k, "mu": mu} | results[call] for (k, mu), call in beyond.items()]
    table = pd.DataFrame(rows).sort_values(["k", "mu"], ignore_index=True)
    return {"": table, "critical": critical.drop(columns="jumps")}


def _picture(figure: Figure, tables: Tables) -> None:
    panels = figure.subplots(1, 2)
    for axes, kind, letter in zip(panels, ("displacement", "gap"), "ab", strict=True):
        _branches(axes, tables, kind)
        lettered(axes, letter, "$n$ = 2")
        axes.set(xlabel=LABELS["mu"], xlim=(0.5, 5.0))
    panels[0].set_ylabel(r"displacement at the jumps $\delta/z_0$")
    panels[1].set_ylabel(r"central gap at the jumps $H_0/z_0$")
    legend_below(figure, 4)


def _branches(axes: Axes, tables: Tables, kind: str) -> None:
    # Where the branches begin, enlarged.
    inset = axes.inset_axes(_INSETS[kind])
    for index, (k, mu) in enumerate(zip(_GRADIENTS, tables["critical"]["mu"], strict=True)):
        part = tables[""][tables[""]["k"] == k]
        style = dashed(index)
        inward, outward = part[f"jump_in_{kind}"], part[f"jump_out_{kind}"]
        # Both branches begin in one point, at the critical Tabor number, between their first points.
        meeting = 0.5 * (inward.iloc[0] + outward.iloc[0])
        for shown in (axes, inset):
            label = rf"$k$ = {k:g}, $\mu_c$ = {mu:.5f}"
            shown.plot([mu, *part["mu"]], [meeting, *inward], label=label, **style)
            shown.plot([mu, *part["mu"]], [meeting, *outward], **style)
            shown.plot(mu, meeting, marker="o", ms=4, color=COLOURS[index], mfc="white")
    inset.set(xlim=_NEAR, ylim=_NEAR_RANGES[kind])
    inset.tick_params(labelsize=7, pad=2)
    last = tables[""][tables[""]["mu"] == _LABEL_AT]
    for name in ("in", "out"):
        place = (_LABEL_AT, float(last[f"jump_{name}_{kind}"].mean()))
        axes.annotate(f"jump {name}", place, _LABELS[kind, name], textcoords="offset points", ha="center")


JUMPS = PaperFigure(
    name="8",
    stem="fig08_jumps",
    title="Displacement and central gap at the jumps for n = 2, over the Tabor number",
    plan=_plan,
    picture=_picture,
    size=(7.2, 3.8),
)
