"""Bounds on random punches and laws that are less smooth than the panels: each quantity against one at 1e-10.

Balls, laws through points, functions with an unstated jump of a derivative and the other kinds of `tests.random_kinds`.
The part `law` is of the law, not of the computation, and is left out.
"""

import pytest

import fscm
from tests.marks import heavy
from tests.random_kinds import problem

SEED = 20261128
TABOR = (0.1, 3.0)
NAMES = tuple(name for name in fscm.QUANTITIES if name != "critical_tabor_number")
NINE_THREE = "lennard-jones-9-3"
FINE = 1e-10
#: Quantities, and a kind of punch and of law each, with seed and number; their bounds were up to 2.5 times too small.
ONCE_TOO_SMALL = [
    (("zero_load_displacement",), "ball", NINE_THREE, 9100, 107),
    (("pull_off_displacement",), "sphere", "table", 9200, 102),
    *heavy(
        (NAMES, "ball", NINE_THREE, 9100, 106),
        (NAMES, "sphere", "table", 9200, 103),
        (NAMES, "function", NINE_THREE, 9400, 0),
        (NAMES, "function", NINE_THREE, 9400, 2),
    ),
]
#: Kinds, and how many are drawn of each.
DRAWN = {
    ("ball", NINE_THREE): 60,
    ("sphere", "table"): 40,
    ("sphere", "smoothed table"): 20,
    ("rounded-cone", "table"): 20,
    ("ball", "mie"): 20,
    ("function", NINE_THREE): 40,
    ("function", "table"): 10,
    ("table", NINE_THREE): 20,
    ("smoothed table", NINE_THREE): 20,
    ("rounded-flat", NINE_THREE): 20,
    ("power sum", "table"): 20,
}


def without_law(solution: fscm.Solution) -> float:
    return sum(bound for part, bound in solution.parts.items() if part != "law")


def judge(posed: fscm.Problem, names: tuple[str, ...]) -> None:
    """Each quantity exists at both accuracies, within the sum of both bounds, or at neither."""
    solutions, exact = fscm.solve_together(posed, names), fscm.solve_together(posed, names, FINE)
    for name in names:
        assert isinstance(solutions[name], fscm.Solution) == isinstance(exact[name], fscm.Solution), name
        if isinstance(exact[name], fscm.Solution):
            error = abs(solutions[name].value - exact[name].value)
            assert error <= without_law(solutions[name]) + without_law(exact[name]), (name, solutions[name].value)


@pytest.mark.filterwarnings("ignore::fscm.AccuracyWarning")
@pytest.mark.parametrize(("names", "punch", "law", "seed", "number"), ONCE_TOO_SMALL)
def test_bounds_that_did_not_see_a_bend_between_the_nodes(names, punch, law, seed, number):
    judge(problem(fscm, seed, number, punch, law, TABOR), names)


@pytest.mark.heavy
@pytest.mark.filterwarnings("ignore::fscm.AccuracyWarning")
@pytest.mark.parametrize(
    ("punch", "law", "number"), [(*kinds, i) for kinds, count in DRAWN.items() for i in range(count)]
)
def test_random_punches_and_laws_are_within_their_bounds(punch, law, number):
    print(f"seed {SEED}, number {number}")
    judge(problem(fscm, SEED, number, punch, law, TABOR), NAMES)


@pytest.mark.heavy
@pytest.mark.filterwarnings("ignore::fscm.AccuracyWarning")
def test_the_critical_tabor_number_of_a_ball_and_of_a_law_through_points():
    for punch, law in (("ball", NINE_THREE), ("sphere", "table")):
        core = problem(fscm, SEED, 0, punch, law, TABOR).dimensionless
        judge(core, ("critical_tabor_number",))


def test_a_smoothed_law_whose_spline_has_nearly_the_stated_error():
    assert problem(fscm, SEED, 7, "sphere", "smoothed table", TABOR).law.work_of_adhesion > 0.0


def test_the_joint_of_a_ball_is_an_end_of_a_panel():
    """Without it the force of this ball was wrong by 9e-8 and its jump by 5e-11; both are 1e-4 of that now."""
    posed = fscm.Problem(fscm.Homogeneous(1.0850879349546185, 0.3), fscm.Ball(34.080948685574434), fscm.LennardJones())
    solutions = fscm.solve_together(posed, ("pull_off_force", "jump_out_displacement"))
    assert abs(solutions["jump_out_displacement"].value - -4.7644465198386) < 5e-13
    assert solutions["jump_out_displacement"].u_num < 1e-12
    assert solutions["pull_off_force"].u_num < 1e-10
