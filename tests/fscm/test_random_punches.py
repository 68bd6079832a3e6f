"""Paths of random punches: complete or refused, as the brute-force path on a fixed mesh and the committed table say."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fscm import Analysis, NoSuchEvent, Problem, trace
from tests.fscm.brute_force import BruteForce, stable_states
from tests.fscm.random_punches import COUNT, TABLE, random_punch
from tests.fscm.solved_once import ASPERITY
from tests.marks import heavy
from tests.random_tables import stored

# The fixed mesh of the brute force does not resolve the contact edge: measured worst 4e-4 over the hundred punches.
BRUTE_FORCE = 1e-3
# A branch is left at the end of a step of 2e-4, on that mesh: measured worst 6e-4.
JUMP = 3e-3
# One of each kind; the measured profiles were refused, or had folds that do not exist.
LIGHT = (0, 4, 9)


ROWS = stored(TABLE)


def test_no_punch_of_the_table_is_silently_wrong() -> None:
    assert [int(row["number"]) for row in ROWS] == list(range(COUNT))
    for row in ROWS:
        assert float(row["pull_off_force"]) == pytest.approx(float(row["brute_force"]), rel=BRUTE_FORCE)


@pytest.mark.parametrize("number", [*LIGHT, *heavy(*(i for i in range(COUNT) if i not in LIGHT))])
def test_the_path_has_the_force_of_the_table_and_its_folds(number: int) -> None:
    """The folds at which the stable states of a fixed mesh end as well, up to the end of the path."""
    row, analysis = ROWS[number], Analysis(random_punch(number).problem)
    assert analysis.solution("pull_off_force").value == pytest.approx(float(row["pull_off_force"]), rel=1e-6)
    for column, maximum in (("retreat", False), ("approach", True)):
        folds = [f.displacement for f in analysis.folds if f.quantity == "displacement" and f.maximum == maximum]
        for jump in map(float, row[column].split()):
            if jump < analysis.points[-1].state.displacement:
                assert min(abs(jump - fold) for fold in folds) < JUMP
    if number == 9:  # a mesh that follows the edge over the kinks of this profile adds two folds of the displacement
        assert all(fold.quantity == "load" for fold in analysis.folds)


def test_jumps_farther_in_than_the_last_tension_are_not_part_of_the_path() -> None:
    """Brute force finds one at delta = 17.2, where every state is compressed; the message has the end of the path."""
    analysis = Analysis(random_punch(67).problem)
    assert float(ROWS[67]["approach"]) > analysis.points[-1].state.displacement
    with pytest.raises(
        NoSuchEvent, match=r"no jump up to delta = 1\d\.\d+, P = \d+\.\d+, beyond which no state carries"
    ):
        analysis.solution("jump_in_displacement")


@pytest.mark.parametrize("number", [0, *heavy(*range(1, COUNT))])
def test_stable_states_on_a_fixed_mesh_have_the_least_load_and_the_jumps_of_the_table(number: int) -> None:
    states, row = stable_states(*random_punch(number)), ROWS[number]
    assert states.pull_off_force == pytest.approx(float(row["brute_force"]), rel=1e-4)
    for column in ("retreat", "approach"):
        jumps = [float(jump) for jump in row[column].split()]
        assert getattr(states, column) == pytest.approx(jumps, abs=JUMP)


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


@pytest.mark.heavy
def test_the_force_of_the_tall_asperity_by_another_route() -> None:
    """A fixed mesh from compression under displacement control, no edge followed: all ten digits of 36.50212035."""
    brute = BruteForce(Problem(2, 0, 0.3, punch=ASPERITY), 0.3, 13.0, order=10, most=10**6, height=1e6)
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
