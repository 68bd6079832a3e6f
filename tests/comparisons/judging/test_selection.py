"""The results that a run computes: those that its gates need."""

import pytest

from comparisons.judging.gates import load_gates
from comparisons.judging.selection import needed_keys
from comparisons.runs.cases import load_grids
from tests.comparisons.conftest import GATES, GRID


def gates(*changes):
    text = GATES
    for old, new in changes:
        text = text.replace(old, new)
    return load_gates(text)


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
        (RIVAL, ["ten-percent", "twelve-percent"], (["exact", "ten-percent", "twelve-percent"], 12)),
        # A model that no gate names is in the tables of errors.
        ([], ["twelve-percent"], (["exact", "twelve-percent"], 8)),
    ],
)
def test_the_candidates_and_what_they_are_compared_with_are_needed_in_the_cases_of_the_gates(changes, models, needed):
    keys = needed_keys(gates(*changes), load_grids(GRID), models)
    assert (sorted({key[0] for key in keys}), len(keys)) == needed
