"""Paths of random punches: complete or refused, as the brute-force path on a fixed mesh and the committed table say."""

from __future__ import annotations

import csv
import math
from functools import lru_cache

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fscm import Analysis, CustomPunch, NoSuchEvent, Problem, displacement_cycle, trace
from fscm._bounds import EventErrors, energy_of_jump
from fscm._meshes import Mesh, Meshes
from fscm.path import EquilibriumPath, _with_events
from tests.fscm.brute_force import BruteForce, stable_states
from tests.fscm.random_punches import COUNT, SEED, TABLE, outcome, random_punch

# The fixed mesh of the brute force does not resolve the contact edge: measured worst 4e-4 over the hundred punches.
BRUTE_FORCE = 1e-3
# A branch is left at the end of a step of 2e-4, on that mesh: measured worst 6e-4.
JUMP = 3e-3
# One of each kind; the measured profiles were refused, or had folds that do not exist.
LIGHT = (0, 2, 3, 4, 6, 9)


@lru_cache(maxsize=1)
def table() -> dict[int, dict[str, str]]:
    with TABLE.open() as file:
        return {int(row["number"]): row for row in csv.DictReader(file)}


def heavy_but(light: tuple[int, ...]) -> list[object]:
    """All numbers of the table; those that are not `light` are marked as heavy."""
    return [*light, *(pytest.param(i, marks=pytest.mark.heavy) for i in range(COUNT) if i not in light)]


def test_no_punch_of_the_table_is_silently_wrong() -> None:
    rows = table()
    assert list(rows) == list(range(COUNT))
    for number, row in rows.items():
        assert int(row["seed"]) == SEED
        assert row["kind"] == random_punch(number).kind
        assert row["status"] == "complete"
        assert float(row["pull_off_force"]) == pytest.approx(float(row["brute_force"]), rel=BRUTE_FORCE)


@pytest.mark.parametrize("number", heavy_but(LIGHT))
def test_the_outcome_is_that_of_the_table(number: int) -> None:
    """The path has the folds at which the stable states of a fixed mesh end as well, up to its own end."""
    row, analysis = table()[number], Analysis(random_punch(number).problem)
    values = outcome(analysis)
    assert values.status == row["status"], values.reason
    assert values.force == pytest.approx(float(row["pull_off_force"]), rel=1e-6)
    for column, maximum in (("retreat", False), ("approach", True)):
        folds = [f.displacement for f in analysis.folds if f.quantity == "displacement" and f.maximum == maximum]
        for jump in map(float, row[column].split()):
            if jump < analysis.points[-1].state.displacement:
                assert min(abs(jump - fold) for fold in folds) < JUMP


def test_jumps_farther_in_than_the_last_tension_are_not_part_of_the_path() -> None:
    """Brute force finds one at delta = 17.2, where every state is compressed; the message has the end of the path."""
    analysis = Analysis(random_punch(67).problem)
    assert float(table()[67]["approach"]) > analysis.points[-1].state.displacement
    with pytest.raises(
        NoSuchEvent, match=r"no jump up to delta = 1\d\.\d+, P = \d+\.\d+, beyond which no state carries"
    ):
        analysis.solution("jump_in_displacement")


@pytest.mark.parametrize("number", heavy_but((0,)))
def test_stable_states_on_a_fixed_mesh_have_the_least_load_and_the_jumps_of_the_table(number: int) -> None:
    case, row = random_punch(number), table()[number]
    states = stable_states(case.problem, case.height)
    assert states.pull_off_force == pytest.approx(float(row["brute_force"]), rel=1e-4)
    for column in ("retreat", "approach"):
        jumps = [float(jump) for jump in row[column].split()]
        assert list(getattr(states, column)) == pytest.approx(jumps, abs=JUMP)


def test_no_fold_appears_where_the_edge_passes_a_kink() -> None:
    """A mesh that follows the edge over the kinks of this profile adds two folds of the displacement."""
    assert table()[9]["approach"] == ""
    assert all(fold.quantity == "load" for fold in Analysis(random_punch(9).problem).folds)


