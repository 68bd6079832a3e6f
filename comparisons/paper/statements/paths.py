"""Measures of equilibrium paths: turning points, jumps, curves beside each other, and what is at the jumps."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import beta

from comparisons.model import Array
from comparisons.numerics.curve_distance import curve_distance as distance_of
from comparisons.paper.paper_figure import Plan, result_of
from comparisons.paper.statements.evidence import Number
from comparisons.paper.statements.measures import ROUNDING, Measured, Place, call, measure, term
from comparisons.paper.tasks import curve, near_critical

__all__ = ["count_jumps", "turning_points"]

Path = dict[str, Any]

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


#: Paths of the reference, and of the model that the term names.
_PATH, _PATH_OF_MODEL = call(curve, "{reference}"), call(curve, "{0}")


def _gaps(path: Path) -> Array:
    return np.array(path["central_gap"], float)


@measure("largest step of the central gap along the path", _PATH)
def gap_step(at: Place, path: Path) -> Measured:
    # The gap is as certain as the displacement: delta = -H_0 + w(0) (Eq. 33).
    return np.diff(_gaps(path)).max(), 2.0 * path["u_displacement"]


@measure("", _PATH)
def turns_of_displacement(at: Place, path: Path) -> Measured:
    displacement, u = np.array(path["displacement"]), path["u_displacement"]
    turns = turning_points(displacement, u)
    rise = max((displacement[turns[2:-1:2]] - displacement[turns[1:-1:2]]), default=0)
    again = f", between them the displacement rises again by at least {rise:.5f} (bound {2 * u:.1g})" if rise else ""
    return len(turns), 0.0, f"turning points of the displacement, {at.label}{again}"


@measure("jumps under displacement control", _PATH)
def jumps_seen(at: Place, path: Path) -> Measured:
    return count_jumps(np.array(path["displacement"]), path["u_displacement"]), 0.0


@measure("largest |delta + H_0| / H_0 from H_0 = 10 on", _PATH)
def far_deformation(at: Place, path: Path) -> Measured:
    gap, displacement = _gaps(path), np.array(path["displacement"])
    far = gap >= _FAR
    return np.max(np.abs(gap + displacement)[far] / gap[far]), path["u_displacement"] / _FAR


@measure("largest |P| over the pull-off force from H_0 = 10 on", _PATH)
def far_load(at: Place, path: Path) -> Measured:
    load = np.array(path["load"])
    return np.max(np.abs(load)[_gaps(path) >= _FAR] / -load.min()), 2.0 * path["u_load"] / -load.min()


@measure("distance of the curves, {0} from {reference}", _PATH, _PATH_OF_MODEL)
def curve_distance(at: Place, exact: Path, path: Path) -> Measured:
    (x, y), (model_x, model_y) = ((np.array(of["displacement"]), np.array(of["load"])) for of in (exact, path))
    # Both bounds as shares of the picture, in which the distance is measured.
    bound = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
    distance = distance_of(model_x, model_y, x, y)
    return distance.value, distance.u_interpolation + 2.0 * bound


@measure("largest difference of the loads of {0} and {reference} over the pull-off force", _PATH, _PATH_OF_MODEL)
def load_difference(at: Place, exact: Path, path: Path) -> Measured:
    """At one displacement, from the pull-off to the end of the path."""
    (x, y), (model_x, model_y) = _branch(exact), _branch(path)
    inside = (x >= model_x[0]) & (x <= model_x[-1])
    linear, spline = np.interp(x[inside], model_x, model_y), CubicSpline(model_x, model_y)(x[inside])
    depth = -float(y.min())
    return np.abs(spline - y[inside]).max() / depth, (np.abs(spline - linear).max() + exact["u_load"]) / depth


def _branch(path: Path) -> tuple[Array, Array]:
    """Displacements and loads from the smallest load on, where the displacement rises."""
    start = int(np.argmin(path["load"]))
    x, y = np.array(path["displacement"][start:]), np.array(path["load"][start:])
    rising = np.concatenate([[True], np.diff(x) > 0.0])
    return x[rising], y[rising]


def _onset(at: Place) -> Plan[Any]:
    return result_of(near_critical, at.n, at.k)


@measure("distance of the gaps against the square root of the excess", _onset)
def gap_cusp(at: Place, onset: dict[str, Any]) -> Measured:
    distances, u = [], 0.0
    for excess in _EXCESSES:
        jump = next(row for row in onset["jumps"] if abs(row["mu"] / onset["mu"] - 1.0 - excess) < 1e-9)
        distances.append(jump["jump_in_gap"] - jump["jump_out_gap"])
        u = u + jump["u_jump_in_gap"] + jump["u_jump_out_gap"]
    ratio = distances[0] / distances[1] / (_EXCESSES[0] / _EXCESSES[1]) ** 0.5
    return abs(ratio - 1.0), ratio * u * (1.0 / distances[0] + 1.0 / distances[1])


@measure("repulsive over attractive term of Eq. {0} at jump-in", term("jump_in_gap"))
def repulsion(at: Place, gap: Number) -> Measured:
    b = ((1.0 - at.k) if at.arguments[0] == "41" else 2.0) / at.n
    share = float(beta(9.0 - b, b) / beta(3.0 - b, b)) / (gap.value + 1.0) ** 6
    return share, share * (6.0 * gap.u / (gap.value + 1.0) + ROUNDING)
