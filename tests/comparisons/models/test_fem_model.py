"""The finite elements as a model: units, Poisson's ratio, bounds, surfaces at pull-off, and what they refuse."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.model import NotApplicable
from comparisons.models.fem_model import _LEVELS, _SCALES, FiniteElements
from comparisons.numerics.curve_distance import curve_distance, mesh_difference
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.registry import create

PROBLEM = Problem.dimensionless(n=2, k=0.4, mu=0.5)

#: Largest distance as a fraction of the picture; measured 2e-7 (gap) and 2e-5 (pressure, whose reference is a spline
#: between its nodes).
GAP, PRESSURE = 2e-6, 1e-4


def test_curves_and_surfaces_are_in_units_of_the_problem_with_the_distance_of_two_meshes_as_their_bound(monkeypatch):
    units, x = FiniteElements()._scaled(PROBLEM).units, np.linspace(0.0, 1.0, 60)

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


@pytest.mark.parametrize("quantity", fem_reference.QUANTITIES)
def test_the_solver_gets_the_same_tabor_number_and_returns_the_same_unit(monkeypatch, quantity):
    def one_unit(body, name):
        solid, punch, law = body.solid, body.punch, body.law
        physical = fscm.Problem(
            fscm.PowerLaw(solid.E0, solid.c0, solid.k, solid.nu),
            fscm.PowerPunch(punch.n, punch.Q),
            fscm.LennardJones(law.work_of_adhesion, law.z0),
        )
        assert (physical.mu, solid.nu, name) == (pytest.approx(0.8, rel=1e-13), 0.2, quantity)
        unit = physical.units[QUANTITIES[name].scale]
        return fem_reference.Solution(2.5 * unit, 0.5 * unit, 9, 8, 7e-16, 0.6, (4, 6, 7), (2.5 * unit,) * 3)

    monkeypatch.setattr(fem_reference, "solve", one_unit)
    result = create("fem", 0.2).evaluate(Problem.dimensionless(1.5, 0.4, 0.8), quantity)
    assert (result.value, result.u_num) == (pytest.approx(2.5), pytest.approx(0.5))
    assert (result.size, result.iterations, result.residual) == (9, 8, 7e-16)


def test_the_critical_tabor_number_is_that_of_the_modulus_and_has_the_bound_of_its_softer_end(monkeypatch):
    calls = []

    def solve(body, quantity):
        calls.append((body.solid.k, body.solid.nu, body.punch.Q, quantity))
        return fem_reference.Solution(12.0, 0.6, 9, 3, 1e-12, 0.1, (4, 6, 7), (12.0, 12.0, 12.0))

    monkeypatch.setattr(fem_reference, "solve", solve)
    result = FiniteElements().evaluate(PROBLEM, "critical_tabor_number")
    assert calls == [(0.4, 0.3, _SCALES["Q"], "critical_modulus")]

    def tabor_number(E0):
        solid = fscm.PowerLaw(E0, _SCALES["c0"], 0.4, 0.3)
        law = fscm.LennardJones(_SCALES["work_of_adhesion"], _SCALES["z0"])
        return fscm.Problem(solid, fscm.PowerPunch(2, _SCALES["Q"]), law).mu

    assert result.value == pytest.approx(tabor_number(12.0), rel=1e-14)
    assert result.value + result.u_num == pytest.approx(tabor_number(11.4), rel=1e-14)
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
    ("problem", "quantity", "reason"),
    [
        (Problem.dimensionless(0.9, 0, 1), "pull_off_force", "n >= 1"),
        (Problem.dimensionless(2, 0.95, 1), "pull_off_force", "k <= 0.9, not k = 0.95"),
        (Problem.dimensionless(2, 0, 1), "contact_radius", "does not compute contact_radius"),
    ],
)
def test_what_the_finite_elements_do_not_do(problem, quantity, reason):
    with pytest.raises(NotApplicable, match=reason):
        FiniteElements().evaluate(problem, quantity)
    assert FiniteElements().physical(Problem.dimensionless(1, 0.9, 1))[1].punch.n == 1.0
