"""Laws with a barrier: their wells, their tension, and where their paths begin and end."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from fscm import Analysis, Dlvo, LennardJones, Mie, Problem, TabulatedLaw, solve, trace
from fscm._path.ends import LeastLoad
from fscm._surface.breaks import end_radius
from fscm.wells import has_one_well, outermost_turn, tension_beyond

#: Double layers, as shares of 8 w/(3 z0) of the law without one, and their lengths in z0.
LAYERS = [(0.0, 1.0), (0.3, 1.0), (1.0, 1.0), (0.5, 2.0), (50.0, 0.5), (7.5e-4, 48.0), (1e4, 0.1), (1e-12, 1.0)]


def dlvo(share: float, length: float) -> Dlvo:
    """The 9-3 law of w = z0 = 1 with a double layer."""
    return Dlvo(16.0 * math.pi, 1.0, 8.0 / 3.0 * share, length)


@pytest.mark.parametrize(("share", "length"), LAYERS)
def test_wells_are_where_a_dense_scan_finds_them(share: float, length: float) -> None:
    law = dlvo(share, length)
    distance = np.geomspace(0.3, 1e4, 200_001)
    traction = 8.0 / 3.0 * (distance**-9 - distance**-3 + share * np.exp(-distance / length))
    crossings = np.flatnonzero(np.diff(np.sign(traction)))
    assert law.equilibrium_distances == pytest.approx(distance[crossings], rel=1e-4)
    np.testing.assert_allclose(law.traction(distance - law.distance), traction, rtol=1e-9, atol=1e-12)
    works = [-quad(law.traction, at - law.distance, np.inf, limit=500)[0] for at in law.equilibrium_distances[::2]]
    assert law.work_of_adhesion == pytest.approx(max(works), rel=1e-9)
    assert law.distance == pytest.approx(law.equilibrium_distances[2 * int(np.argmax(works))], rel=1e-12)
    assert law.peak_gap + law.distance == pytest.approx(distance[np.argmin(traction)], rel=1e-4)


@pytest.mark.parametrize(("share", "length"), LAYERS)
def test_slope_curvature_and_energy_are_derivatives(share: float, length: float) -> None:
    law = dlvo(share, length)
    gap, step = np.array([-0.3, 0.0, 0.7, 5.0, 90.0]), 1e-5
    for function, derivative in (
        (law.energy, lambda H: -law.traction(H)),
        (law.traction, law.slope),
        (law.slope, law.curvature),
    ):
        difference = (function(gap + step) - function(gap - step)) / (2.0 * step)
        assert derivative(gap) == pytest.approx(difference, rel=1e-6, abs=1e-8)


def test_without_a_double_layer_it_is_the_9_3_law() -> None:
    gap = np.geomspace(1e-3, 1e3, 50) - 0.5
    assert dlvo(0.0, 1.0).traction(gap) == pytest.approx(LennardJones().traction(gap), rel=1e-12, abs=1e-15)
    assert dlvo(0.0, 1.0).decay == pytest.approx(LennardJones().decay)


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        ({"hamaker_constant": 0.0}, "hamaker_constant"),
        ({"z0": -1.0}, "z0"),
        ({"double_layer": -1.0}, "double_layer"),
        ({"debye_length": math.inf}, "debye_length"),
    ],
)
def test_a_parameter_outside_its_range_is_named(changed: dict[str, float], name: str) -> None:
    values = {"hamaker_constant": 1.0, "z0": 1.0, "double_layer": 1.0, "debye_length": 1.0}
    with pytest.raises(ValueError, match=name):
        Dlvo(**values | changed)


def test_which_laws_have_one_well() -> None:
    assert has_one_well(LennardJones())
    assert has_one_well(Mie(m=12, n=6))
    assert [has_one_well(dlvo(*layer)) for layer in LAYERS] == [True, True, False, False, True, False, True, True]


@pytest.mark.parametrize("layer", [(1.0, 1.0), (0.5, 2.0), (7.5e-4, 48.0)])
def test_the_tension_beyond_a_gap_is_the_largest_of_all(layer: tuple[float, float]) -> None:
    law = dlvo(*layer)
    gap = np.geomspace(0.5, 2e3, 20_001) - law.distance
    largest = np.maximum.accumulate(-law.traction(gap)[::-1])[::-1]
    bound = tension_beyond(law, gap)
    assert np.all(bound >= largest)
    np.testing.assert_allclose(bound, largest, rtol=0.05, atol=0.05 * largest[0])
    farther = gap >= 1.01 * outermost_turn(law)
    assert np.all(largest[farther] + law.traction(gap[farther]) <= 1e-8 * largest[0])
    assert np.any(largest + law.traction(gap) > 1e-8 * largest[0])


@pytest.mark.parametrize("mu", [0.3, 2.0])
def test_no_state_beyond_the_end_of_a_path_carries_tension(mu: float) -> None:
    """The bound of the load holds on the path, which goes on until it is positive."""
    problem = Problem(n=2.0, k=0.0, mu=mu, law=dlvo(1.0, 1.0))
    points = Analysis(problem).points
    bound = LeastLoad(problem, end_radius(problem, 1e4))
    states = [point.state for point in points[:: max(1, len(points) // 20)]]
    assert all(bound(state.displacement) <= state.load for state in states)
    assert bound(points[-1].state.displacement) > 0.0


def test_the_contact_passes_the_barrier_before_the_pull_off() -> None:
    """The compressed contact in the outer well is not the end of the path: the inner well holds much more."""
    law = dlvo(1.0, 1.0)
    outer = max(gap for gap in law.equilibrium_distances) - law.distance
    analysis = Analysis(Problem(n=2.0, k=0.0, mu=1.0, law=law))
    jump, pull_off = analysis.event("jump_in").value, analysis.event("pull_off").value
    assert jump.load > 1.0
    assert 0.0 < jump.central_gap < outer
    assert pull_off.central_gap < 0.0
    assert pull_off.load < analysis.points[0].state.load


def test_a_rigid_solid_has_the_force_of_derjaguin() -> None:
    """2 pi R w of the deepest well, whatever barrier is farther out."""
    for layer in ((1.0, 1.0), (7.5e-4, 48.0)):
        force = solve(Problem(n=2.0, k=0.0, mu=1e-4, law=dlvo(*layer)), "pull_off_force")
        assert force.value == pytest.approx(2.0, rel=1e-4)


def test_a_table_may_have_a_barrier() -> None:
    law = dlvo(1.0, 1.0)
    distance = np.concatenate([np.linspace(0.7, 8.0, 400), np.geomspace(8.05, 400.0, 150)])
    table = TabulatedLaw(distance, law.traction(distance - law.distance), tail_exponent=3.0)
    assert table.equilibrium_gap == pytest.approx(law.distance, rel=1e-8)
    assert table.work_of_adhesion == pytest.approx(law.work_of_adhesion, rel=1e-7)
    values = [solve(Problem(n=2.0, k=0.0, mu=1.0, law=each), "pull_off_force").value for each in (law, table)]
    assert values[1] == pytest.approx(values[0], rel=1e-8)


def test_a_curve_begins_beyond_the_barrier() -> None:
    """At its first state the outer well attracts; inside, the double layer would press the surfaces apart."""
    law = dlvo(7.5e-3, 15.0)
    curve = trace(Problem(n=2.0, k=0.0, mu=0.3, law=law), "quick", with_bounds=False)
    assert curve.central_gap[0] + law.distance > law.equilibrium_distances[-1]
    assert -1e-2 * curve.load.max() < curve.load[0] < 0.0
