"""Cases as data: accepted and refused files."""

import math
import re
from itertools import pairwise

import pytest

from comparisons.runs.cases import Case, grids, load_grids

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
    assert grid.cases[:3] == (Case(1, 0, 0.5), Case(1, 0, 1), Case(1, 0.4, 0.5))
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


def test_ids_are_unique():
    with pytest.raises(ValueError, match="must be unique"):
        load_grids(GRID + GRID)


def test_the_quick_tier_covers_the_transition():
    cases = {case for grid in grids("quick") if grid.reference == "fscm" for case in grid.cases}
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
        Case(2, 0, 1, nu)


def test_a_case_knows_the_parameters_it_was_given():
    assert Case(2, 0, 1).parameters == {"n": 2.0, "k": 0.0, "mu": 1.0}
    assert Case(2, 0, 1, 0.3).label == "n = 2, k = 0, mu = 1, nu = 0.3"
