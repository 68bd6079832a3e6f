"""Random punches and laws of every kind of a problem file, over the range of each kind, and of functions of one's own.

Lengths are in the range of the laws and energies per area in about their work of adhesion, both 1.  A punch has a size:
the radius of a sphere that is about as blunt.  `problem` puts a punch and a law on a homogeneous solid of a random
Tabor number.  All take the package whose classes they use, `fscm` or `fem_reference`, and draw the same for both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

import fscm
from comparisons.problem.punch_shapes import RoundedFlat, SmoothedProfile
from fscm.wells import has_one_well

#: A punch and its size; a surface law.
MakePunch = Callable[[ModuleType, np.random.Generator], tuple[Any, float]]
MakeLaw = Callable[[ModuleType, np.random.Generator], Any]
#: A table of a law that `fscm` refuses is drawn again, at most so often.
_ATTEMPTS = 40


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _sphere(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    R = between(rng, 3.0, 1e5)
    return package.PowerPunch(2.0, R), R


def _ball(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    """From the smallest that holds its contact to one that is a paraboloid."""
    R = between(rng, 20.0, 3e3)
    return package.Ball(R), R


def _cone(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    Q = math.tan(math.radians(rng.uniform(20.0, 85.0)))
    return package.PowerPunch(1.0, Q), Q * Q


def _power_law(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    n, radius = float(rng.uniform(1.0, 6.0)), between(rng, 3.0, 100.0)
    return package.PowerPunch(n, radius**n / n), radius**2 / 2.0


def _rounded_cone(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    R, slope = between(rng, 3.0, 300.0), between(rng, 0.1, 2.0)
    return package.RoundedCone(R * slope, slope), max(R, 1.0 / slope**2)


def _rounded_flat(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    a, R = between(rng, 1.0, 10.0), between(rng, 3.0, 100.0)
    return RoundedFlat(a, R), R


def _power_sum(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    R, quartic = between(rng, 3.0, 300.0), between(rng, 1e-3, 1.0)
    return package.PowerSum([0.5 / R, quartic * R**-3], [2.0, 4.0]), R


def _profile(rng: np.random.Generator, rows: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Radii and heights of a paraboloid with waves of up to a range of the law, and its radius."""
    R = between(rng, 3.0, 100.0)
    end = math.sqrt(2.0 * R * rng.uniform(10.0, 30.0))
    radii = np.append(0.0, np.sort(end * (np.arange(1, rows) + rng.uniform(-0.3, 0.3, rows - 1)) / (rows - 1)))
    wave, height = rng.uniform(1.0, 3.0) * math.pi / end, rng.uniform(0.0, 1.0)
    heights = radii**2 / (2.0 * R) + height * (1.0 - np.cos(wave * radii))
    return radii, heights, R


