"""Maugis-Dugdale profiles against the ring response of Eq. 6: close contact, Griffith's relation, load."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import ellipkm1, gamma, hyp2f1

from comparisons.model import NotApplicable
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import CohesiveEvents
from comparisons.models.cohesive_profiles import gap, pressure
from comparisons.models.cohesive_stress import eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from fscm.problem import Problem

Array = NDArray[np.float64]
CASES = [(2.0, 0.0, 1.0), (2.0, 0.4, 1.0), (1.0, 0.3, 0.3), (5.0, 0.6, 2.0), (1.5, 0.2, 4.0)]

T = np.linspace(-4.3, 4.3, 401)
FRACTION = 1.0 / (1.0 + np.exp(-np.pi * np.sinh(T)))
REST = 1.0 / (1.0 + np.exp(np.pi * np.sinh(T)))
WEIGHT = np.pi * np.cosh(T) * FRACTION * REST * (T[1] - T[0])


def integrate(f: Callable[[Array, Array, Array], Array], low: float, high: float) -> float:
    """Tanh-sinh rule; f gets t and its distances from `low` and from `high`, both without cancellation."""
    size = high - low
    return float(np.sum(f(low + size * FRACTION, size * FRACTION, size * REST) * WEIGHT) * size)


def ring(k: float, r: float, t: Array, distance: Array) -> Array:
    """Eq. 6 over 2 b c0^k / E*, distance = |r - t|: F((k+1)/2, (k+1)/2; 1; x^2) about x = 1 (DLMF 15.8.4)."""
    big = np.maximum(r, t)
    x2, y = (np.minimum(r, t) / big) ** 2, distance * (r + t) / big**2
    a, b = (1 + k) / 2, (1 - k) / 2
    if k == 0:
        F = 2 / np.pi * ellipkm1(y)
    else:
        z = np.minimum(y, 0.5)
        near = gamma(-k) / gamma(b) ** 2 * hyp2f1(a, a, 1 + k, z)
        near += z**-k * gamma(k) / gamma(a) ** 2 * hyp2f1(b, b, 1 - k, z)
        F = np.where(y < 0.3, near, hyp2f1(a, a, 1.0, np.minimum(x2, 0.75)))
    return np.where(r < t, t**-k, t * r ** -(k + 1.0)) * F


def kernel_gap(contact: CohesiveContact, state, r: float) -> float:
    """H(r) = -delta + r^n / n + 2 (1 - k) integral of p G_k dt, tilde variables."""
    n, k = contact.punch.n, contact.punch.k
    a, c = float(state.contact_radius[0]), float(state.cohesive_radius[0])
    points = sorted({0.0, a, c, min(r, c)})
    w = 0.0
    for low, high in pairwise(points):

        def integrand(t: Array, up: Array, down: Array, low: float = low, high: float = high) -> Array:
            # One-sided values: the pressure of this interval even where t rounds to its end.
            p = pressure(contact, state, np.clip(t, np.nextafter(low, high), np.nextafter(high, low)))
            distance = up if r == low else down if r == high else np.abs(r - t)
            return p * ring(k, r, t, distance)

        w += integrate(integrand, low, high)
    return -float(state.displacement[0]) + r**n / n + 2 * (1 - k) * w


def pull_off_state(n: float, k: float, mu: float):
    contact = CohesiveContact(GradedPunch(n, k), eta(n) * mu)
    return contact, CohesiveEvents.scan(contact).pull_off().state


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_close_contact_in_the_kernel(n: float, k: float, mu: float) -> None:
    """The pressure superposed with Eq. 6 closes the gap for r < a."""
    contact, state = pull_off_state(n, k, mu)
    a = float(state.contact_radius[0])
    for share in (0.03, 0.4, 0.8, 0.97):
        assert abs(kernel_gap(contact, state, share * a)) < 1e-7 * float(state.displacement_scale[0])


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_gap_is_the_kernels_outside(n: float, k: float, mu: float) -> None:
    contact, state = pull_off_state(n, k, mu)
    a, c = float(state.contact_radius[0]), float(state.cohesive_radius[0])
    r = np.array([a + 0.3 * (c - a), a + 0.8 * (c - a), 1.1 * c, 2.5 * c])
    expected = [kernel_gap(contact, state, float(x)) for x in r]
    np.testing.assert_allclose(gap(contact, state, r), expected, rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_griffith_in_the_kernel(n: float, k: float, mu: float) -> None:
    """sigma_0 H(c) = dgamma with the gap from Eq. 6 (Eq. 61 for a constant stress)."""
    contact, state = pull_off_state(n, k, mu)
    c = float(state.cohesive_radius[0])
    assert contact.maugis_number * kernel_gap(contact, state, c) == pytest.approx(1.0, abs=1e-7)
    assert contact.maugis_number * gap(contact, state, np.array([c]))[0] == pytest.approx(1.0, abs=1e-13)


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_load_is_the_integral_of_the_pressure(n: float, k: float, mu: float) -> None:
    contact, state = pull_off_state(n, k, mu)
    a, c = float(state.contact_radius[0]), float(state.cohesive_radius[0])

    def inside(t: Array, up: Array, down: Array) -> Array:
        return 2 * t * pressure(contact, state, np.minimum(t, np.nextafter(a, 0.0)))

    load = integrate(inside, 0.0, a) - contact.maugis_number * (c - a) * (c + a)
    assert load == pytest.approx(float(state.load[0]), rel=1e-9)


def test_homogeneous_sphere_pressure() -> None:
    """n = 2, k = 0: (2/pi) [sqrt(a^2 - r^2) - Lambda arcsin(L / sqrt(c^2 - r^2))], in tilde variables."""
    contact, state = pull_off_state(2.0, 0.0, 1.0)
    a, c, L = (float(x[0]) for x in (state.contact_radius, state.cohesive_radius, state.cohesive_width))
    r = np.linspace(0.01, 0.999, 30) * a
    expected = np.sqrt(a**2 - r**2) - contact.maugis_number * np.arcsin(L / np.sqrt(c**2 - r**2))
    np.testing.assert_allclose(pressure(contact, state, r), 2 / np.pi * expected, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("model", [MaugisDugdaleOriginal(), MaugisDugdaleImproved()], ids=lambda m: m.name)
@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), (1.0, 0.0, 0.01), (5.0, 0.95, 5.0), (2.0, 1.0, 0.5)])
def test_profiles_in_barred_variables(model: MaugisDugdaleOriginal, n: float, k: float, mu: float) -> None:
    problem = Problem(n, k, mu)
    profile = model.profiles(problem)
    r, p, H = profile.radius, profile.pressure, profile.gap
    a, c = profile.contact_radius, profile.cohesive_radius
    assert -profile.load == pytest.approx(model.evaluate(problem, "pull_off_force").value, rel=1e-13)
    assert np.all(np.diff(r) > 0)
    assert np.all(H[r < a * (1 - 1e-12)] == 0.0)
    assert np.all(np.diff(H[r > a]) > -1e-13)
    zone = (r > a * (1 + 1e-12)) & (r < c * (1 - 1e-12))
    np.testing.assert_allclose(p[zone], -model.cohesive_stress(problem), rtol=1e-13)
    assert np.all(p[r > c * (1 + 1e-12)] == 0.0)
    assert np.all(p >= -model.cohesive_stress(problem) * (1 + 1e-13))
    # 2 integral of p r dr by the trapezoidal rule on the given points, the jump at c being two points apart.
    assert np.sum(np.diff(r**2) * 0.5 * (p[1:] + p[:-1])) == pytest.approx(profile.load, rel=2e-3)


@pytest.mark.parametrize(("k", "mu", "reason"), [(1.0, 3.0, "no cohesive"), (0.999, 20.0, "width below")])
def test_refuses_an_edge_without_width(k: float, mu: float, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        MaugisDugdaleOriginal().profiles(Problem(2, k, mu))
