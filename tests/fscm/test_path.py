"""The traced path: energy balance, folds among its points, the experiment, states under each control."""

import math
from itertools import pairwise

import numpy as np
import pytest

from fscm import NotConverged, Problem, equilibria, profile, solve, solve_together, trace
from fscm._arc_length import parameter_of, rates_of
from fscm._continuation import equilibrium_path, moved
from tests.fscm.solved_once import analysis_of, path_of
from tests.marks import heavy


@pytest.mark.parametrize(
    ("n", "k", "mu"),
    [
        (5.0, 0.3, 1.2),
        *heavy((2.0, 0.0, 0.3), (2.0, 0.4, 1.5), (1.5, 0.6, 1.0), (1.0, 0.2, 0.5)),
    ],
)
def test_work_equals_change_of_energy(n: float, k: float, mu: float) -> None:
    """Elastic plus surface energy changes by the work of the load between all neighbours on the path.

    The work is the Gauss integral over the continuation parameter of P d(delta), at states solved there.
    """
    points = []
    for point in equilibrium_path(Problem(n, k, mu), 10, 1e-6, longest_step=0.2):
        points.append(point)
        if point.state.follows_edge and point.state.load > 0:
            break
    nodes, weights = np.polynomial.legendre.leggauss(6)
    worst = 0.0
    for a, b in pairwise(points):
        if a.state.follows_edge != b.state.follows_edge:
            continue
        x = [parameter_of(p.state) for p in (a, b)]
        work = 0.0
        for node, weight in zip(nodes, weights, strict=True):
            state = moved(a.state, rates_of(a.state), x[0] + 0.5 * (1 + node) * (x[1] - x[0]))
            work += 0.5 * (x[1] - x[0]) * weight * state.load * rates_of(state).displacement
        worst = max(worst, abs(b.state.energy - a.state.energy - work))
    # Meshes of tolerance 1e-6 differ between neighbours; measured worst 4e-7.
    assert worst < 3e-6


@pytest.mark.parametrize("mu", [1.0, *heavy(3.0)])
def test_a_path_has_its_events_and_bounds_that_hold(mu: float) -> None:
    problem = Problem(2, 0.4, mu)
    path, analysis = path_of(problem), analysis_of(problem)
    assert path.load.min() == pytest.approx(-analysis.solution("pull_off_force").value, abs=1e-7)
    folds = np.flatnonzero(np.diff(path.displacement) < 0)
    for jump, at in (("jump_in", folds[0]), ("jump_out", folds[-1] + 1)):
        exact = analysis.solution(f"{jump}_displacement").value
        assert path.displacement[at] == pytest.approx(exact, abs=1e-6)
    assert max(path.u_load, path.u_displacement) < 1e-5
    # States at the same central gap, solved to full accuracy.
    for i in (3, len(path.load) // 2, -5):
        (state,) = equilibria(problem, "central_gap", float(path.central_gap[i]))
        # In contact the central gap hardly moves: compare along the curve, not at equal gap.
        slope = np.gradient(path.load, path.displacement)[i]
        off = state.load - path.load[i] - slope * (state.displacement - path.displacement[i])
        assert abs(off) < path.u_load + abs(slope) * path.u_displacement + 1e-9


def test_bad_controls_and_angles_are_refused() -> None:
    problem = Problem(2, 0.4, 1.0)
    for control, value, message in (
        ("gap", 1.0, "unknown"),
        ("load", math.nan, "finite"),
        ("central_gap", -1.0, "singular"),
    ):
        with pytest.raises(ValueError, match=message):
            equilibria(problem, control, value)
    for degrees in (0.0, -5.0, 181.0, math.nan):
        with pytest.raises(ValueError, match="largest_turn"):
            trace(problem, largest_turn=degrees)


def test_profiles_at_pull_off() -> None:
    """Eq. 4 closes on the profiles; the contact is flat and the edge carries the strength (Fig. 5)."""
    surface = profile(Problem(2, 0.4, 1.0))
    closure = surface.gap + surface.displacement - surface.radius**2 / 2 - surface.deformation
    assert np.max(np.abs(closure) / (1 + surface.gap)) < 1e-10
    assert surface.pressure.min() == pytest.approx(-1.0264, abs=1e-3)
    assert abs(surface.gap[0]) < 0.02


@pytest.mark.parametrize(
    ("k", "mu", "zero_load_displacement"), [(0.0, 1e5, 194888.854486038), (0.4, 1e3, 2017.03606843554)]
)
@pytest.mark.heavy
def test_an_edge_below_the_rounding_of_its_radius(k: float, mu: float, zero_load_displacement: float) -> None:
    """JKR-n-k: it is right to 5e-7 here.  A mesh that does not resolve the edge was wrong by 2e-3."""
    solutions = solve_together(Problem(2.0, k, mu), ("pull_off_force", "zero_load_displacement"))
    for solution, jkr in zip(solutions.values(), (0.5 * (3.0 + k), zero_load_displacement), strict=True):
        assert solution.value == pytest.approx(jkr, rel=5e-7)
        assert solution.u_num < 1e-6 * jkr


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.9, 100.0), (2.0, 0.99, 1.0), (2.0, 0.95, 20.0)])
def test_an_edge_too_narrow_is_refused_with_the_largest_tabor_number(n: float, k: float, mu: float) -> None:
    with pytest.raises(NotConverged, match=r"the largest Tabor number at n = 2, k = .* is mu = "):
        solve(Problem(n, k, mu), "pull_off_force")


def test_the_drawn_curve_turns_slowly():
    """The loop at n = 5, mu = 2 has several folds: 180 degrees adds no points, and then the line has corners."""
    problem = Problem(5.0, 0.4, 2.0)
    sparse, dense = trace(problem, largest_turn=180.0), trace(problem)

    def largest_turn(path):
        depth = -path.load.min()
        drawn = (path.load < 0.5 * depth) & (np.abs(path.load) > 0.05 * depth)
        x, y = path.displacement / np.ptp(path.displacement[drawn]), path.load / (1.5 * depth)
        chords = np.diff(np.stack([x, y]), axis=1)
        # Folds and the zero of the load may be next to a point of the path.
        long = np.hypot(*chords) > 1e-6
        angle = np.unwrap(np.arctan2(chords[1], chords[0]))
        inside = drawn[1:-1] & long[1:] & long[:-1]
        return np.degrees(np.abs(np.diff(angle))[inside].max())

    assert largest_turn(sparse) > 20.0
    assert largest_turn(dense) <= 5.0
    assert len(dense.load) < 4 * len(sparse.load)
