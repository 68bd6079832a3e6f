"""Completeness of paths: what may hide, where they end; layered solids against JKR on the same layers."""

import math
from itertools import pairwise

import numpy as np
import pytest

from fscm import Analysis, NotConverged, Problem, displacement_cycle, equilibria, trace
from fscm._path import events
from fscm._path.completeness import completed, may_hide
from fscm._path.ends import LeastLoad, beyond_layers, displacement_of_compression, refusal
from fscm.custom_punch import CustomPunch
from fscm.experiment import load_controlled_retreat
from fscm.measured_punch import MeasuredPunch
from fscm.path import EquilibriumPath
from fscm.punch import PowerSum, RoundedCone
from tests.fscm.solved_once import ASPERITY, SUBSTRATE, WORK, R, analysis_of, path_of, stiff_on_soft
from tests.marks import heavy
from tests.refusals import refused
from tests.solvers.layered_jkr import Stack, jkr
from tests.solvers.test_layered_jkr import COATINGS

TALL = Problem(2, 0, 0.3, punch=ASPERITY)


def test_the_path_goes_on_behind_a_tall_asperity() -> None:
    """The plain around the asperity of 8 z0 adheres after the first compressive load; value of a finer path."""
    solution = analysis_of(TALL).solution("pull_off_force")
    assert solution.value == pytest.approx(36.50212035, abs=1e-8)
    assert solution.u_num < 1e-7
    minima = [fold.load for fold in analysis_of(TALL).folds if fold.quantity == "load" and not fold.maximum]
    assert minima == pytest.approx([-0.96158840, -36.50212035], abs=1e-4)


def test_the_path_behind_an_asperity_is_passed_once() -> None:
    """The edge jumps from the asperity to the plain; no state comes twice, and delta and P turn only at true folds."""
    turns = [fold for fold in analysis_of(TALL).folds if fold.quantity == "displacement"]
    assert [fold.maximum for fold in turns] == [True, False]
    assert turns[0].displacement == pytest.approx(7.27959, abs=1e-4)
    assert turns[1].displacement == pytest.approx(7.06167, abs=1e-4)
    # Neither the load nor the displacement is stationary where the mesh changes over to another edge.
    for a, b in pairwise(analysis_of(TALL).points):
        if a.segment != b.segment:
            assert b.state.load == pytest.approx(a.state.load, rel=1e-4)
            assert b.state.displacement == pytest.approx(a.state.displacement, rel=1e-4)


@pytest.mark.parametrize(("k", "mu"), [(0.5, 1.0), *heavy((0.0, 0.05), (0.0, 1.0))])
def test_no_state_is_below_the_least_load_of_its_displacement(k: float, mu: float) -> None:
    """The bound holds on all of the path of an asperity, and far in contact it is of the size of the load."""
    problem = Problem(2, k, mu, punch=CustomPunch(lambda r: -3 * np.expm1(-(r**2)) + r**2 / 4, growth=2))
    bound = LeastLoad(problem, 2000.0)
    analysis = Analysis(problem)
    for point in analysis.points:
        assert point.state.load > bound(point.state.displacement)
    end = displacement_of_compression(problem, 2000.0)
    assert analysis.points[-1].state.displacement >= end
    assert bound(1.05 * end) > 0.0 >= bound(0.95 * end)


def test_the_least_load_tends_to_that_without_adhesion() -> None:
    """Under a flat punch of the best radius a paraboloid without adhesion carries 1/sqrt(2) of Hertz."""
    problem = Problem(2, 0, 0.02, punch=PowerSum([0.5, 1e-12], [2, 4]))
    # Without asperities no bound is needed, however slowly the punch rises.
    assert displacement_of_compression(Problem(1, 0, 2.0, punch=RoundedCone(1.0)), 1e6) == -math.inf
    displacement = 100.0
    C = 4 / (math.pi * problem.compliance)
    # The best radius is a^2 = delta + s, the load C (2/3) a (delta + s); less the tension around.
    expected = C * (2 / 3) * (displacement - 1.0) ** 1.5
    assert LeastLoad(problem, 2000.0)(displacement) == pytest.approx(expected, rel=3e-2)
    assert displacement_of_compression(Problem(2, 0, 1.0), 1000.0) == -math.inf


