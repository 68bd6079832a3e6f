"""Rigid contacts: Bradley, DMT, the semi-rigid asymptote and the cohesive stress against quadrature and digits."""

from __future__ import annotations

import math
from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from comparisons import create
from comparisons.model import Result
from comparisons.models.bradley import Bradley, rigid_load
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.dmt import DMT
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.problem import Problem
from fscm.laws import LennardJones

contact = Problem.dimensionless
CASES = pytest.mark.parametrize(
    ("n", "k", "mu"), [(1.0, 0.0, 2.0), (1.5, 0.2, 3.0), (5.0, 0.6, 1.5), (2.0, 0.95, 1.0), (0.9, 0.4, 5.0)]
)


def full_law(H: float) -> float:
    return float(LennardJones().traction(np.array(H)))


def attraction(H: float) -> float:
    return -(8.0 / 3.0) * (H + 1.0) ** -3


def load_by_quadrature(n: float, H0: float, law: Callable[[float], float] = full_law) -> float:
    """2 integral of p(H0 + r^n / n) r dr, in u = r^n / n with the end u = 0 taken by v = u^(2/n)."""

    def integrand(v: float) -> float:
        return law(H0 + v ** (n / 2.0) / n)

    inner, _ = quad(integrand, 0.0, 4.0, epsabs=1e-13, epsrel=1e-13, limit=200)
    # Beyond, v = 4 x^-m with m chosen so that the tail ~ v^(-3 n / 2) becomes a bounded function of x.
    m = 1.0 / (1.5 * n - 1.0)
    outer, _ = quad(lambda x: integrand(4.0 * x**-m) * 4.0 * m * x ** (-m - 1.0), 0.0, 1.0, epsabs=1e-13, epsrel=1e-12)
    return inner + outer


@pytest.mark.parametrize("n", [0.8, 1.0, 1.5, 2.0, 5.0, 10.0])
def test_load_and_events_are_those_of_the_integral(n: float) -> None:
    model, problem = Bradley(), contact(n, 0.3, 1.0)
    for H0 in (-0.15, 0.4, 3.0):
        assert float(rigid_load(n, np.array(H0))) == pytest.approx(load_by_quadrature(n, H0), rel=1e-9, abs=1e-10)
    lowest = minimize_scalar(
        lambda H0: load_by_quadrature(n, H0), bounds=(-0.45, 0.5), method="bounded", options={"xatol": 1e-9}
    )
    assert model.evaluate(problem, "pull_off_force").value == pytest.approx(-lowest.fun, rel=1e-9)
    assert model.evaluate(problem, "pull_off_displacement").value == pytest.approx(-lowest.x, abs=1e-5)
    zero = brentq(lambda gap: load_by_quadrature(n, gap), -0.6, 0.0, xtol=1e-12)
    assert model.evaluate(problem, "zero_load_displacement").value == pytest.approx(-zero, abs=1e-9)


def test_a_paraboloid_has_a_force_of_two_at_zero_displacement_within_its_bounds() -> None:
    for quantity, exact in (("pull_off_force", 2.0), ("pull_off_displacement", 0.0)):
        result = Bradley().evaluate(contact(2, 0.4, 3.0), quantity)
        assert abs(result.value - exact) <= result.u_num < 1e-13


def force_of(name: str, problem: Problem) -> float:
    return create(name).evaluate(problem, "pull_off_force").value


@pytest.mark.parametrize("n", [0.8, 1.0, 2.0, 5.0, 10.0])
def test_forces_of_dmt(n: float) -> None:
    """Eq. 74, and the strength over the disc in which the undeformed gap r^n / n is below 1 / sigma_th."""
    problem, strength = contact(n, 0.4, 0.7), 16 * np.sqrt(3) / 27
    assert force_of("dmt", problem) == pytest.approx(force_of("bradley", problem), rel=1e-13)
    assert force_of("dmt-strength", problem) == pytest.approx(strength * (n / strength) ** (2 / n), rel=1e-13)
    assert DMT().evaluate(problem, "pull_off_displacement").value == 0.0


@pytest.mark.parametrize(("name", "finite"), [("dmt", "md-improved"), ("dmt-strength", "md-original")])
@pytest.mark.parametrize(("n", "k"), [(1.0, 0.2), (1.5, 0.0), (5.0, 0.6)])
def test_dmt_is_the_limit_of_maugis_dugdale(name: str, finite: str, n: float, k: float) -> None:
    """The difference vanishes like a positive power of mu: a thousandth of mu shrinks it manyfold."""
    for quantity in ("pull_off_force", "zero_load_displacement"):
        errors = []
        for mu in (1e-3, 1e-6):
            dmt, dugdale = (create(model).evaluate(contact(n, k, mu), quantity).value for model in (name, finite))
            errors.append(abs(dugdale / dmt - 1.0))
        assert errors[1] < 0.05 * errors[0] < 0.05


def test_the_zero_load_displacement_inherits_the_bound_of_the_adhesion(monkeypatch: pytest.MonkeyPatch) -> None:
    """It covers what an adhesion that is wrong by its bound changes, and little more."""
    problem, model, relative = contact(5.0, 0.6, 0.7), DMT(), 1e-6
    adhesion = model.pull_off_force(problem).value

    def estimate(factor: float, bound: float) -> Result:
        monkeypatch.setattr(model, "pull_off_force", lambda _: Result(factor * adhesion, bound * adhesion))
        return model.zero_load_displacement(problem)

    low, middle, high = (estimate(factor, relative) for factor in (1.0 - relative, 1.0, 1.0 + relative))
    change = max(high.value - middle.value, middle.value - low.value)
    assert change * (1.0 - 1e-5) < middle.u_num < 1.001 * change
    # With an exact adhesion: the rounding of the power n / (n + k + 1) and of two factors.
    exact, least = estimate(1.0, 0.0), 16.0 * 2.0**-52 * (1.0 + 2.0 * 5.0 / 6.6)
    assert least * exact.value < exact.u_num < 2.0 * least * exact.value


