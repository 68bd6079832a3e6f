"""The ring response and its primitives against mpmath, in every corner."""

from decimal import Decimal, localcontext
from functools import partial

import mpmath
import numpy as np
import pytest

from fscm._surface.gamma import gamma
from fscm._surface.kernel import _NEAR_DEGREE, Kernel, Phi, Psi, _polynomial, ring_response

# The first one above zero is below the rounding of one.
EXPONENTS = [0.0, 1e-22, 1e-12, 1e-3, 0.05, 0.4, 0.8, 0.95]
DISTANCES = [1e-300, 1e-100, 1e-30, 1e-12, 1e-5, 0.01, 0.3, 0.5, 0.8, 0.83, 0.99, 1 - 1e-6]
# Required of the kernel; measured worst 5.1e-15 (Phi at k = 0.95).
RELATIVE = 1e-12
DIGITS = 60
# Digits that the gamma function may lose: the logarithm of Gamma at 110 is 400, and small arguments are rounded.
GAMMA_LOSES = 4


def _radii(distance: float, outside: bool) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Ring radius t and exact offset t - 1 with 1 - min/max = distance."""
    d = mpmath.mpf(distance)
    offset = d / (1 - d) if outside else -d
    return 1 + offset, offset


def _response(k: float, t: mpmath.mpf, offset: mpmath.mpf) -> mpmath.mpf:
    """Eq. 8 at r = 1, through the connection formula where the argument rounds to one."""
    k = mpmath.mpf(k)
    a = (k + 1) / 2
    y = (offset / (1 + t)) ** 2
    front = t * (1 + t) ** (-1 - k)
    if y > mpmath.mpf(10) ** -40:
        return front * mpmath.hyp2f1(a, mpmath.mpf(1) / 2, 1, 1 - y)
    root = mpmath.sqrt(mpmath.pi)
    if k == 0:  # K = log(4 / sqrt y) to O(y log y)
        return front * (2 / mpmath.pi) * mpmath.log(4 / mpmath.sqrt(y))
    A = mpmath.gamma(-k / 2) / (mpmath.gamma(1 - a) * root)
    return front * (A + y ** (-k / 2) * mpmath.gamma(k / 2) / (mpmath.gamma(a) * root))


def _phi(k: float, s: mpmath.mpf) -> mpmath.mpf:
    """Eq. 18 as printed."""
    k = mpmath.mpf(k)
    a, half = (k + 1) / 2, mpmath.mpf(1) / 2
    z = 4 * s / (1 + s) ** 2
    bracket = (s - 1) * mpmath.hyp2f1(a, half, 1, z) + (1 + s) * mpmath.hyp2f1(a - 1, half, 1, z)
    return bracket / (2 * (1 + s) ** k)


def _wrong(function, points, values):
    """Points (t, t - 1) at which a function is off by more than `RELATIVE`."""
    pairs = zip(points, values, strict=True)
    errors = [(point, float(function(*map(float, point)) / exact - 1)) for point, exact in pairs]
    return [(point, error) for point, error in errors if not abs(error) < RELATIVE]


@pytest.mark.parametrize("k", EXPONENTS)
def test_response_against_mpmath(k: float) -> None:
    with mpmath.workdps(DIGITS):
        points = [_radii(d, outside) for d in DISTANCES for outside in (False, True)]
        exact = [_response(k, t, offset) for t, offset in points]
        assert _wrong(lambda t, offset: ring_response(k, 1.0, t, abs(offset)), points, exact) == []


@pytest.mark.parametrize("k", EXPONENTS)
def test_primitives_against_the_printed_formula(k: float) -> None:
    ratios = [1e-30, 1e-8, 1e-3, 1e3, 1e8, 1e30]
    with mpmath.workdps(140):  # the printed formula cancels at both ends
        points = [(mpmath.mpf(x), mpmath.mpf(x) - 1) for x in ratios]
        points += [_radii(d, outside) for d in DISTANCES if d > 1e-90 for outside in (False, True)]
        phi = [_phi(k, s) for s, _ in points]
        assert _wrong(partial(Phi, k), points, phi) == []
        psi = [value - s ** (1 - mpmath.mpf(k)) for value, (s, _) in zip(phi, points, strict=True)]
        assert _wrong(partial(Psi, k), points, psi) == []


@pytest.mark.parametrize("k", [-0.1, 1.0, 1.5, float("nan")])
def test_exponent_outside_range_is_refused(k: float) -> None:
    with pytest.raises(ValueError, match=r"outside \[0, 1\)"):
        Kernel(k)


@pytest.mark.parametrize("k", [0.99, 0.995, 0.9999])
def test_primitives_at_the_ring_itself_near_the_gibson_limit(k):
    """Gauss's theorem: Gamma(1-k) / (Gamma((1-k)/2) Gamma((3-k)/2)) at s = 1."""
    rest = 1 - mpmath.mpf(k)
    exact = float(mpmath.gamma(rest) / mpmath.gamma(rest / 2) / mpmath.gamma(1 + rest / 2))
    assert Phi(k, np.array([1.0]))[0] == pytest.approx(exact, rel=1e-13)
    assert Psi(k, np.array([1.0]))[0] == pytest.approx(exact - 1.0, rel=1e-13)


def test_a_polynomial_has_its_coefficients_that_are_zero_too():
    """Several exponents are evaluated together; which of their last coefficients are 0 differs between processors."""
    np.testing.assert_array_equal(_polynomial([0]), np.zeros(_NEAR_DEGREE + 1))


@pytest.mark.parametrize("digits", [10, 50, 110])
@pytest.mark.parametrize("x", [2.0, 1.0, 0.5, 1e-30, -1e-30, 0.47, -0.47, -1.0 + 2.0**-53])
def test_the_gamma_function_has_the_digits_of_its_context_but_a_few(x, digits):
    with localcontext(prec=digits), mpmath.workdps(digits + 30):
        ratio = mpmath.mpf(str(gamma(Decimal(x)))) / mpmath.gamma(mpmath.mpf(x))
        assert abs(ratio - 1) < mpmath.mpf(10) ** (GAMMA_LOSES - digits)
