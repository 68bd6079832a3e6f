"""Models of a power-law punch on a graded half-space with a cohesive zone at the contact edge.

A model chooses the largest traction of the zone, unless it is the theoretical strength of the 9-3 law (Eq. 73), and how
a traction that is not constant decays.

*Maugis-Dugdale (M-D-n-k, Eqs. 63-78)*: the traction is constant.  `MaugisDugdaleOriginal` takes the theoretical
strength, `MaugisDugdaleImproved` the stress eta(n) that gives the rigid pull-off force (Eqs. 76-78), and
`MaugisDugdaleJin` that of Jin, Tang, Guo and Gao (2021), dgamma / z0.  Their strength is the theoretical one without
its decimals (1 for 1.026), so that the Maugis number is the Tabor number.  Their Tabor number has no factor b/(1-k)
(Eq. 30); the Maugis number has none either, and the ratio of the two, which alone enters here, is the same.

*Double Hertz*: the theoretical strength at the contact edge.  For n = 2 this is the model of Jin, Guo and Gao, for
n = 2 and k = 0 that of Greenwood and Johnson.  For other n the traction stays the difference of the Hertz pressures of
a paraboloid.  That of the Hertz pressures of r^n would be infinite on the axis for n <= 1 - k, and largest inside the
zone, away from the contact edge, for a large n.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from comparisons.model import Curve, Result, refuse
from comparisons.models.closed_form import EPS, POINTS, ContactBranch
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import STATE_ROUNDING, CohesiveEvents, Event
from comparisons.models.cohesive_profiles import CohesiveProfiles, cohesive_profiles
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.problem import Problem
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES, Kind

#: The curve starts at a = 0 and then at this fraction of its largest contact radius.
_FIRST_RADIUS = 1e-4
#: Hertz's load at pull-off has fallen to exp(-3) of itself this far (over n) below in log(a).
_NEAR = 3.0


class CohesiveModel(ContactBranch):
    """Events, curve and surface of a contact with a cohesive zone; the largest traction is the cohesive stress."""

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 in dgamma / z0; by default 16 sqrt(3) / 27, the largest tension of the 9-3 law (Eq. 73)."""
        return THEORETICAL_STRENGTH

    def decay(self, problem: Problem) -> float:
        """How fast the traction decays from the contact edge (`CohesiveContact`); 0: it is constant."""
        return 0.0

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, for a surface whose edge is that of JKR."""
        if (reason := super().skip(problem, quantity)) or ALL_QUANTITIES[quantity].kind is not Kind.FIELD:
            return reason
        if not self._is_jkr(problem):
            return None
        return f"{self.name} has no cohesive zone at k = {problem.k:g} and mu = {problem.mu:g}: its edge is JKR's"

    def _call(self, quantity: str, problem: Problem) -> Any:
        refuse(self.skip(problem, quantity))
        is_jkr = quantity in QUANTITIES and self._is_jkr(problem)
        return JKR().evaluate(problem, quantity) if is_jkr else getattr(self, quantity)(problem)

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P over the contact branch, its end point a = 0 included."""
        event = self._events(problem).pull_off()
        rounding = _conditioning(problem) * STATE_ROUNDING * float(event.state.load_scale[0])
        scale = GradedPunch.of(problem).scales(problem.mu).load
        return _of_event(event, -event.load * scale, scale * (rounding + event.curvature_error))

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event of `CohesiveEvents`."""
        located: Event = getattr(self._events(problem), event)()
        state = located.state
        rounding = (_conditioning(problem) * STATE_ROUNDING + EPS) * float(state.displacement_scale[0])
        displaced = abs(float(state.displacement_slope[0])) * located.w_error
        # Where the slope vanishes by definition (the fold) its rounding is what is left.
        displaced += float(state.displacement_slope_scale[0]) * STATE_ROUNDING * located.w_error
        scale = GradedPunch.of(problem).scales(problem.mu).displacement
        u_num = scale * (rounding + displaced + located.curvature_error)
        return _of_event(located, located.displacement * scale, u_num)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the contact branch from a = 0 to a load as compressive as the pull-off is tensile.

        Columns ``contact_radius`` and ``cohesive_radius``.
        """
        if self._is_jkr(problem):
            return self.curve_to(problem, JKR().pull_off_force(problem).value)
        scale = GradedPunch.of(problem).scales(problem.mu)
        return self.curve_to(problem, -self._events(problem).pull_off().load * scale.load)

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the same to a load, in pi Q^(2/n) dgamma z0^(2/n-1)."""
        if self._is_jkr(problem):
            curve = JKR().curve_to(problem, load)
            curve.columns["cohesive_radius"] = curve.columns["contact_radius"]
            return curve
        scale = GradedPunch.of(problem).scales(problem.mu)
        events = self._events(problem)
        contact, pull_off = events.contact, events.pull_off()
        end = events.first_beyond(load / scale.load)
        # Half the points from first contact on, half about the pull-off, where a large n bends the curve.
        log_first = contact.log_contact_radius(end) + np.log(_FIRST_RADIUS)
        start = float(events.w[events.states.contact_radius >= np.exp(log_first)][0])
        bend = max(start, pull_off.w - _NEAR / contact.punch.n)
        even, dense = np.linspace(start, end, POINTS // 2), np.linspace(bend, end, POINTS // 2)
        w = np.unique(np.concatenate(([-np.inf, pull_off.w], even, dense)))
        state = contact.at(w)
        radii = {"contact_radius": state.contact_radius, "cohesive_radius": state.cohesive_radius}
        return scale.curve(state.displacement, state.load, **radii)

    def pull_off_profile(self, problem: Problem, points: int = 60) -> CohesiveProfiles:
        """Return the surface where P is smallest, with `points` radii in each of its three parts.

        Raises
        ------
        NotApplicable
            As `evaluate`; also where the cohesive zone is narrower than a rounding.
        """
        refuse(self.skip(problem, "pull_off_gap"))
        events = self._events(problem)
        scales = GradedPunch.of(problem).scales(problem.mu)
        return cohesive_profiles(events.contact, events.pull_off().state, scales, points)

    def _is_jkr(self, problem: Problem) -> bool:
        """At k = 1 the surface is a bed of springs, and the cohesive zone vanishes for Lambda >= 1."""
        return problem.k == 1.0 and self.cohesive_stress(problem) * problem.mu >= 1.0

    def _events(self, problem: Problem) -> CohesiveEvents:
        stress = self.cohesive_stress(problem)
        return CohesiveEvents.scan(CohesiveContact(GradedPunch.of(problem), stress * problem.mu, self.decay(problem)))


class MaugisDugdaleOriginal(CohesiveModel):
    """M-D-n-k with the theoretical strength 16 sqrt(3) / 27 as cohesive stress (Eq. 73).

    Examples
    --------
    >>> round(MaugisDugdaleOriginal().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.7304517
    """

    name = "md-original"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-73; Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509"
    domain = "n > (1-k)/2, 0 <= k <= 1; cohesive stress 16 sqrt(3)/27"


class MaugisDugdaleImproved(CohesiveModel):
    """M-D-n-k with the cohesive stress eta(n) of the rigid-limit-consistency condition (Eqs. 76-78).

    Examples
    --------
    >>> round(MaugisDugdaleImproved().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.78527591
    """

    name = "md-improved"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-78; Zheng & Yu, J. Colloid Interface Sci. 310 (2007) 27-34"
    domain = "n > 2/3, 0 <= k <= 1; cohesive stress eta(n)"

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = eta(n), in dgamma / z0."""
        return eta(float(problem.n))


class MaugisDugdaleJin(CohesiveModel):
    """M-D-n-k with the cohesive stress 1.

    Examples
    --------
    >>> round(MaugisDugdaleJin().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.73229032
    """

    name = "md-jin"
    citation = (
        "Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509; Zhu, Zheng, Huang & Yu, Eqs. 63-72 and Sec. 4.2"
    )
    domain = "n > (1-k)/2, 0 <= k <= 1; cohesive stress 1"

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = 1, in dgamma / z0."""
        return 1.0


class DoubleHertz(CohesiveModel):
    """Double-Hertz-n-k with the theoretical strength 16 sqrt(3) / 27 as largest traction.

    Examples
    --------
    >>> round(DoubleHertz().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.75097087
    """

    name = "double-hertz-n-k"
    citation = (
        "Greenwood & Johnson, J. Phys. D 31 (1998) 3279-3290; Jin, Guo & Gao, J. Mech. Phys. Solids 61 (2013) "
        "2473-2492; other n: equations of this repository (docs/theory.md)"
    )
    domain = "n > (1-k)/2, 0 <= k <= 1; largest traction 16 sqrt(3)/27"

    def decay(self, problem: Problem) -> float:
        """Of the difference of two Hertz pressures: (1+k)/2."""
        return 0.5 * (1.0 + float(problem.k))


def _conditioning(problem: Problem) -> float:
    """Return how much an event amplifies an error of Griffith's relation: loads ~ dgamma^((k+3)/(2n+k-1))."""
    return 1.0 + (3.0 + problem.k) / (2.0 * problem.n + problem.k - 1.0)


def _of_event(event: Event, value: float, u_num: float) -> Result:
    return Result(value, u_num, iterations=event.iterations, residual=event.residual)