def test_a_path_has_an_edge_where_the_mesh_does_not_follow_it() -> None:
    """The mesh of a measured profile has a fixed scale; its edge is where the gap is that of the largest tension."""
    path = trace(random_punch(4).problem, "quick")
    touching = ~np.isnan(path.edge_radius)
    assert not touching[0]
    assert touching[-1]
    assert path.edge_radius[-1] > 3.0
    edges = [fold.edge_radius for fold in path.folds]
    assert len(edges) == 1
    assert 0.0 < edges[0] < path.edge_radius[-1]


def test_hysteresis_counts_every_jump_of_a_cycle() -> None:
    """The asperity and the paraboloid around it jump one after the other: the lost energy is the area of both loops."""
    punch = CustomPunch(
        lambda r: -12 * np.expm1(-((r / 3) ** 2)) + r**2 / 16,
        growth=2,
        derivative=lambda r: 24 * r / 9 * np.exp(-((r / 3) ** 2)) + r / 8,
    )
    analysis = Analysis(Problem(2, 0, 1.6, punch=punch))
    for name in ("jump_in", "jump_out"):
        assert len(analysis.jumps(name)) == 2
    with pytest.raises(ValueError, match="unknown jump"):
        analysis.landing("nonsense")
    jumps = [jump for name in ("jump_in", "jump_out") for jump in analysis.jumps(name)]
    parts = [energy_of_jump(*EventErrors(fold.value).at_fold(), fold.value, landing.value) for fold, landing in jumps]
    assert analysis.solution("hysteresis_energy").u_num == pytest.approx(sum(part.total for part in parts))
    states, _ = _with_events(analysis.points)
    arrays = [np.array([getattr(state, name) for state in states]) for name in ("central_gap", "displacement", "load")]
    blank = np.full(len(states), math.nan)
    cycle = displacement_cycle(EquilibriumPath(*arrays, blank, blank, 0.0, 0.0))
    area = sum(np.trapezoid(part[1], part[0]) for part in (cycle.loading, cycle.unloading))
    # The trapezoidal rule on the coarse path with its folds; the first jumps alone have less than half of it.
    assert analysis.solution("hysteresis_energy").value == pytest.approx(area, rel=0.1)


def test_a_small_force_of_a_tall_asperity_in_a_ring_is_bracketed_on_a_finer_path() -> None:
    """An asperity of a curvature near 900: its force is as small as the resolution of the usual path."""
    bumps = ((100.0, 8.0, 1.0), (110.0, 0.0, 0.5))

    def height(r: np.ndarray) -> np.ndarray:
        shapes = (h * (np.exp(-((r - at) ** 2) / w**2) - np.exp(-(at**2) / w**2)) for h, at, w in bumps)
        return 0.5 * r**2 - sum(shapes)

    def slope(r: np.ndarray) -> np.ndarray:
        return r + sum(2.0 * h * (r - at) / w**2 * np.exp(-((r - at) ** 2) / w**2) for h, at, w in bumps)

    problem = Problem(2, 0, 1.0, CustomPunch(height, growth=2, derivative=slope))
    force = Analysis(problem).solution("pull_off_force")
    finer = Analysis(problem, Meshes(path=Mesh(8, 3e-6))).solution("pull_off_force")
    assert 0.0 < force.u_num < 1e-9 * force.value
    assert abs(force.value - finer.value) <= force.u_num + finer.u_num + 1e-12 * force.value


@pytest.mark.heavy
def test_the_force_of_the_tall_asperity_by_another_route() -> None:
    """A fixed mesh from compression under displacement control, no edge followed: all ten digits of 36.50212035."""
    problem = Problem(2, 0, 0.3, punch=CustomPunch(lambda r: -8 * np.expm1(-(r**2)) + r**2 / 50, growth=2))
    brute = BruteForce(problem, 0.3, 13.0, order=10, most=10**6, height=1e6)
    H = brute.compressed(12.0)

    def load(displacement: float) -> float:
        nonlocal H
        for _ in range(12):
            step = np.linalg.solve(brute.jacobian(H), -brute.residual(H, displacement))
            H = H + step
            if np.max(np.abs(step) / (1.0 + np.abs(H))) < 1e-11:
                return brute.load(H)
        raise AssertionError(f"no state at delta = {displacement}")

    for displacement in np.arange(11.6, 7.5, -0.4):
        load(displacement)
    least = minimize_scalar(load, bounds=(7.4, 7.6), method="bounded", options={"xatol": 1e-6})
    assert -least.fun == pytest.approx(36.50212035, abs=1e-8)
