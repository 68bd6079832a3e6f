"""Paths whose states are continued over meshes."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from fem_reference import (
    Coating,
    CohesiveTrapezoid,
    CustomPunch,
    Homogeneous,
    LennardJones,
    MeasuredPunch,
    NotConverged,
    PowerLaw,
    PowerPunch,
    Problem,
    solve,
    trace,
)
from fem_reference._contact import followed, path
from fem_reference._contact.edge_states import MOVES, EdgeStates, to_root
from fem_reference._contact.event_kinds import Anchor
from fem_reference._contact.events import PathEvents
from fem_reference._contact.jkr_tension import jkr_curve
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.path import BEYOND_LAST_TURN, completed, contact_points, separate_points, traced
from fem_reference._contact.states import edge_is_resolved
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import level_for
from tests.fem_reference.solved_together import problem_with, sphere_on
from tests.marks import heavy

HOMOGENEOUS = sphere_on(Coating(1.0, 1.0, 1.0, 0.0, 0.0))


def stiff_coating(E_coating, thickness, range_of_law=0.4):
    """A sphere of 5 um, 50 mJ/m^2, on a coating in MPa and nm on 1.5 MPa; forces in pN."""
    solid = Coating(E_coating, 1.5, thickness, 0.0, 0.4, 0.49)
    return Problem(solid, PowerPunch(2.0, 5000.0), LennardJones(50.0, range_of_law))


def soft_coating(E_coating):
    """The same under 10.6 mJ/m^2 on 1.56 nm of a soft coating on 850 MPa: the Tabor number of 1 MPa is 160."""
    solid = Coating(E_coating, 850.0, 1.56, 0.0, 0.3)
    return Problem(solid, PowerPunch(2.0, 3400.0), LennardJones(10.6, 0.404))


#: Two minima of the load under 1 GPa and 100 nm: by the integral equation for the 9-3 law with a range of 2 nm, and in
#: the limit of a short range, at 76.64 nm and 765.1 nm (Hankel).
WIDE_LAW, LAYERED_JKR = (366.88778e3, 684.62827e3), (320.94451e3, 660.03700e3)


def test_a_traced_power_law_has_the_accuracy_of_its_meshes():
    """Not that of the coarser states that tell the edges: those are wrong by 1e-4 of the load."""
    problem = Problem(PowerLaw(1.0, 1.0, 0.4, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    coarse, fine = (trace(problem, accuracy) for accuracy in ("quick", "fine"))
    touching = [np.isfinite(path.edge_radius) for path in (coarse, fine)]
    r, load = fine.edge_radius[touching[1]], fine.load[touching[1]]
    there = touching[0] & (coarse.edge_radius > r[2]) & (coarse.edge_radius < r[-3])
    expected = CubicSpline(np.log(r), load)(np.log(coarse.edge_radius[there]))
    assert there.sum() > 5
    # Measured 1.4e-7, with the error of the spline.
    assert coarse.load[there] == pytest.approx(expected, abs=2e-6 * np.ptp(load))


STEP = 0.2
# Load and displacement in x = log r: the load has two minima that are closer to each other than two meshes at first.
NARROW, AT = 0.25, 2.75
LOAD = np.polynomial.Polynomial([-1.0, -1.0, 0.25])


def _bump(x):
    return math.exp(-(((x - AT) / NARROW) ** 2))


@dataclass(eq=False)
class _Point:
    """Stands for a point of the path."""

    parameter: float
    state: SimpleNamespace
    branch: SimpleNamespace
    rates: tuple[float, float] | None = None
    orientation: float = 1.0
    pinned: bool = False

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
        contact = SimpleNamespace(law=LennardJones(1.0, 1.0), punch=PowerPunch(2.0, 1.0))
        return _Point(radius, state, SimpleNamespace(contact=contact, touching=True))


def _minima(points):
    return sum(a.load_rate < 0.0 <= b.load_rate for a, b in pairwise(points))


def _path(height, inner=0.5, last_turn=0.0, kinks=(), highest=0.0):
    at = _States(height).at
    return completed(at, contact_points(at, inner, kinks, highest, last_turn))


def test_a_path_over_meshes_goes_from_the_first_edge_into_compression():
    points = _path(0.0)
    radii = [point.edge_radius for point in points]
    assert radii == sorted(radii)
    assert radii[0] == 0.5
    assert points[-1].state.load > 0.0 >= points[-2].state.load
    assert max(np.diff(np.log(radii))) <= STEP * (1.0 + 1e-12)
    assert _minima(points) == 1


def test_a_path_over_meshes_goes_on_while_tension_can_return():
    end = _path(0.0)[-1]
    farther = _path(0.0, last_turn=2.0 * end.edge_radius)[-1]
    assert farther.edge_radius >= 2.0 * BEYOND_LAST_TURN * end.edge_radius
    higher = _path(0.0, highest=end.state.displacement + 1.0)[-1]
    assert higher.state.displacement >= end.state.displacement + 1.0


def test_a_second_minimum_is_found_between_states():
    assert _minima(_path(0.3)) == 2


def test_an_event_moves_to_its_state_on_the_mesh_of_its_edge():
    """Other meshes begin with it there, and take the error of its radius into their bound."""
    events = PathEvents(_path(0.0), _States(0.0).at)
    anchor = Anchor(_States(0.0).at(math.exp(2.1)), 0.7, 1e-3)
    events.relocate("pull_off", anchor)
    assert events.at("pull_off") is anchor.point
    assert events.anchor("pull_off") is anchor
    assert events.slope("pull_off", anchor.point) == 0.7


@pytest.fixture
def exact_states(monkeypatch):
    """States on meshes of their own are those of the polynomial, which has its minimum at x = 2."""
    spec = MeshSpec(0.1, 0.05, 64.0, 1.3, 4)
    monkeypatch.setattr(EdgeStates, "on_fine_mesh", lambda states, radius: (spec, _States(0.0).at(radius)))
    monkeypatch.setattr(EdgeStates, "similar", lambda states, spec, radius: _States(0.0).at(radius))


@pytest.mark.usefixtures("exact_states")
@pytest.mark.parametrize("kinks", [(), (math.exp(2.01),)])
def test_an_extremum_follows_from_the_values_of_its_neighbours(kinks):
    """Rates on one mesh put that of a narrow edge beside it: none is used.  No value is from beyond a kink."""
    problem, radii = SimpleNamespace(punch=SimpleNamespace(kinks=kinks)), []
    states = EdgeStates(SimpleNamespace(problem=problem), _States(0.0).at(math.exp(1.9)), 4, 1.4)

    def load(point):
        radii.append(point.edge_radius)
        return point.state.load

    radius, bend = states.extremum(load)
    assert math.log(radius) == pytest.approx(2.0, abs=1e-9)
    assert bend == pytest.approx(0.5 / radius**2, rel=1e-4)
    assert all(radius < kink for radius in radii for kink in kinks)


@pytest.mark.usefixtures("exact_states")
@pytest.mark.parametrize(("distance", "used"), [(5e-4, 5e-4), (2e-3, 0.0), (-2e-3, 0.0)])
def test_rates_that_vanish_away_from_the_least_value_are_not_used(distance, used, monkeypatch):
    """Those on one mesh may vanish there with several degrees alike, and the load was 0.26 % above its minimum."""
    minimum = replace(_States(0.0).at(math.exp(2.0 + distance)), rates=(0.0, 0.0))
    monkeypatch.setattr(EdgeStates, "located", lambda states, excess, slope: (None, minimum.edge_radius))
    monkeypatch.setattr(followed, "edge_width", lambda point: 0.1)
    path = followed.FollowedPath(Meshes(sphere_on(PowerLaw(1.0, 1.0, 0.0, 0.3)), level_for("default")))
    vars(path)["_whole"] = SimpleNamespace(slope=lambda event, point: 0.5 / point.edge_radius**2)
    (_, radius), anchor = path._located("pull_off", minimum)
    assert math.log(radius) == pytest.approx(2.0 + used, abs=1e-9)
    assert anchor.radius_error == pytest.approx(abs(used), abs=1e-6)


#: Tabor number, pull-off force in pi R w at k = 0 by the integral equation, all digits shown, and the largest relative
#: bound (measured: 2.3e-7 at 1500; 8.4e-7 where the meshes beside the extremum differed in their innermost element). At
#: 402 the event was refused where its only state was projected, not moved with its edge.
SHORT_RANGE = ((1000.0, 1.50000328331, 1e-6), (1500.0, 1.50000155548, 4e-7), (402.0, 1.50001731240, 4e-7))


@pytest.mark.parametrize(("mu", "force", "bound"), heavy(*SHORT_RANGE))
def test_a_large_tabor_number_has_a_mesh_for_each_radius(mu, force, bound):
    """The minimum by rates on one mesh was 1.9e-6 above it; one mesh for the whole path was too coarse."""
    solution = solve(sphere_on(PowerLaw(0.91 * mu**-1.5, 1.0, 0.0, 0.3)), "pull_off_force")
    assert solution.u_num <= bound * solution.value
    assert solution.value / math.pi == pytest.approx(force, abs=solution.u_num / math.pi)


def test_both_sides_of_a_kink_are_on_the_path():
    radii = [point.edge_radius for point in _path(0.0, kinks=(2.0,))]
    assert sum(abs(radius / 2.0 - 1.0) < 1e-8 for radius in radii) == 2


def test_the_load_in_the_limit_of_a_short_range_is_that_of_jkr():
    """P = 4 E* a^3 / (3 R) - (8 pi w E* a^3)^(1/2), with elements of a third of the radius."""
    meshes = Meshes(HOMOGENEOUS, level_for("quick"))
    spec, size = meshes.first()
    a, load, _ = jkr_curve(meshes.contact(replace(spec, density=0.2, order=4), size), size)
    tension, compression = np.sqrt(8.0 * math.pi * a**3), 4.0 / 3.0 * a**3
    assert np.max(np.abs(load - compression + tension) / (tension + compression)) < 0.1


@pytest.mark.parametrize(
    ("range_of_law", "forces", "tolerance"), [(2.0, WIDE_LAW, 5e-4), *heavy((0.4, LAYERED_JKR, 0.03))]
)
def test_a_stiff_coating_has_two_minima_of_the_load(range_of_law, forces, tolerance):
    """The pull-off force is that of the solid below, which a path that ended behind the first minimum missed."""
    events = followed.followed_path(Meshes(stiff_coating(1000.0, 100.0, range_of_law), level_for("quick"))).events()
    touching = [point for point in events.minima("pull_off") if point.branch.touching]
    assert [-point.state.load for point in touching] == pytest.approx(forces, rel=tolerance)
    assert events.pull_off is not touching[0]
    assert events.points[-1].state.load > 0.0


@pytest.mark.heavy
def test_the_force_on_a_stiff_coating_is_certain_to_a_millionth():
    """By the integral equation, with a relative bound of 2e-8; the difference of the degrees alone gave 1.8e-6."""
    solution = solve(stiff_coating(1000.0, 100.0), "pull_off_force")
    assert solution.u_num <= 1e-6 * solution.value
    assert solution.value == pytest.approx(663.18121e3, abs=solution.u_num)


def test_a_power_law_has_one_path_over_its_meshes():
    """Its states share few compliances, of every size, and the events are those of one mesh that is fine throughout."""
    problem = sphere_on(PowerLaw(0.5, 1.0, 0.4, 0.3))
    path = followed.followed_path(Meshes(problem, level_for("quick")))
    touching = [point for point in path.events().points if point.branch.touching]
    assert all(point.rates is None and point.branch.contact.compliance.scales for point in touching)
    assert len({id(point.branch.contact.compliance.matrix) for point in touching}) <= 3
    assert all(edge_is_resolved(point, 1.3) for point in touching)
    spec, size = path.mesh(("pull_off", "landing"))
    whole = PathEvents(traced(path.meshes.contact(replace(spec, order=5), size)))
    for event in ("pull_off", "jump_in", "jump_out", "landing", "separated", "zero_load"):
        there, on_one = path.events().at(event).state, whole.at(event).state
        assert there.load == pytest.approx(on_one.load, abs=2e-4), event
        assert there.displacement == pytest.approx(on_one.displacement, abs=2e-4), event


@pytest.mark.parametrize("expected", [True, False])
def test_the_mesh_of_a_small_spot_is_made_finer_until_the_path_reaches_it(monkeypatch, expected):
    """Contact under a nearly flat punch begins on a spot far from the rim: two meshes for the rim lost the path."""
    if not expected:
        monkeypatch.setattr(Meshes, "expected", property(lambda meshes: meshes))
    path = followed.FollowedPath(Meshes(problem_with(0.55, 4.12, 5.65, 0.1), level_for("quick")))
    assert (path.meshes.failures == 0) == expected
    assert path.meshes.spot < 0.25 * path.meshes.first()[1]
    assert path.events("jump_in").jump_in.state.displacement < 0.0


def test_contact_on_a_soft_coating_begins_where_it_jumps_in():
    """It begins on a spot of 1e-4 of the mesh, and the solid rises by several lengths of the law before it."""
    path = followed.followed_path(Meshes(soft_coating(1.0), level_for("default")))
    assert path.events("jump_in").jump_in.state.displacement < -5.0 * 0.404


def test_a_path_on_a_very_soft_solid_begins_farther_away():
    """At a Tabor number of 2e4 there is no equilibrium with the central gap that suits stiffer solids."""
    solid = Coating(1e-3, 1e-3, 1.0, 0.0, 0.3)
    meshes = Meshes(Problem(solid, PowerPunch(2.0, 3400.0), LennardJones(10.6, 0.404)), level_for("quick"))
    start = next(separate_points(meshes.contact(*meshes.first())))
    assert start.state.central_gap > 12.0 * 0.404


def test_an_edge_that_no_mesh_resolves_is_refused_before_the_path_is_followed(monkeypatch):
    monkeypatch.setattr(EdgeStates, "at", None)
    with pytest.raises(NotConverged, match="contact edge needs elements"):
        solve(soft_coating(1e-3), "pull_off_force", "quick")


#: Pull-off forces of `blunt` by the integral equation, `fscm` at the accuracy "fine"; bounds 5e-12.
FORCES_OF_BLUNT_PUNCHES = {7.8: 3.62164646196, 9.4: 3.54705376898, 9.98: 3.52465225575}


def blunt(n):
    """A punch with a flat face and steep walls on a soft film of about the size of the face."""
    return Problem(Coating(0.8, 1.6, 1.2, 0.6, 0.3), PowerPunch(n, 1.0), LennardJones(1.0, 1.0))


@pytest.mark.parametrize("n", heavy(9.4, 7.8, 9.98))
def test_a_blunt_punch_on_a_coating_has_the_force_of_the_integral_equation(n):
    result, expected = solve(blunt(n), "pull_off_force"), FORCES_OF_BLUNT_PUNCHES[n]
    assert result.value == pytest.approx(expected, abs=result.u_num)
    assert result.u_num < 1e-6


def touching_of(problem):
    """States of the search, on meshes of their own, by their radii."""
    path = followed.FollowedPath(Meshes(problem, level_for("default")))
    return [point for point in path.events().points if point.branch.touching]


def test_states_are_extrapolated_to_another_mesh_in_few_steps():
    """The repulsion is like the 9th power of the gap: from the gap of a neighbour Newton takes 12 steps or fails."""
    assert max(point.state.iterations for point in touching_of(blunt(9.4))[2:]) <= 6


def test_the_path_goes_on_where_the_range_of_the_law_may_matter():
    problem = blunt(9.4)
    touching = touching_of(problem)
    heights = problem.punch.height(np.array([touching[-2].edge_radius, touching[-1].edge_radius]) / BEYOND_LAST_TURN)
    assert heights[1] >= 4.0
    # No farther than asked for: a flat face under many lengths of the law has steep states without any event.
    assert heights[0] < 40.0


@pytest.mark.parametrize("start", [0.7, 1.3])
@pytest.mark.parametrize("steeper", [1.0, 40.0])
def test_an_event_where_the_rate_is_much_steeper_than_between_states_is_bracketed(start, steeper):
    """Newton's method with the slope far from the root swings about it."""

    def excess(radius):
        x = radius - 1.013
        return x + steeper * math.tanh(x / 0.05) * 0.05

    known, radius = {}, start
    for _ in range(MOVES):
        known[radius] = excess(radius)
        move = to_root(known, radius, 1.0)
        if abs(move) <= 1e-3:
            break
        radius += move
    assert abs(radius - 1.013) < 2e-3


