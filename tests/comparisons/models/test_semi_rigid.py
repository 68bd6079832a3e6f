"""The semi-rigid asymptote against quadrature of the traction on the undeformed gap."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.problem import Problem
from fscm.laws import LennardJones

contact = Problem.dimensionless
CASES = pytest.mark.parametrize(
    ("n", "k", "mu"), [(1.0, 0.0, 2.0), (1.5, 0.2, 3.0), (5.0, 0.6, 1.5), (2.0, 0.95, 1.0), (0.9, 0.4, 5.0)]
)


def central_deformation(problem: Problem, H0: float, traction: Callable[[float], float]) -> float:
    """M integral of p(H0 + t^n / n) d t^(1-k), Eq. 33."""
    n, m = problem.n, 1.0 - problem.k
    inner, _ = quad(lambda v: traction(H0 + v ** (n / m) / n), 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    outer, _ = quad(lambda v: traction(H0 + v ** (-n / m) / n) / v**2, 0.0, 1.0, epsabs=1e-14, epsrel=1e-13, limit=400)
    return problem.posed.compliance * (inner + outer)


def full_law(H: float) -> float:
    return float(LennardJones().traction(np.array(H)))


def attraction(H: float) -> float:
    return -(8.0 / 3.0) * (H + 1.0) ** -3


@CASES
def test_curve_is_the_quadrature(n: float, k: float, mu: float) -> None:
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
            moment = lambda x, H0=H0, law=law: law(H0 + x**n / n) * 2 * x  # noqa: E731
            P, _ = quad(moment, 0.0, np.inf, epsabs=1e-12, epsrel=1e-10, limit=400)
            assert load[i] == pytest.approx(P, rel=1e-7)


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
def test_gibson_limit(n: float) -> None:
    """k = 1: w = 2 mu^2 p(H0) pointwise, so delta = -H0 + 2 mu^2 p(H0), and C_in = 8/3."""
    assert jump_in_coefficient(n, 1.0) == pytest.approx(8 / 3, rel=1e-14)
    assert jump_in_coefficient(n, 1 - 1e-9) == pytest.approx(8 / 3, rel=1e-8)
    curve = SemiRigid().curve(contact(n, 1.0, 1.2))
    H0 = curve.columns["central_gap"]
    np.testing.assert_allclose(curve.displacement, -H0 + 2 * 1.2**2 * LennardJones().traction(H0), rtol=1e-12)
