"""Meshes along a path: completeness, small spots and narrow edges, and meshes of their own for uncertain events."""

from dataclasses import replace
from functools import partial
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import fem_reference
import fem_reference.solution as solution_module
from fem_reference._contact import completeness
from fem_reference._contact import event_mesh as event_mesh_module
from fem_reference._contact.completeness import complete_path, displacement_range
from fem_reference._contact.event_mesh import EventMesh, chosen, event_mesh
from fem_reference._contact.events import PathEvents
from fem_reference._contact.meshes import Meshes
from fem_reference.accuracy import level_for
from fem_reference.quantities import TABLE
from tests.fem_reference.analytic_branch import AnalyticBranch
from tests.fem_reference.solved_together import problem_with, sphere_on
from tests.marks import heavy
from tests.refusals import refused

FORCE, JUMP_IN, JUMP_OUT = NAMES = ("pull_off_force", "jump_in_displacement", "jump_out_displacement")
ROWS = {name: TABLE[name] for name in NAMES}
LAW = fem_reference.LennardJones(1.0, 1.0)
GRADED = sphere_on(fem_reference.Exponential(3.0, 1.0, 5.0, 0.1))
#: Of a power punch, n = 5, on a solid that softens: by both references, all digits shown.
ZERO_LOAD = 0.42243083
CONE = replace(GRADED, solid=fem_reference.Exponential(0.9, 0.3, 5.0, 0.1), punch=fem_reference.PowerPunch(1.0, 1.0))


def _own(problem, points, missed=(), monkeypatch=None):
    """Quantities that get a mesh of their own, from which events are resolved on that of the first."""
    resolved = {"pull_off": False, **points}
    monkeypatch.setattr(event_mesh_module, "edge_is_resolved", lambda event: resolved[event])
    monkeypatch.setattr(EventMesh, "events", SimpleNamespace(at=lambda event: event))
    mesh = EventMesh(SimpleNamespace(meshes=Meshes(problem, level_for("quick"))), "the mesh", 1.0, "pull_off")
    solved = {name: None for name in NAMES if name not in missed}
    return list(solution_module._unresolved(mesh, ROWS, solved, missed))


def test_a_quantity_whose_edge_is_not_resolved_or_that_is_missed_gets_its_own_mesh(monkeypatch):
    names = partial(_own, GRADED, monkeypatch=monkeypatch)
    assert names({"jump_in": True, "jump_out": False}) == [JUMP_OUT]
    assert names({"jump_in": True, "jump_out": True}, {JUMP_OUT: fem_reference.NotConverged()}) == [JUMP_OUT]
    # The mesh of the first event is its own.
    assert names({"jump_in": True, "jump_out": True}) == []
    # The mesh of the jump out of contact serves the other one, which has no contact edge.
    assert names({"jump_in": False, "jump_out": False}) == [JUMP_OUT, JUMP_IN]
    # One mesh serves every event of a solid that scales, unless it misses one.
    scaling = partial(_own, replace(GRADED, solid=fem_reference.PowerLaw(1.0, 1.0, 0.4, 0.3)), monkeypatch=monkeypatch)
    assert scaling({"jump_in": False, "jump_out": False}) == []
    assert scaling({"jump_in": False, "jump_out": False}, {JUMP_OUT: fem_reference.NotConverged()}) == [JUMP_OUT]


def test_every_order_of_quantities_finds_the_events_after_a_jump_before_contact():
    """The path of that jump ends before contact."""
    offset = sphere_on(fem_reference.OffsetPowerLaw(0.91, 1.0, 0.4, 1.0, 0.3))
    orders = ("jump_in_gap", FORCE), (FORCE, "jump_in_gap")
    results = [fem_reference.solve_together(offset, names, "quick") for names in orders]
    assert [tuple(together) for together in results] == list(orders)
    assert [together[FORCE].value for together in results] == [fem_reference.solve(offset, FORCE, "quick").value] * 2
    gap, other_gap = (together["jump_in_gap"] for together in results)
    assert 0.0 < gap.value == pytest.approx(other_gap.value, abs=gap.u_num + other_gap.u_num)