def test_with_the_growth_that_is_named_a_profile_bends_down_nowhere() -> None:
    """The exponent of the last segment, rounded up: a chord is a little less steep than the power."""
    r = np.linspace(0.0, 10.0, 41)
    for power in (2.3, 2.345):
        bent = Problem(2, 0, 1.0, punch=MeasuredPunch(r.tolist(), (r**power).tolist()))
        assert displacement_of_compression(bent, 2000.0) > -math.inf
        growth = float(str(refusal(bent, 2000.0, "unknown")).partition("set growth = ")[2].partition(";")[0])
        straight = Problem(2, 0, 1.0, punch=MeasuredPunch(r.tolist(), (r**power).tolist(), growth))
        assert displacement_of_compression(straight, 2000.0) == -math.inf
        assert power - 0.05 < growth <= power


def test_the_growth_that_is_named_is_not_rounded_down() -> None:
    """The last segment has the exponent 2.30005, and 2.30 would bend the profile down again."""
    r, heights = (0.0, 1.9, 2.0), (0.0, 1.0 - 0.1 * 2.30005 / 2.0, 1.0)
    message = str(refusal(Problem(2, 0, 1.0, punch=MeasuredPunch(r, heights)), 2000.0, "unknown"))
    assert "set growth = 2.31;" in message


def test_a_path_whose_end_has_no_bound_is_not_known_to_be_complete() -> None:
    """So soft a solid pulls itself up to the punch farther than is examined."""
    with pytest.raises(NotConverged, match="cannot be told where its last tension is: the punch bends down at r = "):
        Analysis(Problem(2, 0, 20.0, punch=ASPERITY)).solution("pull_off_force")


@pytest.mark.parametrize(
    ("change", "start", "end", "hides"),
    [(1.0, 1.0, 1.0, False), (-0.1, 1.0, 1.0, True), (0.0, 1.0, -1.0, False), (1.0, 0.01, -0.01, True)],
)
def test_what_may_hide(change: float, start: float, end: float, hides: bool) -> None:
    assert may_hide(1.0, change, start, end) is hides
    assert may_hide(-1.0, change, -start, -end) is hides


def test_steps_over_a_pair_of_folds_are_found() -> None:
    """A path with all points near its two folds left out is completed again."""
    full = analysis_of(Problem(2, 0.6, 3.0)).points
    signs = [point.rates.displacement > 0.0 for point in full]
    down = signs.index(False)
    up = down + signs[down:].index(True)
    assert full[down - 1].segment == full[up].segment
    points = completed([*full[:down], *full[up:]], 1e-4)
    assert sum(p.rates.displacement < 0.0 for p in points) > sum(p.rates.displacement < 0.0 for p in full[up:])


@pytest.mark.parametrize(
    ("control", "value", "number"),
    [
        ("load", -1.788481, 2),
        ("load", -1.788482, 0),
        ("displacement", -1.5569179, 3),
        ("displacement", -1.55691789, 1),
        ("displacement", -1.61733, 3),
        ("displacement", -1.6174, 1),
    ],
)
def test_states_next_to_a_fold_are_all_found(control: str, value: float, number: int) -> None:
    """Two crossings between neighbouring points of the coarse path do not cancel, however close to the fold."""
    states = equilibria(Problem(2, 0.4, 1.0), control, value)
    assert len(states) == number
    assert [getattr(state, control) for state in states] == pytest.approx([value] * number, abs=1e-9)
    gaps = [state.central_gap for state in states]
    assert gaps == sorted(gaps, reverse=True)
    assert len({round(gap, 6) for gap in gaps}) == number


@pytest.mark.heavy
def test_a_landing_that_the_path_does_not_contain_is_told() -> None:
    """It was extrapolated to -0.761; the true load is -0.084."""
    with pytest.raises(ValueError, match=r"ends at delta = -3\.658.* does not contain .*jump-out.* larger start_gap"):
        displacement_cycle(trace(Problem(2, 0.4, 3.0), start_gap=3.0))


