"""Verification: each check within its limit, checks that can fail, and what is refused."""

import pytest

from fem_reference._elastic.mesh import graded_grid
from fem_reference.modulus import PowerLawModulus
from fem_reference.verification import manufactured
from fem_reference.verification.checks import (
    DEFAULT,
    EXPONENTS,
    FINE,
    FINE_RING,
    POISSON,
    RING,
    disc_checks,
    far_field_checks,
    gaussian_checks,
    limit_checks,
    ring_checks,
)
from fem_reference.verification.element_checks import element_checks, manufactured_checks


def _assert_all_pass(checks):
    failed = [f"{r.name} ({r.case}): {r.error:.2e} > {r.limit:.1e}" for r in checks if not r.passed]
    assert not failed, "\n".join(failed)


def test_order_patch_tests_and_identities():
    _assert_all_pass(manufactured_checks() + element_checks())


def test_the_checks_of_the_elements_can_fail(monkeypatch):
    """A stress of another Poisson ratio than the stiffness has is solved by another field."""
    exact = manufactured._load
    monkeypatch.setattr(manufactured, "_load", lambda basis, E, nu, field: exact(basis, E, nu + 0.01, field))
    checks = manufactured_checks() + element_checks()
    broken = {check.name for check in checks if not check.passed}
    assert broken == {"manufactured solution, graded", "patch test"}


def test_nearly_incompressible_solid():
    _assert_all_pass(gaussian_checks(DEFAULT, "default", (0.4,), (0.49,)))


def test_disc_hertz_and_flat_punch():
    _assert_all_pass(disc_checks((0.4,)))


@pytest.mark.heavy
@pytest.mark.parametrize(
    "checks",
    [
        lambda: gaussian_checks(DEFAULT, "default", EXPONENTS, POISSON),
        lambda: gaussian_checks(FINE, "fine", EXPONENTS, POISSON),
        lambda: gaussian_checks(FINE, "fine", (0.0, 0.4), (0.49,)),
        lambda: ring_checks(RING, "ring", EXPONENTS, POISSON),
        lambda: ring_checks(FINE_RING, "fine ring", EXPONENTS, POISSON),
        lambda: disc_checks(EXPONENTS),
        far_field_checks,
        limit_checks,
    ],
    ids=["gaussian", "fine gaussian", "nearly incompressible", "ring", "fine ring", "disc", "far field", "limits"],
)
def test_every_material(checks):
    _assert_all_pass(checks())


def test_impossible_grids_and_exponents_are_refused():
    for options, message in (
        ({"edge_width": 0.0}, "edge_width"),
        ({"density": -1.0}, "density"),
        ({"edge": 200.0}, "must lie in the mesh"),
    ):
        with pytest.raises(ValueError, match=message):
            graded_grid(**options)
    for k in (-0.1, 1.0, float("nan")):
        with pytest.raises(ValueError, match="exponent"):
            PowerLawModulus(1.0, 1.0, k)