def _measured(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    radii, heights, R = _profile(rng, int(rng.integers(6, 14)))
    return package.MeasuredPunch(tuple(radii.tolist()), tuple(heights.tolist()), float(rng.uniform(1.5, 3.0))), R


def _smoothed(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    radii, heights, R = _profile(rng, int(rng.integers(20, 80)))
    noise = between(rng, 1e-3, 0.2)
    heights[1:] += noise * rng.standard_normal(len(radii) - 1)
    return SmoothedProfile(tuple(radii.tolist()), tuple(heights.tolist()), noise, float(rng.uniform(1.5, 3.0))), R


def _function(package: ModuleType, rng: np.random.Generator) -> tuple[Any, float]:
    """A paraboloid whose derivative of order 2 or 3 jumps at a radius that is not stated."""
    R, order = between(rng, 3.0, 100.0), int(rng.integers(2, 4))
    at = math.sqrt(2.0 * R * between(rng, 0.3, 10.0))
    size = rng.uniform(-0.3, 0.3) * at ** (2 - order) / R

    def beyond(r: np.ndarray) -> np.ndarray:
        return np.maximum(r - at, 0.0)

    def fading(r: np.ndarray) -> np.ndarray:
        return np.exp(-((beyond(r) / at) ** 2))

    def height(r: np.ndarray) -> np.ndarray:
        return r**2 / (2.0 * R) + size * beyond(r) ** order * fading(r)

    def slope(r: np.ndarray) -> np.ndarray:
        x = beyond(r)
        return r / R + size * x ** (order - 1) * (order - 2.0 * (x / at) ** 2) * fading(r)

    return package.CustomPunch(height, 2.0, slope if rng.random() < 0.5 else None), R


#: By the names of `comparisons/data/kinds.toml`, and two more.
PUNCHES: dict[str, MakePunch] = {
    "sphere": _sphere,
    "ball": _ball,
    "cone": _cone,
    "power-law": _power_law,
    "rounded-cone": _rounded_cone,
    "rounded-flat": _rounded_flat,
    "table": _measured,
    "smoothed table": _smoothed,
    "power sum": _power_sum,
    "function": _function,
}


def _nine_three(package: ModuleType, rng: np.random.Generator) -> Any:
    return package.LennardJones(1.0, 1.0)


def _exponents(rng: np.random.Generator) -> tuple[float, float]:
    """Of the repulsion and of the attraction."""
    n = between(rng, 1.5, 6.0)
    return n + between(rng, 0.5, 9.0), n


def _mie(package: ModuleType, rng: np.random.Generator) -> Any:
    return package.Mie(1.0, 1.0, *_exponents(rng))


def _dlvo(package: ModuleType, rng: np.random.Generator) -> Any:
    """A double layer that lowers the well and makes no second one: those have `tests/solvers/test_barriers.py`."""
    while True:
        law = fscm.Dlvo(16.0 * math.pi, 1.0, between(rng, 1e-2, 1.0), between(rng, 0.1, 1.0))
        if has_one_well(law):
            return package.Dlvo(law.hamaker_constant, law.z0, law.double_layer, law.debye_length)


def _exponential(package: ModuleType, rng: np.random.Generator) -> Any:
    return package.CohesiveExponential(1.0, 1.0)


def _trapezoid(package: ModuleType, rng: np.random.Generator) -> Any:
    """The elements do not resolve shorter rises and falls."""
    rise = float(rng.uniform(0.3, 0.5))
    return package.CohesiveTrapezoid(1.0, 1.0, rise, float(rng.uniform(rise, 0.7)))


def _rows(rng: np.random.Generator, fewest: int, most: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Gaps and tractions of a law, some with a second well or a shoulder; and the exponent of the attraction."""
    m, n = _exponents(rng)
    first = 1.0 - rng.uniform(0.4, 0.8) * (1.0 - 0.6 ** (1.0 / m))
    count, last = round(between(rng, fewest, most)), between(rng, 6.0, 40.0)
    shares = (np.arange(count) + np.concatenate([[0.0], rng.uniform(-0.2, 0.2, count - 2), [0.0]])) / (count - 1)
    gaps = first * (last / first) ** shares
    law = fscm.Mie(m=m, n=n)
    tractions = law.traction(gaps - 1.0)
    if rng.random() < 0.5:
        place, width = rng.uniform(1.5, 4.0), rng.uniform(0.3, 1.0)
        tractions = tractions + rng.uniform(-0.5, 0.5) * law.traction(np.array(place - 1.0)) * np.exp(
            -(((gaps - place) / width) ** 2)
        )
    return gaps, tractions, n


def _table(package: ModuleType, rng: np.random.Generator) -> Any:
    return _accepted(package, rng, lambda: _rows(rng, 15, 150))


def _smoothed_table(package: ModuleType, rng: np.random.Generator) -> Any:
    """Of `fscm` alone: exact rows, or such with noise."""

    def rows() -> tuple[np.ndarray, np.ndarray, float]:
        gaps, tractions, n = _rows(rng, 15, 80)
        return gaps, tractions * (1.0 + error * noisy * rng.standard_normal(len(gaps))), n

    error, noisy = between(rng, 1e-5, 1e-2), float(rng.random() < 0.5)
    return _accepted(package, rng, rows, smoothing=error)


def _accepted(package: ModuleType, rng: np.random.Generator, rows: Callable[[], Any], **options: float) -> Any:
    """The law of the first rows that `fscm` takes for one."""
    states = rng.random() < 0.5
    for _ in range(_ATTEMPTS):
        gaps, tractions, n = rows()
        columns = {"gaps": tuple(gaps.tolist()), "tractions": tuple(tractions.tolist()), "z0": 1.0, **options}
        if states:
            columns["tail_exponent"] = n
        try:
            fscm.TabulatedLaw(**columns)
        except ValueError:
            continue
        return package.TabulatedLaw(**columns)
    raise AssertionError(f"none of {_ATTEMPTS} random tables is that of a law")


#: By the names of `comparisons/data/kinds.toml`, and one more.
LAWS: dict[str, MakeLaw] = {
    "lennard-jones-9-3": _nine_three,
    "mie": _mie,
    "dlvo": _dlvo,
    "cohesive-exponential": _exponential,
    "cohesive-trapezoid": _trapezoid,
    "table": _table,
    "smoothed table": _smoothed_table,
}


def problem(package: ModuleType, seed: int, number: int, punch: str, law: str, tabor: tuple[float, float]) -> Any:
    """The problem of a number: a punch and a law of the named kinds, on a homogeneous solid.

    Parameters
    ----------
    package : module
    seed, number : int
    punch, law : str
        Of `PUNCHES` and `LAWS`.
    tabor : tuple of float
        Limits of the Tabor number that a sphere of the size of the punch would have.
    """
    rng = np.random.default_rng([seed, number])
    shape, size = PUNCHES[punch](package, rng)
    surface = LAWS[law](package, rng)
    # The load integral of p ~ r^(-m growth) has to converge.
    growth = PUNCHES[punch](fscm, np.random.default_rng([seed, number]))[0].growth
    while not surface.decay[1] * growth > 2.0:
        surface = LAWS[law](package, rng)
    mu, nu = between(rng, *tabor), float(rng.uniform(0.0, 0.49))
    modulus = math.sqrt(size * surface.work_of_adhesion**2 / mu**3)
    return package.Problem(package.Homogeneous(modulus * (1.0 - nu**2), nu), shape, surface)
