"""The limit of JKR on a coated solid, by the integral equation that the FSCM is compared with."""

import math

import numpy as np
import pytest

from comparisons.model import ComputationFailed
from comparisons.paper.studies import coated_jkr
from comparisons.paper.studies.coated_jkr import coated_compliance, coated_load, coated_pull_off
from tests.fem_reference.hankel_reference import transform

#: The ordinary differential equation behind `transform`: its relative tolerance is 1e-11.
TRANSFORM_ERROR = 1e-9


@pytest.mark.parametrize(("ratio", "nu", "nu_below"), [(4.0, 0.3, 0.3), (0.2, 0.2, 0.45)])
def test_the_closed_form_of_the_compliance(ratio, nu, nu_below):
    """Against an integration of the equations of elasticity over the depth."""
    q = np.array([0.1, 0.5, 1.0, 3.0])
    found = transform(
        lambda z: np.where(z < 1.0, 1.0, ratio),
        lambda z: np.where(z < 1.0, nu, nu_below),
        q,
        sharp=(1.0,),
    )
    expected = coated_compliance(q, ratio, nu, nu_below) * 2.0 * (1.0 - nu**2)
    assert expected == pytest.approx(found, rel=TRANSFORM_ERROR)


@pytest.mark.parametrize("radius", [0.5, 1.5, 3.0])
def test_the_load_on_a_homogeneous_solid_is_that_of_jkr(radius):
    expected = 4.0 / 3.0 * radius**3 - math.sqrt(8.0 * math.pi * radius**3)
    assert coated_load(radius, 1.0, 0.2, 0.3, 0.3) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("ratio", "thickness"), [(4.0, 0.5), (0.25, 0.5), (100.0, 0.3)])
def test_finer_quadrature_changes_the_force_by_less_than_the_bound(ratio, thickness, monkeypatch):
    coarse = coated_pull_off(ratio, thickness, 0.3, 0.3)
    for name, value in (("_POINTS", 20), ("_PHASE", 3.0), ("_PANEL", 0.2), ("_FIRST", 1e-4)):
        monkeypatch.setattr(coated_jkr, name, value)
    fine = coated_pull_off(ratio, thickness, 0.3, 0.3)
    assert abs(fine["force"] - coarse["force"]) <= coarse["u_num"]


def test_thick_coatings_and_thin_ones():
    """JKR on the coating alone, whose substrate is felt as (a/h)^3 at least; twice w R pi on a rigid substrate."""
    assert coated_pull_off(4.0, 40.0, 0.3, 0.3)["force"] == pytest.approx(1.5, abs=1e-3)
    shares = [2.0 - coated_pull_off(1e6, h, 0.3, 0.3)["force"] for h in (0.3, 0.1)]
    # Linear in thickness over contact radius, which is 0.263 and 0.113: derived from the edge zone of a thin layer.
    assert shares[0] / shares[1] == pytest.approx(0.263 / 0.113, rel=0.1)


def test_a_minimum_at_an_end_is_no_result():
    with pytest.raises(ComputationFailed, match="an end of the search"):
        coated_pull_off(1e-6, 0.5, 0.3, 0.3)
