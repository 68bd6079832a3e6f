"""The judge on results made by hand: missing, doubled, lost or uncertain ones."""

import math
from itertools import product

import numpy as np
import pandas as pd
import pytest

from comparisons.domain import Domain
from comparisons.judging.decision import roll_up
from comparisons.judging.gates import load_gates
from comparisons.judging.judge import judge
from comparisons.judging.stored_results import UnusableResult, stored_curves, stored_numbers
from comparisons.judging.summary import summarise
from comparisons.runs.cases import load_grids

GRID = """
[[grid]]
id = "four"
title = "Four cases"
tier = "quick"
tags = ["blue"]
reference = "fscm"
models = ["jkr", "dmt"]
quantities = ["pull_off_force", "jump_in_displacement", "force_curve"]
n = [2]
k = [0, 0.4]
mu = [0.5, 1]
"""
GATE = """
[[gate]]
id = "ONE"
requirement = "JKR is right."
quantity = "pull_off_force"
candidate = "jkr"
reference = "fscm"
cases = { tags = ["blue"] }
metric = "rel"
lower = -0.1
upper = 0.1
max_reference_uncertainty = 1e-3
basis = "derived"
grounds = "None."
min_cases = 4
tier = "quick"
"""
GRIDS = load_grids(GRID)


def results(**models):
    """Rows of the four cases; a model's value may be a number or a function of (k, mu)."""
    rows = [
        {
            "model": model,
            "quantity": "pull_off_force",
            "n": 2.0,
            "k": k,
            "mu": mu,
            "nu": math.nan,
            "value": value(k, mu) if callable(value) else value,
            "u_num": 1e-6,
            "status": "ok",
            "reason": "",
        }
        for model, value in models.items()
        for k in (0.0, 0.4)
        for mu in (0.5, 1.0)
    ]
    return pd.DataFrame(rows)


def verdict(rows, gate=GATE, grids=GRIDS, curves=None, models=None):
    judged = judge(load_gates(gate), grids, rows, curves, models)
    return roll_up(judged["verdict"]), judged


EN = GATE.replace('"rel"', '"en"').replace("lower = -0.1", "lower = -1").replace("upper = 0.1", "upper = 1")
EN += "max_candidate_uncertainty = 0.01\n"


@pytest.mark.parametrize(
    ("apart", "expected"), [(1.9e-6, "PASS"), (-1.9e-6, "PASS"), (2.1e-6, "FAIL"), (-2.1e-6, "FAIL")]
)
def test_en_is_the_error_in_units_of_the_sum_of_both_bounds(apart, expected):
    # Each bound is 1e-6.
    found, judged = verdict(results(fscm=2.0, jkr=2.0 + apart), EN)
    assert found == expected
    assert judged["error"].tolist() == pytest.approx([apart / 2e-6] * 4, rel=1e-6)


def test_en_does_not_pass_by_a_large_bound_of_the_reference():
    rows = results(fscm=2.0, jkr=2.1)
    rows.loc[rows["model"] == "fscm", "u_num"] = 1.0
    found, judged = verdict(rows, EN)
    assert found == "INCONCLUSIVE"
    assert "tolerates" in judged["reason"][0]


def test_en_does_not_pass_by_a_large_bound_of_the_candidate():
    rows = results(fscm=2.0, jkr=6.0)
    rows.loc[rows["model"] == "jkr", "u_num"] = 100.0
    found, judged = verdict(rows, EN)
    assert found == "INCONCLUSIVE"
    assert set(judged["reason"]) == {
        "u of the candidate jkr is 50 of the reference's value; the gate tolerates 0.01",
    }


def test_en_with_two_large_bounds_names_both():
    rows = results(fscm=2.0, jkr=6.0)
    rows["u_num"] = 100.0
    found, judged = verdict(rows, EN)
    assert found == "INCONCLUSIVE"
    assert set(judged["reason"]) == {
        "u of the candidate jkr is 50 of the reference's value; the gate tolerates 0.01; "
        "u of the reference fscm is 50 of the reference's value; the gate tolerates 0.001",
    }


