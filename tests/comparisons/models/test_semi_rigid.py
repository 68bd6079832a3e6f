"""The semi-rigid asymptote against quadrature of the traction on the undeformed gap."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from comparisons.model import NotApplicable
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.problem import Problem
from fscm.laws import LennardJones

contact = Problem.dimensionless

CASES = [
    (1.0, 0.0, 2.0),
    (1.5, 0.2, 3.0),
    (2.0, 0.4, 3.0),
    (5.0, 0.6, 1.5),
    (2.0, 0.95, 1.0),
    (0.9, 0.4, 5.0),
]


def central_deformation(problem: Problem, H0: float, traction) -> float:
    """M integral of p(H0 + t^n / n) d t^(1-k), Eq. 33."""
    n, m = problem.n, 1.0 - problem.k
    value, _ = quad(lambda v: traction(H0 + v ** (n / m) / n), 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    far, _ = quad(lambda v: traction(H0 + v ** (-n / m) / n) / v**2, 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    return problem.posed.compliance * (value + far)


def full_law(H: float) -> float:
    return float(LennardJones().traction(np.array(H)))


def attraction(H: float) -> float:
    return -(8.0 / 3.0) * (H + 1.0) ** -3


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_curve_is_the_quadrature(n: float, k: float, mu: float) -> None:
    problem = contact(n, k, mu)
    curve = SemiRigid().curve(problem)
    for i in (0, 200, 400):
        H0 = float(curve.columns["central_gap"][i])
        assert curve.displacement[i] == pytest.approx(-H0 + central_deformation(problem, H0, full_law), rel=1e-8)
        far = -H0 + central_deformation(problem, H0, attraction)
        assert curve.columns["asymptotic_displacement"][i] == pytest.approx(far, rel=1e-8)
        P, _ = quad(
            lambda x, H0=H0: full_law(H0 + x**n / n) * 2 * x,
            0.0,
            np.inf,
            epsabs=1e-12,
            epsrel=1e-10,
            limit=400,
        )
        assert curve.load[i] == pytest.approx(P, rel=1e-7)
        P, _ = quad(
            lambda x, H0=H0: attraction(H0 + x**n / n) * 2 * x,
            0.0,
            np.inf,
            epsabs=1e-12,
            epsrel=1e-10,
            limit=400,
        )
        assert curve.columns["asymptotic_load"][i] == pytest.approx(P, rel=1e-7)


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_jump_in_is_the_fold_of_the_quadrature(n: float, k: float, mu: float) -> None:
    """Under approach the displacement has its largest value at the fold."""
    problem = contact(n, k, mu)
    found = minimize_scalar(
        lambda H0: H0 - central_deformation(problem, H0, attraction),
        bounds=(0.0, 20.0),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert SemiRigid().evaluate(problem, "jump_in_displacement").value == pytest.approx(-found.fun, rel=1e-9)
    assert SemiRigid().evaluate(problem, "jump_in_gap").value == pytest.approx(found.x, rel=1e-5)


@pytest.mark.parametrize("mu", [0.6, 1.0, 4.0])
def test_equation_49(mu: float) -> None:
    expected = 1 - 7 / 5 * (5 * np.pi / np.sqrt(2)) ** (2 / 7) * mu ** (3 / 7)
    assert SemiRigid().evaluate(contact(2, 0, mu), "jump_in_displacement").value == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 5.0])
def test_coefficient_tends_to_eight_thirds(n: float) -> None:
    assert jump_in_coefficient(n, 1.0) == pytest.approx(8 / 3, rel=1e-14)
    assert jump_in_coefficient(n, 1 - 1e-9) == pytest.approx(8 / 3, rel=1e-8)


def test_gibson_limit_is_the_local_spring() -> None:
    """k = 1: w = 2 mu^2 p(H0) pointwise, so delta = -H0 + 2 mu^2 p(H0)."""
    problem = contact(2, 1.0, 1.2)
    curve = SemiRigid().curve(problem)
    H0 = curve.columns["central_gap"]
    np.testing.assert_allclose(curve.displacement, -H0 + 2 * 1.2**2 * LennardJones().traction(H0), rtol=1e-12)


def test_refuses_a_jump_in_from_contact() -> None:
    with pytest.raises(NotApplicable, match="positive"):
        SemiRigid().evaluate(contact(2, 0, 0.05), "jump_in_displacement")
