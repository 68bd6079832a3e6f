"""The finite elements as a model: surfaces at pull-off beside the integral equation, and the audit of their bound."""

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.models.fem_model import _LEVELS, _SCALES, FiniteElements
from comparisons.models.fscm_model import FullSelfConsistent
from comparisons.numerics.curve_distance import curve_distance, mesh_difference
from comparisons.problem import Problem
from comparisons.quantities import CURVES
from comparisons.quantities.points import near

PROBLEM = Problem.dimensionless(n=2, k=0.4, mu=0.5)

#: Largest distance as a fraction of the picture; measured 2e-7 (gap) and 2e-5 (pressure, whose reference is a spline
#: between its nodes).
GAP, PRESSURE = 2e-6, 1e-4


def test_the_uncertainty_of_a_curve_is_the_distance_of_two_levels_and_its_points_are_of_the_finer(monkeypatch):
    def trace(body, level):
        load = np.linspace(-1.0, 2.0, 40) * {"quick": 1.01, "default": 1.0}[level]
        return SimpleNamespace(displacement=np.linspace(0, 1, 40), load=load, central_gap=load, edge_radius=load)

    monkeypatch.setattr(fem_reference, "trace", trace)
    curve = FiniteElements().curve(PROBLEM)
    assert curve.load.max() == pytest.approx(-2.0 * curve.load.min(), rel=1e-12)
    coarse = curve.displacement, 1.01 * curve.load
    assert curve.u_distance == pytest.approx(mesh_difference(*coarse, curve.displacement, curve.load), rel=1e-9)
    assert curve.u_distance > 1e-3


def test_the_critical_tabor_number_is_that_of_the_modulus_and_has_the_bound_of_its_softer_end(monkeypatch):
    asked = []

    def solve(body, quantity):
        asked.append((body, quantity))
        return fem_reference.Solution(12.0, 0.6, 9, 3, 1e-12, 0.1, (4, 6, 7), (12.0, 12.0, 12.0))

    monkeypatch.setattr(fem_reference, "solve", solve)
    result = FiniteElements().evaluate(PROBLEM, "critical_tabor_number")
    body, quantity = asked[0]

    def tabor_number(E0):
        solid = fscm.PowerLaw(E0, _SCALES["c0"], 0.4, 0.3)
        law = fscm.LennardJones(_SCALES["work_of_adhesion"], _SCALES["z0"])
        return fscm.Problem(solid, fscm.PowerPunch(2, _SCALES["Q"]), law).mu

    assert quantity == "critical_modulus"
    assert (body.solid.k, body.solid.nu, body.punch.Q) == (0.4, 0.3, _SCALES["Q"])
    assert result.value == pytest.approx(tabor_number(12.0), rel=1e-14)
    assert result.value + result.u_num == pytest.approx(tabor_number(11.4), rel=1e-14)
    assert result.value - result.u_num < tabor_number(12.6)
    # mu is ignored.
    assert FiniteElements().evaluate(PROBLEM.at({"mu": 1e-9}), "critical_tabor_number") == result


@pytest.mark.heavy
@pytest.mark.parametrize("levels", [("quick", "quick"), pytest.param(_LEVELS, marks=pytest.mark.heavy)], ids=str)
def test_gap_and_pressure_at_pull_off_are_those_of_the_integral_equation(monkeypatch, levels):
    """On the coarsest meshes, which keep the limits too, and in the heavy test on those of the model."""
    monkeypatch.setattr("comparisons.models.fem_model._LEVELS", levels)
    monkeypatch.setattr(fem_reference, "profile", cache(fem_reference.profile))
    fem, fscm = (model.pull_off_profile(PROBLEM) for model in (FiniteElements(), FullSelfConsistent()))
    for name, limit in (("gap", GAP), ("pressure", PRESSURE)):
        points = [near(p.gap, p.radius, getattr(p, name)) for p in (fem, fscm)]
        assert curve_distance(*points[0], *points[1]).value < limit
    assert levels[0] == levels[1] or 0 < fem.u_gap_distance < 1e-4
    assert 0 < fscm.u_gap_distance < 1e-5


def test_both_shapes_are_cut_at_the_same_gap():
    model = FullSelfConsistent()
    pressure, gap = (CURVES[name].evaluate(model, PROBLEM) for name in ("pull_off_pressure", "pull_off_gap"))
    assert pressure.x == gap.x
    assert max(gap.y) <= 10 < max(model.pull_off_profile(PROBLEM).gap)
    # The gap determines the pressure (Eq. 9).
    assert pressure.y == pytest.approx(PROBLEM.posed.law.traction(np.array(gap.y)).tolist())
