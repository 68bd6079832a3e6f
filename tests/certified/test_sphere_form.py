"""The form on the sphere against the ring response, and its bounds against sums."""

import numpy as np
import pytest
from flint import arb, ctx, fmpq
from scipy.integrate import quad
from scipy.special import ellipkm1

from tests.certified.sphere_form import SphereForm, at_infinity, cubic_coefficients

# scipy's adaptive quadrature with a logarithmic singularity at an end point; measured: worst 3e-11.
_QUADRATURE = 1e-9
_RADII = (0.3, 1.0, 4.0, 15.0)


def ring(r: float, t: float) -> float:
    """G_0(r, t): t / (r + t) F(1/2, 1/2; 1; 4 r t / (r + t)^2)."""
    return t / (r + t) * 2 / np.pi * ellipkm1(((r - t) / (r + t)) ** 2)


def deformation(traction, r: float) -> float:
    """Integral of p(t) G_0(r, t) dt."""
    pieces = ((0, r / 2), (r / 2, r), (r, 2 * r), (2 * r, 20 * r), (20 * r, np.inf))
    return sum(quad(lambda t: traction(t) * ring(r, t), a, b, epsabs=1e-12, epsrel=1e-11)[0] for a, b in pieces)


def values(coefficients: list[arb], s: float) -> float:
    return float(np.polynomial.legendre.legval(s, [float(x) for x in coefficients]))


def sigma(length: float, r: float) -> float:
    return float((1 + (r / length) ** 2) ** -0.5)


@pytest.mark.parametrize("r", _RADII)
@pytest.mark.parametrize("length", [2, 5])
def test_the_diagonal_operator_is_the_ring_response(length, r):
    form = SphereForm(fmpq(1, 2), length, 6)
    series = [arb(x) for x in (0.3, -1.1, 0.4, 0.2, -0.5, 0.1, 0.7)]

    def traction(t: float) -> float:
        x = sigma(length, t)
        return x**3 * values(series, 2 * x * x - 1)

    x = sigma(length, r)
    w = x * values(form.deformed(series), 2 * x * x - 1)
    assert w == pytest.approx(float(form.compliance()) * deformation(traction, r), rel=_QUADRATURE)
    load = quad(lambda t: 2 * traction(t) * t, 0, np.inf)[0]
    assert float(form.load(series)) == pytest.approx(load, rel=_QUADRATURE)
    far = float(2 * length / form.compliance() * at_infinity(form.deformed(series)))
    assert far == pytest.approx(load, rel=_QUADRATURE)


def test_the_coefficients_of_sigma_cubed():
    coefficients = cubic_coefficients(60)
    for s in (-0.5, 0.0, 0.7, 1.0):
        # The sum of what is left out: below l^-4.
        assert values(coefficients, s) == pytest.approx(((1 + s) / 2) ** 1.5, abs=60.0**-4)


@pytest.mark.parametrize("degree", [20, 120])
def test_the_remainder_of_sigma_cubed_is_bounded(degree):
    form = SphereForm(fmpq(1, 2), 6, degree)
    with ctx.workprec(100):
        highest, squared = form.cubic_remainder()
        terms = form.deformed(cubic_coefficients(20 * degree))
        terms[: degree + 1] = [arb(0)] * (degree + 1)
        total = abs(at_infinity(terms))
        assert total < highest
        assert highest < 2 * total  # a bound, and not a loose one
    terms = [float(x) for x in terms]
    values = [abs(np.polynomial.legendre.legval(s, terms)) * (1 + s) / 2 for s in np.linspace(-0.999, 1.0, 500)]
    assert max(values) < squared
    assert max(values) > squared / 10
