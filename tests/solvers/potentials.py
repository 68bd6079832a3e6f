"""Potentials of all atoms of a punch, by quadratures that neither reference has; derivatives of the forces of both.

Atoms whose law over a half-space has the power v^-m attract each other with pair potentials of the power m + 3.
"""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import fem_reference.interaction
import fscm.interaction

PACKAGES = (fem_reference, fscm)
both = pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.__name__)

#: Steps of central differences, relative to the gap and to the radius.
STEP = 1e-5


def composite(ends: np.ndarray, count: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of a Gauss rule on each interval between neighbours."""
    x, w = np.polynomial.legendre.leggauss(count)
    half = 0.5 * np.diff(ends)
    return ((ends[:-1] + half)[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def power_of_ball(R: float, m: float, s: float) -> float:
    """Power m of a ball at the distance s of its center, by shells around the point."""
    d, weight = composite(np.geomspace(s - R, s + R, 60))
    inside = 2.0 * math.pi * d**2 * (1.0 - (s * s + d * d - R * R) / (2.0 * s * d))
    return float((weight * inside) @ d ** -(m + 3.0)) * m * (m + 1.0) / (2.0 * math.pi)


def power_of_profile(punch: Any, m: float, x: float, v: float) -> float:
    """Power m of a punch without end, by columns above each place of its face, around the axis and outwards."""
    z, q = float(punch.height(np.array(x))) - v, m + 3.0
    near = np.concatenate([-np.geomspace(0.1, 1e3, 20)[::-1], [0.0], np.geomspace(0.1, 1e5, 30)]) * v + x
    kinks = np.array(getattr(punch, "kinks", ()))
    t, weight = composite(np.unique(np.concatenate([[0.0], near[near > 0.0], kinks])), 10)
    count = 2 * math.ceil(16.0 * (1.0 + x / v * math.hypot(1.0, float(punch.slope(np.array(x))))))
    w, of_w = composite(np.array([0.0, 0.5, 1.0]), 14)
    total = 0.0
    for cosine in np.cos(2.0 * math.pi * (np.arange(count) + 0.5) / count):
        away = np.sqrt(t * t + x * x - 2.0 * t * x * cosine)
        lowest = np.arctan2(away, punch.height(t) - z)  # angle from the vertical to the lowest atom of a column
        column = (np.sin(np.outer(lowest, w * w)) ** (q - 2.0) * 2.0 * w) @ of_w * lowest
        total += float((weight * t * away ** (1.0 - q)) @ column)
    return m * (m + 1.0) / count * total


def of_powers(exponents: tuple[float, float], powers: list[float]) -> tuple[float, float]:
    """Traction of a law of Mie with w = z0 = 1 from both of its powers, and the size of its terms."""
    m, n = exponents
    strength = (m - 1.0) * (n - 1.0) / (m - n)
    return strength * (powers[0] - powers[1]), strength * sum(powers)


def force_of(package: ModuleType, punch: Any, exponents: tuple[float, float] = (9.0, 3.0)) -> Any:
    """Force of all atoms of a punch under a law of Mie with w = z0 = 1."""
    return package.interaction.interaction_of(punch, package.Mie(1.0, 1.0, *exponents), "body")


def table_of(package: ModuleType, law: Any) -> Any:
    """The law through points of another one."""
    gap = law.z0 * (np.geomspace(0.6, 100.0, 400) - 1.0)
    return package.TabulatedLaw(gap, law.traction(gap), z0=law.z0, tail_exponent=3.0)


def rates(force: Any, r: np.ndarray, gap: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """dp/dr at a fixed gap, and dp/dH."""
    return force.slopes(r, gap) if hasattr(force, "slopes") else (force.drift(r, gap) / r, force.slope(r, gap))


def peak_rate(force: Any, r: np.ndarray) -> np.ndarray:
    """Derivative of the gap of the largest tension by the radius."""
    if hasattr(force, "peak_slope"):
        return force.peak_slope(r)
    return np.array([force.peak_drift(float(at)) / at for at in r])


def check_derivatives(force: Any, r: np.ndarray, gap: np.ndarray) -> None:
    """Slopes, energy and gap of the largest tension belong to the traction, by central differences."""
    by_radius, by_gap = rates(force, r, gap)
    change = STEP * np.minimum(1.0 + gap, 100.0)
    ends = [force.traction(r, gap + sign * change) for sign in (1.0, -1.0)]
    assert by_gap == pytest.approx((ends[0] - ends[1]) / (2.0 * change), rel=1e-6, abs=1e-20)
    ends = [force.traction(r * (1.0 + sign * STEP), gap) for sign in (1.0, -1.0)]
    scale = np.max(np.abs(by_gap * force.punch.slope(r)))
    assert by_radius == pytest.approx((ends[0] - ends[1]) / (2.0 * STEP * r), rel=1e-5, abs=1e-8 * scale)
    ends = [force.energy(r, gap + sign * 10.0 * change) for sign in (1.0, -1.0)]
    assert force.traction(r, gap) == pytest.approx((ends[1] - ends[0]) / (20.0 * change), rel=1e-5, abs=1e-15)
    at_peak = rates(force, r, force.peak_gap(r))[1]
    assert np.all(np.abs(at_peak) < 1e-7 * np.abs(force.traction(r, force.peak_gap(r))))
    ends = [force.peak_gap(r * (1.0 + sign * 1e-3)) for sign in (1.0, -1.0)]
    assert peak_rate(force, r) == pytest.approx((ends[0] - ends[1]) / (2e-3 * r), rel=1e-3, abs=1e-6)
