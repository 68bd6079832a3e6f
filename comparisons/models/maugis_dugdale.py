"""The Maugis-Dugdale model of a power-law punch on a graded half-space (M-D-n-k, Eqs. 63-78).

The two models differ in the cohesive stress alone: `MaugisDugdaleOriginal` takes the largest tension of the
9-3 law (Eq. 73), `MaugisDugdaleImproved` the stress eta(n) that gives the rigid pull-off force (Eqs. 76-78).
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np

from comparisons.model import Curve, NotApplicable
from comparisons.models.closed_form import EPS, ClosedForm, Estimate
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import STATE_ROUNDING, CohesiveEvents, Event
from comparisons.models.cohesive_profiles import CohesiveProfiles, cohesive_profiles
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from fscm.problem import Problem

__all__ = ["MaugisDugdaleImproved", "MaugisDugdaleOriginal"]

MODELS = {"md-original": "MaugisDugdaleOriginal", "md-improved": "MaugisDugdaleImproved"}

_POINTS = 401
# The curve starts at a = 0 and then at this fraction of its largest contact radius.
_FIRST_RADIUS = 1e-4
# Hertz's load at pull-off has fallen to exp(-3) of itself this far (over n) below in log(a).
_NEAR = 3.0

_DEFINED = ["pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement", "force_curve"]


class _MaugisDugdale(ClosedForm):
    """The equations common to both choices of the cohesive stress."""

    undefined: ClassVar[dict[str, str]] = {
        "jump_in_displacement": "Eqs. 66-69 hold in contact only",
        "jump_in_gap": "Eqs. 66-69 hold in contact only",
        "jump_out_gap": "the gap is zero by assumption wherever there is contact",
        "hysteresis_energy": "it needs the jump-in, and Eqs. 66-69 hold in contact only",
        "critical_tabor_number": "it needs the jump-in, and Eqs. 66-69 hold in contact only",
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

    def profiles(self, problem: Problem) -> CohesiveProfiles:
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
        return cohesive_profiles(contact, event.state, GradedPunch.of(problem).scales(problem.mu))

    def _is_jkr(self, problem: Problem) -> bool:
        """At k = 1 the surface is a bed of springs, and the cohesive zone vanishes for Lambda >= 1."""
        return problem.k == 1.0 and self.cohesive_stress(problem) * problem.mu >= 1.0

    def _contact(self, problem: Problem) -> CohesiveContact:
        return CohesiveContact(GradedPunch.of(problem), self.cohesive_stress(problem) * problem.mu)

    def _events(self, problem: Problem) -> CohesiveEvents:
        return CohesiveEvents.scan(self._contact(problem))


class MaugisDugdaleOriginal(_MaugisDugdale):
    """M-D-n-k with the theoretical strength 16 sqrt(3) / 27 as cohesive stress (Eq. 73).

    Examples
    --------
    >>> round(MaugisDugdaleOriginal().evaluate(Problem(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.7304517
    """

    name = "md-original"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-73; Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509"
    domain = "n > (1-k)/2, 0 <= k <= 1; cohesive stress 16 sqrt(3)/27"
    applies_to: ClassVar[dict[str, list[Any]]] = {"quantities": _DEFINED}

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = 16 sqrt(3) / 27, in dgamma / z0."""
        return THEORETICAL_STRENGTH


class MaugisDugdaleImproved(_MaugisDugdale):
    """M-D-n-k with the cohesive stress eta(n) of the rigid-limit-consistency condition (Eqs. 76-78).

    Examples
    --------
    >>> round(MaugisDugdaleImproved().evaluate(Problem(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.78527591
    """

    name = "md-improved"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-78; Zheng & Yu, J. Colloid Interface Sci. 310 (2007) 27-34"
    domain = "n > 2/3, 0 <= k <= 1; cohesive stress eta(n)"
    applies_to: ClassVar[dict[str, list[Any]]] = {"quantities": _DEFINED, "n": [0.667, None]}

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = eta(n), in dgamma / z0."""
        return eta(float(problem.n))


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
