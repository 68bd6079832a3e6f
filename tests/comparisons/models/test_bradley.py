"""Bradley's rigid punch against quadrature of the 9-3 law."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from comparisons.models.bradley import Bradley, rigid_load
from comparisons.problem import Problem
from fscm.laws import LennardJones

SHAPES = pytest.mark.parametrize("n", [0.8, 1.0, 1.5, 2.0, 5.0, 10.0])


def load_by_quadrature(n: float, H0: float) -> float:
    """2 integral of p(H0 + r^n / n) r dr, in u = r^n / n with the end u = 0 taken by v = u^(2/n)."""
    law = LennardJones()

    def integrand(v: float) -> float:
        return float(law.traction(np.array(H0 + v ** (n / 2.0) / n)))

    inner, _ = quad(integrand, 0.0, 4.0, epsabs=1e-13, epsrel=1e-13, limit=200)
    # Beyond, v = 4 x^-m with m chosen so that the tail ~ v^(-3 n / 2) becomes a bounded function of x.
    m = 1.0 / (1.5 * n - 1.0)
    outer, _ = quad(lambda x: integrand(4.0 * x**-m) * 4.0 * m * x ** (-m - 1.0), 0.0, 1.0, epsabs=1e-13, epsrel=1e-12)
    return inner + outer


@SHAPES
def test_load_and_events_are_those_of_the_integral(n: float) -> None:
    model, problem = Bradley(), Problem.dimensionless(n, 0.3, 1.0)
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
        result = Bradley().evaluate(Problem.dimensionless(2, 0.4, 3.0), quantity)
        assert abs(result.value - exact) <= result.u_num < 1e-13