def central_deformation(problem: Problem, H0: float, traction: Callable[[float], float]) -> float:
    """M integral of p(H0 + t^n / n) d t^(1-k), Eq. 33."""
    n, m = problem.n, 1.0 - problem.k
    inner, _ = quad(lambda v: traction(H0 + v ** (n / m) / n), 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    outer, _ = quad(lambda v: traction(H0 + v ** (-n / m) / n) / v**2, 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    return problem.posed.compliance * (inner + outer)


@CASES
def test_the_semi_rigid_curve_is_the_quadrature(n: float, k: float, mu: float) -> None:
    problem = contact(n, k, mu)
    curve = SemiRigid().curve(problem)
    columns = curve.columns
    pairs = (
        (full_law, curve.displacement, curve.load),
        (attraction, columns["asymptotic_displacement"], columns["asymptotic_load"]),
    )
    for i in (0, 200, 400):
        H0 = float(columns["central_gap"][i])
        for law, displacement, load in pairs:
            assert displacement[i] == pytest.approx(-H0 + central_deformation(problem, H0, law), rel=1e-8)
            assert load[i] == pytest.approx(load_by_quadrature(n, H0, law), rel=1e-7)


@CASES
def test_jump_in_is_the_fold_of_the_quadrature(n: float, k: float, mu: float) -> None:
    """Under approach the displacement has its largest value at the fold."""
    problem = contact(n, k, mu)
    fold = minimize_scalar(
        lambda H0: H0 - central_deformation(problem, H0, attraction),
        bounds=(0.0, 20.0),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert SemiRigid().evaluate(problem, "jump_in_displacement").value == pytest.approx(-fold.fun, rel=1e-9)
    assert SemiRigid().evaluate(problem, "jump_in_gap").value == pytest.approx(fold.x, rel=1e-5)


@pytest.mark.parametrize("n", [1.0, 2.0, 5.0])
def test_gibson_limit_of_the_semi_rigid_asymptote(n: float) -> None:
    """k = 1: w = 2 mu^2 p(H0) pointwise, so delta = -H0 + 2 mu^2 p(H0), and C_in = 8/3."""
    assert jump_in_coefficient(n, 1.0) == pytest.approx(8 / 3, rel=1e-14)
    assert jump_in_coefficient(n, 1 - 1e-9) == pytest.approx(8 / 3, rel=1e-8)
    curve = SemiRigid().curve(contact(n, 1.0, 1.2))
    H0 = curve.columns["central_gap"]
    np.testing.assert_allclose(curve.displacement, -H0 + 2 * 1.2**2 * LennardJones().traction(H0), rtol=1e-12)


@pytest.mark.parametrize(
    "n", [0.7, 1.0, 1.59, 1.61, 1.9, 2 - 1e-6, 2 - 1e-15, 2 + 1e-12, 2.1, 2.66, 2.67, 5.0, 1e3, 1e8]
)
def test_the_cohesive_stress_is_the_printed_formula(n: float) -> None:
    """Eq. 77 as printed; 60 digits absorb the 0/0 at n = 2."""
    with mp.workdps(60):
        x = mp.mpf(n)
        base = 32 / (9 * x - 2) * mp.beta(3 - 2 / x, 2 / x) * (168 * mp.beta(4 - 2 / x, 6)) ** ((3 - 2 / x) / 6)
        expected = float(base ** (x / (x - 2)))
    assert eta(n) == pytest.approx(expected, rel=1e-14)


def test_the_cohesive_stress_at_two_and_in_the_limit_of_a_flat_punch() -> None:
    assert eta(2.0) == pytest.approx(eta(2.0 + 1e-15), rel=1e-14)
    peak = float(-LennardJones().traction(np.linspace(0.1, 0.3, 20001)).min())
    assert eta(math.inf) == pytest.approx(THEORETICAL_STRENGTH, rel=1e-14)
    assert peak == pytest.approx(THEORETICAL_STRENGTH, rel=1e-8)


@pytest.mark.parametrize("n", [0.5, 2 / 3])
def test_the_cohesive_stress_refuses_an_infinite_rigid_load(n: float) -> None:
    with pytest.raises(ValueError, match="2/3"):
        eta(n)


@pytest.mark.parametrize("name", ["dmt", "dmt-strength"])
def test_dmt_of_a_homogeneous_sphere_is_hertz(name: str) -> None:
    """P = (4/3) E* a^3 / R - 2 pi R dgamma, delta = a^2 / R; E* = mu^(-3/2) for Q = z0 = dgamma = 1."""
    mu, model = 0.6, create(name)
    curve = model.curve(contact(2, 0, mu))
    a = curve.columns["contact_radius"]
    np.testing.assert_allclose(curve.load, (4 / 3) * mu**-1.5 * a**3 / np.pi - 2, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(curve.displacement, a**2, rtol=1e-14)
    zero = (1.5 * np.pi * mu**1.5) ** (2 / 3)
    assert model.evaluate(contact(2, 0, mu), "zero_load_displacement").value == pytest.approx(zero, rel=1e-13)
