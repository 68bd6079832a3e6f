"""Cases as data: accepted and refused files."""

import re

import pytest

from comparisons.problem import Problem
from comparisons.problem.evaluation import REFERENCES
from comparisons.runs.cases import AGAINST_ELEMENTS, VERIFICATION, grids, grids_for, load_grids
from comparisons.runs.tasks import plan
from tests.comparisons.grid_text import PAD, grid_text

#: What a grid has besides its cases.
REST = grid_text(["bradley"], "jkr", id="a", tier="quick")
GRID = f"{REST}n = [2, 1]\nk = [0, 0.4]\nmu = [1, 0.5, 1.0]\n"


def test_a_grid_is_the_sorted_product_without_duplicates():
    (grid,) = load_grids(GRID)
    assert grid.cases == tuple(Problem.dimensionless(n, k, mu) for n in (1, 2) for k in (0, 0.4) for mu in (0.5, 1))


def test_a_list_of_cases_is_taken_as_it_is():
    (grid,) = load_grids(REST + "cases = [{n = 2, k = 0.4, mu = 3, nu = 0.3}, {n = 1, k = 0, mu = 1}]")
    assert grid.cases == (Problem.dimensionless(1, 0, 1), Problem.dimensionless(2, 0.4, 3, 0.3))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (GRID.replace("title", "titel"), "grid a: unknown key 'titel'"),
        (GRID.replace('"quick"', '"slow"'), "tier = 'slow'"),
        (GRID.replace('"bradley"', '"bradly"'), "unknown model 'bradly'"),
        (GRID.replace('"jkr"', '"jrk"'), "unknown model 'jrk'"),
        (GRID.replace('"pull_off_force"', '"pull_off"'), "unknown quantity 'pull_off'"),
        (GRID.replace("[1, 0.5, 1.0]", f"[1{'0' * 400}]"), "mu must be a list of at least one number"),
        (GRID.replace("2, 1]", "1, " * 2000 + "]").replace("1.0]", "1, " * 998 + "]"), "4000000 combinations"),
        (GRID.replace("[0, 0.4]", "[0, 1.4]"), "k = 1.4"),
        (GRID.replace("[[grid]]", "[grid"), "not TOML"),
        (GRID + GRID, "must be unique"),
        (REST, "grid a: it has no cases"),
        (REST + "n = [1]\nmu = [1]", "grid a: k missing"),
        (REST + "nu = [0.3]\ncases = [{n = 2, k = 0, mu = 1}]", "grid a: it has nu and cases together"),
        (REST + "cases = [{n = 2, k = 0, mu = -1}]", "mu = -1.0"),
    ],
)
def test_wrong_grids_are_refused_with_the_key_and_the_value(text, named):
    with pytest.raises(ValueError, match=re.escape(named)):
        load_grids(text)


@pytest.mark.parametrize(
    ("cases", "named"),
    [
        ('problem = "../pad.toml"', "'../pad.toml' leads out of the folder"),
        ('problem = "pad.toml"\nn = [2]', "it has problem and n together"),
        ('problem = "pad.toml"\nvary = {"solid.E" = ["1 nm"]}', "solid.E=1 nm"),
        ('problem = "pad.toml"\nvary = {"solid.E" = ["1 MPa", "1 MPa"]}', "one value twice"),
    ],
)
def test_wrong_grids_of_problem_files_are_refused(tmp_path, cases, named):
    (tmp_path / "pad.toml").write_text(PAD)
    with pytest.raises(ValueError, match=f"grid a: .*{re.escape(named)}"):
        load_grids(REST + cases, folder=tmp_path)


def test_the_grids_of_a_sweep_have_no_tier():
    with pytest.raises(ValueError, match="grid a: unknown key 'tier': the grids of a sweep have none"):
        load_grids(GRID, tiers=None)


def test_the_full_tier_holds_the_quick_one():
    assert set(grids("quick")) < set(grids("full"))


@pytest.mark.parametrize("tier", ["quick", "full"])
def test_a_closed_form_is_compared_with_the_finite_elements_beside_the_fscm(tier):
    compared = [grid for grid in grids_for(grids(tier), None) if VERIFICATION not in grid.tags]
    keys = {
        name: {task.key for task in plan(grid for grid in compared if grid.reference == name)}
        for name in ("fscm", "fem")
    }
    against_elements = {key for key in keys["fem"] if key[0] != "fem"}
    closed_forms = {key[0] for key in keys["fscm"]} - {*REFERENCES}
    assert {key[0] for key in against_elements} >= closed_forms >= {"jkr", "md-original", "schwarz"}
    # Both errors of a pull-off force are in the table, beside each other.
    assert {key for key in against_elements if key[1] == "pull_off_force"} <= keys["fscm"]
    assert "fem" not in {grid.reference for grid in grids_for(grids(tier), ["jkr"])}


@pytest.mark.parametrize(("tier", "most"), [("quick", 8), ("full", 2)])
def test_few_finite_element_solutions_are_computed_for_the_closed_forms_alone(tier, most):
    """Each takes a second or more; of the others a gate compares both references."""
    standing = grids_for(grids(tier), None)
    problems = [
        {
            task.problem
            for task in plan(grid for grid in standing if (AGAINST_ELEMENTS in grid.tags) is tagged)
            if task.model == "fem"
        }
        for tagged in (True, False)
    ]
    assert 0 < len(problems[0] - problems[1]) <= most
