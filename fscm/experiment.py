"""Loading and unloading with jumps, as a testing machine records them (Fig. 3b).

Under displacement control an approaching punch follows the path to the jump-in fold, lands on the contact
branch at the same displacement and goes on; on retreat it leaves at the jump-out fold and lands on the far
branch.  The area between is the hysteresis energy.  Under load control the contact branch is left at the
pull-off point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from fscm._typing import Array
from fscm.path import EquilibriumPath

__all__ = ["Cycle", "displacement_cycle", "load_controlled_retreat"]


@dataclass(frozen=True)
class Cycle:
    """One cycle of loading and unloading; arrays in the order a machine records them.

    Attributes
    ----------
    loading, unloading : ndarray, shape (2, m)
        Rows delta and P.  A jump is two consecutive columns of equal delta.
    jump_in, jump_out : ndarray, shape (2, 2), or None
        Columns before and after the jump.

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


def _at(path: EquilibriumPath, displacement: float, first: int, last: int) -> Array:
    """Column (delta, P) interpolated on a stretch of the path where delta rises."""
    load = PchipInterpolator(path.displacement[first:last], path.load[first:last])(displacement)
    return np.array([[displacement], [float(load)]])


def displacement_cycle(path: EquilibriumPath) -> Cycle:
    """The cycle under displacement control.

    Examples
    --------
    >>> from fscm.path import trace
    >>> from fscm.problem import Problem
    >>> cycle = displacement_cycle(trace(Problem(n=2, k=0.4, mu=3.0)))
    >>> bool(cycle.jump_in[0, 0] > cycle.jump_out[0, 0])
    True
    """
    d = path.displacement
    curve = np.array([d, path.load])
    rising = np.diff(d) > 0.0
    if rising.all():
        return Cycle(curve, curve[:, ::-1], None, None)
    top = int(np.argmin(rising))  # first fold on approach
    bottom = len(d) - 1 - int(np.argmin(rising[::-1]))  # last fold: first on retreat
    landing_in = _at(path, d[top], bottom, len(d))
    landing_out = _at(path, d[bottom], 0, top + 1)
    after_in = bottom + int(np.searchsorted(d[bottom:], d[top]))
    before_out = int(np.searchsorted(d[: top + 1], d[bottom]))
    loading = np.hstack([curve[:, : top + 1], landing_in, curve[:, after_in:]])
    unloading = np.hstack([curve[:, : bottom - 1 : -1], landing_out, curve[:, before_out - 1 :: -1]])
    return Cycle(
        loading,
        unloading,
        np.hstack([curve[:, [top]], landing_in]),
        np.hstack([curve[:, [bottom]], landing_out]),
    )


def load_controlled_retreat(path: EquilibriumPath) -> Array:
    """Columns (delta, P), shape (2, m), of a retreat under load control: from the path's end to pull-off.

    Examples
    --------
    >>> delta, load = np.array([-3.0, -1.0, 0.0, 0.5]), np.array([-0.1, -1.0, -2.0, 1.0])
    >>> path = EquilibriumPath(-delta, delta, load, np.zeros(4), np.full(4, np.nan), u_displacement=0.0, u_load=0.0)
    >>> load_controlled_retreat(path)
    array([[ 0.5,  0. ],
           [ 1. , -2. ]])
    """
    lowest = int(np.argmin(path.load))
    return np.array([path.displacement, path.load])[:, : lowest - 1 : -1] if lowest else np.empty((2, 0))
