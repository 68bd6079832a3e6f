"""Studies beyond the paper: errors over their range, other solids by both references, coated solids against JKR."""

import math

import numpy as np
import pytest
from scipy.special import beta

from comparisons.model import ComputationFailed
from comparisons.paper.studies import coated_jkr
from comparisons.paper.studies.coated_jkr import coated_compliance, coated_load, coated_pull_off
from comparisons.paper.studies.error_maps import errors_along
from comparisons.paper.studies.graded_solids import (
    OFFSET,
    SERIES,
    by_elements,
    by_fscm,
    case_of,
    equivalent_of,
    number_of,
    of_power_law,
)
from comparisons.paper.studies.layered_adhesion import TABOR_NUMBERS, coated_force, extrapolated, layer_compliance
from comparisons.paper.tasks import quantity
from tests.fem_reference.hankel_reference import transform

#: Distance of k and mu from those of a power law with an offset of 1e-6 L: see the test for how it falls.
LARGEST_OFFSET = 3e-4
#: The ordinary differential equation behind `transform`: its relative tolerance is 1e-11.
TRANSFORM_ERROR = 1e-9


@pytest.mark.parametrize("names", [["pull_off_force"], ["jump_in_displacement", "jump_out_displacement"]])
def test_the_references_of_the_maps_are_those_of_the_solver(names, made_of):
    table = made_of(lambda: errors_along([(2.0, 0.0)], names))
    assert set(table["quantity"]) == set(names)
    if "critical" in table:
        # At n = 2, k = 0 it is 0.69721461: there are jumps at 0.70, and none at 0.69.
        assert 0.69 < table["critical"].iloc[0] < table["mu"].min() < 0.70
    for name in names:
        row = table[table["quantity"] == name].iloc[-4]
        solved = quantity("fscm", name, 2.0, 0.0, row["mu"])
        assert abs(row["fscm"] - solved["value"]) <= row["u_fscm"] + solved["u_num"]
        closed = quantity(row["model"], name, 2.0, 0.0, row["mu"])["value"]
        assert row["kappa"] == pytest.approx((closed - solved["value"]) / abs(solved["value"]), abs=1e-5)


@pytest.mark.parametrize("kind", ["coating", *(pytest.param(kind, marks=pytest.mark.heavy) for kind in SERIES)])
def test_a_stored_point_is_computed_again(kind, committed):
    table = committed("graded_solids").groupby("solid").get_group(kind)
    parameter = table["parameter"].iloc[10]
    results, case = by_fscm(kind, parameter), case_of(kind, parameter)
    for row in table[table["parameter"] == parameter].itertuples():
        value, u_num = number_of(results, row.quantity)
        assert abs(value - row.fscm) <= u_num + row.u_fscm
        assert row.power_law_error == pytest.approx((row.power_law - row.fscm) / abs(row.fscm))
        assert (case.mu, *case.depth) == pytest.approx((row.surface_mu, row.depth_k, row.depth_mu))
    value, u_num = of_power_law(row.power_law_k, row.power_law_mu)["hysteresis_energy"]
    assert abs(value - row.power_law) <= 2.0 * u_num


@pytest.mark.heavy
def test_a_stored_point_is_computed_again_by_the_finite_elements(committed):
    row = committed("graded_solids").query("solid == 'coating' and parameter == 1.0").iloc[0]
    value, u_num = by_elements("pull-off", "coating", 1.0)["pull_off_force"]
    assert abs(value - row["fem"]) <= u_num + row["u_fem"]


@pytest.mark.heavy
def test_the_equivalent_power_law_of_a_power_law_is_itself():
    """The skin changes the compliance at the contact radius by its share, z_s^(1-k)."""
    apart = [max(np.abs(np.subtract(equivalent_of("offset power law", z_s), OFFSET))) for z_s in (1e-4, 1e-6)]
    assert apart[1] < min(LARGEST_OFFSET, apart[0] / 3.0)


@pytest.mark.parametrize("kind", [pytest.param("exponential", marks=pytest.mark.heavy), "coating"])
def test_the_equivalent_power_law_of_a_thin_layer_is_that_of_the_depth(kind):
    """What is left is the share of the depth in the lengths of the contact."""
    assert equivalent_of(kind, 1e-6) == pytest.approx(case_of(kind, 1e-6).depth, abs=1e-5)


