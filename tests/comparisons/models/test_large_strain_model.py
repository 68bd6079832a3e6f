"""The finite elements with finite strain as a model: its curve, the bound of that, and what it refuses."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
from comparisons.description.strain_errors import ball_on
from comparisons.models.fem_model import LargeStrain
from comparisons.numerics.curve_distance import curve_distance

GEL = ball_on(5e-3, 2.0, 0.3)

#: Largest bound of a curve (measured: 1.0e-5 for nu = 0.3 and 0.5, w/(E* R) = 5e-3 and mu = 2).
LARGEST_BOUND = 3e-5


def test_the_bound_of_a_curve_is_the_largest_of_its_points_in_parts_of_the_picture(monkeypatch):
    units = GEL.units
    zeros = np.zeros(3)
    path = SimpleNamespace(
        displacement=np.array([-4.0, -2.0, 0.0]) * units["displacement"],
        load=np.array([0.0, -1.0, 1.0]) * units["load"],
        central_gap=zeros,
        edge_radius=zeros,
        u_displacement=np.array([0.0, 0.012, 0.0]) * units["displacement"],
        u_load=np.array([0.0, 0.008, 0.009]) * units["load"],
    )
    monkeypatch.setattr(fem_reference, "trace_large_strain", lambda body, interaction: path)
    curve = LargeStrain().curve(GEL)
    assert curve.displacement == pytest.approx([-4.0, -2.0, 0.0])
    assert curve.load == pytest.approx([0.0, -1.0, 1.0])
    assert curve.u_distance == pytest.approx(math.hypot(0.003, 0.004))


@pytest.mark.heavy
def test_a_curve_on_finer_meshes_is_within_both_bounds(monkeypatch):
    curve = LargeStrain().curve(GEL)
    assert curve.u_distance < LARGEST_BOUND
    trace = fem_reference.trace_large_strain
    monkeypatch.setattr(fem_reference, "trace_large_strain", lambda body, interaction: trace(body, "default"))
    finer = LargeStrain().curve(GEL)
    distance = curve_distance(curve.displacement, curve.load, finer.displacement, finer.load)
    assert distance.value <= curve.u_distance + finer.u_distance + distance.u_interpolation


def test_the_solver_gets_the_tension_of_a_problem_and_no_friction_or_second_body(monkeypatch):
    posed = []

    def solve_large_strain(body, quantity, interaction):
        posed.append(body.solid)
        return SimpleNamespace(value=1.0, u_num=0.1, unknowns=1, iterations=0)

    monkeypatch.setattr(fem_reference, "solve_large_strain", solve_large_strain)
    for nu in (0.3, 0.5):
        gel = ball_on(5e-3, 2.0, nu).with_value("solid.surface_tension", 0.3)
        assert LargeStrain().skip(gel, "pull_off_force") is None
        LargeStrain().evaluate(gel, "pull_off_force")
    assert [(solid.nu, solid.surface_tension) for solid in posed] == [(0.3, 0.3), (0.5, 0.3)]
    bonded = GEL.with_value("solid.friction", "bonded")
    assert "solid.friction" in LargeStrain().skip(bonded, "pull_off_force")
    pair = replace(GEL, punch_solid=GEL.solid)
    assert "punch_solid" in LargeStrain().skip(pair, "pull_off_force")
