"""Paths of random punches: complete or refused, as the brute-force path on a fixed mesh and the committed table say."""

from __future__ import annotations

import csv
import math
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fscm import Analysis, CustomPunch, Problem, displacement_cycle
from fscm._bounds import EventErrors, energy_of_jump
from fscm.path import EquilibriumPath, _with_events
from tests.fscm.brute_force import BruteForce, least_load
from tests.fscm.random_punches import COUNT, SEED, outcome, random_punch

TABLE = Path(__file__).with_name("random_punches.csv")
# The fixed mesh of the brute force does not resolve the contact edge: measured worst 4e-4 over eight punches.
BRUTE_FORCE = 1e-2
LIGHT = (0, 5, 6)


@lru_cache(maxsize=1)
def table() -> dict[int, dict[str, str]]:
    with TABLE.open() as file:
        return {int(row["number"]): row for row in csv.DictReader(file)}


def test_no_punch_of_the_table_is_silently_wrong() -> None:
    rows = table()
    assert list(rows) == list(range(COUNT))
    for number, row in rows.items():
        assert int(row["seed"]) == SEED
        assert row["kind"] == random_punch(number).kind
        if row["status"] == "complete" and row["brute_force"]:
            assert float(row["pull_off_force"]) == pytest.approx(float(row["brute_force"]), rel=BRUTE_FORCE)


@pytest.mark.parametrize(
    "number", [*LIGHT, *(pytest.param(i, marks=pytest.mark.heavy) for i in range(COUNT) if i not in LIGHT)]
)
def test_the_outcome_is_that_of_the_table(number: int) -> None:
    row = table()[number]
    status, force, _ = outcome(random_punch(number))
    assert status == row["status"]
    if status == "complete":
        assert force == pytest.approx(float(row["pull_off_force"]), rel=1e-6)


@pytest.mark.parametrize(
    "number", [0, pytest.param(2, marks=pytest.mark.heavy), pytest.param(10, marks=pytest.mark.heavy)]
)
def test_a_path_on_a_fixed_mesh_from_the_other_end_has_the_same_least_load(number: int) -> None:
    case = random_punch(number)
    _, force, _ = outcome(case)
    assert -least_load(case.problem, case.height) == pytest.approx(force, rel=BRUTE_FORCE)


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
    parts = [energy_of_jump(*EventErrors(fold.value).at_fold(), landing.value) for fold, landing in jumps]
    assert analysis.solution("hysteresis_energy").u_num == pytest.approx(sum(part.total for part in parts))
    states, _ = _with_events(analysis.points)
    arrays = [np.array([getattr(state, name) for state in states]) for name in ("central_gap", "displacement", "load")]
    blank = np.full(len(states), math.nan)
    cycle = displacement_cycle(EquilibriumPath(*arrays, blank, blank, 0.0, 0.0))
    area = sum(np.trapezoid(part[1], part[0]) for part in (cycle.loading, cycle.unloading))
    # The trapezoidal rule on the coarse path with its folds; the first jumps alone have less than half of it.
    assert analysis.solution("hysteresis_energy").value == pytest.approx(area, rel=0.1)


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
