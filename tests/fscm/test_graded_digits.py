"""Responses of graded solids to a ring against the Hankel integral: a layer in 40 digits, four others in 25."""

import json
from functools import lru_cache
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from fscm import Coating
from fscm.graded import GradedKernel
from fscm.graded.compliance import compliance
from fscm.solids import contact_modulus
from tests.fscm import graded_digits

THICKNESS, COATING, SUBSTRATE = 1, (mpmath.mpf(1), mpmath.mpf("0.3")), (mpmath.mpf(10), mpmath.mpf("0.45"))
SOLID = Coating(1.0, 10.0, 1.0, 0.0, 0.3, 0.45)
DIGITS = 40
#: Behind it 1 - D, which falls like x^2 exp(-2 x) at x = xi times thickness, is below 1e-17.
LAST = 24


def _system(E, nu):
    """Matrix of the equations for displacements and stresses, as functions of xi z."""
    a, G, L = nu / (1 - nu), E / (2 * (1 + nu)), E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    return mpmath.matrix([[0, 1, 1 / G, 0], [-a, 0, 0, 1 / L], [E / (1 - nu**2), 0, 0, a], [0, 0, -1, 0]])


def _excess(xi):
    """D - 1 of the layer: the decaying solutions of the substrate, carried to the surface by a matrix exponential."""
    E, nu = SUBSTRATE
    n, m = 2 * (1 - nu**2) / E, (1 + nu) * (1 - 2 * nu) / E
    below = mpmath.matrix([[-n, m], [m, -n], [1, 0], [0, 1]])
    top = mpmath.expm(-xi * THICKNESS * _system(*COATING), method="taylor") * below
    (_, w1, t1, s1), (_, w2, t2, s2) = top[:, 0], top[:, 1]
    compliance = -(w2 * t1 - w1 * t2) / (t1 * s2 - t2 * s1)
    E, nu = COATING
    return compliance * E / (2 * (1 - nu**2)) - 1


@lru_cache
def _rule(nodes):
    """Wave numbers, weights, and weights times D - 1, of Gauss quadrature on pieces of length one and shorter."""
    with mpmath.workdps(DIGITS):
        ends = [mpmath.mpf(0), mpmath.mpf(1) / 4, *(mpmath.mpf(x) / 2 for x in range(1, 8)), *range(4, LAST + 1)]
        x, w = np.polynomial.legendre.leggauss(nodes)
        points, weighed = [], []
        for a, b in pairwise(ends):
            for u, v in zip(x.tolist(), w.tolist(), strict=True):
                points.append(a + (b - a) * (1 + mpmath.mpf(u)) / 2)
                weighed.append((b - a) / 2 * mpmath.mpf(v) * _excess(points[-1]))
        return points, weighed


def _exact(r, t, nodes):
    """G(r, t) of the layer, with the ring of the homogeneous solid in closed form."""
    points, weighed = _rule(nodes)
    with mpmath.workdps(DIGITS):
        r, t = mpmath.mpf(r), mpmath.mpf(t)
        total = mpmath.fsum(
            w * mpmath.besselj(0, x * r) * mpmath.besselj(0, x * t) for x, w in zip(points, weighed, strict=True)
        )
        return t * (1 / mpmath.agm(r + t, abs(r - t)) + total)


@pytest.mark.parametrize("count", [2, pytest.param(50, marks=pytest.mark.heavy)])
def test_the_response_of_a_layer_in_40_digits(count):
    """1e-9 of the kernel at random pairs of radii, and the stated bound is never exceeded."""
    r, t = 10.0 ** np.random.default_rng(12).uniform(-1.0, 0.7, (2, count))
    kernel = GradedKernel(SOLID)
    values, bounds = kernel.response(r, t), kernel.error(r, t)
    for i in range(count):
        exact = _exact(r[i], t[i], 16)
        # Each node of the quadrature takes a matrix exponential in 40 digits; the nodes are the same for all pairs.
        if count > 2:
            assert abs(exact - _exact(r[i], t[i], 12)) < 1e-12 * exact
        assert abs(values[i] - exact) <= 1e-9 * exact
        # Rounding of the sum: the strengths of the images are 3e5 together.
        assert abs(values[i] - exact) <= bounds[i] + 1e-16 * float(np.abs(kernel.images.strengths).sum()) * t[i]


@lru_cache
def _stored():
    return json.loads(graded_digits.FILE.read_text())


@pytest.mark.parametrize("name", graded_digits.SOLIDS)
def test_the_response_of_a_solid_from_25_digits(name):
    """1e-9 of the kernel at 50 random pairs of radii, and the stated bound is never exceeded."""
    stored, kernel = _stored()[name], GradedKernel(graded_digits.SOLIDS[name])
    r, t, exact = (np.array(stored[key]) for key in ("r", "t", "G"))
    assert len(exact) == 50
    assert stored["error"] < 1e-13
    errors = np.abs(kernel.response(r, t) - exact)
    assert np.max(errors / exact) < 1e-9
    # Rounding of the sum, as above; the values themselves change by so much with fewer nodes.
    rounding = 1e-16 * float(np.abs(kernel.images.strengths).sum()) * t + stored["error"] * exact
    assert np.all(errors <= kernel.error(r, t) + rounding)


@pytest.mark.parametrize("name", graded_digits.SOLIDS)
@pytest.mark.parametrize("count", [1, pytest.param(20, marks=pytest.mark.heavy)])
def test_the_stored_compliances_are_those_of_the_series(name, count):
    """Between the nodes of the table, and in double precision by collocation."""
    solid, modes = graded_digits.SOLIDS[name], np.array(_stored()[name]["modes"]).T
    # Below, the series take many steps.
    xi = 10.0 ** np.random.default_rng(8).uniform(-1.0 if count > 1 else 1.0, 2.5, count)
    exact = np.array([float(graded_digits.relative_compliance(solid, x)) for x in xi])
    # What the pieces of the table leave; one step of collocation leaves 6e-13 on the smooth coating.
    assert np.allclose(graded_digits.excess(modes, xi), exact - 1.0, rtol=0.0, atol=1e-12)
    assert np.allclose(0.5 * contact_modulus(solid) * compliance(solid, xi), exact, rtol=2e-12, atol=0.0)


@pytest.mark.heavy
@pytest.mark.parametrize("name", graded_digits.SOLIDS)
def test_the_series_has_25_digits(name, monkeypatch):
    solid, xi = graded_digits.SOLIDS[name], 0.3
    value = graded_digits.relative_compliance(solid, xi)
    for constant, finer in (("BITS", 170), ("TERMS", 80), ("SHARE", 4), ("START", 45), ("CONSTANT", 95)):
        monkeypatch.setattr(graded_digits, constant, finer)
    with mpmath.workdps(DIGITS):
        assert abs(value / graded_digits.relative_compliance(solid, xi) - 1) < mpmath.mpf(10) ** -25
