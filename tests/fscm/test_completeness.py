"""Completeness of the path: hidden turning points, its end, the list of folds, states next to a fold."""

import math
from itertools import pairwise

import numpy as np
import pytest

from fscm import Analysis, Problem, displacement_cycle, equilibria, trace
from fscm._completeness import completed, may_hide
from fscm._path_end import LeastLoad, displacement_of_compression
from fscm.custom_punch import CustomPunch
from fscm.errors import NotConverged
from fscm.experiment import load_controlled_retreat
from fscm.path import EquilibriumPath
from fscm.punch import PowerSum, RoundedCone
from tests.fscm.solved_once import ASPERITY, analysis_of, path_of
from tests.marks import heavy

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


def test_a_path_whose_end_has_no_bound_is_not_known_to_be_complete() -> None:
    """So soft a solid pulls itself up to the punch farther than is examined."""
    with pytest.raises(NotConverged, match="cannot be told where its last tension is"):
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
    with pytest.raises(ValueError, match="max_load = -5 is outside"):
        trace(problem, max_load=-5.0)


def test_a_retreat_needs_a_path_beyond_pull_off() -> None:
    x = np.linspace(0.0, 1.0, 3)
    with pytest.raises(ValueError, match="before pull-off"):
        load_controlled_retreat(EquilibriumPath(-x, x, -x, x, x, 0.0, 0.0))
