"""Bradley's rigid punch against quadrature of the 9-3 law."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from comparisons.models.bradley import Bradley, rigid_load
from comparisons.problem import Problem
from fscm.laws import LennardJones

contact = Problem.dimensionless

SHAPES = [0.8, 1.0, 1.5, 2.0, 5.0, 10.0]


def load_by_quadrature(n: float, H0: float) -> float:
    """2 integral of p(H0 + r^n / n) r dr, in u = r^n / n with the end u = 0 taken by v = u^(2/n)."""
    law = LennardJones()

    def integrand(v: float) -> float:
        return float(law.traction(np.array(H0 + v ** (n / 2.0) / n)))

    near, _ = quad(integrand, 0.0, 4.0, epsabs=1e-13, epsrel=1e-13, limit=200)
    # Beyond, v = 4 x^-m with m chosen so that the tail ~ v^(-3 n / 2) becomes a bounded function of x.
    m = 1.0 / (1.5 * n - 1.0)
    far, _ = quad(lambda x: integrand(4.0 * x**-m) * 4.0 * m * x ** (-m - 1.0), 0.0, 1.0, epsabs=1e-13, epsrel=1e-12)
    return near + far


@pytest.mark.parametrize("n", SHAPES)
@pytest.mark.parametrize("H0", [-0.15, 0.0, 0.4, 3.0])
def test_load_is_the_integral_of_the_law(n: float, H0: float) -> None:
    assert float(rigid_load(n, np.array(H0))) == pytest.approx(load_by_quadrature(n, H0), rel=1e-9, abs=1e-10)


@pytest.mark.parametrize("n", SHAPES)
def test_pull_off_is_the_minimum_of_the_integral(n: float) -> None:
    found = minimize_scalar(
        lambda H0: load_by_quadrature(n, H0), bounds=(-0.45, 0.5), method="bounded", options={"xatol": 1e-9}
    )
    assert Bradley().evaluate(contact(n, 0.3, 1.0), "pull_off_force").value == pytest.approx(-found.fun, rel=1e-9)
    assert Bradley().evaluate(contact(n, 0.3, 1.0), "pull_off_displacement").value == pytest.approx(-found.x, abs=1e-5)


@pytest.mark.parametrize("n", SHAPES)
def test_zero_load(n: float) -> None:
    H0 = brentq(lambda gap: load_by_quadrature(n, gap), -0.6, 0.0, xtol=1e-12)
    assert Bradley().evaluate(contact(n, 0.0, 1.0), "zero_load_displacement").value == pytest.approx(-H0, abs=1e-9)


@pytest.mark.parametrize(("n", "printed"), [(1, 2.880), (1.5, 2.166), (2, 2.0), (5, 1.669)])
def test_printed_values(n: float, printed: float) -> None:
    assert round(Bradley().evaluate(contact(n, 0.0, 1.0), "pull_off_force").value, 3) == printed


@pytest.mark.parametrize("n", SHAPES)
def test_the_gradient_exponent_has_no_influence(n: float) -> None:
    forces = {Bradley().evaluate(contact(n, k, 1.0), "pull_off_force").value for k in (0.0, 0.4, 0.6)}
    assert len(forces) == 1


def test_paraboloid_is_two_at_zero_displacement() -> None:
    force = Bradley().evaluate(contact(2, 0.4, 3.0), "pull_off_force")
    place = Bradley().evaluate(contact(2, 0.4, 3.0), "pull_off_displacement")
    assert abs(force.value - 2.0) <= force.u_num < 1e-13
    assert abs(place.value) <= place.u_num < 1e-13


@pytest.mark.parametrize("n", SHAPES)
def test_curve_contains_its_pull_off(n: float) -> None:
    curve = Bradley().curve(contact(n, 0.0, 1.0))
    force = Bradley().evaluate(contact(n, 0.0, 1.0), "pull_off_force").value
    assert 0.0 <= force + curve.load.min() < 1e-3 * force
    np.testing.assert_array_equal(curve.displacement, -curve.columns["central_gap"])
    assert curve.load[-1] > 0.0
