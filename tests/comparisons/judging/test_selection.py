"""The results that a run computes: those that its gates need."""

import pytest

from comparisons.domain import Domain
from comparisons.judging.gates import gates_text, load_gates
from comparisons.judging.selection import needed_keys
from comparisons.runs.cases import grids, load_grids
from tests.comparisons.conftest import GATES, GRID

#: The standing gates.
STANDING = load_gates(gates_text())


def gates(*changes):
    text = GATES
    for old, new in changes:
        text = text.replace(old, new)
    return load_gates(text)


def keys(gates_of_run, models, ok=()):
    grid = load_grids(GRID)
    needed_at_once = needed_keys(gates_of_run, grid, models, {})
    statuses = {key: "ok" if key[0] in ok else "not-applicable" for key in needed_at_once}
    return needed_at_once, needed_keys(gates_of_run, grid, models, statuses)


def of(needed):
    return sorted({key[0] for key in needed}), len(needed)


@pytest.fixture(autouse=True)
def registered(toys):
    pass


def test_the_reference_is_needed_where_the_candidate_has_a_value():
    needed_at_once, then = keys(gates(), ["ten-percent"], ok=["ten-percent"])
    assert of(needed_at_once) == (["ten-percent"], 4)
    assert of(then) == (["exact", "ten-percent"], 8)


def test_the_reference_is_not_needed_where_the_candidate_has_none():
    needed_at_once, then = keys(gates(('"ten-percent"', '"refuses"')), ["refuses"])
    assert of(then) == of(needed_at_once) == (["refuses"], 4)


def test_the_reference_is_needed_where_the_candidate_has_none_inside_the_domain_that_it_declares():
    """There the missing value counts as a failure, of a case that must be evaluated."""
    gates_of_run, grid = gates(('"ten-percent"', '"refuses"')), load_grids(GRID)
    statuses = dict.fromkeys(needed_keys(gates_of_run, grid, ["refuses"], {}), "not-applicable")
    domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0], "mu": [0, 10]})
    needed = needed_keys(gates_of_run, grid, ["refuses"], statuses, {"refuses": domain})
    assert of(needed) == (["exact", "refuses"], 6)
    assert {key[3] for key in needed if key[0] == "exact"} == {0.0}


def test_cases_that_no_gate_selects_are_not_needed():
    _, then = keys(gates(("mu = [0.1, 1]", "mu = [1, 1]")), ["ten-percent"], ok=["ten-percent"])
    assert {key[4] for key in then} == {1.0}
    assert of(then) == (["exact", "ten-percent"], 4)


def test_a_rival_is_needed_with_the_reference():
    gates_of_run = gates(
        ('tier = "quick"', 'tier = "quick"\nrival = "twelve-percent"'), ("lower = 0.09", "lower = -inf")
    )
    needed_at_once, then = keys(gates_of_run, ["ten-percent", "twelve-percent"], ok=["ten-percent"])
    assert of(needed_at_once) == (["ten-percent"], 4)
    assert of(then) == (["exact", "ten-percent", "twelve-percent"], 12)


def test_the_range_of_the_reference_needs_all_its_cases():
    _, then = keys(gates(('"rel"', '"range-relative"')), ["ten-percent"])
    assert of(then) == (["exact", "ten-percent"], 8)


def test_a_model_that_no_gate_names_is_in_the_tables_of_errors():
    needed_at_once, _ = keys(gates(), ["twelve-percent"])
    assert of(needed_at_once) == (["exact", "twelve-percent"], 8)


def test_a_model_of_one_shape_needs_the_standing_references_of_this_shape():
    grid = grids("quick")
    needed_at_once = needed_keys(STANDING, grid, ["jkr"], {})
    assert of([key for key in needed_at_once if key[1] == "pull_off_force"]) == (["jkr"], 192)
    statuses = {key: "ok" if key[2] == 2 else "not-applicable" for key in needed_at_once}
    added = needed_keys(STANDING, grid, ["jkr"], statuses) - needed_at_once
    assert {key[2] for key in added} == {2.0}
    assert len([key for key in added if key[1] == "pull_off_force"]) == 48
