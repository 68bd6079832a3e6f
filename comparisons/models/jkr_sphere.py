"""The JKR model of a ball on a homogeneous half-space: Sneddon's exact sphere in place of the paraboloid.

With alpha = a/R, x = dgamma/(E* R), Sneddon's h = (1 + alpha^2) artanh(alpha) - alpha, and the energy g dgamma that an
increase of the projected contact area sets free, the load in pi R dgamma and the displacement in R are

    P = [h - sqrt(8 pi x g alpha^3)] / (pi x),    delta = alpha artanh(alpha) - sqrt(2 pi x g alpha).

Maugis counts the work of adhesion for the projected area, g = 1.  Atoms count it for the true area of the sphere,
2 pi R^2 (1 - sqrt(1 - alpha^2)), whose increase by that of pi a^2 is g = (1 - alpha^2)^(-1/2).

At each event a function that rises as alpha^(3/2) or faster is theta sqrt(2 pi x).  With q = alpha g'/g it is
h' / [(alpha g)^(1/2) (1 + q/3)] at pull-off (theta = 3), (alpha artanh(alpha))' (alpha/g)^(1/2) / (1 + q) at jump-out
(1/2) and h / (alpha^3 g)^(1/2) at zero load (2).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from comparisons.model import Curve, Result
from comparisons.models.closed_form import EPS, POINTS, ContactBranch
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


def _sneddon_slope(alpha: ArrayLike) -> NDArray[np.float64]:
    """Derivative of `_sneddon`."""
    x = np.asarray(alpha, float)
    return np.asarray(2.0 * x * (np.arctanh(x) + x / (1.0 - x * x)))


@dataclass(frozen=True, slots=True)
class Release:
    """Energy that an increase of the projected contact area sets free, in dgamma: (1 - alpha^2)^(-power)."""

    power: float

    def __call__(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """Return g."""
        return np.asarray((1.0 - np.asarray(alpha, float) ** 2) ** -self.power)

    def rate(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """Return q = alpha g'/g."""
        square = np.asarray(alpha, float) ** 2
        return np.asarray(2.0 * self.power * square / (1.0 - square))


def _at_pull_off(a: ArrayLike, g: Release) -> NDArray[np.float64]:
    x = np.asarray(a, float)
    return np.asarray(_sneddon_slope(x) / np.sqrt(x * g(x)) / (1.0 + g.rate(x) / 3.0))


def _at_jump_out(a: ArrayLike, g: Release) -> NDArray[np.float64]:
    x = np.asarray(a, float)
    return np.asarray((np.arctanh(x) + x / (1.0 - x * x)) * np.sqrt(x / g(x)) / (1.0 + g.rate(x)))


def _at_zero_load(a: ArrayLike, g: Release) -> NDArray[np.float64]:
    return np.asarray(_sneddon(a) / np.sqrt(np.asarray(a, float) ** 3 * g(a)))


#: Of each event: the function that rises as `start` alpha^(3/2) or faster, `start`, and theta.
_EVENTS: dict[str, tuple[Callable[[ArrayLike, Release], NDArray[np.float64]], float, float]] = {
    "pull_off": (_at_pull_off, 4.0, 3.0),
    "jump_out": (_at_jump_out, 2.0, 0.5),
    "zero_load": (_at_zero_load, 4.0 / 3.0, 2.0),
}

#: Contact radii among which the end of the rise of such a function is looked for.
_RADII = np.linspace(0.3, LARGEST_CONTACT, 651)


