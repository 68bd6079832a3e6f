"""Cases as data: accepted and refused files."""

import math
import re
from itertools import pairwise

import pytest

from comparisons.problem import Problem
from comparisons.runs.cases import VERIFICATION, grids, load_grids

GRID = """
[[grid]]
id = "a"
title = "A grid"
tier = "quick"
reference = "jkr"
models = ["bradley"]
quantities = ["pull_off_force"]
n = [2, 1]
k = [0, 0.4]
mu = [1, 0.5, 1.0]
"""


def test_a_grid_is_the_sorted_product_without_duplicates():
    (grid,) = load_grids(GRID)
    assert grid.cases[:3] == (
        Problem.dimensionless(1, 0, 0.5),
        Problem.dimensionless(1, 0, 1),
        Problem.dimensionless(1, 0.4, 0.5),
    )
    assert len(grid.cases) == 2 * 2 * 2


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("title", "titel", "grid a: unknown key 'titel': did you mean title?"),
        ('tier = "quick"', 'tier = "slow"', "tier = 'slow' must be one of quick, full"),
        ('"bradley"', '"bradly"', "unknown model 'bradly'"),
        ('"pull_off_force"', '"pull_off"', "unknown quantity 'pull_off'"),
        ("mu = [1, 0.5, 1.0]", "mu = []", "mu = [] must be a list of at least one number"),
        ("mu = [1, 0.5, 1.0]", "mu = 1", "mu = 1 must be a list of at least one number"),
        ("k = [0, 0.4]", "k = [0, 1.4]", "k = 1.4"),
        ("[[grid]]", "[[grids]]", "unknown key 'grids': did you mean grid?"),
        ("[[grid]]", "[grid", "Expected"),
    ],
)
def test_a_wrong_grid_is_refused_with_a_reason(old, new, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        load_grids(GRID.replace(old, new))


#: What a grid has besides its cases.
REST = GRID.partition("n = [2, 1]")[0]

HYPERCUBE = """
[grid.latin_hypercube]
count = 50
seed = 3
n = [1, 6]
k = [0, 0.8]
mu = [0.01, 10]
"""


def test_a_list_of_cases_is_taken_as_it_is():
    (grid,) = load_grids(REST + "cases = [{n = 2, k = 0.4, mu = 3, nu = 0.3}, {n = 1, k = 0, mu = 1}]")
    assert grid.cases == (Problem.dimensionless(1, 0, 1), Problem.dimensionless(2, 0.4, 3, 0.3))


def test_a_latin_hypercube_has_one_point_in_each_layer_and_the_same_again():
    (grid,) = load_grids(REST + HYPERCUBE)
    assert load_grids(REST + HYPERCUBE)[0] == grid
    assert load_grids(REST + HYPERCUBE.replace("seed = 3", "seed = 4"))[0] != grid
    units = {
        "n": [(case.n - 1) / 5 for case in grid.cases],
        "k": [case.k / 0.8 for case in grid.cases],
        "mu": [math.log(case.mu / 0.01) / math.log(1000) for case in grid.cases],
    }
    for unit in units.values():
        assert sorted(int(50 * x) for x in unit) == list(range(50))
    # A message prints six digits, and with them the exact case.
    assert all(float(f"{x:g}") == x for case in grid.cases for x in case.parameters.values())


def test_a_range_of_one_value_is_that_value():
    (grid,) = load_grids(REST + HYPERCUBE.replace("[1, 6]", "[1.23456789, 1.23456789]") + "nu = [0.1, 0.4]")
    assert {case.n for case in grid.cases} == {1.23456789}
    assert len({case.nu for case in grid.cases}) == 50


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "grid a: it has no cases; state the cases once: lists n, k, mu (and nu); cases = ["),
        ("n = [1]\nmu = [1]", "grid a: k missing; lists of cases are n, k, mu and perhaps nu"),
        ("nu = [0.3]\ncases = [{n = 2, k = 0, mu = 1}]", "grid a: it has nu and cases together"),
        ("cases = [{n = 2, k = 0}]", "grid a: cases.0: mu missing; a case has n, k, mu and may have nu"),
        ("cases = []", "cases = [] must be a list of at least one case"),
        ("cases = [{n = 2, k = 0, mu = -1}]", "grid a: Tabor number mu = -1.0 is outside (0, inf)"),
        (HYPERCUBE.replace("50", "0"), "latin_hypercube.count = 0 must be a number of points from 1 to 100000"),
        (HYPERCUBE.replace("seed = 3", ""), "grid a: latin_hypercube: seed missing"),
        (HYPERCUBE.replace("[1, 6]", "[6, 1]"), "latin_hypercube: n = [6, 1] is not a range"),
        (HYPERCUBE.replace("0.01", "0"), "mu = [0, 10] is outside (0, inf): points are even in the logarithm"),
        (HYPERCUBE.replace("0.8", "1.01"), "grid a: gradient exponent k = 1.01 is outside [0, 1]"),
        (HYPERCUBE + "nu = [0.1, 0.5]", "Poisson's ratio nu = 0.5 is not in [0, 0.5)"),
    ],
)
def test_wrong_cases_are_refused_with_a_reason(text, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        load_grids(REST + text)


def test_ids_are_unique():
    with pytest.raises(ValueError, match="must be unique"):
        load_grids(GRID + GRID)


def test_the_quick_tier_covers_the_transition():
    cases = {
        case
        for grid in grids("quick")
        if grid.reference == "fscm" and VERIFICATION not in grid.tags
        for case in grid.cases
    }
    for n in (1, 1.5, 2, 5):
        for k in (0, 0.2, 0.4, 0.6):
            mu = sorted(case.mu for case in cases if (case.n, case.k) == (n, k))
            assert len(mu) >= 12
            assert (mu[0], mu[-1]) == (0.01, 5)
            # Evenly enough in log(mu): no gap wider than a factor of 3.5.
            assert max(b / a for a, b in pairwise(mu)) <= 3.5


def test_the_full_tier_holds_the_quick_one():
    assert set(grids("quick")) <= set(grids("full"))


@pytest.mark.parametrize("nu", [-0.1, 0.5, math.nan, math.inf])
def test_poissons_ratio_outside_its_range_is_refused(nu):
    with pytest.raises(ValueError, match=r"\[0, 0.5\)"):
        Problem.dimensionless(2, 0, 1, nu)


def test_a_case_knows_the_parameters_it_was_given():
    assert Problem.dimensionless(2, 0, 1).parameters == {"n": 2.0, "k": 0.0, "mu": 1.0}
    assert Problem.dimensionless(2, 0, 1, 0.3).label == "n = 2, k = 0, mu = 1, nu = 0.3"
