"""The base of the models with a cohesive zone: events, curve and profile of a contact in barred variables.

A model chooses the cohesive stress and, where its traction is not constant, the contact.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np

from comparisons.model import Curve, NotApplicable, RadialField
from comparisons.models.closed_form import EPS, ClosedForm, Estimate
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import STATE_ROUNDING, CohesiveEvents, Event
from comparisons.models.cohesive_profiles import PROFILE_ROUNDING, CohesiveProfiles, cohesive_profiles
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.problem import Problem

__all__ = ["CohesiveModel"]

_POINTS = 401
# Radii of a stored profile in each of its three parts.
_PROFILE_POINTS = 60
# The curve starts at a = 0 and then at this fraction of its largest contact radius.
_FIRST_RADIUS = 1e-4
# Hertz's load at pull-off has fallen to exp(-3) of itself this far (over n) below in log(a).
_NEAR = 3.0


#: What every model with a cohesive zone has at every Tabor number.
SCALARS_AND_CURVE = [
    "pull_off_force",
    "pull_off_displacement",
    "jump_out_displacement",
    "zero_load_displacement",
    "force_curve",
]


class CohesiveModel(ClosedForm):
    """A model of contact with a cohesive zone at the edge; the largest traction is the cohesive stress.

    Examples
    --------
    >>> from comparisons.models.maugis_dugdale import MaugisDugdaleImproved
    >>> model = MaugisDugdaleImproved()
    >>> isinstance(model, CohesiveModel), round(model.cohesive_stress(Problem.dimensionless(n=2, k=0, mu=1)), 3)
    (True, 0.588)
    """

    applies_to: ClassVar[list[dict[str, list[Any]]]] = [
        {"quantities": SCALARS_AND_CURVE},
        {"quantities": ["pull_off_pressure", "pull_off_gap"], "k": [0, 0.9999]},
    ]
    #: The contact that the model solves.
    contact_type: ClassVar[type[CohesiveContact]] = CohesiveContact

    undefined: ClassVar[dict[str, str]] = {
        "jump_in_displacement": "its equations hold in contact only",
        "jump_in_gap": "its equations hold in contact only",
        "jump_out_gap": "the gap is zero by assumption wherever there is contact",
        "hysteresis_energy": "it needs the jump-in, and its equations hold in contact only",
        "critical_tabor_number": "it needs the jump-in, and its equations hold in contact only",
    }

    @abstractmethod
    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 in dgamma / z0."""

    def pull_off_force(self, problem: Problem) -> Estimate:
        """-min P over the contact branch, its end point a = 0 included."""
        if self._is_jkr(problem):
            return JKR().pull_off_force(problem)
        event = self._events(problem).pull_off()
        rounding = _conditioning(problem) * STATE_ROUNDING * float(event.state.load_scale[0])
        scale = GradedPunch.of(problem).scales(problem.mu).load
        return Estimate(
            -event.load * scale, scale * (rounding + event.curvature_error), event.iterations, event.residual
        )

    def pull_off_displacement(self, problem: Problem) -> Estimate:
        """Delta where P is smallest."""
        if self._is_jkr(problem):
            return JKR().pull_off_displacement(problem)
        return _displacement(problem, self._events(problem).pull_off())

    def jump_out_displacement(self, problem: Problem) -> Estimate:
        """Delta at the fold of the contact branch that retreat meets first."""
        if self._is_jkr(problem):
            return JKR().jump_out_displacement(problem)
        return _displacement(problem, self._events(problem).fold())

    def zero_load_displacement(self, problem: Problem) -> Estimate:
        """Delta in contact where P = 0."""
        if self._is_jkr(problem):
            return JKR().zero_load_displacement(problem)
        return _displacement(problem, self._events(problem).zero_load())

    def curve(self, problem: Problem) -> Curve:
        """Return the contact branch from a = 0 to a load as compressive as the pull-off is tensile.

        Columns ``contact_radius`` and ``cohesive_radius``.
        """
        self.check(problem)
        if self._is_jkr(problem):
            curve = JKR().curve(problem)
            return Curve(
                curve.displacement,
                curve.load,
                curve.columns | {"cohesive_radius": curve.columns["contact_radius"]},
            )
        events = self._events(problem)
        contact, pull_off = events.contact, events.pull_off()
        # Half the points from first contact on, half about the pull-off, where a large n bends the curve.
        beyond = (events.states.load >= -pull_off.load) & (events.w > pull_off.w)
        end = float(events.w[beyond][0])
        log_first = contact.log_contact_radius(end) + np.log(_FIRST_RADIUS)
        start = float(events.w[events.states.contact_radius >= np.exp(log_first)][0])
        near = max(start, pull_off.w - _NEAR / contact.punch.n)
        even, dense = np.linspace(start, end, _POINTS // 2), np.linspace(near, end, _POINTS // 2)
        w = np.unique(np.concatenate(([-np.inf, pull_off.w], even, dense)))
        state = contact.at(w)
        scale = GradedPunch.of(problem).scales(problem.mu)
        return Curve(
            displacement=scale.displacement * state.displacement,
            load=scale.load * state.load,
            columns={
                "contact_radius": scale.radius * state.contact_radius,
                "cohesive_radius": scale.radius * state.cohesive_radius,
            },
        )

    def profiles(self, problem: Problem, points: int = 200) -> CohesiveProfiles:
        """Return contact radius, cohesive radius, pressure and gap at the pull-off, in barred variables.

        Raises
        ------
        NotApplicable
            As `evaluate`; also at k = 1 with sigma_0 mu >= 1, where the edge of the contact is singular.
        """
        self.check(problem)
        if self._is_jkr(problem):
            raise NotApplicable(f"{self.name} has no cohesive zone at k = 1 and mu = {problem.mu}: its edge is JKR's")
        contact = self._contact(problem)
        event = CohesiveEvents.scan(contact).pull_off()
        return cohesive_profiles(contact, event.state, GradedPunch.of(problem).scales(problem.mu), points)

    def pull_off_profile(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, out to a gap of 10, or raise as `profiles`."""
        found = self.profiles(problem, _PROFILE_POINTS)
        return RadialField(found.radius, found.pressure, found.gap, PROFILE_ROUNDING, PROFILE_ROUNDING)

    def _is_jkr(self, problem: Problem) -> bool:
        """At k = 1 the surface is a bed of springs, and the cohesive zone vanishes for Lambda >= 1."""
        return problem.k == 1.0 and self.cohesive_stress(problem) * problem.mu >= 1.0

    def _contact(self, problem: Problem) -> CohesiveContact:
        return self.contact_type(GradedPunch.of(problem), self.cohesive_stress(problem) * problem.mu)

    def _events(self, problem: Problem) -> CohesiveEvents:
        return CohesiveEvents.scan(self._contact(problem))


def _conditioning(problem: Problem) -> float:
    """Return how much an event amplifies an error of Griffith's relation: loads ~ dgamma^((k+3)/(2n+k-1))."""
    return 1.0 + (3.0 + problem.k) / (2.0 * problem.n + problem.k - 1.0)


def _displacement(problem: Problem, event: Event) -> Estimate:
    """Return the barred displacement of an event with its bound."""
    state = event.state
    rounding = (_conditioning(problem) * STATE_ROUNDING + EPS) * float(state.displacement_scale[0])
    place = abs(float(state.displacement_slope[0])) * event.w_error
    # Where the slope vanishes by definition (the fold) its rounding is what is left.
    place += float(state.displacement_slope_scale[0]) * STATE_ROUNDING * event.w_error
    scale = GradedPunch.of(problem).scales(problem.mu).displacement
    return Estimate(
        event.displacement * scale,
        scale * (rounding + place + event.curvature_error),
        event.iterations,
        event.residual,
    )
