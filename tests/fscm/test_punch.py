"""Punch shapes: closed forms, derivatives, checked properties."""

import math

import numpy as np
import pytest

from fscm._path import completeness
from fscm._path.continuation import equilibrium_path
from fscm._surface.adaptivity import adapted, indicator, resolving
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.state import rigid_state
from fscm.analysis import Analysis
from fscm.custom_punch import CustomPunch
from fscm.measured_punch import MeasuredPunch
from fscm.problem import Problem
from fscm.punch import unit_of_radii
from fscm.solver import solve
from tests.refusals import refused


def paraboloid(r):
    return 0.5 * r**2


@pytest.mark.parametrize(
    ("f", "df", "growth"),
    [
        (lambda r: r**1.5 / 1.5, np.sqrt, 1.5),
        (lambda r: r**5 / 5, lambda r: r**4, 5),
        (lambda r: r**2 / 2 + 0.1 * (1 - np.cos(3 * r)), lambda r: r + 0.3 * np.sin(3 * r), 2),
        # Dyadic steps at r = 32 would all fall near multiples of this wavelength.
        (lambda r: r**2 / 2 + 0.01 * (1 - np.cos(100 * r)), lambda r: r + np.sin(100 * r), 2),
    ],
)
def test_numerical_slope(f, df, growth):
    r = np.array([1e-2, 0.3, 1.0, 2.7, 4.0, 31.9, 32.0])
    punch = CustomPunch(f, growth)
    # Measured worst 3e-11, on the punch with 100 waves.
    np.testing.assert_allclose(punch.slope(r), df(r), rtol=1e-9)
    assert punch.slope(r.reshape(7, 1)).shape == (7, 1)
    np.testing.assert_array_equal(CustomPunch(f, growth, df).slope(r), df(r))


# An array of one radius is a number for older versions of NumPy, which warn.
@pytest.mark.filterwarnings("ignore:Conversion of an array:DeprecationWarning")
def test_functions_that_break_a_promise_are_refused():
    for f, growth, reason in (
        (np.log1p, 1.0, "does not grow"),
        (lambda r: 0.0 * r, 1.0, "does not grow"),
        (lambda r: -(r**2), 2.0, "does not grow"),
        (np.expm1, 2.0, "not the exponent"),
        (lambda r: r**2, 1.9, "not the exponent"),
        (lambda r: r**2, math.nan, "growth"),
        (lambda r: r**2, "2", "growth"),
        (lambda r: 1.0 + r, 1.0, "subtract"),
        (lambda r: r**2 / (r > 0.01), 2.0, "finite"),
        (lambda r: 1.0, 1.0, "shape"),
        (math.sqrt, 0.5, "array"),
    ):
        refused(reason, CustomPunch, f, growth)
    refused("not the slope", CustomPunch, paraboloid, 2.0, lambda r: 1.01 * r)


class Step:
    """A punch that is 2 higher everywhere but at its very tip."""

    growth = 2.0

    def __init__(self):
        self.evaluations = 0

    def height(self, r):
        self.evaluations += 1
        assert self.evaluations < 10_000
        return np.where(r > 0.0, 2.0 + r**2, 0.0)

    def slope(self, r):
        return 2.0 * r


def test_the_unit_of_radii_of_a_step_is_found_in_a_bounded_number_of_evaluations():
    n, Q = unit_of_radii(Step(), 1.0)
    assert n == 2.0
    assert 0.0 < Q < 1e-50


def test_a_steep_profile_with_kinks_is_continuous_in_its_growth():
    """Above a growth of 10 the deformations are the unknowns, below it the gaps."""
    forces = [
        solve(Problem(2, 0.2, 0.5, punch=MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.3, 1.6], growth)), "pull_off_force")
        for growth in (10.0, 10.0 + 1e-9)
    ]
    assert abs(forces[1].value - forces[0].value) <= forces[0].u_num + forces[1].u_num


def test_a_step_over_kinks_moves_the_gaps_by_the_exact_height():
    punch = MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.3, 1.6])
    state = next(iter(equilibrium_path(Problem(2, 0.2, 0.5, punch=punch), 8, 1e-4))).state
    new = state.shifted(np.zeros_like(state.gap), 0.0, 0.1)
    assert new.scale == pytest.approx(state.scale * math.exp(0.1))
    change = punch.height(new.radius) - punch.height(state.radius) - 0.1 * state.radius * punch.slope(state.radius)
    inner = punch.height(new.radius) < 1e6
    np.testing.assert_allclose((new.gap - state.gap)[inner], change[inner], rtol=1e-9, atol=1e-9)


def test_a_mesh_ends_panels_only_at_rows_that_the_pressure_needs():
    """The path has fewer panels than there are rows; the value and its bound are as with an end at nearly each."""
    r = np.linspace(0.0, 20.0, 50)
    problem = Problem(2, 0.0, 0.5, MeasuredPunch(r, r**2 / 2))
    analysis = Analysis(problem)
    force, finer = analysis.solution("pull_off_force"), solve(problem, "pull_off_force", accuracy=1e-10)
    assert max(len(point.state.disc.mesh.lengths) for point in analysis.points) < 0.7 * len(r)
    # A kink that counts with its effect, not with the root of it, makes this bound 30 times as large.
    assert force.u_num < 1e-9
    assert abs(force.value - finer.value) <= force.u_num + finer.u_num


def test_states_between_which_turning_points_are_looked_for_resolve_kinks(monkeypatch):
    """A mesh that moves over kinks leaves the square of this: 1e-10 of the load."""
    resolved_to = []

    def noted(state, control, tolerance):
        found = adapted(state, control, tolerance)
        resolved_to.append(float(np.max(indicator(found))))
        return found

    monkeypatch.setattr(completeness, "adapted", noted)
    r = np.linspace(0.0, 20.0, 25)
    Analysis(Problem(2, 0.0, 1.0, MeasuredPunch(r, r**2 / 2))).solution("pull_off_force")
    assert resolved_to
    assert max(resolved_to) <= 1e-5


def test_a_panel_ends_at_kinks_between_its_nodes():
    """A ridge so narrow that no node of a coarse mesh is on it."""
    ridge = np.array([1.0, 1.01, 1.02])

    def height(r):
        return r**2 / 2 + np.interp(r, ridge, [0.0, 0.05, 0.0])

    punch = CustomPunch(height, 2.0, kinks=ridge)
    problem = Problem(2, 0.0, 0.5, punch)
    mesh = PanelMesh(np.array([0.0, 0.5, 2.0, 8.0, 2e3]), 8)
    assert not np.any((mesh.nodes > ridge[0]) & (mesh.nodes < ridge[-1]))
    state = rigid_state(Discretisation(problem, mesh), 0.5)
    split = resolving(state, mesh, 1e-5, lambda new: height(new.nodes) + 0.5)
    assert set(ridge) <= set(split.breaks)
