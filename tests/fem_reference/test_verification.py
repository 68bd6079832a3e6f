"""Verification: each check within its limit, and the exact solutions against Eq. 6 by quadrature."""

import numpy as np
import pytest
from scipy import integrate, special

from fem_reference._elastic.mesh import edge_grid
from fem_reference.solid import PowerLaw
from fem_reference.verification import checks, manufactured
from fem_reference.verification.element_checks import element_checks, manufactured_checks
from fem_reference.verification.reference_solutions import (
    gaussian_displacement,
    power_displacement,
    ring_displacement,
    surface_constant,
)
from tests.refusals import refused

#: scipy.integrate.quad with the logarithmic or power singularity at t = r as a break point: measured 1e-10.
QUADRATURE_TOLERANCE = 1e-8


def _assert_all_pass(results):
    failed = [f"{r.name} ({r.case}): {r.error:.2e} > {r.limit:.1e}" for r in results if not r.passed]
    assert not failed, "\n".join(failed)


def _ring_integral(pressure, r, k, nu, end):
    """Eq. 5 with the ring kernel of Eq. 6 as printed, c0 = 1 and E0 = 1."""

    def integrand(t, distance):
        # Euler's transformation F(a,a;1;x) = (1-x)^(1-2a) F(1-a,1-a;1;x), with 1 - x from the distance |t
        # - r|.
        low, high = min(r, t), max(r, t)
        x, y = (low / high) ** 2, distance * (r + t) / high**2
        if k == 0 and y < 1e-13:
            return 0.0  # the logarithm in a strip of 1e-13: below the tolerance
        a = 0.5 * (k + 1)
        factor = t**-k if r < t else t * r ** -(k + 1)
        return pressure(t) * factor * y**-k * special.hyp2f1(1 - a, 1 - a, 1, x)

    # t = r +- u^m takes the |t - r|^-k singularity away.
    m = 6

    def half(sign, length):
        def transformed(u):
            return integrand(r + sign * u**m, u**m) * m * u ** (m - 1) if u > 0 else 0.0

        return integrate.quad(transformed, 0, length ** (1 / m), limit=200, epsabs=1e-12, epsrel=1e-11)[0]

    inner, outer = half(-1, r), half(1, end - r)
    return 2 * surface_constant(k, nu) * (1 - nu**2) * (inner + outer)


@pytest.mark.parametrize("k", [0.0, 0.2, 0.6])
@pytest.mark.parametrize("r", [0.3, 1.1, 2.5])
def test_closed_form_of_the_gaussian_is_the_ring_integral(k, r):
    expected = _ring_integral(lambda t: np.exp(-(t**2)), r, k, 0.3, 8.0)
    assert gaussian_displacement(np.array(r), k, 0.3) == pytest.approx(expected, rel=QUADRATURE_TOLERANCE)


@pytest.mark.parametrize("k", [0.0, 0.4])
def test_closed_form_of_the_disc_is_the_ring_integral(k):
    for beta in (0.0, 0.5 * (1 + k)):
        expected = _ring_integral(lambda t, beta=beta: max(1 - t**2, 0.0) ** beta, 0.4, k, 0.3, 1.0)
        assert power_displacement(np.array(0.4), k, 0.3, beta) == pytest.approx(expected, rel=1e-6)


def test_order_patch_tests_and_identities():
    _assert_all_pass(manufactured_checks() + element_checks())


def test_the_checks_of_the_elements_can_fail(monkeypatch):
    """A stress of another Poisson ratio than the stiffness has is solved by another field."""
    exact = manufactured._load
    monkeypatch.setattr(manufactured, "_load", lambda basis, E, nu, field: exact(basis, E, nu + 0.01, field))
    broken = {check.name for check in manufactured_checks() + element_checks() if not check.passed}
    assert broken == {"manufactured solution, graded", "patch test"}


def test_nearly_incompressible_solid():
    _assert_all_pass(checks.gaussian_checks(checks.DEFAULT, "default", (0.4,), (0.49,)))


def test_disc_hertz_and_flat_punch():
    _assert_all_pass(checks.disc_checks((0.4,)))


@pytest.mark.parametrize("k", [0.0, 0.4])
def test_closed_form_of_the_ring_is_that_of_many_rings(k):
    """The ring of Eq. 6 again, as point forces of 1/distance^(1+k) around it."""
    angle = np.pi * np.arange(4000) / 2000
    for r in (0.0, 0.5, 2.0):
        distance = np.sqrt(1 + r**2 - 2 * r * np.cos(angle))
        expected = 2 * surface_constant(k, 0.3) * (1 - 0.3**2) * np.mean(distance ** -(1 + k))
        assert ring_displacement(np.array(r), k, 0.3) == pytest.approx(expected, rel=1e-13)


@pytest.mark.heavy
@pytest.mark.parametrize(
    "material_checks",
    [
        lambda: checks.gaussian_checks(checks.DEFAULT, "default", checks.EXPONENTS, checks.POISSON),
        lambda: checks.gaussian_checks(checks.FINE, "fine", checks.EXPONENTS, checks.POISSON),
        lambda: checks.gaussian_checks(checks.FINE, "fine", (0.0, 0.4), (0.49,)),
        lambda: checks.ring_checks(checks.RING, "ring", checks.EXPONENTS, checks.POISSON),
        lambda: checks.ring_checks(checks.FINE_RING, "fine ring", checks.EXPONENTS, checks.POISSON),
        lambda: checks.disc_checks(checks.EXPONENTS),
        checks.far_field_checks,
        checks.limit_checks,
    ],
    ids=["gaussian", "fine gaussian", "nearly incompressible", "ring", "fine ring", "disc", "far field", "limits"],
)
def test_every_material(material_checks):
    _assert_all_pass(material_checks())


def test_impossible_grids_and_exponents_are_refused():
    for options, message in (
        ({"edge_width": 0.0}, "edge_width"),
        ({"density": -1.0}, "density"),
        ({"edge": 200.0}, "must lie in the mesh"),
    ):
        refused(message, edge_grid, **options)
    for k in (-0.1, 1.0, float("nan")):
        refused("exponent", PowerLaw, 1.0, 1.0, k, 0.3)
