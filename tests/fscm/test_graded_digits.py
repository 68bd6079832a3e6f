"""Responses of graded solids to a ring against the Hankel integral of compliances in 25 digits."""

import json
from functools import lru_cache

import mpmath
import numpy as np
import pytest

from fscm.graded import GradedKernel
from fscm.graded.compliance import compliance
from fscm.solids import contact_modulus
from tests.fscm import graded_digits


@lru_cache
def _stored():
    return json.loads(graded_digits.FILE.read_text())


@pytest.mark.parametrize("name", graded_digits.SOLIDS)
def test_the_response_of_a_solid_from_25_digits(name):
    """1e-9 of the kernel at 50 random pairs of radii, and the stated bound is never exceeded."""
    stored, kernel = _stored()[name], GradedKernel(graded_digits.SOLIDS[name])
    r, t, exact = (np.array(stored[key]) for key in ("r", "t", "G"))
    assert len(exact) == 50
    assert stored["error"] < 3e-12
    errors = np.abs(kernel.response(r, t) - exact)
    assert np.max(errors / exact) < 1e-9
    # Rounding of the sum over the images, whose strengths are up to 3e5 together; the values themselves change by
    # `error` with fewer nodes.
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
    with mpmath.workdps(40):
        assert abs(value / graded_digits.relative_compliance(solid, xi) - 1) < mpmath.mpf(10) ** -25