@pytest.mark.parametrize("problem", [Problem(2, 0.4, 3.0), *heavy(Problem(5, 0.6, 3.0))])
def test_a_landing_is_within_its_bound(problem: Problem) -> None:
    cycle = displacement_cycle(path_of(problem))
    assert 0.0 < cycle.u_landing < 5e-3  # measured 4.1e-3 and 1.2e-3
    for jump in (cycle.jump_in, cycle.jump_out):
        assert jump is not None
        displacement, load = map(float, jump[:, 1])
        states = equilibria(problem, "displacement", displacement)
        assert min(abs(state.load - load) for state in states) <= cycle.u_landing


@pytest.mark.heavy
def test_a_tensile_end_comes_after_pull_off() -> None:
    problem = Problem(2, 0.4, 3.0)
    path = trace(problem, max_load=-0.5)
    assert path.load[-2] <= -0.5 < path.load[-1] < 0.0
    assert path.load.min() == pytest.approx(path_of(problem).load.min(), abs=1e-7)
    assert load_controlled_retreat(path)[1, -1] == path.load.min()
    refused("max_load = -5 is outside", trace, problem, max_load=-5.0)


def test_a_retreat_needs_a_path_beyond_pull_off() -> None:
    x = np.linspace(0.0, 1.0, 3)
    refused("before pull-off", load_controlled_retreat, EquilibriumPath(-x, x, -x, x, x, 0.0, 0.0))


UNIT = math.pi * R * WORK


def minima(analysis, unit):
    """Contact radii and loads of all minima of the load in contact, about."""
    pairs = events.brackets(analysis.points, events.load_fold, rising=True)
    states = [events.locate(*pair, events.load_fold) for pair in pairs]
    return [(state.scale * unit, state.load) for state in states if state.anchor.in_contact]


def test_the_load_has_the_minima_of_jkr_and_the_deepest_is_the_pull_off():
    """1 GPa, 100 nm on 1.5 MPa: the first minimum, at 75 nm, has half of the load of the second one."""
    analysis, unit = stiff_on_soft()
    for minimum, expected in zip(minima(analysis, unit), COATINGS[1e9, 0.4, 100e-9], strict=True):
        radius, force, _ = expected
        assert minimum == (pytest.approx(radius, rel=0.1), pytest.approx(-force / UNIT, rel=0.03))
    force = analysis.solution("pull_off_force")
    assert force.value * UNIT == pytest.approx(663.18121e-9, rel=2e-7)
    assert force.u_num < 2e-7 * force.value


def test_a_compressive_load_does_not_end_the_path_above_a_stiff_layer():
    """The first compressive state is inside the radius over which the layer bends."""
    analysis, unit = stiff_on_soft()
    points = analysis.points
    compressive = [point.state for point in points if point.state.anchor.in_contact and point.state.load > 0.0]
    assert not beyond_layers(compressive[0])
    assert beyond_layers(compressive[-1])
    # The layer bends up to 1.7 um, twice its thickness times the cube root of the contrast: the margin is above that.
    assert 1.9e-6 < compressive[-1].scale * unit < 5e-6
    assert not any(beyond_layers(state) for state in compressive if state.scale * unit < 1.9e-6)


@pytest.mark.parametrize(("E", "thickness"), [(1e9, 100e-9), *heavy((1e10, 3e-8), (1e9, 1.5e-7))])
def test_no_minimum_follows_the_end_of_a_path(E, thickness):
    """By JKR, up to three times the contact radius of the softest material: the load rises from the end on."""
    analysis, unit = stiff_on_soft(E, thickness)
    limit = jkr(Stack(((E, 0.4, thickness),), SUBSTRATE), WORK, R)
    radii = np.geomspace(analysis.points[-1].state.scale * unit, limit.reach, 3)
    loads = [limit.state(a).load for a in radii]
    assert loads[0] > 0.0
    assert np.all(np.diff(loads) > 0.0)
