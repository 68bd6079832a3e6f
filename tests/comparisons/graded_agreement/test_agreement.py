"""Agreement of both references on graded solids: its cases, its table, and the committed values."""

from pathlib import Path

import pandas as pd
import pytest

from comparisons.data.file_names import BASELINE_FOLDER
from comparisons.graded_agreement.cases import CASES, MU, PUNCHES, QUANTITIES, SOLIDS
from comparisons.graded_agreement.solving import finite_elements, integral_equation
from comparisons.graded_agreement.table import TABLE, compared, worse_than_limits
from comparisons.paper.cache import CachedCall, Results

ROOT = Path(__file__).resolve().parents[3]
#: Of a bound of the finite elements, relative to the value (measured: 2.0e-6).
LARGEST_BOUND = 3e-6


def test_twenty_solids_of_five_kinds():
    assert len(SOLIDS) == 20
    assert len({name.partition("-")[0] for name in SOLIDS}) == 5
    assert len(CASES) == len(set(CASES)) == 20 * len(PUNCHES) * len(MU)


def test_committed_values_agree_within_both_bounds_and_their_limits():
    table = pd.read_csv(ROOT / BASELINE_FOLDER / TABLE, keep_default_na=False, na_values=[""])
    cases = list(dict.fromkeys(zip(table["solid"], table["punch"], table["mu"], strict=True)))
    assert cases == [(case.solid, case.punch, case.mu) for case in CASES]
    assert len(table) == len(cases) * len(QUANTITIES)
    assert set(table["fscm"]) == set(table["fem"]) == {"solved", "no event"}
    largest = (table["u_fem"] / table["fem_value"].abs()).max()
    assert LARGEST_BOUND / 2.0 < largest <= LARGEST_BOUND
    assert worse_than_limits(table) == []


def _results(function, event):
    call = CachedCall.of(function, CASES[0].solid, CASES[0].punch, CASES[0].mu)
    return Results({call: type("Outcome", (), {"result": event, "failure": None})()})


@pytest.mark.parametrize(
    ("force", "message"),
    [
        ([1.0 + 1e-9, 1e-8], None),
        ([1.0 + 3e-8, 1e-8], "above both bounds"),
        ([1.0 + 2e-6, 1e-5], "is above 1e-06"),
        ("no such event", "solved by the FSCM, no event by the finite elements"),
    ],
)
def test_a_difference_is_named(force, message):
    absent = dict.fromkeys(QUANTITIES[1:], "the displacement rises")
    ours = _results(integral_equation, {QUANTITIES[0]: [1.0, 1e-9], **absent})
    theirs = _results(finite_elements, {QUANTITIES[0]: force, **absent})
    found = worse_than_limits(compared(theirs, ours))
    assert (len(found), message is None or message in found[0]) == (message is not None, True)


@pytest.mark.heavy
@pytest.mark.parametrize("case", CASES[:5], ids=lambda case: case.solid)
def test_events_are_the_committed_ones(case):
    table = pd.read_csv(ROOT / BASELINE_FOLDER / TABLE).set_index(["solid", "punch", "mu", "quantity"])
    for name, event in integral_equation(case.solid, case.punch, case.mu).items():
        row = table.loc[(case.solid, case.punch, case.mu, name)]
        if isinstance(event, str):
            assert row["fscm"] == "no event"
        else:
            assert abs(event[0] - row["fscm_value"]) <= event[1] + row["u_fscm"]
