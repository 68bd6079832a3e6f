"""The gates of the full tier can pass and can fail.

Their results take an hour to compute and are not committed.  Here both references answer every question alike, with
the certainty they usually state; then one of them is made wrong, uncertain or incomplete.
"""

import math

import numpy as np
import pandas as pd
import pytest

from comparisons.cases import grids
from comparisons.gates import gates_text, load_gates
from comparisons.judge import judge
from comparisons.run import plan
from comparisons.shapes import SHAPES
from comparisons.verdict import Verdict, roll_up

GRIDS = [grid for grid in grids("full") if grid.tier == "full" and grid.models == ("fem",)]
GATES = [gate for gate in load_gates(gates_text()) if gate.tier == "full"]
EVERY_GATE = pytest.mark.parametrize("gate", GATES, ids=lambda gate: gate.id)
#: Of value and curve, as the two usually state it.
CERTAINTY = {"fem": (2e-7, 5e-5), "fscm": (1e-10, 1e-5)}
POINTS = np.linspace(0.0, 1.0, 60)


def agreeing():
    """Rows and curves in which the finite elements and the FSCM give the same answers."""
    rows, curves = [], []
    for task in plan(GRIDS, None):
        if task.model not in CERTAINTY:
            continue
        key = dict(zip(("model", "quantity", "n", "k", "mu", "nu"), task.key, strict=True))
        u_value, u_curve = CERTAINTY[task.model]
        if task.quantity in SHAPES:
            x, y = POINTS, np.cos(3.0 * POINTS + key["n"]) + key["k"] * POINTS**2
            curves.append(pd.DataFrame({**key, "x": x, "y": y, "u_distance": u_curve, "status": "ok", "reason": ""}))
        else:
            value = 2.0 + key["n"] + key["k"] + 0.1 * key["mu"]
            rows.append({**key, "value": value, "u_num": u_value * value, "status": "ok", "reason": ""})
    return pd.DataFrame(rows), pd.concat(curves, ignore_index=True)


ROWS, CURVES = agreeing()


def judged(gate, rows=ROWS, curves=CURVES):
    asked = [grid for grid in GRIDS if gate.quantity in grid.quantities]
    mine = [table[table["quantity"] == gate.quantity] for table in (rows, curves)]
    return judge([gate], asked, *mine)


def verdict(gate, **results):
    return roll_up(judged(gate, **results)["verdict"])


def altered(gate, model, number, shape):
    """The results with `number` applied to the rows of the model, or `shape` where the gate is about curves."""
    table, change = (CURVES, shape) if gate.quantity in SHAPES else (ROWS, number)
    mine = (table["model"] == model) & (table["quantity"] == gate.quantity)
    assert mine.any()
    table = pd.concat([table[~mine], change(table[mine])], ignore_index=True)
    return {"curves" if gate.quantity in SHAPES else "rows": table}


@EVERY_GATE
def test_agreement_passes(gate):
    assert verdict(gate) == Verdict.PASS


@EVERY_GATE
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_error_a_little_outside_the_limits_fails(gate, sign):
    def number(rows):
        u = np.hypot(*(certainty[0] for certainty in CERTAINTY.values()))
        share = 1.01 * gate.upper * u if gate.metric == "en" else 1.2 * gate.upper + 2.5 * u
        return rows.assign(value=rows["value"] * (1.0 + sign * share))

    def shape(curves):
        u = np.hypot(*(certainty[1] for certainty in CERTAINTY.values()))
        span = curves.groupby(["n", "k", "mu"])["y"].transform(np.ptp)
        # The distance is measured at right angles to the curve: a shift along y moves its level parts by all of it.
        return curves.assign(y=curves["y"] + sign * (1.3 * gate.upper + 4.0 * u) * span)

    assert verdict(gate, **altered(gate, gate.candidate, number, shape)) == Verdict.FAIL


@EVERY_GATE
def test_an_uncertain_reference_is_not_passed(gate):
    too_much = 1.01 * gate.max_reference_uncertainty
    changed = altered(
        gate,
        gate.reference,
        lambda rows: rows.assign(u_num=too_much * rows["value"]),
        lambda curves: curves.assign(u_distance=too_much),
    )
    assert verdict(gate, **changed) == Verdict.INCONCLUSIVE


@EVERY_GATE
@pytest.mark.parametrize("side", ["candidate", "reference"])
def test_what_is_lost_or_not_a_number_is_an_error(gate, side):
    case = judged(gate).iloc[-1]

    def holed(column):
        def change(table):
            there = np.logical_and.reduce([table[name] == case[name] for name in ("n", "k", "mu")])
            return table.assign(**{column: table[column].mask(there & ~np.roll(there, 1), math.nan)})

        return change

    model = getattr(gate, side)
    assert verdict(gate, **altered(gate, model, holed("value"), holed("y"))) == Verdict.ERROR
    lost = altered(gate, model, lambda rows: rows.iloc[:0], lambda curves: curves.iloc[:0])
    assert verdict(gate, **lost) == Verdict.ERROR


@EVERY_GATE
def test_fewer_cases_than_declared_are_an_error(gate):
    def refuse(table):
        return table.assign(status="not-applicable", reason="not asked here")

    assert verdict(gate, **altered(gate, gate.candidate, refuse, refuse)) == Verdict.ERROR
