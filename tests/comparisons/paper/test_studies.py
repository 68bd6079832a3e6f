"""Studies beyond the paper: errors over their range, other solids by both references, coated solids against JKR."""

import math

import numpy as np
import pandas as pd
import pytest

import fscm
from comparisons.paper.studies.error_maps import errors_along
from comparisons.paper.studies.finite_strain import meeting_points
from comparisons.paper.studies.graded_solids import (
    SERIES,
    by_elements,
    by_fscm,
    case_of,
    equivalent_of,
    number_of,
    of_power_law,
)
from comparisons.paper.tasks import quantity
from fscm import Coating
from tests.solvers.layered_jkr import Stack, minima_with_error

NU = 0.3


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


@pytest.mark.parametrize("kind", [pytest.param("exponential", marks=pytest.mark.heavy), "coating"])
def test_the_equivalent_power_law_of_a_thin_layer_is_that_of_the_depth(kind):
    """What is left is the share of the depth in the lengths of the contact."""
    assert equivalent_of(kind, 1e-6) == pytest.approx(case_of(kind, 1e-6).depth, abs=1e-5)


def coated(ratio, thickness):
    """A coating on a substrate so many times as stiff; lengths in (w R^2/E*)^(1/3), E* of the coating."""
    return Stack(((1.0 - NU**2, NU, thickness),), ((1.0 - NU**2) * ratio, NU))


def derived(ratio, thickness):
    """The pull-off force of JKR in pi w R."""
    return -min(state.load for state in minima_with_error(coated(ratio, thickness), 1.0, 1.0)) / math.pi


def limit(mu, forces):
    """The constant beside mu^-2 ln mu, mu^-2, mu^-3 ln mu and mu^-3, and the bound that those of the forces give it."""
    log = np.log(mu)
    terms = np.stack([np.ones_like(mu), log / mu**2, 1.0 / mu**2, log / mu**3, 1.0 / mu**3], axis=1)
    weights = np.linalg.inv(terms)[0]
    return weights @ forces[:, 0], np.abs(weights) @ forces[:, 1]


@pytest.mark.heavy
@pytest.mark.parametrize(("ratio", "thickness"), [(1.0, 0.5), (4.0, 0.5), (0.25, 0.5), (100.0, 0.3)])
def test_a_coated_solid_approaches_its_own_limit(ratio, thickness):
    """The cohesive zone is about L mu^(-3/2) wide, and its tension decays so slowly that a logarithm remains."""
    mu = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
    solids = [Coating(1.0, ratio, thickness * x**0.5, 0.0, NU) for x in mu]
    solutions = [
        fscm.solve(fscm.Problem(2.0, 0.0, x, graded=solid), "pull_off_force")
        for x, solid in zip(mu, solids, strict=True)
    ]
    forces = np.array([(solution.value, solution.u_num) for solution in solutions])
    (before, _), (value, u_forces) = limit(mu[:-1], forces[:-1]), limit(mu[1:], forces[1:])
    bound = abs(value - before) + u_forces
    assert abs(value - derived(ratio, thickness)) <= bound < 1e-5
    # A coating that is one in a thousand thicker is told apart.
    assert ratio == 1.0 or abs(value - derived(ratio, 1.001 * thickness)) > bound


def test_geometry_and_strain_cancel_where_their_parts_are_equal():
    """kappa = 2 x^2 - 0.1 x of the root x vanishes at 0.05; the bound 1e-3 x moves it by 5e-4."""
    x = np.linspace(0.01, 0.2, 8)
    line = pd.DataFrame({"elasto_adhesion_number": x**3, "kappa": 2 * x**2 - 0.1 * x, "u_kappa": 1e-3 * x})
    with_error = line.assign(nu=0.3, kappa=line["kappa"] + 0.2 * x)
    table = pd.concat([line.assign(nu=0.5), with_error]).assign(model="fscm", mu=1.0)
    never, once = meeting_points(table).itertuples()
    roots = np.cbrt([once.elasto_adhesion_number, once.lowest, once.highest])
    assert roots == pytest.approx([0.05, 0.0495, 0.0505])
    assert math.isnan(never.elasto_adhesion_number)
