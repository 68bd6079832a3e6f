"""Contacts with a cohesive zone against printed equations, the ring response of Eq. 6, and many digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest

from comparisons.model import ComputationFailed
from comparisons.models.cohesive_contact import CohesiveContact, ContactState
from comparisons.models.cohesive_events import CohesiveEvents
from comparisons.models.cohesive_models import DoubleHertz, MaugisDugdaleImproved
from comparisons.models.cohesive_profiles import PROFILE_ROUNDING, gap, pressure
from comparisons.models.graded_punch import GradedPunch
from comparisons.problem import Problem
from fscm._surface.kernel import ring_response

Printed = Callable[[mp.mpf, mp.mpf, mp.mpf, mp.mpf, mp.mpf], tuple[mp.mpf, mp.mpf, mp.mpf]]


@lru_cache(maxsize=64)
def functions_of_w(n: mp.mpf, k: mp.mpf, w: mp.mpf, precision: int) -> tuple[mp.mpf, ...]:
    """m and three combinations of hypergeometric functions, none of which depends on the contact radius."""
    m, F = mp.sqrt(1 + mp.exp(-2 * w)), mp.hyp2f1
    cos, x, h = mp.cos(k * mp.pi / 2), 1 / m**2, (k + 1) / 2
    edge = m ** (k - 1) * (m * m - 1) ** ((1 - k) / 2)
    w1 = 4 * cos / (mp.pi * (1 - k * k)) * (F(h - 1, h, h + 1, x) - edge)
    w2 = 4 * cos / (mp.pi * (1 + k)) * (F(k, h, h + 1, x) - edge * F(h, h, h + 1, x))
    w3 = F(h, h, h + 1, x) - (k + 1) / (n + k + 1) * F(h, h + n / 2, h + 1 + n / 2, x)
    return m, w1, w2, w3 * 2 * cos / (mp.pi * (1 + k))


def maugis_dugdale(n: mp.mpf, k: mp.mpf, Lambda: mp.mpf, a: mp.mpf, w: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Eqs. 66-72: displacement, load and the left side of Griffith's relation, m^2 = 1 + exp(-2 w)."""
    m, w1, w2, w3 = functions_of_w(n, k, w, mp.mp.prec)
    cos, h = mp.cos(k * mp.pi / 2), (k + 1) / 2
    delta = a**n / 2 * mp.beta(n / 2, h) - 2 * Lambda * a ** (1 - k) * (m * m - 1) ** ((1 - k) / 2)
    P = a ** (n + k + 1) / (mp.pi * (1 - k * k)) * cos * mp.beta(1 + n / 2, h)
    P -= Lambda * (m * m - w1 * m ** (1 - k)) * a * a
    stress = 2 * (m * m - 1) ** ((1 - k) / 2) - mp.gamma(2 - k) * m ** (1 - k) / mp.gamma((3 - k) / 2) ** 2
    stress += w2 / m ** (2 * k)
    shape = m**n / n + (w3 / m ** (1 + k) - 1) / 2 * mp.beta(n / 2, h)
    return delta, P, Lambda**2 * a ** (1 - k) * stress + Lambda * a**n * shape


