"""Verdicts of the standing gates of the full tier on made-up results of both references.

The full tier takes long and its results are not committed, so the two references agree here by construction: one
number for each task, and for each curve points of one line, others for each model.
"""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comparisons.baseline import BASELINE
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.gates import gates_text, load_gates
from comparisons.judging.judge import judge
from comparisons.numerics.bounds import combined
from comparisons.quantities import CURVES as CURVE_QUANTITIES
from comparisons.runs.cases import VERIFICATION, grids
from comparisons.runs.frames import curve_frame, frame
from comparisons.runs.tasks import plan
from tests.comparisons.rows import row

ROOT = Path(__file__).parents[3]
GRIDS = [grid for grid in grids("full") if grid.tier == "full" and VERIFICATION in grid.tags]
GATES = [gate for gate in load_gates(gates_text()) if gate.tier == "full"]
EVERY_GATE = pytest.mark.parametrize("gate", GATES, ids=lambda gate: gate.id)

#: Of the numbers, and of the curves as a fraction of the picture.
U_NUM, U_DISTANCE = 1e-10, 1e-7
#: Points of a curve of the candidate and of the reference.
POINTS = {"fem": 15, "fscm": 45}


def made_up(task):
    """One result for every task, by the case alone: two models agree on it."""
    problem = task.problem
    common = {"model": task.model, "quantity": task.quantity, "parameters": problem.parameters}
    if task.quantity not in CURVE_QUANTITIES:
        return row(value=problem.n + problem.k + problem.mu, u_num=U_NUM, **common)
    t = np.linspace(0.0, 1.0, POINTS[task.model])
    return row(value=None, u_num=None, points=(list(3.0 * t - 2.0), list(np.sin(3.0 * t)), U_DISTANCE), **common)


RESULTS = [made_up(task) for task in plan(GRIDS)]
ROWS = frame(each for each in RESULTS if not each.points)
CURVES = curve_frame(row for row in RESULTS if row.points)


def verdict(gate, rows=ROWS, curves=CURVES):
    return roll_up(judge([gate], GRIDS, rows, curves)["verdict"])


def changed(gate, model, column, change):
    """The results with one column of a model's rows of a gate's quantity changed."""
    tables = {"rows": ROWS.copy(), "curves": CURVES.copy()}
    table = tables["curves" if gate.metric == "curve" else "rows"]
    mine = (table["model"] == model) & (table["quantity"] == gate.quantity)
    assert mine.any()
    table.loc[mine, column] = change(table[mine])
    return tables


def ordinate(gate):
    return "y" if gate.metric == "curve" else "value"


def test_they_are_there():
    assert len(GATES) >= 14
    assert {gate.metric for gate in GATES} == {"rel", "en", "curve"}


@EVERY_GATE
def test_results_that_agree_pass(gate):
    assert verdict(gate) == Verdict.PASS


@EVERY_GATE
@pytest.mark.parametrize(
    "mistake",
    [
        lambda table, values: 1.7 * values,
        lambda table, values: -values,
        lambda table, values: values * (table["mu"] / 7.0) ** 0.4,
        lambda table, values: values * (1.0 + table["k"]) / (1.0 + table["n"]),
    ],
    ids=["factor", "sign", "exponent", "swapped"],
)
def test_a_wrong_candidate_fails(gate, mistake):
    column = ordinate(gate)
    tables = changed(gate, gate.candidate, column, lambda table: mistake(table, table[column]))
    assert verdict(gate, **tables) == Verdict.FAIL


@EVERY_GATE
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_error_a_little_outside_the_limits_fails(gate, sign):
    """In units of the gate's metric; of a curve, of the range of its ordinate, and what U hides besides."""
    beyond = 1.1 * gate.upper

    def change(table):
        if gate.metric == "rel":
            return table["value"] * (1.0 + sign * (beyond + 3.0 * U_NUM))
        if gate.metric == "en":
            return table["value"] + sign * beyond * combined(U_NUM, U_NUM)
        return table["y"] + sign * (beyond + 1e-5) * np.ptp(table["y"]) * 2.0

    assert verdict(gate, **changed(gate, gate.candidate, ordinate(gate), change)) == Verdict.FAIL


@EVERY_GATE
def test_a_reference_less_certain_than_tolerated_is_not_passed(gate):
    worst = 1.01 * gate.max_reference_uncertainty
    if gate.metric == "curve":
        tables = changed(gate, gate.reference, "u_distance", lambda table: worst)
    else:
        tables = changed(gate, gate.reference, "u_num", lambda table: worst * table["value"])
    assert verdict(gate, **tables) == Verdict.INCONCLUSIVE


EN_GATES = pytest.mark.parametrize("gate", [gate for gate in GATES if gate.metric == "en"], ids=lambda gate: gate.id)


@EN_GATES
def test_a_candidate_less_certain_than_tolerated_is_not_passed(gate):
    """Three times the reference, and so uncertain that both bounds hold."""
    worst = gate.max_candidate_uncertainty
    for size, expected in ((0.99 * worst, Verdict.PASS), (1.01 * worst, Verdict.INCONCLUSIVE)):
        tables = changed(gate, "fem", "u_num", lambda table, size=size: size * table["value"])
        assert verdict(gate, **tables) == expected
    tables = changed(gate, "fem", "value", lambda table: 3.0 * table["value"])
    tables["rows"].loc[tables["rows"]["model"] == "fem", "u_num"] = 100.0
    judged = judge([gate], GRIDS, tables["rows"], tables["curves"])
    assert roll_up(judged["verdict"]) == Verdict.INCONCLUSIVE
    assert judged["reason"].str.startswith("u of the candidate fem is ").all()


@EN_GATES
def test_the_uncertainty_tolerated_is_two_to_three_times_the_largest_committed(gate):
    table = pd.read_csv(ROOT / BASELINE / "references_agreement.csv")
    mine = table[(table["quantity"] == gate.quantity) & (table["model"] == gate.candidate)]
    largest = (mine["u_num"] / mine["reference_value"].abs()).max()
    assert 2.0 * largest <= gate.max_candidate_uncertainty <= 3.5 * largest


@EN_GATES
def test_the_worst_case_stated_is_that_of_the_committed_agreement(gate):
    table = pd.read_csv(ROOT / BASELINE / "references_agreement.csv")
    found = table.loc[(table["quantity"] == gate.quantity) & (table["model"] == gate.candidate), "en"]
    assert gate.worst_measured == pytest.approx(found[found.abs().idxmax()], rel=0.05)


@EVERY_GATE
@pytest.mark.parametrize("side", ["candidate", "reference"])
def test_a_nan_a_row_lost_and_a_column_lost_are_errors(gate, side):
    column, model = ordinate(gate), getattr(gate, side)
    name, table = ("curves", CURVES) if gate.metric == "curve" else ("rows", ROWS)
    cases = judge([gate], GRIDS, ROWS, CURVES)
    case = cases[cases["mu"].notna()].iloc[0]
    mine = (table["model"] == model) & (table["quantity"] == gate.quantity)
    mine &= np.logical_and.reduce([table[name] == case[name] for name in ("n", "k", "mu")])
    assert mine.any()
    holed = table.copy()
    holed.loc[table.index[mine][0], column] = math.nan
    for wrong in (holed, table[~mine], table.drop(columns=column)):
        assert verdict(gate, **{name: wrong}) == Verdict.ERROR


@EVERY_GATE
def test_without_cases_a_gate_is_an_error(gate):
    assert roll_up(judge([gate], [], ROWS, CURVES)["verdict"]) == Verdict.ERROR
