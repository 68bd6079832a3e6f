"""The scheme that a reader of Greenwood (1997) would write: uniform rings of pressure, Newton's method, steps inward.

A sphere on a homogeneous half-space by the 9-3 law, with the units of length z0 across and (R z0)^(1/2) along it:

    H(x) = x^2/2 - delta + (4/pi) mu^(3/2) int p(s) s/(x + s) K(4 x s/(x + s)^2) ds,    p(H) = 8/3 (H^-9 - H^-3).

Each ring has a uniform pressure, whose displacement at the middle of another ring is that of two discs (Johnson,
Contact Mechanics, Sec. 3.4).  It has no bound: it shows what such a scheme costs for its error.

Run it by ``python -m comparisons.bench.greenwood``.
"""

from __future__ import annotations

import numpy as np
from scipy.special import ellipe, ellipk

from comparisons.model import Array

#: Radius of the last ring, in (R z0)^(1/2): beyond it the sphere is 50 z0 above the plane.
_LAST = 10.0
#: Central gaps in z0, the first and the least; the first step, and the change of the load in w R that a step aims at.
_FIRST, _LEAST, _STEP, _CHANGE = 2.0, 0.6, 0.1, 0.04
#: Steps of Newton's method, and the change of a gap in z0 at which it ends.
_ITERATIONS, _SMALL = 30, 1e-10


def disc(radius: Array, x: Array) -> Array:
    """Return the displacement at x by a unit pressure on a disc, times E*; shape of both together.

    Examples
    --------
    >>> float(disc(np.array(1.0), np.array(0.0)))
    2.0
    """
    inside = x <= radius
    ratio = (np.minimum(x, radius) / np.maximum(x, radius)) ** 2
    outer = x * (ellipe(ratio) - (1.0 - ratio) * ellipk(ratio))
    return np.asarray(4.0 / np.pi * np.where(inside, radius * ellipe(ratio), outer))


def pull_off_force(mu: float, rings: int) -> float:
    """Return the pull-off force of a sphere in pi w R.

    Parameters
    ----------
    mu : float
        Tabor number; the steps are for one up to 2, below which the load has its least value on the way inward.
    rings : int

    Raises
    ------
    ArithmeticError
        If a step does not converge.

    Examples
    --------
    >>> bool(abs(pull_off_force(0.5, 100) / 1.78748293 - 1.0) < 5e-3)
    True
    """
    edges = np.linspace(0.0, _LAST, rings + 1)
    x = 0.5 * (edges[1:] + edges[:-1])
    x[0] = 0.0
    inner = np.zeros((rings, rings))
    inner[:, 1:] = disc(edges[1:-1], x[:, None])
    softness = mu**1.5 * (disc(edges[1:], x[:, None]) - inner)
    areas = np.pi * np.diff(edges**2)
    gap, central, step = x**2 / 2.0 + _FIRST, _FIRST, _STEP
    states: list[tuple[float, float]] = []
    while central > _LEAST:
        gap = gap - gap[0] + central
        for _ in range(_ITERATIONS):
            pressure, slope = 8.0 / 3.0 * (gap**-9 - gap**-3), 8.0 / 3.0 * (-9.0 * gap**-10 + 3.0 * gap**-4)
            deformed = softness @ pressure
            # The central gap is given: the displacement is what is left there.
            residual = gap - central - x**2 / 2.0 - deformed + deformed[0]
            matrix = np.eye(rings) - (softness - softness[0]) * slope
            matrix[0] = np.eye(rings)[0]
            change = np.linalg.solve(matrix, -residual)
            gap = gap + change
            if np.abs(change).max() < _SMALL:
                break
        else:
            raise ArithmeticError(f"no convergence at the central gap {central:.3g} z0, mu = {mu:g}")
        states.append((central, float(areas @ pressure)))
        if len(states) > 2:
            if states[-1][1] > states[-2][1]:
                # The vertex of the parabola through three states.
                gaps, loads = np.transpose(states[-3:])
                curvature, slope_at_0, at_0 = np.polyfit(gaps, loads, 2)
                return float(slope_at_0**2 / (4.0 * curvature) - at_0) / np.pi
            step *= float(np.clip(_CHANGE / abs(states[-1][1] - states[-2][1]), 0.3, 1.5))
        central -= step
    raise ArithmeticError(f"the load has no least value between central gaps of {_FIRST:g} and {_LEAST:g} z0")


if __name__ == "__main__":
    for rings in (50, 100, 200):
        print(rings, *(f"mu = {mu:g}: {pull_off_force(mu, rings):.6f}" for mu in (0.1, 0.5, 1.0)))
