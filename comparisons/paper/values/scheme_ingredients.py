"""Pull-off forces of an accurate solution with one ingredient of the Stieltjes scheme (Sec. 2.4) at a time.

The ingredients are the traction neglected beyond f(r_max) = 50, the N = 2500 uniform segments, the steps of the
central gap of which the largest force is taken, and the last central gap, -0.1.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import simpson
from scipy.optimize import newton

import fscm
from comparisons.model import ComputationFailed
from fscm.solution import State
from fscm.stieltjes import StieltjesScheme, StieltjesState

__all__ = ["GAP_STEPS", "HEIGHTS", "LAST_GAP", "SEGMENTS", "exact_force", "sampled_force", "scheme_force"]

#: f(r_max) of the paper, and two that it might have used for a cone.
HEIGHTS = (50.0, 500.0, 5000.0)
#: Steps of the central gap; the paper does not state its own.
GAP_STEPS = (0.1, 0.05, 0.01, 0.001)
#: Central gap at which the computation of the path ends.
LAST_GAP = -0.1
#: Segments of the mesh that the paper states.
SEGMENTS = 2500

# Of the neglected traction, over log(r): measured error below 1e-8 of the force.
_QUADRATURE_POINTS = 4001
# First step and tolerance of the central gap at pull-off, over its size: the force is stationary in it, and an
# error of 1e-3 of it is 3e-7 of the force.
_GAP_STEP, _GAP_TOLERANCE = 0.02, 1e-3


def exact_force(n: float, k: float, mu: float) -> dict[str, float | list[float]]:
    """Return the converged pull-off force, and how much of it acts beyond each of `HEIGHTS`.

    Returns
    -------
    dict
        ``force`` and its ``u_num``; ``beyond``, the share of the force from radii with f > height, which the
        truncated scheme neglects (it also moves the surface there, by a constant, on which the pull-off force does
        not depend); ``central_gap`` at pull-off.

    Raises
    ------
    ComputationFailed
        If the solver refuses.

    Examples
    --------
    >>> found = exact_force(2, 0.4, 1)
    >>> round(found["force"], 8), round(found["beyond"][0], 6)
    (1.78848171, 0.00101)
    """
    problem = fscm.Problem(n, k, mu)
    solution, state = _pull_off(problem)
    log_radius, deformation = np.log(state.radius), state.deformation

    def beyond(height: float) -> float:
        x = np.linspace(math.log(n * height) / n, float(log_radius[-1]), _QUADRATURE_POINTS)
        gap = np.exp(n * x) / n - state.displacement + np.interp(x, log_radius, deformation)
        return -float(simpson(problem.law.traction(gap) * 2.0 * np.exp(2.0 * x), x=x)) - float(state.tail.load)

    return {
        "force": solution.value,
        "u_num": solution.u_num,
        "beyond": [beyond(height) for height in HEIGHTS],
        "central_gap": float(state.central_gap),
    }


def _pull_off(problem: fscm.Problem) -> tuple[fscm.Solution, State]:
    try:
        analysis = fscm.Analysis(problem)
        return analysis.solution("pull_off_force"), analysis.event("pull_off").value
    except (fscm.NoSuchEvent, fscm.NotConverged) as failure:
        raise ComputationFailed(str(failure)) from failure


def scheme_force(n: float, k: float, mu: float, segments: int = SEGMENTS) -> dict[str, float]:
    """Return the pull-off force of the Stieltjes scheme, f(r_max) = 50, at its own stationary gap.

    The path is not followed: Newton's method starts from the accurate surface, so that only the discretisation
    and the truncation differ.

    Returns
    -------
    dict
        ``force``; its ``u_num``, what the last step of the central gap changed; ``central_gap``.

    Raises
    ------
    ComputationFailed
        If the scheme does not converge.
    """
    problem = fscm.Problem(n, k, mu)
    scheme = StieltjesScheme(problem, segments, farthest_height=HEIGHTS[0])
    _, accurate = _pull_off(problem)
    start, central = np.interp(scheme.radius, accurate.radius, accurate.gap), float(accurate.central_gap)
    states: list[StieltjesState] = []

    def slope(central_gap: float) -> float:
        states.append(scheme.solve(float(central_gap), states[-1].gap if states else start))
        return scheme.rates(states[-1]).load

    size = abs(central)
    try:
        newton(slope, central, x1=central - _GAP_STEP * size, tol=_GAP_TOLERANCE * size)
    except (fscm.NotConverged, RuntimeError) as failure:
        raise ComputationFailed(str(failure)) from failure
    before, last = states[-2:]
    return {"force": -last.load, "u_num": abs(last.load - before.load), "central_gap": last.central_gap}


def sampled_force(n: float, k: float, mu: float) -> dict[str, list[float] | float]:
    """Return the largest force among central gaps 10, 10 - step, ..., for each of `GAP_STEPS`, and that at -0.1.

    Returns
    -------
    dict
        ``sampled``, one force a step; ``at_last_gap``, the largest with central gaps not below -0.1; ``u_num`` of all.

    Raises
    ------
    ComputationFailed
        If the solver refuses.
    """
    solution, state = _pull_off(fscm.Problem(n, k, mu))
    stationary, sampled, u = float(state.central_gap), [], [solution.u_num]
    for step in GAP_STEPS:
        above = math.ceil(stationary / step) * step
        force, u_force = max(_at(n, k, mu, above), _at(n, k, mu, above - step))
        sampled.append(force)
        u.append(u_force)
    at_last_gap = solution.value
    if stationary < LAST_GAP:
        at_last_gap, u_force = _at(n, k, mu, LAST_GAP)
        u.append(u_force)
    return {"sampled": sampled, "at_last_gap": at_last_gap, "u_num": max(u)}


def _at(n: float, k: float, mu: float, central_gap: float) -> tuple[float, float]:
    """Tension at a central gap, with its bound."""
    try:
        (state,) = fscm.equilibria(fscm.Problem(n, k, mu), "central_gap", central_gap)
    except fscm.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    return -state.load, state.u_num