@pytest.mark.heavy
def test_the_bound_of_a_second_event_holds():
    """On the mesh of the pull-off the three values at zero load turn back, 1.4 bounds from the value."""
    problem = fem_reference.Problem(
        fem_reference.Exponential(2.0, 1.0, 2.0, 0.3), fem_reference.PowerPunch(5.0, 1.0), LAW
    )
    zero_load = fem_reference.solve_together(problem, (FORCE, "zero_load_displacement"), "quick")[
        "zero_load_displacement"
    ]
    assert zero_load.value == pytest.approx(ZERO_LOAD, abs=zero_load.u_num + 1e-8)
    assert zero_load.u_num < 1e-6


@pytest.mark.heavy
def test_the_jumps_of_a_cone_are_as_certain_together_as_alone():
    """On the mesh of the pull-off the jump out of contact is not found on all densities."""
    together = fem_reference.solve_together(CONE, NAMES, "quick")
    assert all(together[name].u_num <= 1e-4 * abs(together[name].value) for name in NAMES)
    alone = fem_reference.solve(CONE, JUMP_OUT, "quick")
    assert abs(alone.value - together[JUMP_OUT].value) <= alone.parts["rounding"] + together[JUMP_OUT].parts["rounding"]


#: The edge is 1e-10 of its radius wide.
UNRESOLVED = problem_with(0.8778961468202925, 5.103826446508255, 1.8234594621046147, 0.3894883306671959)

#: Of a cone at k = 0 by its Tabor number, by the integral equation; all digits shown.
JUMP_OUT_GAPS = {2.0: -0.03323081, 3.0: -0.03186462}


def test_an_edge_that_no_mesh_resolves_is_refused():
    with pytest.raises(fem_reference.NotConverged, match="of its radius, and the smallest that are meshed"):
        fem_reference.solve(UNRESOLVED, "pull_off_force", "quick")


@pytest.mark.heavy
def test_an_edge_that_does_not_settle_is_searched_with_a_mesh_for_each_radius():
    """A flat end whose edge has the curvature radius 1: the deepest load was elsewhere on each mesh."""

    def outside(r):
        return np.maximum(r - 0.05, 0.0)

    punch = fem_reference.CustomPunch(lambda r: outside(r) ** 2 / 2.0, 2.0, outside, kinks=(0.05,))
    problem = fem_reference.Problem(
        fem_reference.PowerLaw(1.0, 1.0, 0.3, 0.3), punch, fem_reference.LennardJones(0.0005, 0.004)
    )
    mesh = event_mesh(Meshes(problem, level_for("quick")), ("pull_off",))
    assert mesh.event == "pull_off"
    assert mesh.spec.edge_width > 1e-3
    finest = mesh.events
    assert finest.at("pull_off").edge_radius == pytest.approx(mesh.size, rel=0.01)
    assert finest.at("pull_off").state.load == pytest.approx(-3.7757154e-3, rel=1e-5)


@pytest.mark.parametrize("mu", [2.0, *heavy(3.0)])
def test_the_gap_under_the_tip_of_a_cone_is_certain(mu):
    """The pressure is singular there: with elements at the tip like those of a sphere the bound was 9 % of the gap."""
    gap = fem_reference.solve(problem_with(0.0, mu, n=1.0), "jump_out_gap", "quick")
    assert gap.u_num <= 1e-3 * abs(gap.value)
    assert gap.value == pytest.approx(JUMP_OUT_GAPS[mu], abs=gap.u_num)


@pytest.mark.parametrize("shift", [0.0, 0.013, 0.4])
def test_a_hidden_pair_of_turning_points_is_found(shift):
    """A fall over 0.1 of the parameter, in samples 0.8 apart between which the function rises."""
    turns = np.array([shift - 0.05, shift + 0.05])
    slope = Polynomial.fromroots(turns) * Polynomial([1.0, 0.1, 0.02])
    branch = AnalyticBranch(slope.integ(), [0.0, 1.0])
    points = branch.points(np.arange(-2.2, 2.3, 0.8))
    assert all(point.displacement_rate > 0 for point in points)
    complete = complete_path(points)
    changes = [
        (a.parameter, b.parameter) for a, b in pairwise(complete) if a.displacement_rate * b.displacement_rate < 0
    ]
    assert len(changes) == 2
    for (low, high), turn in zip(changes, turns, strict=True):
        assert low <= turn <= high