def double_hertz(n: mp.mpf, k: mp.mpf, Lambda: mp.mpf, a: mp.mpf, w: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Displacement, load and work of adhesion of two Hertz pressures by the antiderivatives, which cancel."""
    L = a * mp.exp(-w)
    c, s, p = mp.sqrt(a**2 + L**2), (1 - k) / 2, k + 1
    S, D = mp.sin(mp.pi * s) / (mp.pi * s), mp.beta(n / 2, p / 2) / 2
    T = Lambda * p / S * L ** (2 * s)
    profile = D * ((c ** (n + p) - a ** (n + p)) / (n + p) - a**n * (c**p - a**p) / p)
    traction = T / L**2 * ((c ** (p + 2) - a ** (p + 2)) / (p + 2) - a**2 * (c**p - a**p) / p)
    load = S * D * n / (p * (n + p)) * a ** (n + p) - 2 * Lambda * (c ** (p + 2) - a ** (p + 2)) / ((p + 2) * L**p)
    return D * a**n - T, load, Lambda * p / L**p * (profile + traction)


TRACTIONS = pytest.mark.parametrize("printed", [maugis_dugdale, double_hertz])


def contact_of(printed: Printed, n: float, k: float, Lambda: float) -> CohesiveContact:
    return CohesiveContact(GradedPunch(n, k), Lambda, 0.0 if printed is maugis_dugdale else (1.0 + k) / 2.0)


def in_digits(printed: Printed, *numbers: float) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    return printed(*map(mp.mpf, numbers))


def printed_state(printed: Printed, n: float, k: float, Lambda: float, w: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Displacement and load at w with Griffith's relation solved in many digits."""
    guess = contact_of(printed, n, k, Lambda).at(np.array([float(w)])).contact_radius[0]
    a = mp.exp(mp.findroot(lambda x: in_digits(printed, n, k, Lambda, mp.exp(x), w)[2] - 1, mp.log(guess)))
    return in_digits(printed, n, k, Lambda, a, w)[:2]


#: Tanh-sinh rule on (0, 1): nodes, their complements and weights.
_U = np.pi * np.sinh(np.linspace(-4.3, 4.3, 401))
NODE, COMPLEMENT = 1.0 / (1.0 + np.exp(-_U)), 1.0 / (1.0 + np.exp(_U))
WEIGHT = np.hypot(_U, np.pi) * NODE * COMPLEMENT * 8.6 / 400


def integrate(f: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray], low: float, high: float) -> float:
    """Integral of f, which gets t and its distances from `low` and from `high`, both without cancellation."""
    size = high - low
    return float(np.sum(f(low + size * NODE, size * NODE, size * COMPLEMENT) * WEIGHT) * size)


def kernel_gap(contact: CohesiveContact, state: ContactState, r: float) -> float:
    """H(r) = -delta + r^n / n + 2 (1 - k) integral of p G_k dt with the ring response G_k of Eq. 6, tilde variables."""
    n, k = contact.punch.n, contact.punch.k
    a, c = float(state.contact_radius[0]), float(state.cohesive_radius[0])
    w = 0.0
    for low, high in pairwise(sorted({0.0, a, c, min(r, c)})):

        def integrand(t: np.ndarray, up: np.ndarray, down: np.ndarray, low: float = low, high: float = high):
            # One-sided values: the pressure of this interval even where t rounds to its end.
            p = pressure(contact, state, np.clip(t, np.nextafter(low, high), np.nextafter(high, low)))
            distance = up if r == low else down if r == high else np.abs(r - t)
            return p * ring_response(k, np.full_like(t, r), t, distance)

        w += integrate(integrand, low, high)
    return -float(state.displacement[0]) + r**n / n + 2 * (1 - k) * w


def random_contacts(count: int) -> list[tuple[float, float, float, float]]:
    rng = np.random.default_rng(20)
    exponents = [0.0, 1e-8, 0.05, 0.3, 0.6, 0.95]
    return [
        (rng.uniform(0.8, 10), rng.choice(exponents), 10 ** rng.uniform(-3, 1.3), rng.uniform(-8, 8))
        for _ in range(count)
    ]


@TRACTIONS
@pytest.mark.parametrize(("n", "k", "Lambda", "w"), random_contacts(30))
def test_a_state_satisfies_the_printed_equations(printed, n, k, Lambda, w) -> None:
    """m from 1 + 1e-7 to 3000; the stated scales bound the rounding (measured worst 6e-15)."""
    state = contact_of(printed, n, k, Lambda).at(np.array([w]))
    with mp.workdps(60):
        delta, P, work = in_digits(printed, n, k, Lambda, state.contact_radius[0], w)
    assert abs(float(work - 1)) < 2e-14
    assert abs(float(state.displacement[0] - delta)) < 2e-14 * state.displacement_scale[0]
    assert abs(float(state.load[0] - P)) < 2e-14 * state.load_scale[0]
    assert abs(state.load_slope[0]) <= state.load_slope_scale[0]
    assert abs(state.displacement_slope[0]) <= state.displacement_slope_scale[0]


