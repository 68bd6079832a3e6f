"""The JKR model of a punch of any axisymmetric profile on a graded half-space, by dimensionality reduction.

In barred units, in which the compliance grows with the Tabor number by G = mu^(2 - (1-k)/n), and with the profile g and
the moment m of `plane_profile` and the constants of `graded_punch`, the contact of the radius a has

    lift = adhesion sqrt(G) a^s,    delta = g - lift,    P = (stiffness / G) [ (g - lift) a^(1+k) / (1+k) - m ],

Griffith's balance at the edge.  The flat punch that is subtracted is the same for every profile (Jin, Guo & Zhang, J.
Appl. Mech. 80 (2013) 061024; Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18, in the limit of a large cohesive stress;
the handbook of Popov, Hess and Willert).  For a power law it is `jkr`, for a ball `jkr-sphere-projected`.

A contact on a disc is assumed: a profile that falls anywhere in the contact is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
import scipy

from comparisons.model import Curve, Result
from comparisons.models.closed_form import EPS, POINTS, ContactBranch
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.plane_profile import PlaneProfile
from comparisons.problem import Problem

#: Contact radii in which the branch is scanned, over the radius where it has no displacement, and their number.
_NEAREST, _RADII = 1e-3, 160
#: Largest ratio of the same radius to the unit of radii, and of its inverse: beyond, nothing is looked for.
_FARTHEST = 1e8
#: Rounding of a term of a displacement or a load: a sum of 460 positive terms.
_ROUNDING = 64.0 * EPS
#: Gaps, in z0, at which a law may not repel.
_GAPS = np.geomspace(1e-3, 1e4, 400)


@dataclass(frozen=True, slots=True)
class _State:
    """A contact in barred units; each scale is the sum of the terms of its number."""

    displacement: float
    load: float
    displacement_scale: float
    load_scale: float


@dataclass(frozen=True)
class _Branch:
    """The states in contact of a profile."""

    profile: PlaneProfile
    punch: GradedPunch
    compliance: float

    @classmethod
    def of(cls, problem: Problem) -> _Branch:
        """Return the branch of a problem."""
        posed = problem.posed
        shape, k = posed.punch, float(posed.k)
        ends = {*(getattr(shape, "kinks", None) or ()), *(getattr(shape, "joints", None) or ())}
        compliance = float(posed.mu) ** (2.0 - (1.0 - k) / float(posed.n))
        return cls(PlaneProfile(shape.slope, tuple(sorted(ends)), k), GradedPunch(float(posed.n), k), compliance)

    def lift(self, radius: float) -> float:
        """What adhesion takes from the displacement."""
        return self.punch.adhesion * math.sqrt(self.compliance) * radius**self.punch.s

    def at(self, radius: float) -> _State:
        """Return the state of a contact radius."""
        profile, moment = self.profile.at(radius)
        lift, area = self.lift(radius), radius ** (1.0 + self.punch.k) / (1.0 + self.punch.k)
        stiffness = self.punch.stiffness / self.compliance
        load = stiffness * ((profile - lift) * area - moment)
        scale = stiffness * ((profile + lift) * area + moment)
        return _State(profile - lift, load, profile + lift, scale)

    @property
    def undisplaced(self) -> float | None:
        """The contact radius without displacement; None if there is none within reach."""
        radius = 1.0
        while self.at(radius).displacement < 0.0 and radius < _FARTHEST:
            radius *= 2.0
        while self.at(0.5 * radius).displacement >= 0.0 and radius > 1.0 / _FARTHEST:
            radius *= 0.5
        if not 1.0 / _FARTHEST < radius < _FARTHEST:
            return None
        return _root(lambda a: self.at(a).displacement, 0.5 * radius, radius)

    def radii(self) -> list[float]:
        """Contact radii from near zero to a load as compressive as the pull-off is tensile, breaks among them."""
        middle = self.undisplaced
        if middle is None:
            return []
        end, least = middle, min(self.at(a).load for a in np.geomspace(0.1 * middle, middle, 12))
        while self.at(end).load < -1.2 * least:
            end *= 1.3
        radii = np.geomspace(_NEAREST * middle, end, _RADII)
        return sorted({*radii.tolist(), *(r for r in self.profile.breaks if radii[0] < r < end)})

    def least(self, value: Callable[[_State], float]) -> float:
        """Return the contact radius where a number of the states is least."""
        radii = self.radii()
        values = [value(self.at(a)) for a in radii]
        i = int(np.argmin(values))
        # For k = 1 the displacement is least at a = 0: a bed of springs.
        candidates = [(values[i], radii[i]), (value(self.at(0.0)), 0.0)]
        for low, high in pairwise(radii[max(i - 1, 0) : i + 2]):
            found = scipy.optimize.minimize_scalar(
                lambda log_a: value(self.at(math.exp(log_a))),
                bounds=(math.log(low), math.log(high)),
                method="bounded",
                options={"xatol": 1e-10},
            )
            candidates.append((float(found.fun), math.exp(float(found.x))))
        return min(candidates)[1]


@lru_cache(maxsize=16)
def _radius_at(branch: _Branch, event: str) -> float:
    if event == "pull_off":
        return branch.least(lambda state: state.load)
    if event == "jump_out":
        return branch.least(lambda state: state.displacement)
    first = _radius_at(branch, "pull_off")
    last = next(a for a in branch.radii() if a > first and branch.at(a).load > 0.0)
    return _root(lambda a: branch.at(a).load, first, last)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    return float(scipy.optimize.brentq(function, low, high, xtol=1e-300, rtol=4.0 * EPS))


class JKRProfile(ContactBranch):
    """JKR of any profile without waves.

    Examples
    --------
    >>> tip = Problem.of(
    ...     solid={"kind": "homogeneous", "E": "1 MPa", "nu": 0.5},
    ...     punch={"kind": "rounded-cone", "R": "20 nm", "slope": 0.4},
    ...     law={"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "0.4 nm"},
    ... )
    >>> model = JKRProfile()
    >>> result = model.evaluate(tip, "pull_off_force")
    >>> 10.0 < result.value < 1e3
    True
    """

    name = "jkr-profile"
    citation = (
        "Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18; Jin, Guo & Zhang, J. Appl. Mech. 80 (2013) 061024; "
        "Popov, Hess & Willert, Handbook of Contact Mechanics (2019)"
    )
    domain = "problems in physical units, power-law solid, punch without waves, law without barrier; mu -> infinity"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless a punch without waves at vertical gaps is on a power-law solid."""
        if undefined := self._undefined(quantity):
            return undefined
        if problem.is_of_the_paper():
            return f"{self.name} is jkr for a power-law punch under the 9-3 law"
        if not problem.is_of_the_paper("solid") or problem.interaction == "body":
            return (
                f"{self.name} is for a power-law or homogeneous solid, with neither surface tension nor friction, and "
                f"the law at the vertical gap; this problem has {problem.parts}"
            )
        if np.any(problem.posed.law.traction(_GAPS) > 0.0):
            return f"{self.name} knows the work of adhesion alone, and the {problem.law.kind} law has a barrier"
        return self._shape_refused(_Branch.of(problem), problem)

    def _shape_refused(self, branch: _Branch, problem: Problem) -> str | None:
        radii = branch.radii()
        if not radii:
            return f"{self.name} found no contact of a radius within 1e-8 to 1e8 units"
        r = np.linspace(0.0, radii[-1], 2000)[1:]
        falling = branch.profile.slope(r) < 0.0
        if np.any(falling):
            at = r[np.argmax(falling)] * problem.units["radius"]
            return f"the punch falls at the radius {at:.4g} m: its contact is no disc, as {self.name} assumes"
        if problem.punch.kind == "ball" and _radius_at(branch, "pull_off") > branch.profile.breaks[-1]:
            return "the ball is smaller than the contact, which reaches beyond 0.95 of its radius"
        return None

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        branch = _Branch.of(problem)
        state = branch.at(_radius_at(branch, "pull_off"))
        return Result(-state.load, _ROUNDING * state.load_scale)

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event."""
        branch = _Branch.of(problem)
        radius = _radius_at(branch, event)
        state = branch.at(radius)
        u_num = _ROUNDING * state.displacement_scale
        if event == "pull_off":
            u_num += _at_minimum(branch, radius)
        elif event == "zero_load":
            step = 1e-4
            above, below = branch.at(radius * (1.0 + step)), branch.at(radius * (1.0 - step))
            rate = abs((above.displacement - below.displacement) / (above.load - below.load))
            u_num += rate * _ROUNDING * state.load_scale
        return Result(state.displacement, u_num)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the branch from a = 0 to a load as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        branch = _Branch.of(problem)
        pull_off, end = _radius_at(branch, "pull_off"), branch.radii()[-1]
        radii = np.unique(np.append(end * np.linspace(0.0, 1.0, POINTS) ** 2, pull_off))
        states = [branch.at(float(a)) for a in radii]
        return Curve(
            displacement=np.array([state.displacement for state in states]),
            load=np.array([state.load for state in states]),
            columns={"contact_radius": radii},
        )


def _at_minimum(branch: _Branch, radius: float) -> float:
    """Change of the displacement over the radii whose loads are the least one to rounding."""
    step = 1e-3
    states = [branch.at(radius * math.exp(shift)) for shift in (-step, 0.0, step)]
    below, least, above = (state.load for state in states)
    # Twice the smaller rise: beside a kink of the profile the load rises more steeply on one side.
    bend = 2.0 * max(min(below, above) - least, EPS * states[1].load_scale) / step**2
    reach = math.sqrt(2.0 * _ROUNDING * states[1].load_scale / bend)
    rate = max(abs(state.displacement - states[1].displacement) for state in states) / step
    return rate * reach