def test_a_path_that_stays_undecided_is_refused(monkeypatch):
    slope = Polynomial.fromroots([0.0, 1e-3]) * Polynomial([1.0, 0.1, 0.02])
    points = AnalyticBranch(slope.integ(), [0.0, 1.0]).points(np.arange(-2.2, 2.3, 0.8))
    assert len(complete_path(points)) > len(points)
    monkeypatch.setattr(completeness, "ROUNDS", 1)
    refused("pair of turning points", complete_path, points, error=fem_reference.NotConverged)


@pytest.mark.parametrize("touching", [([-1.0, -1.0], [-1.0, -1.0]), ([-1.0, -0.01], [-1.0, 10.0])])
def test_a_path_that_turns_back_between_the_branches_is_refused(touching):
    """Its load and displacement, and the displacement alone."""
    approach = AnalyticBranch(Polynomial([0.0, -1.0]), [0.0, -1.0], touching=False).points([3.0, 2.0, 1.0])
    displacement, load = touching
    contact = AnalyticBranch(Polynomial(displacement), load).points([0.0, 1.0, 2.0])
    refused("path turns", complete_path, [*approach, *contact], error=fem_reference.NotConverged)


def test_the_range_includes_turning_points_between_samples():
    low, high = displacement_range(
        AnalyticBranch(Polynomial([0.0, -1.0, 0.0, 1.0]), [0.0, 1.0]).points([-1.0, 0.0, 1.0])
    )
    assert (low, high) == pytest.approx((-2 / 27**0.5, 2 / 27**0.5))


def test_a_level_reached_only_at_a_turning_point_between_samples_counts():
    """The load falls below zero and rises again between two samples with compression."""
    branch = AnalyticBranch(Polynomial([0.0, 1.0]), Polynomial.fromroots([-3.0, 0.2, 0.3]).coef)
    events = PathEvents(branch.points([-4.0, -2.0, -1.0, 0.0, 0.5, 1.0, 2.0]))
    assert events.zero_load.parameter == pytest.approx(0.3)


def test_the_path_begins_beyond_the_jump_out_of_contact():
    """The jump out of a soft solid ends at a distance of 13 lengths of the law; on the coarsest mesh alone."""
    mesh = chosen(problem_with(0.0, 8.0), ("zero_load",), "quick")
    points = mesh.whole_path.points
    assert points[0].state.displacement < min(p.state.displacement for p in points if p.branch.touching) < -12.0


def test_a_power_law_has_the_same_mesh_at_neighbouring_radii():
    """A narrow edge has a mesh for each radius, and each mesh would need a condensation."""
    narrow = Meshes(problem_with(0.0, 1500.0), level_for("default"))
    assert not narrow.scale
    width = 1.01 * 2.0**-26
    assert len({narrow.spec_at(width, radius) for radius in (58.0, 58.5, 59.0)}) == 1


def test_the_mesh_of_a_pull_off_force_ends_nearer_than_its_path():
    """With the elements of the path within: the force is the same, and half of the extent would not have shown it."""
    meshes = Meshes(problem_with(0.0, 0.3, 1.0), level_for("quick"))
    whole, ended = (event_mesh(meshes, ("pull_off",), force_alone=alone) for alone in (False, True))
    grids = [mesh.spec.grid() for mesh in (whole, ended)]
    assert grids[1].extent < grids[0].extent / 50.0
    assert np.array_equal(grids[1].z, grids[0].z[: grids[1].z.size])
    assert np.array_equal(grids[1].r[:-1], grids[0].r[: grids[1].r.size - 1])
    loads = [mesh.events.at("pull_off").state.load for mesh in (whole, ended)]
    assert loads[1] == pytest.approx(loads[0], rel=1e-9)
    assert loads[1] != loads[0]
