"""The Maugis-Dugdale model of a punch of any axisymmetric profile on a graded half-space (M-D-k).

Outside of the contact the constant stress sigma_0, the strength of the law, acts for a < r < c.  With L^2 = c^2 - a^2,
v = (c^2 - x^2) / L^2 and the notation of `profile_branch`, in barred units,

    T = 2 sigma_0 G L^(2s),    delta = g - T,
    P = (stiffness / G) [ (g - T) a^(1+k) / (1+k) - m - T (L^2 / 2) integral_0^1 x^(k-1) v^s dv ],

as `cohesive_contact` has it for a power law.  The stress does the work of adhesion on the gap at c, sigma_0 H(c) = 1.
In H(c) = (2/pi) sin(pi s) integral_a^c x^k (c^2 - x^2)^(s-1) e(x) dx, with e = g(x) - g(a) + T (1 - v^s), the order of
integration of the profile is changed: with the regularised incomplete beta function I

    H(c) = f(c) - f(a) + integral_0^a f'(r) I(s, 1-s; L^2 / (c^2 - r^2)) dr
           - stiffness L^(2s) integral_0^1 x^(k-1) [ g(a) - T (1 - z) ] dz,    z = v^s,

whose last part is that of a flat punch (Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18, has the same model in the form
of the method of dimensionality reduction).  For a power law and the 9-3 law it is `md-original`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
import scipy

from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.models.closed_form import EPS
from comparisons.models.profile_branch import ROUNDING, Branch, ProfileModel, State
from comparisons.models.quadrature import FINE
from comparisons.problem import Problem

#: Widths L among which that of the zone is looked for, as exponents of e over the unit of radii.
_NARROWEST, _WIDEST = -300.0, 40.0
#: Work that stands for what is not positive, by rounding, where the zone is narrow.
_LEAST_WORK = 1e-300
#: Change of log(L) by which the slope of H(c) is found.
_STEP = 1e-4


@dataclass(frozen=True)
class _CohesiveBranch(Branch):
    """The states of Maugis-Dugdale; `stress` is sigma_0."""

    stress: float = math.nan

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the branch of a problem."""
        plain, law = super().of(problem), problem.posed.law
        return cls(plain.profile, plain.punch, plain.compliance, -float(law.traction(np.array(law.peak_gap))))

    def at(self, radius: float) -> State:
        """Return the state of a contact radius."""
        profile, moment = self.profile.at(radius)
        if self._gap(radius, profile, _NARROWEST)[0] >= 1.0 / self.stress:
            raise ComputationFailed(
                f"the cohesive zone at the contact radius {radius:.4g} is narrower than the numbers of the computer: "
                "take jkr-profile, which is its limit"
            )
        log_width = float(
            scipy.optimize.brentq(
                lambda log_L: self._log_work(radius, profile, log_L),
                _NARROWEST,
                _WIDEST,
                xtol=4.0 * EPS,
                rtol=4.0 * EPS,
            )
        )
        k, s, L = self.punch.k, self.punch.s, math.exp(log_width)
        lift, stiffness = self._lift(log_width), self.punch.stiffness / self.compliance
        inner = radius ** (1.0 + k) / (1.0 + k)
        x2 = radius**2 + L**2 * FINE.complement
        zone = 0.5 * L**2 * float(FINE.weight @ (x2 ** (0.5 * (k - 1.0)) * FINE.z**s))
        load = stiffness * ((profile - lift) * inner - moment - lift * zone)
        terms = stiffness * ((profile + lift) * inner + moment + lift * zone)
        shift = self._width_error(radius, profile, log_width)
        displacement_error = ROUNDING * (profile + lift) + 2.0 * s * shift * lift
        load_error = ROUNDING * terms + (2.0 * s + 2.0) * shift * stiffness * lift * (inner + zone)
        return State(profile - lift, load, displacement_error, load_error)

    def _log_work(self, radius: float, profile: float, log_width: float) -> float:
        """Log of sigma_0 H(c), nearly linear in log(L), so that few steps find its root."""
        return math.log(max(self.stress * self._gap(radius, profile, log_width)[0], _LEAST_WORK))

    def _lift(self, log_width: float) -> float:
        """T."""
        return 2.0 * self.stress * self.compliance * math.exp(2.0 * self.punch.s * log_width)

    def _gap(self, radius: float, profile: float, log_width: float) -> tuple[float, float]:
        """Return H(c) and the sum of its terms."""
        k, s, L = self.punch.k, self.punch.s, math.exp(log_width)
        c, lift = math.hypot(radius, L), self._lift(log_width)
        log_z = FINE.log_z / s
        x2 = radius**2 - L**2 * np.expm1(log_z)
        weight = FINE.weight * x2 ** (0.5 * (k - 1.0))
        front = self.punch.stiffness * math.exp(2.0 * s * log_width)
        flat, opened = front * profile * float(weight.sum()), front * lift * float(weight @ FINE.complement)
        rise = self.profile.risen(radius, L, c)
        return rise - flat + opened, rise + flat + opened

    def _width_error(self, radius: float, profile: float, log_width: float) -> float:
        """Return the error of log(L) by the rounding of H(c)."""
        above, below = (self._gap(radius, profile, log_width + shift)[0] for shift in (_STEP, -_STEP))
        slope = (above - below) / (2.0 * _STEP)
        return 4.0 * EPS * abs(log_width) + ROUNDING * self._gap(radius, profile, log_width)[1] / slope


class MaugisDugdaleProfile(ProfileModel):
    """Maugis-Dugdale of any profile without waves, with the strength of the law as cohesive stress.

    Examples
    --------
    >>> from comparisons.models.cohesive_models import MaugisDugdaleOriginal
    >>> sphere = {"solid": {"kind": "homogeneous", "E": "1 GPa", "nu": 0.3}, "punch": {"kind": "sphere", "R": "100 nm"}}
    >>> scales = {"work_of_adhesion": "50 mJ/m^2", "z0": "0.4 nm"}
    >>> mie, nine_three = {"kind": "mie", **scales, "m": 9, "n": 3}, {"kind": "lennard-jones-9-3", **scales}
    >>> by_profile = MaugisDugdaleProfile().evaluate(Problem.of(**sphere, law=mie), "pull_off_force")
    >>> exact = MaugisDugdaleOriginal().evaluate(Problem.of(**sphere, law=nine_three), "pull_off_force")
    >>> abs(by_profile.value - exact.value) < 1e-11
    True
    """

    name = "md-profile"
    citation = (
        "Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18; equations of this repository "
        "(comparisons/models/md_profile.py)"
    )
    domain = "problems in physical units, power-law solid with k < 1, punch without waves, law without barrier"
    _branch_type: ClassVar[type[Branch]] = _CohesiveBranch

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not for k = 1 as well, where the surface is a bed of springs."""
        if not problem.is_of_the_paper() and problem.is_of_the_paper("solid") and problem.posed.k == 1.0:
            return f"{self.name} is for k < 1: for k = 1 the stress at a point lifts the surface there alone"
        return super().skip(problem, quantity)

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event; a fold out of contact is none of this model."""
        if event == "jump_out" and self.branch_of(problem).radius_at(event) == 0.0:
            raise NotApplicable(
                f"the displacement grows with the contact radius from the first touch: {self.name} has no fold in "
                "contact"
            )
        return super().displacement_at(problem, event)
