"""The results that a run computes: those that its gates need."""

import pytest

from comparisons.domain import Domain
from comparisons.judging.gates import load_gates
from comparisons.judging.selection import needed_keys
from comparisons.runs.cases import load_grids
from tests.comparisons.conftest import GATES, GRID


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


RIVAL = [('tier = "quick"', 'tier = "quick"\nrival = "twelve-percent"'), ("lower = 0.09", "lower = -inf")]


@pytest.mark.parametrize(
    ("changes", "models", "needed"),
    [
        ([], ["ten-percent"], (["exact", "ten-percent"], 8)),
        # Cases that no gate selects are not needed.
        ([("mu = [0.1, 1]", "mu = [1, 1]")], ["ten-percent"], (["exact", "ten-percent"], 4)),
        # Where the candidate has no value nothing else is.
        ([('"ten-percent"', '"refuses"')], ["refuses"], (["refuses"], 4)),
        (RIVAL, ["ten-percent", "twelve-percent"], (["exact", "ten-percent", "twelve-percent"], 12)),
        # The range of the reference is over all cases.
        ([('"ten-percent"', '"refuses"'), ('"rel"', '"range-relative"')], ["refuses"], (["exact", "refuses"], 8)),
    ],
)
def test_the_others_are_needed_where_the_candidate_has_a_value(changes, models, needed):
    needed_at_once, then = keys(gates(*changes), models, ok=["ten-percent"])
    assert of(then) == needed
    if '"rel"' not in str(changes):
        assert of(needed_at_once)[0] == models[:1]


def test_the_reference_is_needed_where_the_candidate_has_none_inside_the_domain_that_it_declares():
    """There the missing value counts as a failure, of a case that must be evaluated."""
    gates_of_run, grid = gates(('"ten-percent"', '"refuses"')), load_grids(GRID)
    statuses = dict.fromkeys(needed_keys(gates_of_run, grid, ["refuses"], {}), "not-applicable")
    domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0], "mu": [0, 10]})
    needed = needed_keys(gates_of_run, grid, ["refuses"], statuses, {"refuses": domain})
    assert of(needed) == (["exact", "refuses"], 6)
    assert {key[3] for key in needed if key[0] == "exact"} == {0.0}


def test_a_model_that_no_gate_names_is_in_the_tables_of_errors():
    needed_at_once, _ = keys(gates(), ["twelve-percent"])
    assert of(needed_at_once) == (["exact", "twelve-percent"], 8)
