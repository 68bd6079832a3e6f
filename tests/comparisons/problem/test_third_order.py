"""Energy of third order of the field of JKR, against integrals of other quadratures and the finite elements."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0, j1

from comparisons.description import third_order
from comparisons.description.strain_errors import SOFTNESS, _strains
from comparisons.description.third_order import strain_limit, third_order_energy

#: Transforms of the loads of a flat punch and of Hertz, for a contact radius of 1.
LOADS = (lambda xi: np.sinc(xi / np.pi), lambda xi: 2.0 * (np.sin(xi) - xi * np.cos(xi)) / xi**3)


@pytest.mark.parametrize("load", [0, 1])
def test_the_potentials_are_the_transforms_of_the_loads(load):
    zeta, eta = np.array([0.7]), np.array([0.4])
    r, z = np.sqrt((1.0 + zeta**2) * (1.0 - eta**2)), zeta * eta
    potentials = third_order._potentials(r, z, zeta - 1j * eta)[load][:, 0]
    kernels = [(1, j0), (1, j1), (2, j0), (2, j1), (0, j1)]
    for value, (power, bessel) in zip(potentials, kernels, strict=True):
        integral, _ = quad(
            lambda xi, power=power, bessel=bessel: LOADS[load](xi) * xi**power * np.exp(-xi * z[0]) * bessel(xi * r[0]),
            1e-9,
            120.0,
            limit=500,
        )
        assert value == pytest.approx(integral, abs=1e-7)


def test_the_quadrature_has_converged(monkeypatch):
    limits = []
    for nodes in (20, 28):
        monkeypatch.setattr(third_order, "_NODES", nodes)
        third_order._fields.cache_clear()
        limits.append([third_order_energy(1.0, -4.0 / 3.0, nu) for nu in (0.0, 0.3, 0.5)])
    third_order._fields.cache_clear()
    assert limits[0] == pytest.approx(limits[1], rel=1e-11)


def test_a_sphere_without_adhesion_on_an_incompressible_solid():
    """Its load is that of Hertz times 1 - 0.0651 sqrt(delta/R); the finite elements have -0.0646 to -0.0652."""
    assert 2.25 * third_order_energy(1.0, 0.0, 0.5) == pytest.approx(-0.0651, abs=5e-5)


@pytest.mark.parametrize("nu", [0.0, 0.2, 0.35, 0.5])
def test_the_finite_elements_approach_the_limit_with_the_tabor_number(nu):
    """From mu = 5 to 10 by a share that a power of 1/mu between 0.4 and 1.4 leaves of the distance from the limit."""
    x = np.cbrt(SOFTNESS[0])
    limit = strain_limit(nu) * (9.0 * np.pi / 8.0) ** (1.0 / 3.0) - 0.1 * x
    nodes = _strains(SOFTNESS[0], nu)
    shares = (nodes[10.0].value - limit) / (nodes[5.0].value - limit)
    assert 2.0**-1.4 < shares < 2.0**-0.4


def test_the_limit_depends_on_poissons_ratio_as_a_polynomial_over_the_square_of_one_minus_it():
    """Cubic in nu times (1 - nu)^-2: five values are not independent."""
    ratios = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    scaled = np.array([strain_limit(nu) for nu in ratios]) * (1.0 - ratios) ** 2
    cubic = np.polynomial.Polynomial.fit(ratios[:4], scaled[:4], 3)
    assert cubic(ratios[4:]) == pytest.approx(scaled[4:], abs=1e-12)
    assert scaled[5] > 0.0 > scaled[0]
