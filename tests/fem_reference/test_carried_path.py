"""Paths whose states are carried from mesh to mesh."""

import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import (
    CustomSolid,
    ExponentialModulus,
    LennardJones,
    NotConverged,
    PowerPunch,
    Problem,
    Solution,
    solve_together,
)
from fem_reference._contact import edge_search
from fem_reference._contact.carried_path import carried_path, found_on_carried
from fem_reference._contact.edge_search import EdgeSearch
from fem_reference._contact.events import JUMP_IN, LANDING, PathEvents
from fem_reference._contact.mesh_choice import MeshChoice, chosen
from fem_reference._contact.tracing import traced_to_fold
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import level_for

NAMES = ("pull_off_force", "jump_in_displacement", "jump_out_displacement")
CONE = Problem(CustomSolid(ExponentialModulus(0.9, 0.3, 5.0), 0.1), PowerPunch(1.0, 1.0), LennardJones(1.0, 1.0))

STEP = 0.2
# Load and displacement in x = log r: the load has two minima that are closer to each other than two meshes at first.
NARROW, AT = 0.1, 2.75
LOAD = np.polynomial.Polynomial([-1.0, -1.0, 0.25])


def _bump(x):
    return math.exp(-(((x - AT) / NARROW) ** 2))


class _States:
    """Stands for the solver on a mesh for each radius."""

    def __init__(self, height):
        self.height, self.event, self.level, self.asked, self.begun = height, "pull_off", 0.0, [], []

    def at(self, radius):
        x = math.log(radius)
        self.asked.append(radius)
        slope = -2.0 * (x - AT) / NARROW**2 * self.height * _bump(x)
        load, rate = LOAD(x) + self.height * _bump(x), (LOAD.deriv()(x) + slope) / radius
        state = SimpleNamespace(load=load, displacement=x, load_rate=rate, displacement_rate=1.0 / radius)
        branch = SimpleNamespace(contact=SimpleNamespace(law=SimpleNamespace(length=1.0)), touching=True)
        rates = {"load_rate": rate, "displacement_rate": 1.0 / radius}
        return SimpleNamespace(state=state, branch=branch, edge_radius=radius, parameter=radius, **rates)

    def lowest(self, radii, degree):
        self.begun = list(radii)
        return "the mesh", radii[0]


def _minima(points):
    return sum(a.load_rate < 0.0 <= b.load_rate for a, b in pairwise(points))


def test_a_carried_path_goes_from_the_first_edge_into_compression():
    states = _States(0.0)
    points = carried_path(states, 0.5, 2.0)
    radii = [point.edge_radius for point in points]
    assert radii == sorted(radii)
    assert radii[0] == 0.5
    assert points[-1].state.load > 0.0 >= points[-2].state.load
    assert max(np.diff(np.log(radii))) <= STEP * (1.0 + 1e-12)
    assert _minima(points) == 1


@pytest.mark.parametrize("height", [0.056, 0.05])
def test_turning_points_between_two_meshes_are_found(height):
    """Loads and rates at radii a step apart show one minimum; the path has two, for the lower bump with a rise of 2e-4
    of the largest tension between them."""
    states = _States(height)
    coarse = [states.at(2.0 * math.exp(STEP * i)) for i in range(20)]
    assert _minima(coarse) == 1
    points = carried_path(_States(height), 2.0, 2.0)
    assert _minima(points) == 2


def test_the_lowest_of_several_minima_is_searched_from_each():
    states = _States(0.056)
    points = carried_path(states, 2.0, 2.0)
    assert found_on_carried(states, points, 6) == ("the mesh", states.begun[0])
    assert len(states.begun) == 2
    # The load vanishes once.
    states.event = "zero_load"
    found_on_carried(states, points, 6)
    assert len(states.begun) == 1
    # A fold may lie before there is a contact edge: that it is not here does not show that there is none.
    states.event = "jump_out"
    with pytest.raises(NotConverged, match="has no jump_out"):
        found_on_carried(states, points, 6)


class _Meshes:
    """Stands for what makes meshes."""

    def spec(self, width, size, smallest, far_share=1.0, apex=math.inf):
        return MeshSpec(width, 0.05, 100.0, 1.0, 4)

    def contact(self, spec, size):
        return size


def _from_near(contact, radius, starts):
    """The state, from another if that is within a fiftieth of the radius."""
    if min(abs(math.log(start.edge_radius / radius)) for start in starts) > 0.021:
        raise NotConverged("too far")
    return _States(0.0).at(radius)


def test_a_state_that_is_not_found_at_once_is_reached_by_way_of_others(monkeypatch):
    monkeypatch.setattr(edge_search, "state_at", _from_near)
    monkeypatch.setattr(edge_search, "edge_width", lambda point: 1.0)
    search = EdgeSearch(_Meshes(), "pull_off", [_States(0.0).at(1.0)], 0.1, 0.1, 4)
    search.at(1.0)
    assert search.at(1.1).edge_radius == 1.1
    assert len(search.known) > 4
    # Where there is none, the radii come so close that it is refused.
    monkeypatch.setattr(edge_search, "state_at", lambda contact, radius, starts: _from_near(contact, 9.0, starts))
    with pytest.raises(NotConverged, match="too far"):
        search.at(1.2)
    with pytest.raises(NotConverged, match=r"not found on \d+ meshes"):
        replace(search, most=len(search.known)).at(1.4)


def test_a_part_of_a_path_is_not_taken_for_the_whole():
    with pytest.raises(NotConverged, match="not known as a whole"):
        _ = PathEvents([], "pull_off", whole=False).points


def test_a_jump_into_contact_needs_the_path_up_to_it_only():
    """The fold of the approach alone is that of the whole path."""
    stiff = level_for("quick")
    choice = MeshChoice(CONE, stiff)
    spec, size, _ = choice._first_mesh()
    contact = choice.contact(replace(spec, order=3), size)
    points = traced_to_fold(contact)
    assert points[-1].displacement_rate <= 0.0 < points[-2].displacement_rate
    fold = PathEvents(points, JUMP_IN, whole=False).jump_in
    assert points[-1].state.central_gap < fold.state.central_gap < points[-2].state.central_gap
    assert abs(fold.displacement_rate) < 1e-8


def _not_carried_from_mesh_to_mesh(choice, event):
    raise NotConverged("no path is carried from mesh to mesh")


def _not_carried_by_one_mesh(choice, events, start, brief=False):
    raise NotConverged("no mesh carries the path")


@pytest.mark.heavy
def test_a_carried_path_has_the_events_of_the_traced_one(monkeypatch):
    """Two routes to the same values: every event on the meshes that the ordinary route chooses, and on these."""
    with monkeypatch.context() as patch:
        patch.setattr(MeshChoice, "carried", _not_carried_from_mesh_to_mesh)
        ordinary = solve_together(CONE, NAMES, "quick")
    monkeypatch.setattr(MeshChoice, "adapted", _not_carried_by_one_mesh)
    carried = solve_together(CONE, NAMES, "quick")
    for name in NAMES:
        one, other = ordinary[name], carried[name]
        assert isinstance(other, Solution)
        assert one.value != other.value
        assert abs(one.value - other.value) <= one.u_num + other.u_num
        assert other.u_num <= 1e-4 * abs(other.value)


def test_events_that_need_the_whole_path_are_not_carried(monkeypatch):
    """The end of a jump is at the displacement of another event: the reason of the failure stays."""
    monkeypatch.setattr(MeshChoice, "adapted", _not_carried_by_one_mesh)
    with pytest.raises(NotConverged, match="no mesh carries the path"):
        chosen(CONE, (LANDING,), "fine")
