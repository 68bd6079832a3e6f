"""Paths whose states are continued over meshes."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import LennardJones, NotConverged, PowerLaw, PowerPunch, Problem, solve, trace
from fem_reference._contact import edge_states
from fem_reference._contact import multimesh_path as multimesh_path_module
from fem_reference._contact.edge_states import EdgeStates
from fem_reference._contact.jkr_tension import jkr_curve
from fem_reference._contact.mesh_choice import MeshChoice, followed_path
from fem_reference._contact.multimesh_path import multimesh_path, with_rates
from fem_reference._contact.path import equilibrium_points
from fem_reference.accuracy import level_for
from fem_reference.coating import CoatingModulus
from fem_reference.depth_profiles import ExponentialModulus
from fem_reference.poisson import CoatingPoisson
from tests.fem_reference.profile_solid import ProfileSolid

LAW = LennardJones(1.0, 1.0)
CONE = Problem(ProfileSolid(ExponentialModulus(0.9, 0.3, 5.0), 0.1), PowerPunch(1.0, 1.0), LAW)
HOMOGENEOUS = Problem(ProfileSolid(CoatingModulus(1.0, 1.0, 1.0), 0.0), PowerPunch(2.0, 1.0), LAW)


def stiff_coating(E_coating, thickness, range_of_law=0.4):
    """A sphere of 5 um, 50 mJ/m^2, on a coating in MPa and nm on 1.5 MPa; forces in pN."""
    interface = (thickness, 0.0)
    solid = ProfileSolid(CoatingModulus(E_coating, 1.5, *interface), CoatingPoisson(0.4, 0.49, *interface))
    return Problem(solid, PowerPunch(2.0, 5000.0), LennardJones(50.0, range_of_law))


def soft_coating(E_coating):
    """The same under 10.6 mJ/m^2 on 1.56 nm of a soft coating on 850 MPa: the Tabor number of 1 MPa is 160."""
    solid = ProfileSolid(CoatingModulus(E_coating, 850.0, 1.56, 0.0), 0.3)
    return Problem(solid, PowerPunch(2.0, 3400.0), LennardJones(10.6, 0.404))


#: Two minima of the load under 1 GPa and 100 nm in the limit of a short range, at 76.64 nm and 765.1 nm (Hankel).
LAYERED_JKR = (320.94451e3, 660.03700e3)

STEP = 0.2
# Load and displacement in x = log r: the load has two minima that are closer to each other than two meshes at first.
NARROW, AT = 0.25, 2.75
LOAD = np.polynomial.Polynomial([-1.0, -1.0, 0.25])


def _bump(x):
    return math.exp(-(((x - AT) / NARROW) ** 2))


@dataclass(frozen=True)
class _Point:
    """Stands for a point of the path."""

    parameter: float
    state: SimpleNamespace
    branch: SimpleNamespace
    rates: tuple[float, float] | None = None
    orientation: float = 1.0

    edge_radius = property(lambda self: self.parameter)
    load_rate = property(lambda self: self.rates[0])
    displacement_rate = property(lambda self: self.rates[1])


class _States:
    """Stands for the solver on a mesh for each radius."""

    def __init__(self, height):
        self.height = height

    def at(self, radius):
        x = math.log(radius)
        state = SimpleNamespace(load=LOAD(x) + self.height * _bump(x), displacement=x)
        contact = SimpleNamespace(law=SimpleNamespace(z0=1.0), punch=PowerPunch(2.0, 1.0))
        return _Point(radius, state, SimpleNamespace(contact=contact, touching=True))


def _minima(points):
    return sum(a.load_rate < 0.0 <= b.load_rate for a, b in pairwise(points))


def _path(height, inner=0.5, last_turn=0.0, kinks=(), highest=0.0):
    return multimesh_path(_States(height), inner, last_turn, kinks, highest)


def test_a_multimesh_path_goes_from_the_first_edge_into_compression():
    points = _path(0.0)
    radii = [point.edge_radius for point in points]
    assert radii == sorted(radii)
    assert radii[0] == 0.5
    assert points[-1].state.load > 0.0 >= points[-2].state.load
    assert max(np.diff(np.log(radii))) <= STEP * (1.0 + 1e-12)
    assert _minima(points) == 1


def test_a_multimesh_path_goes_on_while_tension_can_return():
    end = _path(0.0)[-1]
    farther = _path(0.0, last_turn=2.0 * end.edge_radius)[-1]
    assert farther.edge_radius >= 2.0 * multimesh_path_module.FARTHER * end.edge_radius
    higher = _path(0.0, highest=end.state.displacement + 1.0)[-1]
    assert higher.state.displacement >= end.state.displacement + 1.0


def test_a_second_minimum_is_found_between_states():
    assert _minima(_path(0.3)) == 2


def test_the_rates_follow_from_the_states():
    points = with_rates([_States(0.0).at(math.exp(STEP * i)) for i in range(12)])
    exact = [LOAD.deriv()(math.log(point.parameter)) / point.parameter for point in points]
    assert [point.load_rate for point in points] == pytest.approx(exact, rel=1e-10, abs=1e-10)


def test_an_extremum_follows_from_the_values_of_its_neighbours(monkeypatch):
    """Rates on one mesh put that of a narrow edge beside it: none is used.  The polynomial has its minimum at 2."""
    states = EdgeStates(None, _States(0.0).at(math.exp(1.7)), 4, 1.4)
    monkeypatch.setattr(EdgeStates, "own", lambda states, radius: (None, _States(0.0).at(radius)))
    monkeypatch.setattr(EdgeStates, "_on_similar_mesh", lambda states, spec, radius: _States(0.0).at(radius))
    radius, bend = states.extremum(lambda point: point.state.load)
    assert math.log(radius) == pytest.approx(2.0, abs=1e-9)
    assert bend == pytest.approx(0.5 / radius**2, rel=1e-6)


#: Tabor number, and pull-off force in pi R w at k = 0 by the integral equation; all digits shown.
SHORT_RANGE = (1000.0, 1.50000328331)


@pytest.mark.heavy
def test_a_large_tabor_number_has_a_mesh_for_each_radius():
    """The minimum by rates on one mesh was 1.9e-6 above it; one mesh for the whole path was too coarse."""
    mu, force = SHORT_RANGE
    found = solve(Problem(PowerLaw(0.91 * mu**-1.5, 1.0, 0.0, 0.3), PowerPunch(2.0, 1.0), LAW), "pull_off_force")
    assert found.u_num <= 1e-6 * found.value
    assert found.value / math.pi == pytest.approx(force, abs=found.u_num / math.pi)


def test_both_sides_of_a_kink_are_on_the_path():
    radii = [point.edge_radius for point in _path(0.0, kinks=(2.0,))]
    assert sum(abs(radius / 2.0 - 1.0) < 1e-8 for radius in radii) == 2


def test_the_load_in_the_limit_of_a_short_range_is_that_of_jkr():
    """P = 4 E* a^3 / (3 R) - (8 pi w E* a^3)^(1/2), with elements of a third of the radius."""
    choice = MeshChoice(HOMOGENEOUS, level_for("quick"))
    spec, size = choice.first_mesh()
    a, load, _ = jkr_curve(choice.contact(replace(spec, density=0.2, order=4), size), size)
    tension, compression = np.sqrt(8.0 * math.pi * a**3), 4.0 / 3.0 * a**3
    assert np.max(np.abs(load - compression + tension) / (tension + compression)) < 0.1


def _from_near(near, contact, radius):
    """The state, from another if that is within a fiftieth of the radius."""
    if abs(math.log(near.edge_radius / radius)) > 0.021:
        raise NotConverged("too far")
    return _States(0.0).at(radius)


def test_a_state_that_is_not_found_at_once_is_reached_by_way_of_others(monkeypatch):
    monkeypatch.setattr(edge_states, "_state_from", _from_near)
    monkeypatch.setattr(edge_states, "edge_width", lambda point: 1.0)
    monkeypatch.setattr(EdgeStates, "_on_neighbour_mesh", lambda states, radius: None)
    meshes = SimpleNamespace(
        spec_at=lambda width, radius: MeshChoice(HOMOGENEOUS, level_for("quick")).spec_at(width, radius),
        contact=lambda spec, size: size,
    )
    states = EdgeStates(meshes, _States(0.0).at(1.0), 4, 1.4)
    assert states.at(1.1).edge_radius == 1.1
    assert len(states.states) > 4
    monkeypatch.setattr(edge_states, "MOST_STATES", len(states.states))
    with pytest.raises(NotConverged, match="states with edges between"):
        states.at(1.4)


def test_a_stiff_coating_has_two_minima_of_the_load():
    """The pull-off force is that of the solid below, which a path that ended behind the first minimum missed."""
    events = followed_path(MeshChoice(stiff_coating(1000.0, 100.0), level_for("quick"))).events()
    touching = [point for point in events.minima("pull_off") if point.branch.touching]
    assert [-point.state.load for point in touching] == pytest.approx(LAYERED_JKR, rel=0.03)
    assert events.pull_off is not touching[0]
    assert events.points[-1].state.load > 0.0


#: Modulus and thickness, and pull-off force by the integral equation (relative bound 2e-8).
STIFF_COATINGS = ((1000.0, 100.0, 663.18121e3), (10000.0, 30.0, None))


@pytest.mark.heavy
@pytest.mark.parametrize(("E_coating", "thickness", "force"), STIFF_COATINGS)
def test_the_force_on_a_stiff_coating_is_certain_to_a_millionth(E_coating, thickness, force):
    """The difference of the degrees on the medium mesh alone gave 1.8e-6 and 2.5e-6 of the force."""
    found = solve(stiff_coating(E_coating, thickness), "pull_off_force")
    assert found.u_num <= 1e-6 * found.value
    if force is not None:
        assert found.value == pytest.approx(force, abs=found.u_num)


def test_contact_on_a_soft_coating_begins_where_it_jumps_in():
    """It begins on a spot of 1e-4 of the mesh, and the solid rises by several lengths of the law before it."""
    followed = followed_path(MeshChoice(soft_coating(1.0), level_for("default")))
    assert followed.events("jump_in").jump_in.state.displacement < -5.0 * 0.404


def test_a_path_on_a_very_soft_solid_begins_farther_away():
    """At a Tabor number of 2e4 there is no equilibrium with the central gap that suits stiffer solids."""
    solid = ProfileSolid(CoatingModulus(1e-3, 1e-3, 1.0), 0.3)
    choice = MeshChoice(Problem(solid, PowerPunch(2.0, 3400.0), LennardJones(10.6, 0.404)), level_for("quick"))
    first = next(equilibrium_points(choice.contact(*choice.first_mesh())))
    assert first.state.central_gap > 12.0 * 0.404


def test_an_edge_that_no_mesh_resolves_is_refused_before_the_path_is_followed(monkeypatch):
    monkeypatch.setattr(EdgeStates, "at", None)
    with pytest.raises(NotConverged, match="contact edge needs elements"):
        solve(soft_coating(1e-3), "pull_off_force", "quick")


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("E_coating", "thickness", "layered_jkr"),
    [(1000.0, 100.0, 660.03700e3), (10000.0, 30.0, 843.79742e3), (100.0, 100.0, 992.65614e3)],
)
def test_the_pull_off_force_of_a_stiff_coating(E_coating, thickness, layered_jkr):
    """Of the deeper minimum; the law of 0.4 nm differs by 1 % from the limit of a short range."""
    force = solve(stiff_coating(E_coating, thickness), "pull_off_force", "quick")
    assert force.value == pytest.approx(layered_jkr, rel=0.012)
    assert force.u_num < 1e-4 * force.value


@pytest.mark.heavy
def test_the_path_of_a_stiff_coating_is_traced_into_compression():
    path = trace(stiff_coating(1000.0, 100.0), "quick", largest_turn=20.0)
    assert path.load[-1] > 0.0
    assert -path.load.min() == pytest.approx(LAYERED_JKR[1], rel=0.012)


@pytest.mark.heavy
@pytest.mark.parametrize("quantity", ["pull_off_force", "jump_in_displacement", "jump_out_displacement"])
def test_the_events_of_a_cone_are_certain(quantity):
    """At mu = 3, on a solid that is softer below, no mesh carried the path, or an event was missed there."""
    event = solve(CONE, quantity, "quick")
    assert event.u_num <= 1e-4 * abs(event.value)
