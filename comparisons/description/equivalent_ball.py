"""Ball on a homogeneous solid that stands for a sphere on any solid, by the contact radius at pull-off."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from comparisons.model import Array, NotApplicable
from comparisons.models.jkr_sphere import LARGEST_CONTACT
from comparisons.problem import Problem

#: Kinds of punches that are spheres: the paraboloid of the tip, and the exact one.
PARABOLOID, BALL = "sphere", "ball"

#: Wave number of the modulus that the contact meets, times its radius (measured: on layers and gradients the radius of
#: JKR with that modulus is 0.83 to 1.05 of that at pull-off, and 1.23 at a Tabor number of 2).
_AT_CONTACT = 2.0

#: Contact radii in that of the sphere among which that of a solid that is not homogeneous is looked for.
_RADII = np.geomspace(1e-6, LARGEST_CONTACT, 60)


class EquivalentBall(NamedTuple):
    """A ball on a homogeneous solid: w/(E* R), Tabor number and Poisson's ratio; whether it is the problem itself."""

    softness: float
    mu: float
    nu: float
    is_exact: bool


def equivalent_ball(problem: Problem, contact_radius: float | None = None) -> EquivalentBall:
    """Return the ball on a homogeneous solid that stands for a sphere on the solid of a problem.

    On a homogeneous solid it is the problem itself.  On another one it has the contact radius a of JKR at pull-off,
    a^3 = 9 pi w R^2/(8 E*).

    Parameters
    ----------
    problem : Problem
        In physical units.
    contact_radius : float, optional
        In m at pull-off; by default that of JKR with the modulus that the solid has at a wave number of 2/a.

    Raises
    ------
    NotApplicable
        If the punch is no sphere, the law another one than the 9-3 law, or the contact larger than the sphere.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> solid, sphere = Section("homogeneous", {"E": 1.5e6, "nu": 0.5}), Section("sphere", {"R": 5e-6})
    >>> ball = equivalent_ball(Problem(solid, sphere, law))
    >>> round(ball.softness, 12), round(ball.mu, 1), ball.is_exact
    (0.005, 365.5, True)
    """
    if "R_solid" in problem.punch.values or problem.punch_solid is not None:
        raise NotApplicable("it is known for one rigid sphere on a plane solid")
    if problem.punch.kind not in (PARABOLOID, BALL):
        raise NotApplicable(f"it is known for spheres, not for the punch of the kind {problem.punch.kind}")
    if not problem.is_of_the_paper("law"):
        raise NotApplicable(f"it is known for the 9-3 law, not for the law of the kind {problem.law.kind}")
    radius, z0 = problem.punch["R"], problem.units["displacement"]
    if problem.is_of_the_paper("solid") and problem.posed.k == 0.0:
        mu = problem.posed.mu
        return EquivalentBall((mu * z0 / radius) ** 1.5, mu, problem.solid["nu"], True)
    # Imported here: a power law needs no compliance of its surface.
    from comparisons.problem.equivalent_solid import surface_ratio

    share = (_radius_of_jkr(problem) if contact_radius is None else contact_radius) / radius
    softness = 8.0 / (9.0 * math.pi) * share**3
    return EquivalentBall(softness, float(np.cbrt(softness)) ** 2 * radius / z0, surface_ratio(problem), False)


def _radius_of_jkr(problem: Problem) -> float:
    """The contact radius at pull-off, in m."""
    from comparisons.problem.equivalent_solid import modulus_at

    radius, w = problem.punch["R"], problem.law["work_of_adhesion"]
    radii: Array = radius * _RADII
    moduli = modulus_at(problem, _AT_CONTACT / radii)
    rising = np.log(8.0 * moduli * radii**3 / (9.0 * math.pi * w * radius**2))
    above = np.flatnonzero(rising >= 0.0)
    if not above.size:
        raise NotApplicable("the contact is larger than the sphere")
    last = max(int(above[0]), 1)
    return float(np.exp(np.interp(0.0, rising[last - 1 : last + 1], np.log(radii[last - 1 : last + 1]))))
