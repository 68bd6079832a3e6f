"""Loading and unloading with jumps, as a testing machine records them (Fig. 3b).

Under displacement control an approaching punch follows the path to the jump-in fold, lands on the contact
branch at the same displacement and goes on; on retreat it leaves at the jump-out fold and lands on the far
branch.  A punch with asperities, or a stiff film on a soft solid, may jump several times.  The area between is the
hysteresis energy.  Under load control the contact branch is left at the pull-off point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from fscm._typing import Array
from fscm.path import EquilibriumPath, Mask

__all__ = ["Cycle", "displacement_cycle", "load_controlled_retreat"]


@dataclass(frozen=True)
class Cycle:
    """One cycle of loading and unloading; arrays in the order in which a machine records them.

    Attributes
    ----------
    loading, unloading : ndarray, shape (2, m)
        Rows delta and P.  A jump is two consecutive columns of equal delta.
    jump_in, jump_out : ndarray, shape (2, 2), or None
        Columns before and after the first jump of the approach, and the last one of the retreat.
    u_landing : float
        Uncertainty of every load after a jump, which is interpolated on the path: 0 without a jump.

    Examples
    --------
    >>> from fscm.path import trace
    >>> from fscm.problem import Problem
    >>> displacement_cycle(trace(Problem(n=2, k=0.4, mu=0.3))).jump_in is None  # a stiff solid does not jump
    True
    """

    loading: Array
    unloading: Array
    jump_in: Array | None
    jump_out: Array | None
    u_landing: float = 0.0


def displacement_cycle(path: EquilibriumPath) -> Cycle:
    """The cycle under displacement control.

    A jump lands on the next stable section of the path, farther in (on approach) or out (on retreat), that contains its
    displacement.  A section with rising displacement is stable unless `stable_under_displacement` is False.  The load
    after a jump is interpolated by a cubic; `u_landing` is the error of the path plus the distance of that cubic from
    the less accurate straight line.

    Raises
    ------
    ValueError
        When a jump lands beyond one of the ends of the path.

    Examples
    --------
    >>> from fscm.path import trace
    >>> from fscm.problem import Problem
    >>> cycle = displacement_cycle(trace(Problem(n=2, k=0.4, mu=3.0)))
    >>> bool(cycle.jump_in[0, 0] > cycle.jump_out[0, 0])
    True
    """
    curve = np.array([path.displacement, path.load])
    if np.all(np.diff(path.displacement) > 0.0):
        return Cycle(curve, curve[:, ::-1], None, None)
    errors = path.u_displacement, path.u_load
    stable = path.stable_under_displacement if path.stable_under_displacement.size else np.ones(curve.shape[1], bool)
    loading, jumps_in, u_in = _recorded(curve, stable, errors, "the displacement of jump-in", "max_load")
    # A retreat is an approach along the curve rotated by 180 degrees.
    turned, jumps_out, u_out = _recorded(
        -curve[:, ::-1], stable[::-1], errors, "the displacement of jump-out", "start_gap"
    )
    return Cycle(loading, -turned, jumps_in[0], -jumps_out[-1], max(u_in, u_out))


def _recorded(
    curve: Array, stable: Mask, errors: tuple[float, float], event: str, argument: str
) -> tuple[Array, list[Array], float]:
    """Columns of the curve that are recorded while the displacement rises, the jumps, and `u_landing`."""
    d = curve[0]
    rising = np.diff(d) > 0.0
    segments: list[Array] = []
    jumps: list[Array] = []
    i, uncertainty = 0, 0.0
    while True:
        falls = np.flatnonzero(~rising[i:])
        if not falls.size:
            return np.hstack([*segments, curve[:, i:]]), jumps, uncertainty
        top = i + int(falls[0])
        # The fold at the end of a stable section is not marked as stable.
        is_stable = stable[top:-1] | stable[top + 1 :]
        after = np.flatnonzero((d[top:-1] <= d[top]) & (d[top + 1 :] > d[top]) & is_stable)
        if not after.size:
            end = d[-1] if argument == "max_load" else -d[-1]
            level = d[top] if argument == "max_load" else -d[top]
            raise ValueError(
                f"the path ends at delta = {end:.6g} and does not contain {event}, {level:.6g}, on the other branch: "
                f"trace it with a larger {argument}"
            )
        column = top + int(after[0])
        landing, curved, slope = _at(curve, d[top], column)
        # The displacement of the fold has the error of that of the branch.
        uncertainty = max(uncertainty, curved + errors[1] + 2.0 * slope * errors[0])
        segments += [curve[:, i : top + 1], landing]
        jumps.append(np.hstack([curve[:, [top]], landing]))
        i = column + 1


def _at(curve: Array, displacement: float, column: int) -> tuple[Array, float, float]:
    """Column (delta, P) interpolated between a column and the next, within the section of rising delta around them.

    Also the distance of P from the straight line, and the size of the slope dP/d(delta).
    """
    start, stop = column, column + 2
    while start > 0 and curve[0, start - 1] < curve[0, start]:
        start -= 1
    while stop < curve.shape[1] and curve[0, stop] > curve[0, stop - 1]:
        stop += 1
    cubic = scipy.interpolate.PchipInterpolator(*curve[:, start:stop])
    load = float(cubic(displacement))
    straight = float(np.interp(displacement, *curve[:, column : column + 2]))
    return np.array([[displacement], [load]]), abs(load - straight), abs(float(cubic(displacement, 1)))


def load_controlled_retreat(path: EquilibriumPath) -> Array:
    """Columns (delta, P), shape (2, m), of a retreat under load control: from the path's end to pull-off.

    Raises
    ------
    ValueError
        When the path ends before pull-off: its last load is its smallest.

    Examples
    --------
    >>> delta, load = np.array([-3.0, -1.0, 0.0, 0.5]), np.array([-0.1, -1.0, -2.0, 1.0])
    >>> path = EquilibriumPath(-delta, delta, load, np.zeros(4), np.full(4, np.nan), u_displacement=0.0, u_load=0.0)
    >>> load_controlled_retreat(path)
    array([[ 0.5,  0. ],
           [ 1. , -2. ]])
    """
    lowest = int(np.argmin(path.load))
    if lowest == len(path.load) - 1:
        raise ValueError(f"the path ends at its smallest load, {path.load[-1]:.6g}, before pull-off: trace it farther")
    return np.array([path.displacement, path.load])[:, : lowest - 1 : -1] if lowest else np.empty((2, 0))