def test_en_is_inconclusive_from_the_declared_uncertainty_of_the_candidate_on():
    for u, expected in ((0.0199, "PASS"), (0.0201, "INCONCLUSIVE")):
        # Relative to the reference, not to the value of the candidate.
        rows = results(fscm=2.0, jkr=2.01)
        rows.loc[rows["model"] == "jkr", "u_num"] = u
        assert verdict(rows, EN)[0] == expected


@pytest.mark.parametrize(("metric", "u"), [("rel", 0.02), ("abs", 0.01), ("range-relative", 0.005)])
def test_a_limit_of_the_candidates_uncertainty_is_in_the_unit_of_the_metric(metric, u):
    gate = GATE.replace('"rel"', f'"{metric}"') + "max_candidate_uncertainty = 0.01\n"
    for factor, expected in ((0.99, "PASS"), (1.01, "INCONCLUSIVE")):
        rows = results(fscm=lambda k, mu: 1.5 + mu, jkr=lambda k, mu: 1.5 + mu)
        rows.loc[rows["model"] == "jkr", "u_num"] = factor * u
        assert verdict(rows, gate)[0] == expected


def test_a_failure_stays_a_failure_whatever_the_uncertainty():
    rows = results(fscm=2.0, jkr=6.0)
    rows.loc[rows["model"] == "jkr", "u_num"] = 0.1
    assert verdict(rows, GATE + "max_candidate_uncertainty = 0.01\n")[0] == "FAIL"


@pytest.mark.parametrize(
    ("uncertain", "reason"),
    [
        ("jkr", "mostly by u of the candidate jkr: 0.005 (the reference fscm: 5.5e-07)"),
        ("fscm", "mostly by u of the reference fscm: 0.0055"),
    ],
)
def test_an_inconclusive_verdict_says_whose_uncertainty_it_is(uncertain, reason):
    rows = results(fscm=2.0, jkr=2.195)
    rows.loc[rows["model"] == uncertain, "u_num"] = 0.01
    found, judged = verdict(rows, GATE.replace("1e-3", "1e-1"))
    assert found == "INCONCLUSIVE"
    assert judged["reason"].str.startswith("E = 0.0975 +- 0.005").all()
    assert judged["reason"].str.contains("reaches across the limit 0.1, ").all()
    assert judged["reason"].str.contains(reason, regex=False).all()


@pytest.mark.parametrize("uncertain", ["jkr", "fscm", "dmt"])
def test_an_inconclusive_comparison_with_a_rival_says_whose_uncertainty_it_is(uncertain):
    gate = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = 0.0") + 'rival = "dmt"\n'
    rows = results(fscm=2.0, jkr=2.1, dmt=2.101)
    rows.loc[rows["model"] == uncertain, "u_num"] = 0.01
    found, judged = verdict(rows, gate)
    role = {"jkr": "candidate", "fscm": "reference", "dmt": "rival"}[uncertain]
    assert found == "INCONCLUSIVE"
    assert judged["reason"].str.contains(f"mostly by u of the {role} {uncertain}: 0.0", regex=False).all()


def test_an_inconclusive_distance_of_curves_says_whose_uncertainty_it_is():
    x = [i / 20 for i in range(21)]
    case = {"quantity": "force_curve", "n": 2.0, "nu": math.nan, "status": "ok", "reason": ""}
    curves = pd.DataFrame(
        [
            case | {"model": model, "k": k, "mu": mu, "x": at, "y": at, "u_distance": u}
            for model, u in (("jkr", 0.2), ("fscm", 1e-9))
            for k in (0.0, 0.4)
            for mu in (0.5, 1.0)
            for at in x
        ]
    )
    gate = (
        GATE.replace("pull_off_force", "force_curve")
        .replace('"rel"', '"curve"')
        .replace("lower = -0.1", "lower = -inf")
    )
    found, judged = verdict(results(), gate, curves=curves)
    assert found == "INCONCLUSIVE"
    assert judged["reason"].str.contains("mostly by u of the candidate jkr: 0.2", regex=False).all()
    limited = gate.replace("upper = 0.1", "upper = 0.5") + "max_candidate_uncertainty = 0.1\n"
    found, judged = verdict(results(), limited, curves=curves)
    assert found == "INCONCLUSIVE"
    assert set(judged["reason"]) == {"u of the candidate jkr is 0.2; the gate tolerates 0.1"}


