"""The solvers as models: units, bounds, refusals; of the finite elements also surfaces and Poisson's ratio."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fem_model import _LEVELS, FiniteElements, _surface_at_pull_off
from comparisons.models.fscm_model import StieltjesModel
from comparisons.numerics.curve_distance import curve_distance, mesh_difference
from comparisons.problem import Problem
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import create


@pytest.fixture(autouse=True)
def no_surface_of_another_test():
    """The model keeps its last surface, which here may be of other meshes or of a stub."""
    _surface_at_pull_off.cache_clear()
    yield
    _surface_at_pull_off.cache_clear()


def test_the_curve_of_the_reference_holds_its_own_pull_off():
    curve = create("fscm").curve(Problem.dimensionless(2, 0.4, 1))
    assert -curve.load.min() == pytest.approx(1.78848171, rel=1e-3)
    assert 0.0 < curve.u_distance < 1e-6


def test_both_fields_end_at_the_same_gap_and_have_their_own_bound():
    model, problem = create("fscm"), Problem.dimensionless(n=2, k=0.4, mu=0.5)
    pressure, gap = (CURVES[name].evaluate(model, problem) for name in ("pull_off_pressure", "pull_off_gap"))
    surface = model.pull_off_profile(problem)
    assert pressure.x == gap.x
    assert max(gap.y) <= 10 < max(surface.gap)
    assert (pressure.u_distance, gap.u_distance) == (surface.u_distance, surface.u_gap_distance)
    # The gap determines the pressure (Eq. 9).
    assert pressure.y == pytest.approx(problem.posed.law.traction(np.array(gap.y)).tolist())


@pytest.mark.parametrize(("name", "package"), [("fscm", fscm), ("fem", fem_reference)])
def test_a_solver_that_does_not_converge_has_failed(monkeypatch, name, package):
    def stuck(*_, **__):
        raise package.NotConverged("50 iterations were not enough")

    monkeypatch.setattr(package, "solve", stuck)
    monkeypatch.setattr(package, "trace", stuck)
    model, problem = create(name), Problem.dimensionless(2, 0, 1)
    for call in (lambda: model.evaluate(problem, "pull_off_force"), lambda: model.curve(problem)):
        with pytest.raises(ComputationFailed, match="50 iterations"):
            call()


def test_the_stieltjes_scheme_ends_in_compression_or_at_its_last_gap(monkeypatch):
    assert [create(name).segments for name in ("fscm-stieltjes", "fscm-stieltjes-400")] == [2500, 400]
    monkeypatch.setattr(StieltjesModel, "segments", 60)
    for n, k, mu, end in ((1, 0.2, 0.1, -0.4), (2, 0.4, 0.5, None)):
        curve = StieltjesModel().curve(Problem.dimensionless(n, k, mu))
        gap = curve.columns["central_gap"]
        assert gap[0] == 10.0
        assert gap[-1] == end or (curve.load[-1] > 0.0 >= curve.load[-2] and gap[-1] > -0.4)


def test_a_result_of_the_atlas_is_that_of_the_function():
    for quantity in QUANTITIES:
        result = create("atlas").evaluate(Problem.dimensionless(n=2.5, k=0.3, mu=2.0), quantity)
        assert (result.value, result.u_num) == fscm.atlas(2.5, 0.3, 2.0, quantity)


PROBLEM = Problem.dimensionless(n=2, k=0.4, mu=0.5)

#: Largest distance as a fraction of the picture; measured 2e-7 (gap) and 2e-5 (pressure, whose reference is a spline
#: between its nodes).
GAP, PRESSURE = 2e-6, 1e-4


def test_curves_and_surfaces_are_in_units_of_the_problem_with_the_distance_of_two_meshes_as_their_bound(monkeypatch):
    units, x = FiniteElements().physical(PROBLEM)[0], np.linspace(0.0, 1.0, 60)

    def of_level(body, accuracy):
        scale = {"quick": 1.01, "default": 1.0}[accuracy]
        return SimpleNamespace(
            displacement=x * units["displacement"],
            load=scale * (3.0 * x - 1.0) * units["load"],
            central_gap=x,
            edge_radius=x,
            radius=3.0 * x * units["radius"],
            pressure=-x * units["traction"],
            gap=scale * 12.0 * x * units["gap"],
        )

    monkeypatch.setattr(fem_reference, "trace", of_level)
    monkeypatch.setattr(fem_reference, "profile", of_level)
    curve, surface = FiniteElements().curve(PROBLEM), FiniteElements().pull_off_profile(PROBLEM)
    ends = curve.displacement[-1], curve.load[0], surface.radius[-1], surface.pressure[-1], surface.gap[-1]
    assert ends == pytest.approx((1.0, -1.0, 3.0, -1.0, 12.0), rel=1e-13)
    coarse = curve.displacement, 1.01 * curve.load
    assert curve.u_distance == pytest.approx(mesh_difference(*coarse, curve.displacement, curve.load), rel=1e-9)
    assert surface.u_gap_distance > 1e-3 > 1e-12 > surface.u_distance


def of_fscm(body, E0=None):
    """The problem of the finite elements, perhaps with another modulus, as one of the FSCM."""
    solid = fscm.PowerLaw(E0 or body.solid.E0, body.solid.c0, body.solid.k, body.solid.nu)
    law = fscm.LennardJones(body.law.work_of_adhesion, body.law.z0)
    return fscm.Problem(solid, fscm.PowerPunch(body.punch.n, body.punch.Q), law)


@pytest.mark.parametrize("quantity", fem_reference.QUANTITIES)
def test_the_solver_gets_the_same_tabor_number_and_returns_the_same_unit(monkeypatch, quantity):
    def one_unit(body, name):
        physical = of_fscm(body)
        assert (physical.mu, body.solid.nu, name) == (pytest.approx(0.8, rel=1e-13), 0.2, quantity)
        unit = physical.units[QUANTITIES[name].scale]
        return fem_reference.Solution(2.5 * unit, 0.5 * unit, 9, 8, 7e-16, 0.6, (4, 6, 7), (2.5 * unit,) * 3)

    monkeypatch.setattr(fem_reference, "solve", one_unit)
    result = create("fem", 0.2).evaluate(Problem.dimensionless(1.5, 0.4, 0.8), quantity)
    assert (result.value, result.u_num) == (pytest.approx(2.5), pytest.approx(0.5))
    assert (result.size, result.iterations, result.residual) == (9, 8, 7e-16)


def test_the_critical_tabor_number_is_that_of_the_modulus_and_has_the_bound_of_its_softer_end(monkeypatch):
    calls = []

    def solve(body, quantity):
        calls.append((body, quantity))
        return fem_reference.Solution(12.0, 0.6, 9, 3, 1e-12, 0.1, (4, 6, 7), (12.0, 12.0, 12.0))

    monkeypatch.setattr(fem_reference, "solve", solve)
    result = FiniteElements().evaluate(PROBLEM, "critical_tabor_number")
    ((body, quantity),) = calls
    assert (body.solid.k, body.solid.nu, quantity) == (0.4, 0.3, "critical_modulus")
    assert result.value == pytest.approx(of_fscm(body, 12.0).mu, rel=1e-14)
    assert result.value + result.u_num == pytest.approx(of_fscm(body, 11.4).mu, rel=1e-14)
    # mu is ignored.
    assert FiniteElements().evaluate(PROBLEM.at({"mu": 1e-9}), "critical_tabor_number") == result


@pytest.mark.heavy
@pytest.mark.parametrize("levels", [("quick", "quick"), _LEVELS], ids=str)
def test_gap_and_pressure_at_pull_off_are_those_of_the_integral_equation(monkeypatch, levels):
    """On the coarsest meshes, which keep the limits too, and on those of the model."""
    monkeypatch.setattr("comparisons.models.fem_model._LEVELS", levels)
    monkeypatch.setattr(fem_reference, "profile", cache(fem_reference.profile))
    elements, reference = (create(name).pull_off_profile(PROBLEM) for name in ("fem", "fscm"))
    for name, limit in (("gap", GAP), ("pressure", PRESSURE)):
        assert curve_distance(*elements.shown(name)[:2], *reference.shown(name)[:2]).value < limit
    assert levels[0] == levels[1] or 0 < elements.u_gap_distance < 1e-4
    assert 0 < reference.u_gap_distance < 1e-5


@pytest.mark.parametrize(
    ("model", "n", "k", "mu", "quantity", "reason"),
    [
        ("fem", 0.9, 0, 1, "pull_off_force", "n >= 1"),
        ("fem", 2, 0.95, 1, "pull_off_force", "k <= 0.9, not k = 0.95"),
        ("fem", 2, 0, 1, "contact_radius", "does not compute contact_radius"),
        ("atlas", 2, 0.4, 11, "pull_off_force", r"mu = 11 is outside \[0.01, 10\]"),
        ("atlas", 2, 0, 0.3, "jump_in_gap", "critical Tabor number 0.69"),
        ("fscm", 2, 0, 0.3, "jump_in_gap", "critical Tabor number"),
        ("fscm-stieltjes-400", 2, 0.4, 0.5, "hysteresis_energy", "does not compute"),
        ("fscm-stieltjes-400", 2, 1, 0.5, "pull_off_force", "k < 1, not k = 1"),
    ],
)
def test_what_the_solvers_do_not_do(model, n, k, mu, quantity, reason):
    with pytest.raises(NotApplicable, match=reason):
        create(model).evaluate(Problem.dimensionless(n, k, mu), quantity)
    assert FiniteElements().physical(Problem.dimensionless(1, 0.9, 1))[1].punch.n == 1.0
