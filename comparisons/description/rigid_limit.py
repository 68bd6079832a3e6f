"""Pull-off force of a sphere in the limit of a rigid solid, under any law at vertical gaps."""

from __future__ import annotations

import math

import numpy as np
import scipy

from comparisons.description.equivalent_ball import BALL, PARABOLOID
from comparisons.problem import Problem

#: Pieces of the integral over gaps, of equal ratio, and the nodes of each (measured: twice as many change the force
#: by at most 1e-14, under the 9-3 law, mie and dlvo).
_PIECES, _GAUSS = 48, np.polynomial.legendre.leggauss(16)


def rigid_force(problem: Problem) -> float | None:
    """Return the pull-off force of a rigid sphere from a rigid plane, in N.

    With W(D) the work to separate parallel faces from the distance D, the load of a sphere of radius R at the least
    distance D is that of Derjaguin, 2 pi R W(D), for the paraboloid.  The exact sphere has its surface at
    D + R - sqrt(R^2 - r^2), so that with u for this distance r dr = (R + D - u) du, and the load is
    2 pi [R W(D) - integral of W from D to D + R].  The force is the maximum over D.  Under the 9-3 law it is
    2 pi w (R - 9/7 z0), but for terms of z0^2/R.

    Parameters
    ----------
    problem : Problem
        In physical units.

    Returns
    -------
    float or None
        None where the punch is no single sphere, and for the potential of the whole body of a paraboloid.  For a ball
        that potential has nearly the same load.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("homogeneous", {"E": 5e10, "nu": 0.25})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.1, "z0": 4e-10})
    >>> force = rigid_force(Problem(solid, Section("ball", {"R": 2e-6}), law))
    >>> round(force / (2.0 * math.pi * 0.1 * (2e-6 - 9.0 / 7.0 * 4e-10)), 6)
    1.0
    """
    if problem.is_dimensionless or problem.punch.kind not in (PARABOLOID, BALL) or "R_solid" in problem.punch.values:
        return None
    radius, z0, law = problem.punch["R"], problem.units["gap"], problem.posed.law
    if problem.punch.kind == PARABOLOID and problem.interaction == "body":
        return None
    unit = 2.0 * math.pi * radius * problem.units["energy_per_area"]
    at_contact = -float(law.energy(np.array(0.0)))
    if problem.punch.kind == PARABOLOID:
        return unit * at_contact if at_contact > 0.0 else None
    ends = np.linspace(0.0, math.log1p(radius / z0), _PIECES + 1)
    half = 0.5 * np.diff(ends)
    x, weights = _GAUSS
    distance = np.exp((ends[:-1] + half)[:, None] + half[:, None] * x)

    def load(gap: float) -> float:
        work = -law.energy(gap + distance - 1.0)
        return float(law.energy(np.array(gap)) + z0 / radius * np.sum(half[:, None] * weights * distance * work))

    least = scipy.optimize.minimize_scalar(load, bounds=(0.0, law.peak_gap), method="bounded").fun
    return float(-unit * least) if least < 0.0 else None
