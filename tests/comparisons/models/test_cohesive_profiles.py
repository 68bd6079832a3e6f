"""Maugis-Dugdale profiles against the ring response of Eq. 6: close contact, Griffith's relation, load."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from numpy.typing import NDArray

from comparisons.model import NotApplicable
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import CohesiveEvents
from comparisons.models.cohesive_profiles import PROFILE_ROUNDING, gap, pressure
from comparisons.models.cohesive_stress import eta
from comparisons.models.double_hertz_contact import DoubleHertzContact
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.problem import Problem

from .kernel_gap import integrate, kernel_gap

Array = NDArray[np.float64]
CASES = [(2.0, 0.0, 1.0), (2.0, 0.4, 1.0), (1.0, 0.3, 0.3), (5.0, 0.6, 2.0), (1.5, 0.2, 4.0)]


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
    problem = Problem.dimensionless(n, k, mu)
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
        MaugisDugdaleOriginal().profiles(Problem.dimensionless(2, k, mu))


@pytest.mark.parametrize("contact_type", [CohesiveContact, DoubleHertzContact])
@pytest.mark.parametrize(
    ("n", "k", "Lambda", "w"),
    [(2.0, 0.0, 1.0, 0.0), (1.0, 0.3, 0.3, -2.0), (5.0, 0.6, 2.0, 1.0), (1.5, 0.2, 4.0, 3.0), (2.0, 0.9, 0.5, 0.0)],
)
def test_profiles_against_many_digits(contact_type, n: float, k: float, Lambda: float, w: float) -> None:
    """The integrals of the two module texts by another rule in 25 digits."""
    contact = contact_type(GradedPunch(n, k), Lambda)
    state = contact.at(np.array([w]))
    a_, c_, L_ = (float(x[0]) for x in (state.contact_radius, state.cohesive_radius, state.cohesive_width))
    radii = np.array([a_ + share * (c_ - a_) for share in (0.1, 0.5, 0.9)] + [1.05 * c_, 3.0 * c_])
    inner = a_ * np.array([0.1, 0.5, 0.9, 0.99])
    constant = contact_type is CohesiveContact
    with mp.workdps(25):
        a, c, L, n, k = (mp.mpf(x) for x in (a_, c_, L_, n, k))
        s, D = (1 - k) / 2, mp.beta(n / 2, (1 + k) / 2) / 2
        S = mp.sin(mp.pi * s) / (mp.pi * s)
        lift = 2 * Lambda * L ** (2 * s) if constant else Lambda * (1 + k) / S * L ** (2 * s)

        def excess(x):
            v = max(c - x, 0) * (c + x) / L**2
            return D * (x**n - a**n) + lift * (1 - (v**s if constant else v))

        def deformed_gap(r):
            # With v = (r^2-x^2)^s the kernel (r^2-x^2)^(s-1) x dx is -dv / (2 s).
            def integrand(v):
                x = mp.sqrt(r * r - v ** (1 / s))
                return x ** (k - 1) * excess(x)

            ends = [(r * r - x * x) ** s for x in ([r, c, a] if r > c else [r, a])]
            return mp.cos(k * mp.pi / 2) / (mp.pi * s) * mp.quad(integrand, ends)

        def contact_pressure(r):
            hertz = S / 2 * n * D * mp.quad(lambda x: x ** (n - 1) * (x * x - r * r) ** -s, [r, a])
            if constant:
                share = mp.betainc(s, 1 - s, 0, L**2 / (c * c - r * r), regularized=True)
            else:
                share = ((c * c - r * r) ** (1 - s) - (a * a - r * r) ** (1 - s)) / L ** (2 - 2 * s)
            return hertz - Lambda * share

        gaps = [float(deformed_gap(mp.mpf(float(r)))) for r in radii]
        pressures = [float(contact_pressure(mp.mpf(float(r)))) for r in inner]
    np.testing.assert_allclose(gap(contact, state, radii), gaps, rtol=0, atol=PROFILE_ROUNDING * (1.0 + max(gaps)))
    np.testing.assert_allclose(pressure(contact, state, inner), pressures, rtol=0, atol=PROFILE_ROUNDING * Lambda)
