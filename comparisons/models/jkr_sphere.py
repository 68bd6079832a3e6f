"""The JKR model of a ball on a homogeneous half-space: Sneddon's exact sphere in place of the paraboloid.

With alpha = a/R, x = dgamma/(E* R) and Sneddon's h = (1 + alpha^2) artanh(alpha) - alpha, the load in pi R dgamma and
the displacement in R are

    P = [h - sqrt(8 pi x alpha^3)] / (pi x),    delta = alpha artanh(alpha) - sqrt(2 pi x alpha).

At each event a function that rises as alpha^(3/2) or faster is theta sqrt(2 pi x): h' / alpha^(1/2) at pull-off
(theta = 3), (alpha artanh(alpha))' alpha^(1/2) at jump-out (1/2) and h / alpha^(3/2) at zero load (2).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from comparisons.model import Curve, NotApplicable, Result
from comparisons.models.closed_form import EPS, POINTS, ContactBranch, Limits
from comparisons.problem import Problem

#: Largest contact radius in radii of the ball, as in both references.
LARGEST_CONTACT = 0.95

#: Below this alpha the series of h has no cancellation; 20 terms leave 1e-22.
_SERIES_BELOW, _TERMS = 0.3, 20


def _sneddon(alpha: ArrayLike) -> NDArray[np.float64]:
    """(1 + alpha^2) artanh(alpha) - alpha, the sum of 4j/(4j^2 - 1) alpha^(2j+1)."""
    x = np.asarray(alpha, float)
    j = np.arange(1, _TERMS)
    series = x**3 * np.polynomial.polynomial.polyval(x**2, 4.0 * j / (4.0 * j**2 - 1.0))
    return np.where(x < _SERIES_BELOW, series, (1.0 + x**2) * np.arctanh(x) - x)


#: Of each event: the function that rises as `start` alpha^(3/2) or faster, `start`, and theta.
_EVENTS: dict[str, tuple[Callable[[float], float], float, float]] = {
    "pull_off": (lambda a: (2.0 * math.atanh(a) + 2.0 * a / (1.0 - a * a)) * math.sqrt(a), 4.0, 3.0),
    "jump_out": (lambda a: (math.atanh(a) + a / (1.0 - a * a)) * math.sqrt(a), 2.0, 0.5),
    "zero_load": (lambda a: float(_sneddon(a)) / a**1.5, 4.0 / 3.0, 2.0),
}


@dataclass(frozen=True, slots=True)
class _Ball:
    """A ball by x = dgamma/(E* R) and by its radius in z0."""

    softness: float
    radius: float

    @classmethod
    def of(cls, problem: Problem) -> _Ball:
        """Return the ball of a problem: x = (mu z0 / R)^(3/2) for n = 2 and k = 0 (Eq. 29)."""
        radius = problem.punch["R"] / problem.units["displacement"]
        return cls((problem.posed.mu / radius) ** 1.5, radius)

    def displacement(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """Delta / R."""
        x = np.asarray(alpha, float)
        return x * np.arctanh(x) - np.sqrt(2.0 * math.pi * self.softness * x)

    def load(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """P / (pi R dgamma)."""
        x = np.asarray(alpha, float)
        return (_sneddon(x) - np.sqrt(8.0 * math.pi * self.softness * x**3)) / (math.pi * self.softness)

    def at(self, event: str) -> float:
        """Return alpha where the rising function of an event is theta sqrt(2 pi x)."""
        rise, start, theta = _EVENTS[event]
        target = theta * math.sqrt(2.0 * math.pi * self.softness)
        largest = (target / start) ** (2.0 / 3.0)
        if rise(LARGEST_CONTACT) < target:
            raise NotApplicable(
                f"the ball is smaller than the contact, which reaches beyond {LARGEST_CONTACT} of its radius; "
                "check the modulus and the work of adhesion"
            )
        smallest = min(largest, LARGEST_CONTACT) / 1e3
        largest = min(largest * (1.0 + 8.0 * EPS), LARGEST_CONTACT)
        tolerances = {"xtol": 1e-300, "rtol": 4.0 * EPS}
        return float(scipy.optimize.brentq(lambda alpha: rise(alpha) - target, smallest, largest, **tolerances))


class JKRSphere(ContactBranch):
    """JKR of a ball: Sneddon's punch and Griffith's balance at the contact edge.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("homogeneous", {"E": 0.75e6, "nu": 0.5})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> ball = Problem(solid, Section("ball", {"R": 1e-5}), law)
    >>> round(JKRSphere().evaluate(ball, "pull_off_force").value, 6)
    1.460549
    """

    name = "jkr-sphere"
    citation = "Maugis, Langmuir 11 (1995) 679, with the sphere of Sneddon, Int. J. Eng. Sci. 3 (1965) 47"
    domain = "a ball on a homogeneous solid, contact radius up to 0.95 R; exact as mu -> infinity"
    checks_problems: ClassVar[bool] = True
    limits: ClassVar[Limits | None] = None

    def check(self, problem: Problem) -> None:
        """Raise `NotApplicable` unless the punch is a ball and the solid homogeneous."""
        if problem.punch.kind != "ball":
            raise NotApplicable(f"{self.name} is for the punch of the kind ball, not for {problem.punch.kind}")
        if not problem.is_of_the_paper("solid") or problem.posed.k != 0.0:
            raise NotApplicable(f"{self.name} is for a homogeneous solid, not for the {problem.solid.kind} solid given")

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        ball = _Ball.of(problem)
        alpha = ball.at("pull_off")
        terms = float(_sneddon(alpha)) + math.sqrt(8.0 * math.pi * ball.softness * alpha**3)
        return Result(-float(ball.load(alpha)), 32.0 * EPS * terms / (math.pi * ball.softness))

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event, with the rounding of its terms and that of alpha."""
        ball = _Ball.of(problem)
        alpha = ball.at(event)
        terms = alpha * math.atanh(alpha) + math.sqrt(2.0 * math.pi * ball.softness * alpha)
        rounding = 32.0 * EPS * (terms + alpha**2) / (1.0 - alpha**2)
        return Result(ball.radius * float(ball.displacement(alpha)), ball.radius * rounding)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the curve from a = 0 to where the load is as compressive as the pull-off is tensile.

        It ends where the contact reaches 0.95 R.  Column ``contact_radius``.
        """
        ball = _Ball.of(problem)
        end = pull_off = ball.at("pull_off")
        while end < LARGEST_CONTACT and ball.load(end) < -ball.load(pull_off):
            end = min(1.02 * end, LARGEST_CONTACT)
        alpha = end * np.linspace(0.0, 1.0, POINTS) ** 2
        return Curve(
            displacement=ball.radius * ball.displacement(alpha),
            load=ball.load(alpha),
            columns={"contact_radius": math.sqrt(ball.radius) * alpha},
        )
