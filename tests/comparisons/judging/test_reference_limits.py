"""How uncertain a reference may be, by the standing gates, against how uncertain the committed references are.

A limit far above what was measured would let a reference become worse without a word.
"""

import math
from pathlib import Path

import pandas as pd
import pytest

from comparisons.baseline import BASELINE, read_baseline
from comparisons.judging.gates import GIVEN, gates_text, load_gates
from comparisons.judging.judge import judge
from comparisons.runs.cases import grids

ROOT = Path(__file__).parents[3]
GATES = [gate for gate in load_gates(gates_text()) if gate.candidate != GIVEN]
GRIDS = grids("quick")
ROWS, CURVES = read_baseline(ROOT / BASELINE)
QUICK = [gate for gate in GATES if gate.tier == "quick"]
FULL = [gate for gate in GATES if gate.tier == "full"]

#: A limit over the largest bound measured: 11 for the curves of the closed forms.
ROOM = 12.0
#: A limit that is small enough whatever was measured: absolute, and as a fraction of the gate's limits of the error.
SMALL, FRACTION = 1e-7, 0.1
#: The same for gates of |E_n|, whose limits of the error are in units of the bounds: 1e-6 of the value.
SMALL_FOR_EN = 1e-6
#: Curves of the full tier are not committed; the limit over that of the error is 0.3 for the pressures.
FRACTION_OF_A_CURVE = 0.31


def by_name(gates):
    return pytest.mark.parametrize("gate", gates, ids=lambda gate: gate.id)


@by_name(QUICK)
def test_of_the_quick_tier(gate):
    largest = judge([gate], GRIDS, ROWS, CURVES)["u_reference"].max()
    limits = [abs(limit) for limit in (gate.lower, gate.upper) if math.isfinite(limit) and limit != 0.0]
    small = min([SMALL] + [FRACTION * limit for limit in limits])
    assert gate.max_reference_uncertainty <= max(ROOM * largest, small)


@by_name([gate for gate in FULL if gate.metric == "en"])
def test_of_the_bounds_of_the_full_tier(gate):
    table = pd.read_csv(ROOT / BASELINE / "references_agreement.csv")
    mine = table[(table["quantity"] == gate.quantity) & (table["reference"] == gate.reference)]
    largest = (mine["u_reference"] / mine["reference_value"].abs()).max()
    assert gate.max_reference_uncertainty <= max(ROOM * largest, SMALL_FOR_EN)


@by_name([gate for gate in FULL if gate.metric != "en"])
def test_of_the_errors_of_the_full_tier(gate):
    assert gate.max_reference_uncertainty <= FRACTION_OF_A_CURVE * gate.upper
