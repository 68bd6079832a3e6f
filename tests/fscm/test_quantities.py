"""The table of quantities, several quantities at once, and the accuracy of paths and fields."""

import numpy as np
import pytest

from fscm import Analysis, NoSuchEvent, Problem, Solution, profile, solve, solve_together, trace
from fscm.quantities import TABLE

# A stiff solid, which does not jump, and a soft one.
STIFF, SOFT = Problem(2, 0, 0.1), Problem(2, 0.4, 1.0)
PATH_QUANTITIES = [name for name, row in TABLE.items() if row.needs]


def test_quantities_of_one_path_together_are_those_alone() -> None:
    solutions = solve_together(SOFT, reversed(PATH_QUANTITIES))
    assert list(solutions) == PATH_QUANTITIES[::-1]
    for name in ("jump_out_gap", "hysteresis_energy"):
        solution = solutions[name]
        assert isinstance(solution, Solution)
        assert solution.value == pytest.approx(solve(SOFT, name).value, rel=1e-12)


@pytest.mark.parametrize("problem", [STIFF, Problem(2, 1, 0.3)], ids=["graded", "Gibson"])
def test_a_quantity_that_does_not_exist_is_returned_as_the_exception(problem: Problem) -> None:
    solutions = solve_together(problem, PATH_QUANTITIES)
    missing = {name for name, solution in solutions.items() if isinstance(solution, NoSuchEvent)}
    assert missing == {name for name in PATH_QUANTITIES if name.startswith("jump") or name == "hysteresis_energy"}
    assert solutions["pull_off_force"].value > 0


@pytest.mark.parametrize("problem", [STIFF, Problem(2, 1, 0.3)], ids=["graded", "Gibson"])
def test_an_unknown_quantity_or_accuracy_is_refused_before_anything_is_computed(problem: Problem) -> None:
    with pytest.raises(ValueError, match="unknown quantity 'weight'; known are pull_off_force"):
        solve_together(problem, ["pull_off_force", "weight"])
    with pytest.raises(ValueError, match="unknown accuracy 'best'; it is a relative error or one of quick"):
        solve(problem, "pull_off_force", accuracy="best")


def test_an_unknown_event_is_refused_with_the_known_names() -> None:
    with pytest.raises(ValueError, match="unknown event 'jump_in_gap'; known are pull_off, jump_in, jump_out, zero"):
        Analysis(STIFF).event("jump_in_gap")
    with pytest.raises(ValueError, match="unknown jump 'pull_off'; known are jump_in, jump_out"):
        Analysis(STIFF).landing("pull_off")


def test_paths_and_fields_are_as_accurate_as_requested() -> None:
    coarse, fine = (trace(SOFT, accuracy) for accuracy in (1e-6, 1e-9))
    assert fine.u_load < 0.1 * coarse.u_load
    assert abs(coarse.load.min() - fine.load.min()) <= coarse.u_load + fine.u_load
    coarse, fine = (profile(SOFT, "zero_load", accuracy) for accuracy in (1e-6, 1e-9))
    assert coarse.radius.size < fine.radius.size
    inner = coarse.radius < 3.0
    between = np.interp(coarse.radius[inner], fine.radius, fine.gap)
    np.testing.assert_allclose(coarse.gap[inner], between, atol=1e-2)  # linear between the nodes of the finer mesh