class _KinkedStates:
    """A load that turns shortly before a kink at the radius 1, and rises behind it."""

    def at(self, radius):
        x = math.log(radius)
        load = -1.0 - x + 0.015 * math.exp(x / 0.005) if x < 0.0 else -0.985 + 2.0 * x + 3.0 * x * x
        punch = CustomPunch(lambda r: r**2 / 2.0, 2.0, kinks=(1.0,))
        contact = SimpleNamespace(law=LennardJones(1.0, 1.0), punch=punch)
        state = SimpleNamespace(load=load, displacement=x)
        return _Point(radius, state, SimpleNamespace(contact=contact, touching=True))


def test_rates_of_both_sides_of_a_kink_decide_what_the_test_of_each_side_does_not_see(monkeypatch):
    """Five states see a rate of -0.8 at the kink, where it is 2."""
    monkeypatch.setattr(path, "complete_branch", lambda points, *_: points)
    monkeypatch.setattr(path, "edge_width", lambda point: 0.0)
    at = _KinkedStates().at
    points = completed(at, contact_points(at, 0.33, (1.0,), 0.0))
    within = [(a, b) for a, b in pairwise(points) if b.edge_radius > a.edge_radius * (1.0 + 1e-6)]
    ((a, b),) = [pair for pair in within if pair[0].load_rate < 0.0 <= pair[1].load_rate]
    assert a.edge_radius <= math.exp(0.005 * math.log(1.0 / 3.0)) <= b.edge_radius <= 1.0


def test_a_path_has_states_at_one_three_and_nine_widths_from_a_kink(monkeypatch):
    width = 0.005
    monkeypatch.setattr(path, "edge_width", lambda point: width)
    at = _KinkedStates().at
    points = completed(at, contact_points(at, 0.33, (1.0,), 0.0))
    places = np.log([point.edge_radius for point in points]) / width
    for place in (-9.0, -3.0, -1.0, 1.0, 3.0, 9.0):
        assert np.min(np.abs(places - place)) < 1e-5


def test_states_beside_a_kink_show_a_minimum_within_the_width_of_the_edge():
    """The load turns 0.5 % before the kink: five states a part, and values from beyond the kink, had 53.17."""
    law = CohesiveTrapezoid(work_of_adhesion=1.0, strength=1.0, rise_end=0.318, fall_start=0.35)
    profile = MeasuredPunch(radii=(0.0, 6.0, 13.3), heights=(0.0, 1.8, 9.0), growth=2.9)
    force = solve(Problem(Homogeneous(E=0.133, nu=0.236), profile, law), "pull_off_force", "quick")
    # By the integral equation.
    assert force.value == pytest.approx(53.527162188, abs=force.u_num)
    assert force.u_num <= 1e-4