def test_a_limit_of_uncertainty_is_printed_with_all_its_digits():
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[rows["model"] == "fscm", "u_num"] = 3e-3
    _, judged = verdict(rows, GATE.replace("1e-3", "1.2345e-3"))
    assert (
        judged["reason"]
        .str.endswith("u of the reference fscm is 0.0015 of the reference's value; the gate tolerates 0.0012345")
        .all()
    )


@pytest.mark.parametrize(("reference", "u"), [(0.0, 1e-6), (2.0, 0.0)])
def test_en_without_a_scale_is_an_error(reference, u):
    rows = results(fscm=reference, jkr=2.0)
    rows["u_num"] = u
    assert verdict(rows, EN)[0] == "ERROR"


def test_right_within_limits_passes_and_counts_its_cases():
    found, judged = verdict(results(fscm=2.0, jkr=2.1))
    assert found == "PASS"
    assert len(judged) == 4
    assert judged["error"].tolist() == pytest.approx([0.05] * 4)
    # U of a relative error: the denominator moves too.
    assert judged["uncertainty"].tolist() == pytest.approx([5e-7 + 1.05 * 5e-7] * 4)


@pytest.mark.parametrize(
    ("metric", "error"),
    [("rel", [0.1] * 4), ("abs", [0.2, 0.3, 0.2, 0.3]), ("range-relative", [0.2, 0.3, 0.2, 0.3])],
)
def test_metrics(metric, error):
    rows = results(fscm=lambda k, mu: -2.0 * (mu + 0.5), jkr=lambda k, mu: -2.0 * (mu + 0.5) * 0.9)
    _, judged = verdict(rows, GATE.replace('"rel"', f'"{metric}"'))
    # Less negative is a positive error, whatever the metric; the range is 1.
    assert judged["error"].tolist() == pytest.approx(error)


def test_a_model_that_is_wrong_in_one_case_fails_and_the_case_is_named():
    found, judged = verdict(results(fscm=2.0, jkr=lambda k, mu: 2.3 if (k, mu) == (0.4, 0.5) else 2.0))
    assert found == "FAIL"
    (row,) = summarise(judged).to_dict("records")
    assert (row["k"], row["mu"], row["cases"]) == (0.4, 0.5, 4)


def test_a_reference_less_certain_than_declared_is_inconclusive_not_a_pass():
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[rows["model"] == "fscm", "u_num"] = 3e-3
    found, judged = verdict(rows)
    assert found == "INCONCLUSIVE"
    assert judged["reason"].str.contains("the gate tolerates 0.001").all()


def test_a_row_for_every_declared_case_or_it_is_an_error():
    rows = results(fscm=2.0, jkr=2.0)
    for model in ("jkr", "fscm"):
        lost = rows.drop(index=rows.index[rows["model"] == model][1])
        found, judged = verdict(lost)
        assert found == "ERROR"
        assert judged["reason"].str.contains(f"{model} has no row").sum() == 1


def test_a_row_that_is_there_twice_or_is_not_declared_is_an_error():
    rows = results(fscm=2.0, jkr=2.0)
    found, judged = verdict(pd.concat([rows, rows.iloc[-1:]]))
    assert found == "ERROR"
    assert judged["reason"].str.contains("has 2 rows").any()
    found, judged = verdict(pd.concat([rows, rows.iloc[-1:].assign(mu=7.0)]))
    assert found == "ERROR"
    assert judged["reason"].str.contains("not declared").any()