@dataclass(frozen=True, slots=True)
class _Ball:
    """A ball by x = dgamma/(E* R), by its radius in z0 and by g."""

    softness: float
    radius: float
    release: Release

    @classmethod
    def of(cls, problem: Problem, release: Release) -> _Ball:
        """Return the ball of a problem: x = (mu z0 / R)^(3/2) for n = 2 and k = 0 (Eq. 29)."""
        radius = problem.punch["R"] / problem.units["displacement"]
        return cls((problem.posed.mu / radius) ** 1.5, radius, release)

    def displacement(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """Delta / R."""
        x = np.asarray(alpha, float)
        return x * np.arctanh(x) - np.sqrt(2.0 * math.pi * self.softness * self.release(x) * x)

    def load(self, alpha: ArrayLike) -> NDArray[np.float64]:
        """P / (pi R dgamma)."""
        x = np.asarray(alpha, float)
        adhesive = np.sqrt(8.0 * math.pi * self.softness * self.release(x) * x**3)
        return (_sneddon(x) - adhesive) / (math.pi * self.softness)

    def target(self, event: str) -> float:
        """Return theta sqrt(2 pi x) of an event."""
        return _EVENTS[event][2] * math.sqrt(2.0 * math.pi * self.softness)

    def last_radius(self, event: str) -> tuple[float, bool]:
        """Return where the rise of the function of an event ends, and whether it rises to theta sqrt(2 pi x)."""
        values = _EVENTS[event][0](_RADII, self.release)
        last = int(np.argmax(values))
        return float(_RADII[last]), bool(values[last] >= self.target(event))

    def at(self, event: str) -> float:
        """Return alpha where the rising function of an event is theta sqrt(2 pi x)."""
        rise, start, _ = _EVENTS[event]
        target, last = self.target(event), self.last_radius(event)[0]
        ends = min((target / start) ** (2.0 / 3.0), last) / 1e3, last
        tolerances = {"xtol": 1e-300, "rtol": 4.0 * EPS}
        return float(scipy.optimize.brentq(lambda a: float(rise(a, self.release)) - target, *ends, **tolerances))


class JKRSphere(ContactBranch):
    """JKR of a ball: Sneddon's punch and Griffith's balance at the contact edge, with the true area of contact.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("homogeneous", {"E": 0.75e6, "nu": 0.5})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> ball = Problem(solid, Section("ball", {"R": 1e-5}), law)
    >>> round(JKRSphere().evaluate(ball, "pull_off_force").value, 6)
    1.510628
    """

    name = "jkr-sphere"
    citation = (
        "Maugis, Langmuir 11 (1995) 679, with the sphere of Sneddon, Int. J. Eng. Sci. 3 (1965) 47, and the work of "
        "adhesion counted for the true area of contact"
    )
    domain = "a ball on a homogeneous solid, contact radius up to 0.95 R; small strains, mu -> infinity"
    #: The area of a sphere over its projection grows as the secant of its slope.
    release: ClassVar[Release] = Release(0.5)

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless a ball that is larger than its contact is on a homogeneous solid."""
        if problem.punch.kind != "ball":
            exact = '; write kind = "ball" for the exact sphere' if problem.punch.kind == "sphere" else ""
            return f"{self.name} is for the punch of the kind ball, not for {problem.punch.kind}{exact}"
        if not problem.is_of_the_paper("solid") or problem.posed.k != 0.0:
            return f"{self.name} is for a homogeneous solid, not for the {problem.solid.kind} solid given"
        if undefined := self._undefined(quantity):
            return undefined
        event = next((name for name in _EVENTS if quantity == f"{name}_displacement"), "pull_off")
        last, is_reached = _Ball.of(problem, self.release).last_radius(event)
        if is_reached:
            return None
        return (
            f"the ball is smaller than the contact, which reaches beyond {last:.2g} of its radius; "
            "check the modulus and the work of adhesion"
        )

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        ball = _Ball.of(problem, self.release)
        alpha = ball.at("pull_off")
        adhesive = math.sqrt(8.0 * math.pi * ball.softness * float(self.release(alpha)) * alpha**3)
        terms = float(_sneddon(alpha)) + adhesive
        return Result(-float(ball.load(alpha)), 32.0 * EPS * terms / (math.pi * ball.softness))

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event, with the rounding of its terms and that of alpha."""
        ball = _Ball.of(problem, self.release)
        alpha = ball.at(event)
        terms = alpha * math.atanh(alpha) + math.sqrt(
            2.0 * math.pi * ball.softness * float(self.release(alpha)) * alpha
        )
        rounding = 32.0 * EPS * (terms + alpha**2) / (1.0 - alpha**2)
        return Result(ball.radius * float(ball.displacement(alpha)), ball.radius * rounding)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the curve from a = 0 to where the load is as compressive as the pull-off is tensile.

        It ends where the contact reaches 0.95 R.  Column ``contact_radius``.
        """
        ball = _Ball.of(problem, self.release)
        return self.curve_to(problem, -float(ball.load(ball.at("pull_off"))))

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the same to a load, in pi Q^(2/n) dgamma z0^(2/n-1)."""
        ball = _Ball.of(problem, self.release)
        end = ball.at("pull_off")
        while end < LARGEST_CONTACT and ball.load(end) < load:
            end = min(1.02 * end, LARGEST_CONTACT)
        alpha = end * np.linspace(0.0, 1.0, POINTS) ** 2
        return Curve(
            displacement=ball.radius * ball.displacement(alpha),
            load=ball.load(alpha),
            columns={"contact_radius": math.sqrt(ball.radius) * alpha},
        )


class JKRSphereProjected(JKRSphere):
    """JKR of a ball as Maugis has it, with the projected area of contact: the limit of a force of vertical gaps.

    Examples
    --------
    >>> from comparisons.description.strain_errors import ball_on
    >>> model = JKRSphereProjected()
    >>> round(model.evaluate(ball_on(5e-3, 100.0, 0.5), "pull_off_force").value / 1.5, 6)
    0.973699
    """

    name = "jkr-sphere-projected"
    citation = "Maugis, Langmuir 11 (1995) 679, with the sphere of Sneddon, Int. J. Eng. Sci. 3 (1965) 47"
    domain = "a ball on a homogeneous solid, contact radius up to 0.95 R; exact for vertical gaps as mu -> infinity"
    release: ClassVar[Release] = Release(0.0)

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not for a force of the whole body as well, which counts the true area."""
        if problem.interaction == "body":
            return (
                f"{self.name} counts the work of adhesion for the projected area, as vertical gaps do: for interaction "
                "= body take jkr-sphere"
            )
        return super().skip(problem, quantity)
