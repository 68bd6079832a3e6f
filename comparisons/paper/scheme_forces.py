"""Pull-off forces of the Stieltjes scheme (Sec. 2.4) and of an accurate solution without what the scheme neglects.

The scheme has N = 2500 uniform segments and neglects the traction beyond f(r_max) = 50.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import simpson
from scipy.optimize import newton

import fscm
from comparisons.model import ComputationFailed
from comparisons.paper.tasks import TRACTION, analysed
from fscm.stieltjes import StieltjesScheme, StieltjesState

#: f(r_max) of the paper, and the segments of its mesh.
HEIGHT, SEGMENTS = 50.0, 2500

#: Of the neglected traction, over log(r): measured error below 1e-8 of the force.
_QUADRATURE_POINTS = 4001
#: First step and tolerance of the central gap at pull-off, over its size: the force is stationary in it, and an
#: error of 1e-3 of it is 3e-7 of the force.
_GAP_STEP, _GAP_TOLERANCE = 0.02, 1e-3


def exact_force(n: float, k: float, mu: float) -> dict[str, float]:
    """Return the converged pull-off force, and how much of it acts where f > `HEIGHT`.

    Returns
    -------
    dict
        ``force`` and its ``u_num``; ``beyond``, the part of the force that the truncated scheme neglects (it also
        moves the surface there, by a constant, on which the pull-off force does not depend); ``central_gap`` at
        pull-off.

    Raises
    ------
    NotApplicable, ComputationFailed
        If the solver refuses or fails.

    Examples
    --------
    >>> result = exact_force(2, 0.4, 1)
    >>> round(result["force"], 8), round(result["beyond"], 6)
    (1.78848171, 0.00101)
    """
    with analysed(n, k, mu) as analysis:
        solution, state = analysis.solution("pull_off_force"), analysis.event("pull_off").value
    log_radius = np.log(state.radius)
    x = np.linspace(math.log(n * HEIGHT) / n, float(log_radius[-1]), _QUADRATURE_POINTS)
    gap = np.exp(n * x) / n - state.displacement + np.interp(x, log_radius, state.deformation)
    load = float(simpson(TRACTION(gap) * 2.0 * np.exp(2.0 * x), x=x))
    return {
        "force": solution.value,
        "u_num": solution.u_num,
        "beyond": -load - float(state.tail.load),
        "central_gap": float(state.central_gap),
    }


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
    with analysed(n, k, mu) as analysis:
        accurate = analysis.event("pull_off").value
    scheme = StieltjesScheme(fscm.Problem(n, k, mu), segments, farthest_height=HEIGHT)
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
