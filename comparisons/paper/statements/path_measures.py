"""Measures of equilibrium paths: turning points, jumps, curves beside each other, and what is at the jumps."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.special import beta

from comparisons.numerics.curve_distance import curve_distance as distance_of
from comparisons.paper.paper_figure import Plan, result_of, together
from comparisons.paper.solver_tasks import near_critical
from comparisons.paper.statements.measures import ROUNDING, Made, label, measure, measured, of_case
from comparisons.paper.tasks import curve

__all__ = ["count_jumps", "turning_points"]

Array = NDArray[np.float64]

#: Central gap from which the two bodies count as far apart: the paper begins there (Sec. 2.4).
_FAR = 10.0
#: Excesses of the Tabor number over the critical one, of which the distances of the gaps are compared.
_EXCESSES = (1e-4, 1e-2)


def turning_points(displacement: Array, u: float) -> list[int]:
    """Return the points where a displacement turns back by more than twice its bound.

    Examples
    --------
    >>> turning_points(np.array([0.0, 2.0, 1.0, 1.5, 1.4999, 3.0]), 0.001)
    [1, 2]
    """
    turns: list[int] = []
    extreme, rising = 0, True
    for i, value in enumerate(displacement):
        ahead = value - displacement[extreme] if rising else displacement[extreme] - value
        if ahead >= 0.0:
            extreme = i
        elif ahead < -2.0 * u:
            turns.append(extreme)
            extreme, rising = i, not rising
    return turns


def count_jumps(displacement: Array, u: float) -> int:
    """Return how many jumps a machine that controls the displacement sees while it approaches and while it retracts.

    A jump ends where the path rises again to the displacement at which it began; what is between is passed over.

    Examples
    --------
    >>> count_jumps(np.array([0.0, 3.0, 1.0, 2.0, -1.0, 4.0]), 0.001)          # one inside another
    2
    >>> count_jumps(np.array([0.0, 2.0, 1.0, 3.0, -1.0, 4.0]), 0.001)          # two maxima
    3
    """
    count = 0
    for path in (displacement, -displacement[::-1]):
        maxima = path[turning_points(path, u)[::2]]
        # A maximum below one that was passed before it is on a part of the path that the jump leaves out.
        count += len(np.unique(np.maximum.accumulate(maxima)))
    return count


@measure("largest step of the central gap along the path")
def gap_step(reference: str, case: dict[str, float]) -> Made:
    path = yield from result_of(curve, reference, *of_case(case))
    # The gap is as certain as the displacement: delta = -H_0 + w(0) (Eq. 33).
    return np.diff(np.array(path["columns"]["central_gap"], float)).max(), 2.0 * path["u_displacement"]


@measure("")
def turns_of_displacement(reference: str, case: dict[str, float]) -> Made:
    path = yield from result_of(curve, reference, *of_case(case))
    displacement, u = np.array(path["displacement"]), path["u_displacement"]
    turns = turning_points(displacement, u)
    rise = max((displacement[turns[2:-1:2]] - displacement[turns[1:-1:2]]), default=0)
    again = f", between them the displacement rises again by at least {rise:.5f} (bound {2 * u:.1g})" if rise else ""
    return len(turns), 0.0, f"turning points of the displacement, {label(tuple(case.items()))}{again}"


@measure("jumps under displacement control")
def jumps_seen(reference: str, case: dict[str, float]) -> Made:
    path = yield from result_of(curve, reference, *of_case(case))
    return count_jumps(np.array(path["displacement"]), path["u_displacement"]), 0.0


@measure("largest |delta + H_0| / H_0 from H_0 = 10 on")
def far_deformation(reference: str, case: dict[str, float]) -> Made:
    path = yield from result_of(curve, reference, *of_case(case))
    gap, displacement = np.array(path["columns"]["central_gap"], float), np.array(path["displacement"])
    far = gap >= _FAR
    return np.max(np.abs(gap + displacement)[far] / gap[far]), path["u_displacement"] / _FAR


@measure("largest |P| over the pull-off force from H_0 = 10 on")
def far_load(reference: str, case: dict[str, float]) -> Made:
    path = yield from result_of(curve, reference, *of_case(case))
    gap, load = np.array(path["columns"]["central_gap"], float), np.array(path["load"])
    return np.max(np.abs(load)[gap >= _FAR] / -load.min()), 2.0 * path["u_load"] / -load.min()


def _curves(reference: str, case: dict[str, float], model: str) -> Plan[list[Any]]:
    both = yield from together({name: result_of(curve, name, *of_case(case)) for name in (reference, model)})
    return list(both.values())


@measure("distance of the curves, {0} from {reference}")
def curve_distance(reference: str, case: dict[str, float], model: str) -> Made:
    exact, own = yield from _curves(reference, case, model)
    (x, y), (own_x, own_y) = ((np.array(path["displacement"]), np.array(path["load"])) for path in (exact, own))
    # Both bounds as shares of the picture, in which the distance is measured.
    bound = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
    distance = distance_of(own_x, own_y, x, y)
    return distance.value, distance.u_interpolation + 2.0 * bound


@measure("largest difference of the loads of {0} and {reference} over the pull-off force")
def load_difference(reference: str, case: dict[str, float], model: str) -> Made:
    """At one displacement, from the pull-off to the end of the path."""
    exact, own = yield from _curves(reference, case, model)
    (x, y), (own_x, own_y) = _branch(exact), _branch(own)
    inside = (x >= own_x[0]) & (x <= own_x[-1])
    linear, spline = np.interp(x[inside], own_x, own_y), CubicSpline(own_x, own_y)(x[inside])
    depth = -float(y.min())
    return np.abs(spline - y[inside]).max() / depth, (np.abs(spline - linear).max() + exact["u_load"]) / depth


def _branch(path: dict[str, Any]) -> tuple[Array, Array]:
    """Displacements and loads from the smallest load on, where the displacement rises."""
    start = int(np.argmin(path["load"]))
    x, y = np.array(path["displacement"][start:]), np.array(path["load"][start:])
    rising = np.concatenate([[True], np.diff(x) > 0.0])
    return x[rising], y[rising]


@measure("distance of the gaps against the square root of the excess")
def gap_cusp(reference: str, case: dict[str, float]) -> Made:
    onset = yield from result_of(near_critical, case["n"], case["k"])
    distances, u = [], 0.0
    for excess in _EXCESSES:
        at = next(jump for jump in onset["jumps"] if abs(jump["mu"] / onset["mu"] - 1.0 - excess) < 1e-9)
        distances.append(at["jump_in_gap"] - at["jump_out_gap"])
        u = u + at["u_jump_in_gap"] + at["u_jump_out_gap"]
    ratio = distances[0] / distances[1] / (_EXCESSES[0] / _EXCESSES[1]) ** 0.5
    return abs(ratio - 1.0), ratio * u * (1.0 / distances[0] + 1.0 / distances[1])


@measure("repulsive over attractive term of Eq. {0} at jump-in")
def repulsion(reference: str, case: dict[str, float], equation: str) -> Made:
    gap = yield from measured("jump_in_gap", reference, tuple(case.items()))
    b = ((1.0 - case["k"]) if equation == "41" else 2.0) / case["n"]
    share = float(beta(9.0 - b, b) / beta(3.0 - b, b)) / (gap.value + 1.0) ** 6
    return share, share * (6.0 * gap.u / (gap.value + 1.0) + ROUNDING)
