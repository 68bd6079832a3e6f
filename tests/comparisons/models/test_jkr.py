"""JKR against the extremes of the printed curve, Eqs. 50-51, and the figures of the paper that follow."""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np
import pytest

from comparisons.models.jkr import JKR
from comparisons.problem import Problem

contact = Problem.dimensionless

CASES = [
    (1.0, 0.0, 0.3),
    (1.5, 0.2, 2.0),
    (2.0, 0.0, 1.0),
    (2.0, 0.4, 3.0),
    (5.0, 0.6, 0.1),
    (0.8, 0.0, 1.0),
    (10.0, 0.95, 7.0),
]


def printed_curve(n: float, k: float, mu: float, a: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Eqs. 50-51 with Q = z0 = dgamma = 1, where b c0^k / E* = (1 - k) mu^((2n+k-1)/n) by Eq. 29."""
    n, k, mu = mp.mpf(n), mp.mpf(k), mp.mpf(mu)
    softness = (1 - k) * mu ** ((2 * n + k - 1) / n)
    cos = mp.cos(k * mp.pi / 2)
    delta = mp.beta(n / 2, (1 + k) / 2) * a**n / 2 - mp.sqrt(2 * mp.pi * softness / cos) * a ** ((1 - k) / 2)
    P = cos / (softness * (1 + k)) * mp.beta(1 + n / 2, (1 + k) / 2) * a ** (n + k + 1)
    P -= mp.sqrt(8 * mp.pi * cos / (softness * (1 + k) ** 2)) * a ** ((3 + k) / 2)
    return delta, P / mp.pi


@cache
def extreme(n: float, k: float, mu: float, which: int) -> mp.mpf:
    """Contact radius where the displacement (0) or the load (1) of the printed curve is smallest."""
    log_a = np.linspace(-12.0, 8.0, 401)
    values = [printed_curve(n, k, mu, mp.exp(x))[which] for x in log_a]
    start = float(log_a[int(np.argmin(np.array(values, float)))])
    with mp.workdps(30):
        return mp.exp(mp.findroot(lambda x: mp.diff(lambda y: printed_curve(n, k, mu, mp.exp(y))[which], x), start))


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_events_are_the_extremes_of_the_printed_curve(n: float, k: float, mu: float) -> None:
    problem, model = contact(n, k, mu), JKR()
    delta, P = printed_curve(n, k, mu, extreme(n, k, mu, 1))
    assert model.evaluate(problem, "pull_off_force").value == pytest.approx(float(-P), rel=1e-13)
    assert model.evaluate(problem, "pull_off_displacement").value == pytest.approx(float(delta), rel=1e-12, abs=1e-13)
    a_out = extreme(n, k, mu, 0)
    delta, _ = printed_curve(n, k, mu, a_out)
    assert model.evaluate(problem, "jump_out_displacement").value == pytest.approx(float(delta), rel=1e-13)
    assert model.jump_out_radius(problem).value == pytest.approx(float(a_out), rel=1e-12)


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_zero_load_lies_on_the_printed_curve(n: float, k: float, mu: float) -> None:
    with mp.workdps(30):
        start = extreme(n, k, mu, 1) * 1.5
        a = mp.exp(mp.findroot(lambda x: printed_curve(n, k, mu, mp.exp(x))[1], mp.log(start)))
        delta = printed_curve(n, k, mu, a)[0]
    value = JKR().evaluate(contact(n, k, mu), "zero_load_displacement").value
    assert value == pytest.approx(float(delta), rel=1e-13)


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_curve_is_the_printed_curve(n: float, k: float, mu: float) -> None:
    curve = JKR().curve(contact(n, k, mu))
    a = curve.columns["contact_radius"]
    for i in (0, 1, 100, 250, 400):
        delta, P = printed_curve(n, k, mu, mp.mpf(a[i]))
        assert curve.displacement[i] == pytest.approx(float(delta), rel=1e-11, abs=1e-12)
        assert curve.load[i] == pytest.approx(float(P), rel=1e-11, abs=1e-12)
    force = JKR().evaluate(contact(n, k, mu), "pull_off_force").value
    assert -curve.load.min() == pytest.approx(force, rel=1e-3)
    assert curve.load[-1] >= force


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_printed_closed_forms(n: float, k: float, mu: float) -> None:
    """Eqs. 54-55 and 57 letter by letter."""
    B, cos, pi = float(mp.beta(n / 2, 0.5 + k / 2)), np.cos(k * np.pi / 2), np.pi
    base = (cos / (2 * pi * (1 - k))) ** (n - 2) * ((k + 3) / (n * B)) ** (k + 3)
    force = 2 * (2 * n + k - 1) / ((1 + k) * (n + k + 1)) * base ** (1 / (2 * n + k - 1)) * mu ** ((2 - n) / n)
    C_out = 0.5 * (2 * n + k - 1) * (2 * pi * (1 - k) / (n**2 * cos)) ** (n / (2 * n + k - 1))
    C_out *= ((1 - k) / B) ** ((1 - k) / (2 * n + k - 1))
    assert JKR().evaluate(contact(n, k, mu), "pull_off_force").value == pytest.approx(force, rel=1e-12)
    assert JKR().evaluate(contact(n, k, mu), "jump_out_displacement").value == pytest.approx(-C_out * mu, rel=1e-12)


def chi(n: float, k: float) -> float:
    """Relative change of the pull-off force from the homogeneous material, percent (Eq. 58)."""
    graded, homogeneous = (JKR().evaluate(contact(n, x, 1.0), "pull_off_force").value for x in (k, 0.0))
    return 100 * abs(graded / homogeneous - 1)


@pytest.mark.parametrize(("n", "printed"), [(1.0, 4.4), (1.5, 40.8), (2.0, 33.3), (5.0, 4.2)])
def test_printed_sensitivity_to_the_gradient(n: float, printed: float) -> None:
    """chi_max of Fig. 11(a); k stops at 0.999, as 40.8 % at n = 1.5 does (the limit k = 1 is 40.89 %)."""
    assert round(max(chi(n, k) for k in np.linspace(0, 0.999, 1000)), 1) == printed


def test_sensitivity_in_the_gibson_limit() -> None:
    """k = 1, mu = 1: Eq. 51 is P = a^(n+2) / (2 (n+2)) - a^2, least at a^n = 4, -P_c = n/(n+2) 4^(2/n)."""
    assert JKR().evaluate(contact(1.5, 1.0, 1.0), "pull_off_force").value == pytest.approx(
        1.5 / 3.5 * 4 ** (4 / 3), rel=1e-14
    )
    assert chi(1.5, 1.0) == pytest.approx(40.886, abs=1e-3)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 5.0])
def test_jump_out_coefficient_tends_to_two(n: float) -> None:
    assert JKR().evaluate(contact(n, 1.0, 3.0), "jump_out_displacement").value == pytest.approx(-6.0, rel=1e-14)
    near = JKR().evaluate(contact(n, 1 - 1e-9, 3.0), "jump_out_displacement").value
    assert near == pytest.approx(-6.0, rel=1e-7)


@pytest.mark.parametrize("quantity", ["pull_off_force", "pull_off_displacement", "zero_load_displacement"])
def test_gibson_limit_is_continuous(quantity: str) -> None:
    limit, near = (JKR().evaluate(contact(1.5, k, 2.0), quantity).value for k in (1.0, 1 - 1e-10))
    assert near == pytest.approx(limit, rel=1e-8)