@pytest.mark.parametrize("column", ["value", "u_num"])
@pytest.mark.parametrize("model", ["jkr", "fscm"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_an_error(column, model, bad):
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[rows.index[rows["model"] == model][0], column] = bad
    assert verdict(rows)[0] == "ERROR"


def test_a_negative_uncertainty_is_an_error():
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[0, "u_num"] = -1e-6
    assert verdict(rows)[0] == "ERROR"


@pytest.mark.parametrize("column", ["model", "quantity", "n", "nu", "value", "u_num", "status"])
def test_a_vanished_column_is_an_error(column):
    found, judged = verdict(results(fscm=2.0, jkr=2.0).drop(columns=column))
    assert found == "ERROR"
    assert column in judged["reason"].iloc[0]


@pytest.mark.parametrize("selection", ['tags = ["red"]', "mu = [3, 4]", "nu = [0, 0.4]"])
def test_an_empty_selection_is_an_error(selection):
    found, judged = verdict(results(fscm=2.0, jkr=2.0), GATE.replace('tags = ["blue"]', selection))
    assert found == "ERROR"
    assert "0 cases were evaluated, 4 are declared" in judged["reason"].iloc[0]


def test_fewer_cases_than_declared_is_an_error():
    assert verdict(results(fscm=2.0, jkr=2.0), GATE.replace("min_cases = 4", "min_cases = 5"))[0] == "ERROR"


def test_no_gate_is_an_error():
    assert roll_up(judge([], GRIDS, results(fscm=2.0, jkr=2.0))["verdict"]) == "ERROR"


def test_no_results_at_all_are_an_error():
    assert verdict(results())[0] == "ERROR"


def status(rows, model, status, count):
    index = rows.index[rows["model"] == model][:count]
    rows.loc[index, "status"] = status
    rows.loc[index, ["value", "u_num"]] = math.nan
    rows.loc[index, "reason"] = "why not"
    return rows


@pytest.mark.parametrize("model", ["jkr", "fscm"])
def test_not_applicable_is_an_error_unless_it_is_declared_to_be_left_out(model):
    rows = status(results(fscm=2.0, jkr=2.0), model, "not-applicable", 1)
    found, judged = verdict(rows)
    assert found == "ERROR"
    assert judged["reason"].str.contains("why not").sum() == 1
    leave_out = GATE + 'not_applicable = "leave-out"\n'
    assert verdict(rows, leave_out)[0] == "ERROR"  # four cases are declared, three are left
    found, judged = verdict(rows, leave_out.replace("min_cases = 4", "min_cases = 3"))
    assert found == "PASS"
    assert judged["verdict"].tolist().count("NOT-APPLICABLE") == 1
    assert summarise(judged)[["cases", "skipped"]].to_numpy().tolist() == [[3, 1]]


def test_all_left_out_is_an_error():
    rows = status(results(fscm=2.0, jkr=2.0), "jkr", "not-applicable", 4)
    gate = GATE.replace("min_cases = 4", "min_cases = 1") + 'not_applicable = "leave-out"\n'
    assert verdict(rows, gate)[0] == "ERROR"


def test_a_failed_computation_is_an_error_even_where_not_applicable_is_left_out():
    rows = status(results(fscm=2.0, jkr=2.0), "jkr", "failed", 1)
    assert verdict(rows, GATE.replace("= 4", "= 1") + 'not_applicable = "leave-out"\n')[0] == "ERROR"


def test_an_expected_failure_is_strict_in_every_case():
    gate = GATE + 'expected_failure = "known"\nworst_measured = 0.25\nmeasured_range = [0.24, 0.26]\n'
    assert verdict(results(fscm=2.0, jkr=2.5), gate)[0] == "XFAIL"
    assert verdict(results(fscm=2.0, jkr=lambda k, mu: 2.0 if k else 2.5), gate)[0] == "XPASS"


@pytest.mark.parametrize("failure", ["", 'expected_failure = "known"\n'])
@pytest.mark.parametrize("value", [2.47, 2.53, 1.5, 19.0])
def test_an_error_that_was_not_measured_fails_although_it_keeps_the_limits_or_is_declared_to_fail(failure, value):
    limits = "lower = -0.1\nupper = 0.1" if failure else "lower = -9\nupper = 9"
    gate = GATE.replace("lower = -0.1\nupper = 0.1", limits) + failure
    gate += "worst_measured = 0.25\nmeasured_range = [0.24, 0.26]\n"
    assert verdict(results(fscm=2.0, jkr=2.5), gate)[0] == ("XFAIL" if failure else "PASS")
    found, judged = verdict(results(fscm=2.0, jkr=value), gate)
    assert found == "FAIL"
    assert judged["reason"].str.endswith("errors measured when the gate was made are between 0.24 and 0.26").all()


def test_an_uncertainty_does_not_hide_a_change():
    gate = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -9\nupper = 9").replace("1e-3", "3.0")
    gate += "worst_measured = 0.25\nmeasured_range = [0.24, 0.26]\n"
    rows = results(fscm=2.0, jkr=2.6)
    rows["u_num"] = 2.0
    assert verdict(rows, gate)[0] == "FAIL"


@pytest.mark.parametrize(("rival", "expected"), [(2.2, "PASS"), (1.8, "PASS"), (2.1, "INCONCLUSIVE"), (2.05, "FAIL")])
def test_a_rival_is_beaten_by_size_of_error(rival, expected):
    gate = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = 0.0") + 'rival = "dmt"\n'
    assert verdict(results(fscm=2.0, jkr=1.9, dmt=rival), gate)[0] == expected


def test_the_bound_against_a_rival_has_the_reference_once_for_each_of_the_two():
    gate = GATE.replace("lower = -0.1\nupper = 0.1", "lower = -inf\nupper = 0.0") + 'rival = "dmt"\n'
    rows = results(fscm=2.0, jkr=1.8, dmt=2.4)
    rows["u_num"] = rows["model"].map({"fscm": 1e-4, "jkr": 1e-5, "dmt": 1e-6})
    # Relative to the reference, whose own u counts abs(value / reference) times for each of the two.
    expected = (1e-5 + 1e-6 + (0.9 + 1.2) * 1e-4) / 2.0
    assert verdict(rows, gate)[1]["uncertainty"].tolist() == pytest.approx([expected] * 4)


def test_a_failed_row_is_no_result_although_it_has_a_number():
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[rows["model"] == "jkr", ["status", "reason"]] = "failed", "no root"
    found, judged = verdict(rows)
    assert found == "ERROR"
    assert (judged["reason"] == "jkr: failed: no root").all()


def test_the_rows_of_other_models_and_quantities_are_left_out():
    case = {"n": 2.0, "k": 0.0, "mu": 1.0, "nu": math.nan, "value": 1.5, "u_num": 0.0, "status": "ok", "reason": ""}
    pairs = list(product(("jkr", "dmt", "fscm"), ("pull_off_force", "pull_off_displacement")))
    table = pd.DataFrame([case | {"model": model, "quantity": quantity} for model, quantity in pairs])
    for chosen in ([], pairs[:1], pairs[1:4]):
        assert [key[:2] for key in stored_numbers(table, chosen).rows] == chosen
    assert stored_numbers(table.drop(columns="value"), []).missing_columns == ["value"]


@pytest.mark.parametrize(
    ("first", "last", "expected"),
    [(1e-3, 2e-3, 2e-3), (2e-3, 1e-3, 2e-3), (math.nan, 1e-3, None), (1e-3, math.nan, None), (-1e-3, -1e-3, None)],
)
def test_the_bound_of_a_curve_is_the_largest_of_its_points_and_each_has_one(first, last, expected):
    t = np.linspace(0.0, 1.0, 21)
    case = {"model": "jkr", "quantity": "force_curve", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": math.nan}
    u = np.where(t < 0.5, first, last)
    table = pd.DataFrame(case | {"x": t, "y": t, "u_distance": u, "status": "ok", "reason": ""})
    stored = stored_curves(table, {("jkr", "force_curve")})
    key = ("jkr", "force_curve", 2.0, 0.0, 1.0, None, "")
    if expected is not None:
        assert stored.points(key)[2] == expected
    else:
        with pytest.raises(UnusableResult, match="states the uncertainty"):
            stored.points(key)


def test_a_reference_elsewhere():
    rows = results(fscm=lambda k, mu: 2.0 + k, jkr=lambda k, mu: 2.4)
    found, judged = verdict(rows, GATE + "reference_at = { k = 0.4 }\n")
    assert found == "PASS"
    assert judged["reference_value"].tolist() == [2.4] * 4


def test_a_reference_of_zero_needs_another_metric():
    found, judged = verdict(results(fscm=0.0, jkr=0.0))
    assert found == "ERROR"
    assert judged["reason"].str.contains("use metric abs").all()
    assert verdict(results(fscm=0.0, jkr=0.0), GATE.replace('"rel"', '"abs"'))[0] == "PASS"
    assert verdict(results(fscm=2.0, jkr=2.0), GATE.replace('"rel"', '"range-relative"'))[0] == "ERROR"


def test_a_case_that_does_not_apply_names_its_cure():
    rows = results(fscm=2.0, jkr=2.0)
    rows.loc[(rows["model"] == "jkr") & (rows["k"] == 0.4), ["status", "reason"]] = "not-applicable", "k = 0 alone"
    found, judged = verdict(rows)
    assert found == "ERROR"
    (reason,) = set(judged.loc[judged["verdict"] == "ERROR", "reason"])
    assert reason.startswith("jkr: k = 0 alone (")
    assert "k = [0, 0]" in reason
    assert 'not_applicable = "leave-out"' in reason
    for cure in (
        GATE.replace('tags = ["blue"]', "k = [0, 0]").replace("min_cases = 4", "min_cases = 2"),
        GATE.replace("min_cases = 4", 'min_cases = 2\nnot_applicable = "leave-out"'),
    ):
        assert verdict(rows, cure)[0] == "PASS"


def test_an_error_beyond_all_numbers_says_so():
    found, judged = verdict(results(fscm=0.5, jkr=1.7e308))
    assert found == "ERROR"
    assert judged["reason"].iloc[0].startswith("the error inf +- ")


def test_gates_for_models_that_are_given():
    gate = GATE.replace('"jkr"', '"given"')
    rows = results(fscm=2.0, jkr=2.0, dmt=2.5)
    assert judge(load_gates(gate), GRIDS, rows).empty
    _, judged = verdict(rows, gate, models=["jkr", "dmt"])
    assert summarise(judged).set_index("candidate")["verdict"].to_dict() == {"dmt": "FAIL", "jkr": "PASS"}


def test_a_given_model_is_not_compared_with_itself():
    rows = results(fscm=lambda k, mu: 2.0 + 0.1 * k, jkr=2.0)
    gate = GATE.replace('"jkr"', '"given"')
    _, judged = verdict(rows, gate, models=["fscm", "jkr"])
    assert set(judged["candidate"]) == {"jkr"}
    _, judged = verdict(rows, gate + "reference_at = { k = 0 }\n", models=["fscm", "jkr"])
    assert set(judged["candidate"]) == {"fscm", "jkr"}


def test_a_gate_of_a_model_that_is_not_given_does_not_count():
    rows = results(fscm=2.0, dmt=2.0)
    assert judge(load_gates(GATE), GRIDS, rows, models=["dmt"]).empty


def test_worst_first():
    gates = GATE + GATE.replace("ONE", "TWO").replace('"jkr"', '"dmt"')
    _, judged = verdict(results(fscm=2.0, jkr=2.0, dmt=3.0), gates)
    assert summarise(judged)["gate"].tolist() == ["TWO", "ONE"]


def test_judging_twice_gives_the_same_and_touches_nothing():
    rows = results(fscm=2.0, jkr=2.1)
    before = rows.copy(deep=True)
    first, second = (judge(load_gates(GATE), GRIDS, rows) for _ in range(2))
    pd.testing.assert_frame_equal(first, second)
    pd.testing.assert_frame_equal(rows, before)


COVERED = GATE.replace("min_cases = 4", "min_cases = 1") + 'not_applicable = "leave-out"\nmin_coverage = 1\n'


@pytest.mark.parametrize(("no_event", "refused", "failures"), [(0, 0, 0), (2, 0, 0), (0, 1, 1), (2, 1, 1)])
def test_a_case_without_an_event_is_covered_and_a_refused_one_is_not(no_event, refused, failures):
    """There is no event where the reference has no value either."""
    rows = results(jkr=1.0, fscm=1.0)
    of_jkr, of_fscm = (rows.index[rows["model"] == model] for model in ("jkr", "fscm"))
    rows.loc[[*of_jkr[: no_event + refused], *of_fscm[:no_event]], "status"] = "not-applicable"
    judged = judge(load_gates(COVERED), GRIDS, rows, domains={"jkr": Domain.of({"quantities": ["pull_off_force"]})})
    assert (judged["status"] == "no-event").sum() == no_event
    # The gate as a whole, for its coverage.
    assert judged["n"].isna().sum() == failures
    assert roll_up(judged["verdict"]) == ("FAIL" if failures else "PASS")
