"""The branch in contact of a punch of any profile: what JKR and Maugis-Dugdale have in common.

In barred units the compliance grows with the Tabor number by G = mu^(2 - (1-k)/n).  A contact on a disc is assumed: a
profile that falls anywhere in the contact is refused.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import ClassVar, Self

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
ROUNDING = 64.0 * EPS
#: Gaps, in z0, at which a law may not repel, but for a share of its strength that is the rounding of a table.
_GAPS, _NO_BARRIER = np.geomspace(1e-3, 1e4, 400), 1e-9


@dataclass(frozen=True, slots=True)
class State:
    """A contact in barred units; each error is the rounding of its number."""

    displacement: float
    load: float
    displacement_error: float
    load_error: float


@dataclass(frozen=True)
class Branch(ABC):
    """The states in contact of a profile.

    Attributes
    ----------
    profile : PlaneProfile
    punch : GradedPunch
    compliance : float
        G.
    """

    profile: PlaneProfile
    punch: GradedPunch
    compliance: float

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the branch of a problem."""
        posed = problem.posed
        shape, k = posed.punch, float(posed.k)
        ends = {*(getattr(shape, "kinks", None) or ()), *(getattr(shape, "joints", None) or ())}
        compliance = float(posed.mu) ** (2.0 - (1.0 - k) / float(posed.n))
        profile = PlaneProfile(shape.height, shape.slope, tuple(sorted(ends)), k)
        return cls(profile, GradedPunch(float(posed.n), k), compliance)

    @abstractmethod
    def at(self, radius: float) -> State:
        """Return the state of a contact radius, 0 or more."""

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

    @lru_cache(maxsize=4)  # noqa: B019  # a list of numbers each, and a model asks for every event
    def radii(self) -> tuple[float, ...]:
        """Contact radii from near zero to a load as compressive as the pull-off is tensile, breaks among them."""
        middle = self.undisplaced
        if middle is None:
            return ()
        end = middle
        least = min(self.at(a).load for a in (0.0, *np.geomspace(0.1 * middle, middle, 12)))
        while self.at(end).load < -1.2 * least:
            end *= 1.3
        radii = np.geomspace(_NEAREST * middle, end, _RADII)
        return tuple(sorted({*radii.tolist(), *(r for r in self.profile.breaks if radii[0] < r < end)}))

    @lru_cache(maxsize=4)  # noqa: B019  # a few numbers for each radius, and every event is looked for among them
    def _scan(self) -> tuple[State, ...]:
        """Return the states of these radii."""
        return tuple(self.at(a) for a in self.radii())

    @lru_cache(maxsize=16)  # noqa: B019  # a number each
    def radius_at(self, event: str) -> float:
        """Return the contact radius at ``pull_off``, ``jump_out`` or ``zero_load``."""
        if event == "pull_off":
            return self._least(lambda state: state.load)
        if event == "jump_out":
            return self._least(lambda state: state.displacement)
        first = self.radius_at("pull_off")
        last = next(a for a, state in zip(self.radii(), self._scan(), strict=True) if a > first and state.load > 0.0)
        return _root(lambda a: self.at(a).load, first, last)

    def _least(self, value: Callable[[State], float]) -> float:
        """Return the contact radius where a number of the states is least."""
        radii = self.radii()
        values = [value(state) for state in self._scan()]
        i = int(np.argmin(values))
        # At a = 0 for a bed of springs (k = 1), and with a cohesive zone on a stiff solid.
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


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    return float(scipy.optimize.brentq(function, low, high, xtol=1e-300, rtol=4.0 * EPS))


class ProfileModel(ContactBranch):
    """A model of a punch of any profile without waves; a subclass names the class of its branch."""

    _branch_type: ClassVar[type[Branch]]

    def branch_of(self, problem: Problem) -> Branch:
        """Return the branch of a problem, which keeps its events."""
        return _branch(self._branch_type, problem)

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless a punch without waves at vertical gaps is on a power-law solid."""
        if undefined := self._undefined(quantity):
            return undefined
        if problem.is_of_the_paper():
            return f"{self.name} is for other punches or laws than those of n, k and mu, which the closed forms take"
        if not problem.is_of_the_paper("solid") or problem.interaction == "body":
            return (
                f"{self.name} is for a power-law or homogeneous solid, with neither surface tension nor friction, and "
                f"the law at the vertical gap; this problem has {problem.parts}"
            )
        tractions = problem.posed.law.traction(_GAPS)
        if tractions.max() > -_NO_BARRIER * tractions.min():
            return f"{self.name} knows the tension alone, and the {problem.law.kind} law has a barrier"
        return self._shape_refused(self.branch_of(problem), problem)

    def _shape_refused(self, branch: Branch, problem: Problem) -> str | None:
        radii = branch.radii()
        if not radii:
            return f"{self.name} found no contact of a radius within 1e-8 to 1e8 units"
        r = np.linspace(0.0, radii[-1], 2000)[1:]
        falling = branch.profile.slope(r) < 0.0
        if np.any(falling):
            at = r[np.argmax(falling)] * problem.units["radius"]
            return f"the punch falls at the radius {at:.4g} m: its contact is no disc, as {self.name} assumes"
        if problem.punch.kind == "ball" and branch.radius_at("pull_off") > branch.profile.breaks[-1]:
            return "the ball is smaller than the contact, which reaches beyond 0.95 of its radius"
        return None

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        branch = self.branch_of(problem)
        state = branch.at(branch.radius_at("pull_off"))
        return Result(-state.load, state.load_error)

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event."""
        branch = self.branch_of(problem)
        radius = branch.radius_at(event)
        state = branch.at(radius)
        u_num = state.displacement_error
        if event == "pull_off" and radius > 0.0:
            u_num += _at_minimum(branch, radius)
        elif event == "zero_load":
            above, below = branch.at(radius * (1.0 + 1e-4)), branch.at(radius * (1.0 - 1e-4))
            u_num += abs((above.displacement - below.displacement) / (above.load - below.load)) * state.load_error
        return Result(state.displacement, u_num)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the branch from a = 0 to a load as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        branch = self.branch_of(problem)
        pull_off, end = branch.radius_at("pull_off"), branch.radii()[-1]
        radii = np.unique(np.append(end * np.linspace(0.0, 1.0, POINTS) ** 2, pull_off))
        states = [branch.at(float(a)) for a in radii]
        return Curve(
            displacement=np.array([state.displacement for state in states]),
            load=np.array([state.load for state in states]),
            columns={"contact_radius": radii},
        )


@lru_cache(maxsize=16)
def _branch(kind: type[Branch], problem: Problem) -> Branch:
    return kind.of(problem)


def _at_minimum(branch: Branch, radius: float) -> float:
    """Change of the displacement over the radii whose loads are the least one to rounding."""
    step = 1e-3
    states = [branch.at(radius * math.exp(shift)) for shift in (-step, 0.0, step)]
    below, least, above = (state.load for state in states)
    error = states[1].load_error
    # Twice the smaller rise: beside a kink of the profile the load rises more steeply on one side.
    bend = 2.0 * max(min(below, above) - least, error) / step**2
    rate = max(abs(state.displacement - states[1].displacement) for state in states) / step
    return rate * math.sqrt(2.0 * error / bend)
