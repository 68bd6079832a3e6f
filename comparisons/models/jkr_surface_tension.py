"""The JKR model of a sphere on a homogeneous solid with surface tension.

With x = a/A, A = (R^2 dgamma/E*)^(1/3), and the functions of l/a of `surface_tension`, the state without adhesion has
delta = x^2 e/k.  Griffith's balance (1/2) flat^2 dC/da = 2 pi a dgamma gives what a flat punch subtracts from it:

    flat = sqrt(2 pi x/k),   delta = x^2 e/k - flat,   P = 2 x c delta - (2/3) x^3 m,

delta in A^2/R and P in R dgamma.  l = 2 Y/E*, so that all depends on L = l/A = 2 Y mu z0/(dgamma R).  For L -> 0 this
is JKR, and for L -> infinity, where the surface tension alone resists, the pull-off force is pi R dgamma.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from comparisons.model import Array, Curve, Result
from comparisons.models.closed_form import EPS, POINTS, ContactBranch
from comparisons.models.surface_tension import LARGEST, SERIES_ERROR, contact
from comparisons.problem import Problem

#: Contact radii in A between which the events are: JKR has them from 0.9 to 3, surface tension makes them smaller.
_LEAST, _LARGEST = 1e-4, 6.0

#: Radii at equal ratios among which an event is looked for.
_SEARCH = 400


@dataclass(frozen=True, slots=True)
class _Sphere:
    """A sphere by L and by the Tabor number."""

    tension: float
    mu: float

    @classmethod
    def of(cls, problem: Problem) -> _Sphere:
        """Return the sphere of a problem, whose radius R is that of the unit of radii sqrt(R z0)."""
        elastic = problem.without("solid.surface_tension")
        units, mu = elastic.units, elastic.posed.mu
        ratio = problem.solid["surface_tension"] / units["energy_per_area"]
        return cls(2.0 * ratio * mu * (units["displacement"] / units["radius"]) ** 2, mu)

    @property
    def relative_error(self) -> float:
        """Of each term of a load or a displacement, which has up to three constants of the series."""
        return 3.0 * SERIES_ERROR * (self.tension > 0.0) + 32.0 * EPS

    @property
    def smallest(self) -> float:
        """The least contact radius for which the series holds."""
        return self.tension / LARGEST

    def displacement(self, radius: ArrayLike) -> Array:
        """Delta in A^2/R."""
        x = np.asarray(radius, float)
        at = contact(self.tension / x)
        return np.asarray(x**2 * at.e / at.k - np.sqrt(2.0 * math.pi * x / at.k))

    def load(self, radius: ArrayLike) -> Array:
        """P in pi R dgamma."""
        x = np.asarray(radius, float)
        at = contact(self.tension / x)
        return np.asarray(2.0 * x * at.c * self.displacement(x) - 2.0 * x**3 * at.m / 3.0) / math.pi

    def displacement_slope(self, radius: ArrayLike) -> Array:
        """d(delta)/dx."""
        x = np.asarray(radius, float)
        at = contact(self.tension / x)
        flat = np.sqrt(2.0 * math.pi * x / at.k)
        hertz = x * (2.0 * at.e - at.e_rate + at.e * at.k_rate / at.k) / at.k
        return np.asarray(hertz - 0.5 * flat / x * (1.0 + at.k_rate / at.k))

    def load_slope(self, radius: ArrayLike) -> Array:
        """dP/dx: the displacement at a constant radius costs 2 x c, and the radius at a constant delta -2 k flat."""
        x = np.asarray(radius, float)
        at = contact(self.tension / x)
        flat = np.sqrt(2.0 * math.pi * x / at.k)
        return np.asarray(2.0 * x * at.c * self.displacement_slope(x) - 2.0 * at.k * flat) / math.pi

    @lru_cache(maxsize=64)  # noqa: B019  # two numbers each, and a model asks for an event twice
    def radius_at(self, event: str) -> float:
        """Return x at an event, 0 where the contact is smaller than those of the series.

        There a rising function is zero: a slope, or the load beyond its minimum.
        """
        rising: dict[str, Callable[[ArrayLike], Array]] = {
            "pull_off": self.load_slope,
            "jump_out": self.displacement_slope,
            "zero_load": self.load,
        }
        first = self.radius_at("pull_off") if event == "zero_load" else max(_LEAST, self.smallest)
        radii = np.geomspace(first, _LARGEST, _SEARCH)
        negative = np.flatnonzero(rising[event](radii) < 0.0)
        if not len(negative):
            return 0.0
        ends = radii[negative[-1]], radii[negative[-1] + 1]
        return float(scipy.optimize.brentq(lambda x: float(rising[event](x)), *ends, xtol=1e-300, rtol=4.0 * EPS))


class JKRSurfaceTension(ContactBranch):
    """JKR of a sphere with the surface tension of the solid.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("homogeneous", {"E": 1.5e6, "nu": 0.5, "surface_tension": 0.02})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 1e-9})
    >>> bead = Problem(solid, Section("sphere", {"R": 5e-6}), law)
    >>> round(JKRSurfaceTension().evaluate(bead, "pull_off_force").value, 6)
    1.467125
    """

    name = "jkr-surface-tension"
    citation = (
        "Hui, Liu, Salez, Raphael & Jagota, Proc. R. Soc. A 471 (2015) 20140727, by Griffith's balance and a series of "
        "the solved integral equation"
    )
    domain = "a rigid sphere on a homogeneous solid with surface tension Y, 2 Y/(E* a) up to 1e5; mu -> infinity"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless a rigid sphere is on one homogeneous solid that states its surface tension."""
        if problem.punch.kind != "sphere" or problem.punch_solid is not None or "solid.friction" in problem.surface:
            return f"{self.name} is for a rigid sphere without friction; this problem has {problem.parts}"
        elastic = problem.without("solid.surface_tension")
        if not elastic.is_of_the_paper("solid") or elastic.posed.k != 0.0:
            return f"{self.name} is for a homogeneous solid; this problem has {problem.parts}"
        if "surface_tension" not in problem.solid.values:
            return f"{self.name} needs surface_tension in [solid]; without it, it is jkr"
        if undefined := self._undefined(quantity):
            return undefined
        event = "jump_out" if quantity == "jump_out_displacement" else "pull_off"
        if _Sphere.of(problem).radius_at(event) > 0.0:
            return None
        return (
            f"the contact is smaller than {1.0 / LARGEST:g} of the length 2 Y/E* of the surface tension Y: the "
            "solid is a liquid, whose pull-off force is pi R w"
        )

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        sphere = _Sphere.of(problem)
        x = sphere.radius_at("pull_off")
        at = contact(sphere.tension / x)
        terms = 2.0 * x * at.c * (x**2 * at.e / at.k + np.sqrt(2.0 * math.pi * x / at.k)) + 2.0 * x**3 * at.m / 3.0
        return Result(-float(sphere.load(x)), sphere.relative_error * float(terms) / math.pi)

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event, with the errors of its terms and that of the radius."""
        sphere = _Sphere.of(problem)
        x = sphere.radius_at(event)
        at = contact(sphere.tension / x)
        terms = float(x**2 * at.e / at.k + np.sqrt(2.0 * math.pi * x / at.k))
        return Result(sphere.mu * float(sphere.displacement(x)), sphere.mu * sphere.relative_error * terms)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the curve from the smallest contact to where the load is as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        sphere = _Sphere.of(problem)
        pull_off = sphere.radius_at("pull_off")
        end = pull_off
        while sphere.load(end) < -sphere.load(pull_off):
            end *= 1.02
        # Not at 0: the load and the displacement there are those of their limit, to a part in 1e9.
        start = max(sphere.smallest, 1e-9 * end)
        x = start + (end - start) * np.linspace(0.0, 1.0, POINTS) ** 2
        displacement, load = sphere.mu * sphere.displacement(x), sphere.load(x)
        return Curve(displacement, load, {"contact_radius": math.sqrt(sphere.mu) * x})
