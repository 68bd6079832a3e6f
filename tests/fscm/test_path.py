"""The traced path and its jumps: energy balance, folds, states under each control, several stable branches."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

import fscm
from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import equilibrium_path, moved
from fscm._path.jumps import Branch, jumps_between
from fscm.stability import margins
from tests.fscm.solved_once import analysis_of, path_of, stiff_on_soft
from tests.marks import heavy
from tests.refusals import refused


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
    for point in equilibrium_path(fscm.Problem(n, k, mu), 10, 1e-6, longest_step=0.2):
        points.append(point)
        if point.state.anchor.in_contact and point.state.load > 0:
            break
    nodes, weights = np.polynomial.legendre.leggauss(6)
    worst = 0.0
    for a, b in pairwise(points):
        if a.state.anchor.in_contact != b.state.anchor.in_contact:
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
    problem = fscm.Problem(2, 0.4, mu)
    path, analysis = path_of(problem), analysis_of(problem)
    assert path.load.min() == pytest.approx(-analysis.solution("pull_off_force").value, abs=1e-7)
    folds = np.flatnonzero(np.diff(path.displacement) < 0)
    for jump, at in (("jump_in", folds[0]), ("jump_out", folds[-1] + 1)):
        exact = analysis.solution(f"{jump}_displacement").value
        assert path.displacement[at] == pytest.approx(exact, abs=1e-6)
    assert max(path.u_load, path.u_displacement) < 1e-5
    # States at the same central gap, solved to full accuracy.
    for i in (3, len(path.load) // 2, -5):
        (state,) = fscm.equilibria(problem, "central_gap", float(path.central_gap[i]))
        # In contact the central gap hardly moves: compare along the curve, not at equal gap.
        slope = np.gradient(path.load, path.displacement)[i]
        off = state.load - path.load[i] - slope * (state.displacement - path.displacement[i])
        assert abs(off) < path.u_load + abs(slope) * path.u_displacement + 1e-9


def test_bad_controls_and_angles_are_refused() -> None:
    problem = fscm.Problem(2, 0.4, 1.0)
    for control, value, message in (
        ("gap", 1.0, "unknown"),
        ("load", math.nan, "finite"),
        ("central_gap", -1.0, "singular"),
    ):
        refused(message, fscm.equilibria, problem, control, value)
    for degrees in (0.0, -5.0, 181.0, math.nan):
        refused("largest_turn", fscm.trace, problem, largest_turn=degrees)


def test_profiles_at_pull_off() -> None:
    """Eq. 4 closes on the profiles; the contact is flat and the edge carries the strength (Fig. 5)."""
    surface = fscm.profile(fscm.Problem(2, 0.4, 1.0))
    closure = surface.gap + surface.displacement - surface.radius**2 / 2 - surface.deformation
    assert np.max(np.abs(closure) / (1 + surface.gap)) < 1e-10
    assert surface.pressure.min() == pytest.approx(-1.0264, abs=1e-3)
    assert abs(surface.gap[0]) < 0.02


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.9, 100.0), (2.0, 0.99, 1.0), (2.0, 0.95, 20.0)])
def test_an_edge_too_narrow_is_refused_with_the_largest_tabor_number(n: float, k: float, mu: float) -> None:
    with pytest.raises(fscm.NotConverged, match=r"the largest Tabor number at n = 2, k = .* is mu = "):
        fscm.solve(fscm.Problem(n, k, mu), "pull_off_force")


def test_the_drawn_curve_turns_slowly():
    """The loop at n = 5, mu = 2 has several folds: 180 degrees adds no points, and then the line has corners."""
    problem = fscm.Problem(5.0, 0.4, 2.0)
    sparse, dense = fscm.trace(problem, largest_turn=180.0), fscm.trace(problem)

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


#: Displacements at jump-in and at both folds of the retreat of the film below, in nm; from its traced path.
FILM_JUMPS = [-9.0557, -122.2588, -135.4293]
#: Loss in the first jump of the retreat, in pi R w z0, by the finite elements (`tests/fem_reference/test_jumps.py`).
LOSS_OF_FILM = 0.46289


def _branches(*spans):
    """Branches between displacements; the names of their folds stand for brackets, which are only handed on."""
    return [
        Branch(f"low {i}" if least > -math.inf else None, f"high {i}" if largest < math.inf else None, least, largest)
        for i, (least, largest) in enumerate(spans)
    ]


@pytest.mark.parametrize(
    ("spans", "approach", "retreat"),
    [
        ([(-math.inf, 1.0), (0.0, math.inf)], [("high 0", 1)], [("low 1", 0)]),
        # The last minimum is not the lowest: two jumps of the retreat, one of the approach.
        ([(-math.inf, 9.0), (0.0, 3.0), (2.0, math.inf)], [("high 0", 2)], [("low 2", 1), ("low 1", 0)]),
        # The last minimum is the lowest: the branch in the middle is not met on retreat.
        ([(-math.inf, 3.0), (2.0, 9.0), (0.0, math.inf)], [("high 0", 1), ("high 1", 2)], [("low 2", 0)]),
        # Two asperities that jump one after the other both ways.
        ([(-math.inf, 1.0), (0.0, 7.0), (6.0, math.inf)], [("high 0", 1), ("high 1", 2)], [("low 2", 1), ("low 1", 0)]),
        # The branch in the middle is above the first jump and below the second: neither lands there.
        ([(-math.inf, 1.0), (2.0, 3.0), (0.0, math.inf)], [("high 0", 2)], [("low 2", 0)]),
    ],
)
def test_each_jump_lands_on_the_next_branch_with_its_displacement(
    spans: list[tuple[float, float]], approach: list[tuple[str, int]], retreat: list[tuple[str, int]]
) -> None:
    branches = _branches(*spans)
    for inward, expected in ((True, approach), (False, retreat)):
        jumps = [(fold, branches.index(branch)) for fold, branch in jumps_between(branches, inward)]
        assert jumps == expected


def test_a_jump_without_a_branch_to_land_on_is_told() -> None:
    with pytest.raises(fscm.NotConverged, match=r"displacement 9, at which a jump-in begins"):
        jumps_between(_branches((-math.inf, 9.0), (0.0, 3.0)), inward=True)


@pytest.fixture(scope="module")
def film() -> fscm.Analysis:
    """A sphere on a stiff film on a soft solid: the film alone jumps out of contact before the solid below does."""
    return stiff_on_soft()[0]


def test_a_film_jumps_twice_on_retreat(film: fscm.Analysis) -> None:
    jumps = [*film.jumps("jump_in"), *film.jumps("jump_out")]
    assert [len(film.jumps(name)) for name in ("jump_in", "jump_out")] == [1, 2]
    assert [0.4 * fold.value.displacement for fold, _ in jumps] == pytest.approx(FILM_JUMPS, abs=1e-4)
    assert film.solution("jump_out_displacement").value == jumps[-1][0].value.displacement
    for fold, landing in jumps:
        assert landing.value.displacement == pytest.approx(fold.value.displacement, abs=1e-9)
        assert margins(landing.value)[0] > 0.0
        assert fold.value.energy > landing.value.energy


def test_the_hysteresis_of_a_film_is_what_its_three_jumps_lose(film: fscm.Analysis) -> None:
    jumps = [*film.jumps("jump_in"), *film.jumps("jump_out")]
    losses = [fold.value.energy - landing.value.energy for fold, landing in jumps]
    energy = film.solution("hysteresis_energy")
    assert energy.value == pytest.approx(sum(losses), rel=1e-12)
    assert losses[1] == pytest.approx(LOSS_OF_FILM, rel=1e-3)
    assert 0.0 < energy.u_num < 1e-7 * energy.value


@pytest.mark.parametrize(
    ("held", "retreat"), [([True, False, False, False, False, True], [-2.5]), ([], [-2.5, -3.0])], ids=["marks", "none"]
)
def test_a_recorded_jump_passes_over_what_cannot_be_held(held: list[bool], retreat: list[float]) -> None:
    """Of a part between two folds that is unstable twice the displacement rises, too."""
    displacement = np.array([-9.0, 0.0, -3.0, -1.0, -2.5, 1.0])
    blank, marks = np.zeros(6), np.array(held, bool)
    cycle = fscm.displacement_cycle(
        fscm.EquilibriumPath(blank, displacement, np.arange(6.0), blank, blank, 0.0, 0.0, (), marks, marks)
    )
    jumps = np.flatnonzero(np.diff(cycle.unloading[0]) == 0.0)
    assert cycle.unloading[0, jumps].tolist() == retreat
    assert cycle.jump_in is not None
    assert cycle.jump_out is not None
    assert cycle.jump_in[0].tolist() == [0.0, 0.0]
    assert cycle.jump_out[0, 0] == retreat[-1]


@pytest.mark.parametrize(
    ("k", "mu", "zero_load_displacement"), [(0.0, 1e5, 194888.854486038), (0.4, 1e3, 2017.03606843554)]
)
@pytest.mark.heavy
def test_an_edge_below_the_rounding_of_its_radius(k: float, mu: float, zero_load_displacement: float) -> None:
    """JKR-n-k: it is right to 5e-7 here.  A mesh that does not resolve the edge was wrong by 2e-3."""
    solutions = fscm.solve_together(fscm.Problem(2.0, k, mu), ("pull_off_force", "zero_load_displacement"))
    for solution, jkr in zip(solutions.values(), (0.5 * (3.0 + k), zero_load_displacement), strict=True):
        assert solution.value == pytest.approx(jkr, rel=5e-7)
        assert solution.u_num < 1e-6 * jkr
