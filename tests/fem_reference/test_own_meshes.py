"""Meshes of their own for the events that the mesh of another event leaves uncertain."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import pytest

import fem_reference.solution as solution_module
from fem_reference import (
    Exponential,
    LennardJones,
    NotConverged,
    OffsetPowerLaw,
    PowerLaw,
    PowerPunch,
    Problem,
    solve,
    solve_together,
)
from fem_reference.quantities import TABLE
from tests.fem_reference.solved_together import sphere_on

FORCE, JUMP_IN, JUMP_OUT = NAMES = ("pull_off_force", "jump_in_displacement", "jump_out_displacement")
ROWS = {name: TABLE[name] for name in NAMES}
LAW = LennardJones(1.0, 1.0)
GRADED = sphere_on(Exponential(3.0, 1.0, 5.0, 0.1))
#: Of a power punch, n = 5, on a solid that softens: by both references, all digits shown.
ZERO_LOAD = 0.42243083
CONE = replace(GRADED, solid=Exponential(0.9, 0.3, 5.0, 0.1), punch=PowerPunch(1.0, 1.0))


def _own(problem, points, missed=(), monkeypatch=None):
    """Quantities that get a mesh of their own, from which events are resolved on that of the first."""
    resolved = {"pull_off": False, **points}
    monkeypatch.setattr(solution_module, "edge_is_resolved", lambda event: resolved[event])
    solved = {name: None for name in NAMES if name not in missed}
    return list(solution_module._unresolved(problem, ROWS, solved, missed, SimpleNamespace(at=lambda event: event)))


def test_a_quantity_whose_edge_is_not_resolved_or_that_is_missed_gets_its_own_mesh(monkeypatch):
    names = partial(_own, GRADED, monkeypatch=monkeypatch)
    assert names({"jump_in": True, "jump_out": False}) == [JUMP_OUT]
    assert names({"jump_in": True, "jump_out": True}, {JUMP_OUT: NotConverged()}) == [JUMP_OUT]
    # The mesh of the first event is its own.
    assert names({"jump_in": True, "jump_out": True}) == []
    # The mesh of the jump out of contact serves the other one, which has no contact edge.
    assert names({"jump_in": False, "jump_out": False}) == [JUMP_OUT, JUMP_IN]


def test_one_mesh_serves_every_event_of_a_solid_that_scales(monkeypatch):
    scaling = replace(GRADED, solid=PowerLaw(1.0, 1.0, 0.4, 0.3))
    assert _own(scaling, {"jump_in": False, "jump_out": False}, monkeypatch=monkeypatch) == []


def test_every_order_of_quantities_finds_the_events_after_a_jump_before_contact():
    """The path of that jump ends before contact."""
    offset = sphere_on(OffsetPowerLaw(0.91, 1.0, 0.4, 1.0, 0.3))
    orders = ("jump_in_gap", FORCE), (FORCE, "jump_in_gap")
    results = [solve_together(offset, names, "quick") for names in orders]
    assert [tuple(together) for together in results] == list(orders)
    assert [together[FORCE].value for together in results] == [solve(offset, FORCE, "quick").value] * 2
    gap, other_gap = (together["jump_in_gap"] for together in results)
    assert 0.0 < gap.value == pytest.approx(other_gap.value, abs=gap.u_num + other_gap.u_num)


def test_the_bound_of_a_second_event_holds():
    """On the mesh of the pull-off the three values at zero load turn back, 1.4 bounds from the value."""
    problem = Problem(Exponential(2.0, 1.0, 2.0, 0.3), PowerPunch(5.0, 1.0), LAW)
    zero_load = solve_together(problem, (FORCE, "zero_load_displacement"), "quick")["zero_load_displacement"]
    assert zero_load.value == pytest.approx(ZERO_LOAD, abs=zero_load.u_num + 1e-8)
    assert zero_load.u_num < 1e-6


@pytest.mark.heavy
def test_the_jumps_of_a_cone_are_as_certain_together_as_alone():
    """On the mesh of the pull-off the jump out of contact is not found on all densities."""
    together = solve_together(CONE, NAMES, "quick")
    assert all(together[name].u_num <= 1e-4 * abs(together[name].value) for name in NAMES)
    alone = solve(CONE, JUMP_OUT, "quick")
    assert abs(alone.value - together[JUMP_OUT].value) <= alone.parts["algebra"] + together[JUMP_OUT].parts["algebra"]