@pytest.mark.parametrize(
    ("model", "printed", "n", "k", "mu"),
    [
        (MaugisDugdaleImproved(), maugis_dugdale, 2.0, 0.0, 1.0),
        (MaugisDugdaleImproved(), maugis_dugdale, 9.0, 0.3, 0.05),
        pytest.param(MaugisDugdaleImproved(), maugis_dugdale, 5.5, 0.95, 9.0, marks=pytest.mark.heavy),
        (DoubleHertz(), double_hertz, 2.0, 0.4, 1.0),
        (DoubleHertz(), double_hertz, 1.0, 0.0, 0.3),
        (DoubleHertz(), double_hertz, 5.0, 0.2, 3.0),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_error_bounds_hold_against_many_digits(model, printed, n, k, mu) -> None:
    """One step of Newton's method in many digits from the event found: L / a is 1e-30 at k = 0.95."""
    problem = Problem.dimensionless(n, k, mu)
    Lambda, scale = model.cohesive_stress(problem) * mu, GradedPunch(n, k).scales(mu)
    events = CohesiveEvents.scan(contact_of(printed, n, k, Lambda))
    pull_off, zero = events.pull_off(), events.zero_load()
    with mp.workdps(130 if k > 0.9 else 50):
        h = mp.mpf(10) ** -10

        def values(w: mp.mpf) -> list[tuple[mp.mpf, mp.mpf]]:
            return [printed_state(printed, n, k, Lambda, w + side * h) for side in (-1, 0, 1)]

        (_, P0), (_, P1), (_, P2) = values(mp.mpf(pull_off.w))
        step = -(P2 - P0) / 2 * h / (P2 - 2 * P1 + P0)
        delta, P = printed_state(printed, n, k, Lambda, pull_off.w + step)
        (_, P0), (_, P1), (_, P2) = values(mp.mpf(zero.w))
        delta_0, _ = printed_state(printed, n, k, Lambda, zero.w - P1 * 2 * h / (P2 - P0))
    exact = {
        "pull_off_force": -P * scale.load,
        "pull_off_displacement": delta * scale.displacement,
        "zero_load_displacement": delta_0 * scale.displacement,
    }
    for quantity, reference in exact.items():
        result = model.evaluate(problem, quantity)
        assert abs(float(result.value - reference)) <= result.u_num, quantity
        assert result.u_num < 1e-10 * (1.0 + abs(result.value)), quantity


@pytest.mark.parametrize("decay", [0.0, 0.7, None], ids=["constant", "another", "double Hertz"])
@pytest.mark.parametrize(
    ("n", "k", "Lambda"), [(2.0, 0.0, 1.0), (2.0, 0.4, 0.6), (1.0, 0.3, 0.1), (5.0, 0.6, 1.6), (1.5, 0.2, 2.0)]
)
def test_the_surface_is_that_of_the_ring_response(n, k, Lambda, decay) -> None:
    """The pressure superposed with Eq. 6: close contact, gap outside, load, and the work on the gap.

    The work is the integral of sigma over H from a to c, as integral of H over sigma: in t with v = t^4 it is smooth.
    """
    contact = CohesiveContact(GradedPunch(n, k), Lambda, (1.0 + k) / 2.0 if decay is None else decay)
    state = contact.at(np.array([0.0]))
    a, c, L = (float(x[0]) for x in (state.contact_radius, state.cohesive_radius, state.cohesive_width))
    for share in (0.03, 0.4, 0.97):
        assert abs(kernel_gap(contact, state, share * a)) < 1e-7 * float(state.displacement_scale[0])
    r = np.array([a + 0.3 * (c - a), a + 0.8 * (c - a), 1.1 * c, 2.5 * c])
    np.testing.assert_allclose(gap(contact, state, r), [kernel_gap(contact, state, x) for x in r], rtol=1e-6, atol=1e-7)

    def moment(t, up, down):
        return 2 * t * pressure(contact, state, t)

    load = integrate(moment, 0.0, a * (1 - 1e-15)) + integrate(moment, a * (1 + 1e-15), c * (1 - 1e-15))
    assert load == pytest.approx(float(state.load[0]), rel=1e-9)
    if contact.decay == 0.0:
        work = Lambda * kernel_gap(contact, state, c)
    else:
        x, weights = np.polynomial.legendre.leggauss(24)
        t, power = 0.5 * (x + 1.0), 4.0 * contact.decay
        gaps = np.array([kernel_gap(contact, state, np.sqrt(c**2 - L**2 * v)) for v in t**4])
        work = Lambda * float(np.sum(0.5 * weights * gaps * power * t ** (power - 1.0)))
    assert work == pytest.approx(1.0, abs=5e-5)
    assert pressure(contact, state, np.linspace(1e-6 * c, c, 2001)).min() >= -Lambda * (1 + 1e-13)


@TRACTIONS
@pytest.mark.parametrize(
    ("n", "k", "Lambda", "w"),
    [(2.0, 0.0, 1.0, 0.0), (1.0, 0.3, 0.3, -2.0), (5.0, 0.6, 2.0, 1.0), (2.0, 0.9, 0.5, 0.0)],
)
def test_profiles_against_many_digits(printed, n, k, Lambda, w) -> None:
    """The integrals of the two module texts by another rule in 25 digits."""
    contact = contact_of(printed, n, k, Lambda)
    state = contact.at(np.array([w]))
    a_, c_, L_ = (float(x[0]) for x in (state.contact_radius, state.cohesive_radius, state.cohesive_width))
    radii = np.array([a_ + share * (c_ - a_) for share in (0.1, 0.9)] + [1.05 * c_, 3.0 * c_])
    inner = a_ * np.array([0.1, 0.5, 0.99])
    with mp.workdps(25):
        a, c, L, n, k, d = map(mp.mpf, (a_, c_, L_, n, k, contact.decay))
        s, D = (1 - k) / 2, mp.beta(n / 2, (1 + k) / 2) / 2
        S, p = mp.sin(mp.pi * s) / (mp.pi * s), s + d
        lift = 2 * s * mp.beta(1 + d, s) * Lambda * L ** (2 * s)

        def deformed_gap(r):
            # With v = (r^2-x^2)^s the kernel (r^2-x^2)^(s-1) x dx is -dv / (2 s).
            def integrand(v):
                x = mp.sqrt(r * r - v ** (1 / s))
                zone = (max(c - x, 0) * (c + x) / L**2) ** p
                return x ** (k - 1) * (D * (x**n - a**n) + lift * (1 - zone))

            ends = [(r * r - x * x) ** s for x in ([r, c, a] if r > c else [r, a])]
            return mp.cos(k * mp.pi / 2) / (mp.pi * s) * mp.quad(integrand, ends)

        def contact_pressure(r):
            hertz = S / 2 * n * D * mp.quad(lambda x: x ** (n - 1) * (x * x - r * r) ** -s, [r, a])
            u = L**2 / (c * c - r * r)
            return hertz - Lambda * u**-d * mp.betainc(p, 1 - s, 0, u, regularized=True)

        gaps = [float(deformed_gap(mp.mpf(float(r)))) for r in radii]
        pressures = [float(contact_pressure(mp.mpf(float(r)))) for r in inner]
    np.testing.assert_allclose(gap(contact, state, radii), gaps, rtol=0, atol=PROFILE_ROUNDING * (1.0 + max(gaps)))
    np.testing.assert_allclose(pressure(contact, state, inner), pressures, rtol=0, atol=PROFILE_ROUNDING * Lambda)


def test_a_missed_minimum_is_not_passed_in_silence() -> None:
    """A scan whose slopes hide the minimum, or which saw a load a little below it, must fail."""
    events = CohesiveEvents.scan(CohesiveContact(GradedPunch(2.0, 0.0), 3.0))
    states, lowest = events.states, events.pull_off().load
    deeper = np.where(states.load == states.load.min(), lowest - 1e-7, states.load)
    for seen in (replace(states, load_slope=np.abs(states.load_slope)), replace(states, load=deeper)):
        with pytest.raises(ComputationFailed, match="below the pull-off"):
            replace(events, states=seen).pull_off()


def test_gibson_contact_is_algebraic() -> None:
    """k = 1, Lambda < 1: c^n = a^n + n (1/Lambda - Lambda), and p = (delta - r^n / n) / 2 inside a."""
    Lambda, n = 0.6, 3.0
    state = CohesiveContact(GradedPunch(n, 1.0), Lambda).at(np.array([-1.0, 0.3]))
    a, c = state.contact_radius, state.cohesive_radius
    np.testing.assert_allclose(c**n, a**n + n * (1 / Lambda - Lambda), rtol=1e-13)
    delta = a**n / n - 2 * Lambda
    np.testing.assert_allclose(state.displacement, delta, rtol=1e-13)
    load = delta * a**2 / 2 - a ** (n + 2) / (n * (n + 2)) - Lambda * (c**2 - a**2)
    np.testing.assert_allclose(state.load, load, rtol=1e-13)
    # The surface moves by 2 p(r).
    for decay in (0.0, 1.0):
        contact = CohesiveContact(GradedPunch(n, 1.0), Lambda, decay)
        state = contact.at(np.array([0.3]))
        r = state.contact_radius + np.array([0.0, 0.3, 0.9, 1.5]) * (state.cohesive_radius - state.contact_radius)
        deformed = r**n / n - state.displacement + 2 * pressure(contact, state, r)
        np.testing.assert_allclose(gap(contact, state, r), deformed, rtol=1e-12, atol=1e-13)
