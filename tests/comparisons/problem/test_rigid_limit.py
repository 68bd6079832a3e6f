"""Limit of a rigid solid for a sphere: its force, and the regime that follows."""

import math

import pytest

from comparisons.description.overview import overview
from comparisons.description.rigid_limit import rigid_force
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate
from tests.comparisons.rows import row

RIGID = Section("homogeneous", {"E": 1e18, "nu": 0.25})
LAW = Section("lennard-jones-9-3", {"work_of_adhesion": 0.1, "z0": 4e-10})
MIE = Section("mie", {"work_of_adhesion": 0.05, "z0": 4e-10, "m": 8.0, "n": 4.0})


@pytest.mark.parametrize("law", [LAW, MIE], ids=["9-3", "mie"])
@pytest.mark.parametrize("kind", ["sphere", "ball"])
def test_the_limit_is_the_force_on_a_solid_of_vanishing_tabor_number(kind, law):
    problem = Problem(RIGID, Section(kind, {"R": 2e-7}), law)
    assert problem.posed.mu < 1e-5
    solved = evaluate("fscm", "pull_off_force", problem)
    # The solver's ball is a sphere up to 0.95 R.
    assert rigid_force(problem) == pytest.approx(solved.value, rel=2e-6)


def test_under_the_9_3_law_a_ball_has_less_than_the_paraboloid_by_9_7_of_the_range():
    force = rigid_force(Problem(RIGID, Section("ball", {"R": 2e-7}), LAW))
    assert force / (2.0 * math.pi * 0.1) == pytest.approx(2e-7 - 9.0 / 7.0 * 4e-10, rel=1e-5)


@pytest.mark.parametrize("kind", ["sphere", "ball"])
def test_a_stiff_solid_is_in_the_rigid_limit(kind):
    problem = Problem(Section("homogeneous", {"E": 5e10, "nu": 0.25}), Section(kind, {"R": 2e-8}), LAW)
    force = row("fscm", value=1.02 * 2.0 * math.pi * 0.1 * 1.945e-8, u_num=1e-17)
    regime = overview(problem, force)["regime"]
    assert "rigid" in regime
    assert "within 5 %" in regime
