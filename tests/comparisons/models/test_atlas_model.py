"""The model `atlas`: results, bounds, and what it refuses."""

import json
import subprocess
import sys

import pytest

import fscm
from comparisons.model import NotApplicable
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.tasks import evaluate


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_result_is_that_of_the_function(quantity):
    result = create("atlas").evaluate(Problem.dimensionless(n=2.5, k=0.3, mu=2.0), quantity)
    assert (result.value, result.u_num) == fscm.atlas(2.5, 0.3, 2.0, quantity)


@pytest.mark.parametrize("quantity", ["pull_off_force", "jump_out_displacement"])
def test_the_reference_is_within_the_bound(quantity):
    problem = Problem.dimensionless(n=2, k=0.4, mu=1.0)
    atlas, reference = (create(name).evaluate(problem, quantity) for name in ("atlas", "fscm"))
    assert abs(atlas.value - reference.value) <= atlas.u_num + reference.u_num


@pytest.mark.parametrize(
    ("n", "k", "mu", "reason"),
    [
        (0.9, 0.4, 1, r"n = 0.9 is outside \[1, 6\]"),
        (2, 0.81, 1, r"k = 0.81 is outside \[0, 0.8\]"),
        (2, 0.4, 11, r"mu = 11 is outside \[0.01, 10\]"),
    ],
)
def test_outside_its_box_it_is_not_applicable(n, k, mu, reason):
    row = evaluate(create("atlas"), "pull_off_force", Problem.dimensionless(n, k, mu))
    assert row.status == "not-applicable"
    with pytest.raises(NotApplicable, match=reason):
        create("atlas").evaluate(Problem.dimensionless(n=n, k=k, mu=mu), "pull_off_force")


def test_below_the_critical_tabor_number_a_jump_is_not_applicable():
    row = evaluate(create("atlas"), "jump_in_gap", Problem.dimensionless(2, 0, 0.3))
    assert row.status == "not-applicable"
    assert "critical Tabor number 0.69" in row.reason


def test_it_has_no_curve():
    with pytest.raises(NotApplicable, match="no force-displacement curve"):
        create("atlas").curve(Problem.dimensionless(n=2, k=0.4, mu=1.0))


def test_another_fit_is_another_version():
    version = create("atlas").version
    assert version.startswith("1+")
    assert len(version) == 10


def test_the_command_solves_with_it():
    command = ["solve", "--model", "atlas", "--quantity", "pull_off_force", "--n", "2", "--k", "0.4", "--mu", "1"]
    done = subprocess.run(
        [sys.executable, "-m", "comparisons", *command, "--format", "json"], capture_output=True, text=True, check=True
    )
    assert "u_num" in json.dumps(json.loads(done.stdout))