def response_factor(k: float, nu: float) -> float:
    """Eq. 7."""
    q = math.sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    factor = 2 ** (k + 1) * (k + 2) * q * math.sin(q * math.pi / 2) / (k * (k + 1) * beta(k / 2, 0.5))
    return factor * beta((3 + k + q) / 2, (3 + k - q) / 2)


def test_tabor_number_of_the_uniform_solid():
    """Eq. 29 for both solids, divided: every scale but z_s / L drops out."""
    k, mu = OFFSET
    ratio = 0.3**-k * (1 - k) / response_factor(k, 0.3)
    assert case_of("offset power law", 0.3).mu == pytest.approx((mu ** ((3 + k) / 2) * ratio) ** (2 / 3))


def test_without_jumps_there_is_a_reason():
    results = by_elements("jump-out", "offset power law", 100.0)
    assert {"too stiff" in reason for reason in results.values()} == {True}
    assert math.isnan(number_of(results, "jump_out_displacement")[0])


@pytest.mark.parametrize(("ratio", "nu", "nu_below"), [(4.0, 0.3, 0.3), (0.2, 0.2, 0.45)])
def test_the_closed_form_of_the_compliance(ratio, nu, nu_below):
    """Against an integration of the equations of elasticity over the depth."""
    q = np.array([0.1, 0.5, 1.0, 3.0])
    modulus, poisson = (lambda z: np.where(z < 1.0, 1.0, ratio)), (lambda z: np.where(z < 1.0, nu, nu_below))
    expected = transform(modulus, poisson, q, sharp=(1.0,))
    compliance = coated_compliance(q, ratio, nu, nu_below) * 2.0 * (1.0 - nu**2)
    assert compliance == pytest.approx(expected, rel=TRANSFORM_ERROR)


@pytest.mark.parametrize("radius", [0.5, 1.5, 3.0])
def test_the_load_on_a_homogeneous_solid_is_that_of_jkr(radius):
    expected = 4.0 / 3.0 * radius**3 - math.sqrt(8.0 * math.pi * radius**3)
    assert coated_load(radius, 1.0, 0.2, 0.3, 0.3) == pytest.approx(expected, rel=1e-12)


def test_finer_quadrature_changes_the_force_by_less_than_the_bound(monkeypatch):
    coarse = coated_pull_off(100.0, 0.3, 0.3, 0.3)
    for name, value in (("_POINTS", 20), ("_PHASE", 3.0), ("_PANEL", 0.2), ("_FIRST", 1e-4)):
        monkeypatch.setattr(coated_jkr, name, value)
    fine = coated_pull_off(100.0, 0.3, 0.3, 0.3)
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


def test_the_compliance_of_a_layer_is_that_published():
    expected = coated_compliance(np.array([0.1]), 4.0, 0.3, 0.3)[0]
    assert layer_compliance(0.1, 4.0, 0.3, 0.3) == pytest.approx(expected)
    assert layer_compliance(0.1, 4.0, 0.3, 0.31) != pytest.approx(expected)


@pytest.mark.heavy
@pytest.mark.parametrize("index", range(3))
def test_a_coated_solid_approaches_its_own_limit(index, committed):
    row = committed("layered_adhesion").query("check == 'coated JKR'").iloc[index]
    layer = row["modulus_ratio"], row["thickness"]
    value, u_num = extrapolated(TABOR_NUMBERS, [coated_force(*layer, mu) for mu in TABOR_NUMBERS])
    assert value == pytest.approx(row["found"], abs=u_num)
    # A coating that is one in a thousand thicker is told apart.
    thicker = coated_pull_off(layer[0], 1.001 * layer[1], 0.3, 0.3)["force"]
    assert abs(value - row["expected"]) <= u_num < abs(value - thicker)


def test_the_bound_of_the_limit_covers_a_neglected_term_and_the_bounds_of_the_forces():
    mu = np.array(TABOR_NUMBERS)
    value, u_num = extrapolated(mu, [(x, 1e-9) for x in 1.5 + np.log(mu) / mu**2 + (np.log(mu) / mu**2) ** 2])
    assert 1e-9 < abs(value - 1.5) <= u_num
    assert 1e-6 < extrapolated(mu, [(1.5 + x**-2, 1e-6) for x in mu])[1] < 1e-5
