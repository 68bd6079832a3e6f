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


def keys(chosen, models, ok=()):
    grid = load_grids(GRID)
    first = needed_keys(chosen, grid, models, {})
    statuses = {key: "ok" if key[0] in ok else "not-applicable" for key in first}
    return first, needed_keys(chosen, grid, models, statuses)


def of(found):
    return sorted({key[0] for key in found}), len(found)


@pytest.fixture(autouse=True)
def registered(toys):
    pass


def test_the_reference_is_needed_where_the_candidate_has_a_value():
    first, then = keys(gates(), ["ten-percent"], ok=["ten-percent"])
    assert of(first) == (["ten-percent"], 4)
    assert of(then) == (["exact", "ten-percent"], 8)


def test_the_reference_is_not_needed_where_the_candidate_has_none():
    first, then = keys(gates(('"ten-percent"', '"refuses"')), ["refuses"])
    assert of(then) == of(first) == (["refuses"], 4)


def test_the_reference_is_needed_where_the_candidate_has_none_inside_the_domain_that_it_declares():
    """There the missing value counts as a failure, of a case that must be evaluated."""
    chosen, grid = gates(('"ten-percent"', '"refuses"')), load_grids(GRID)
    statuses = dict.fromkeys(needed_keys(chosen, grid, ["refuses"], {}), "not-applicable")
    domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0], "mu": [0, 10]})
    needed = needed_keys(chosen, grid, ["refuses"], statuses, {"refuses": domain})
    assert of(needed) == (["exact", "refuses"], 6)
    assert {key[3] for key in needed if key[0] == "exact"} == {0.0}


def test_cases_that_no_gate_selects_are_not_needed():
    _, then = keys(gates(("mu = [0.1, 1]", "mu = [1, 1]")), ["ten-percent"], ok=["ten-percent"])
    assert {key[4] for key in then} == {1.0}
    assert of(then) == (["exact", "ten-percent"], 4)


def test_a_rival_is_needed_with_the_reference():
    chosen = gates(('tier = "quick"', 'tier = "quick"\nrival = "twelve-percent"'), ("lower = 0.09", "lower = -inf"))
    first, then = keys(chosen, ["ten-percent", "twelve-percent"], ok=["ten-percent"])
    assert of(first) == (["ten-percent"], 4)
    assert of(then) == (["exact", "ten-percent", "twelve-percent"], 12)


def test_the_range_of_the_reference_needs_all_its_cases():
    _, then = keys(gates(('"rel"', '"range-relative"')), ["ten-percent"])
    assert of(then) == (["exact", "ten-percent"], 8)


def test_a_model_that_no_gate_names_is_in_the_tables_of_errors():
    first, _ = keys(gates(), ["twelve-percent"])
    assert of(first) == (["exact", "twelve-percent"], 8)


def test_a_model_of_one_shape_needs_the_standing_references_of_this_shape():
    grid = grids("quick")
    first = needed_keys(STANDING, grid, ["jkr"], {})
    assert of([key for key in first if key[1] == "pull_off_force"]) == (["jkr"], 192)
    statuses = {key: "ok" if key[2] == 2 else "not-applicable" for key in first}
    added = needed_keys(STANDING, grid, ["jkr"], statuses) - first
    assert {key[2] for key in added} == {2.0}
    assert len([key for key in added if key[1] == "pull_off_force"]) == 48
