"""Rules of verdicts: decision, roll-up, summary by gate, fresh cases beside the standing ones, report cards."""

import math
from itertools import pairwise

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.judging.decision import Verdict, decide, expecting_failure, roll_up
from comparisons.judging.fresh_verdicts import compare_with_standing
from comparisons.judging.judge import Judged, verdict_table
from comparisons.judging.report_card import AGAIN, DIGITS, ModelCheck, check_models, overall
from comparisons.judging.summary import summarise, worst_first

NUMBERS = st.floats(-1e3, 1e3)


@pytest.mark.parametrize(
    ("error", "uncertainty", "verdict"),
    [
        (1.0, 0.0, "PASS"),
        (0.5, 0.5, "PASS"),
        (0.5, 0.500001, "INCONCLUSIVE"),
        (1.5, 0.5, "INCONCLUSIVE"),
        (1.5, 0.499999, "FAIL"),
        (-2.4, 0.4, "INCONCLUSIVE"),
        (math.nan, 0.1, "ERROR"),
        (0.0, math.inf, "ERROR"),
        (0.0, -0.1, "ERROR"),
    ],
)
def test_the_interval_decides(error, uncertainty, verdict):
    assert decide(error, uncertainty, -2.0, 1.0) == verdict


@given(NUMBERS, st.floats(0, 1e3), NUMBERS, st.floats(0, 1e3))
def test_more_uncertainty_never_makes_a_verdict_surer(error, u, lower, width):
    before, after = (decide(error, factor * u, lower, lower + width) for factor in (1.0, 2.0))
    assert after == before or after == Verdict.INCONCLUSIVE


@given(NUMBERS, st.floats(0, 1e3), NUMBERS, st.floats(0, 1e3))
def test_the_sign_of_everything_is_a_symmetry(error, u, lower, width):
    assert decide(error, u, lower, lower + width) == decide(-error, u, -lower - width, -lower)


ORDER = ["ERROR", "FAIL", "XPASS", "INCONCLUSIVE", "XFAIL", "PASS"]


def test_the_order_of_the_roll_up():
    for worse, better in pairwise(ORDER):
        assert roll_up([better, worse, better]) == worse
    assert roll_up([]) == roll_up([Verdict.NOT_APPLICABLE]) == "ERROR"


def test_an_expected_failure_is_strict():
    expected = ["ERROR", "XFAIL", "XPASS", "INCONCLUSIVE", "XFAIL", "XPASS"]
    assert [expecting_failure(Verdict(name)) for name in ORDER] == expected


def case(mu, error, uncertainty=0.0, verdict="PASS", lower=-1.0, upper=1.0, gate="A", reason=""):
    limits = {"lower": lower, "upper": upper, "verdict": Verdict(verdict), "reason": reason}
    return Judged(gate, "pull_off_force", "mine", "fscm", 2.0, 0.0, mu, error=error, uncertainty=uncertainty, **limits)


def table(*cases):
    return verdict_table(cases)


@pytest.mark.parametrize(
    ("cases", "worst"),
    [
        # Largest towards the upper limit, the lower limit; also where it is neither the first nor the last.
        ([case(1.0, 0.1), case(2.0, 0.9), case(3.0, 0.5)], 2.0),
        ([case(1.0, 0.5), case(2.0, -0.9), case(3.0, 0.1)], 2.0),
        # The uncertainty counts.
        ([case(1.0, 0.1), case(2.0, 0.5, 0.4), case(3.0, 0.6)], 2.0),
        # Beyond a limit, the farthest.
        ([case(1.0, 1.2, verdict="FAIL"), case(2.0, -3.0, verdict="FAIL"), case(3.0, 0.9)], 2.0),
        # A worse verdict comes before a larger error.
        ([case(1.0, 0.999), case(2.0, 0.1, verdict="INCONCLUSIVE"), case(3.0, -0.999)], 2.0),
        # One limit only: the width of the gate is one.
        ([case(1.0, 0.2, lower=-math.inf), case(2.0, 0.7, lower=-math.inf), case(3.0, -9.0, lower=-math.inf)], 2.0),
        # A case without a number is worse than any number.
        ([case(1.0, 5.0, verdict="ERROR"), case(2.0, math.nan, verdict="ERROR")], 2.0),
    ],
)
def test_the_worst_case_is_shown(cases, worst):
    row = summarise(table(*cases)).iloc[0]
    assert row["mu"] == worst
    assert row["cases"] == len(cases)
    assert worst_first(table(*cases)).iloc[0]["mu"] == worst


def test_cases_that_do_not_apply_and_errors_of_the_gate_as_a_whole_are_counted_apart():
    cases = [case(1.0, 0.1), case(2.0, None, None, "NOT-APPLICABLE"), case(3.0, 0.2)]
    assert summarise(table(*cases))[["verdict", "mu", "cases", "skipped"]].to_numpy().tolist() == [["PASS", 3.0, 2, 1]]
    cases = table(*cases, case(None, None, None, "ERROR", reason="2 cases were evaluated, 3 are declared"))
    (row,) = summarise(cases).to_dict("records")
    assert (row["verdict"], row["cases"], row["skipped"], row["reason"][:7]) == ("ERROR", 2, 1, "2 cases")


def test_gates_and_cases_are_sorted_worst_first_in_widths_of_their_gate():
    wide = [case(1.0, 9.5, gate="WIDE", lower=-10.0, upper=10.0), case(2.0, 0.9, gate="NARROW")]
    failed = case(3.0, 2.0, gate="FAILED", verdict="FAIL")
    assert summarise(table(*wide, failed))["gate"].tolist() == ["FAILED", "WIDE", "NARROW"]
    assert worst_first(table(*wide, failed))["gate"].tolist() == ["FAILED", "WIDE", "NARROW"]


def rows(gate, cases):
    """Verdicts of one model; a case is mu, error, uncertainty, verdict and status."""
    blank = dict.fromkeys(Judged.__slots__)
    names = {"gate": gate, "candidate": "mine", "quantity": "pull_off_force", "n": 2.0, "k": 0.4}
    return pd.DataFrame(
        [
            blank | names | {"mu": mu, "error": error, "uncertainty": u, "verdict": verdict, "status": status}
            for mu, error, u, verdict, status in cases
        ]
    )


def ok(mu, error, u=0.0, verdict=Verdict.PASS):
    return mu, error, u, verdict, "ok"


REFUSED = (0.5, None, None, Verdict.FAIL, "not-applicable")
STANDING = [ok(0.1, 1e-3, 1e-4), ok(1.0, -1e-3, 1e-4)]
#: Ten times what the error of a standing case can be at most.
LIMIT = 1.1e-2


@pytest.mark.parametrize(
    ("fresh", "fails"),
    [
        ([ok(0.5, 1e-3)], False),
        # Between the standing cases an error counts that is certainly more than ten times as large.
        ([ok(0.5, 0.99 * LIMIT)], False),
        ([ok(0.5, 1.01 * LIMIT)], True),
        ([ok(0.5, -1.01 * LIMIT)], True),
        ([ok(0.5, 1.01 * LIMIT, 0.02 * LIMIT)], False),
        ([ok(0.5, 1e-3), ok(0.6, 1.01 * LIMIT), ok(0.7, 1e-3)], True),
        # Elsewhere it does not, unless it is beyond the limits of the gate; also where none is between them.
        ([ok(5.0, 1.01 * LIMIT)], False),
        ([ok(5.0, 1.01 * LIMIT), ok(0.5, 1e-3)], False),
        ([ok(5.0, 1.01 * LIMIT, verdict=Verdict.FAIL)], True),
        ([ok(0.5, 2e-3, verdict=Verdict.FAIL)], True),
        # Half as many values as in the standing cases are enough.
        ([ok(0.5, 1e-3), REFUSED], False),
        ([ok(0.5, 1e-3), REFUSED, REFUSED], True),
        ([REFUSED], True),
        ([], False),
    ],
)
def test_a_model_that_is_right_in_the_standing_cases_alone_fails(fresh, fails):
    failures = compare_with_standing(rows("A", STANDING), rows("A-RANDOM", fresh) if fresh else rows("A", STANDING)[:0])
    assert failures["verdict"].tolist() == [Verdict.FAIL] * fails
    assert failures["gate"].tolist() == ["A-RANDOM"] * fails


@pytest.mark.parametrize("standing", [[], [*STANDING, ok(0.3, 1.0, verdict=Verdict.FAIL)]])
def test_a_model_that_is_not_right_in_the_standing_cases_has_failed_there(standing):
    fresh = rows("A-RANDOM", [ok(0.5, 1.0, verdict=Verdict.FAIL)])
    assert compare_with_standing(rows("A", standing) if standing else rows("A", STANDING)[:0], fresh).empty


def test_fresh_cases_of_a_problem_file_are_between_its_standing_ones():
    standing, fresh = (rows(gate, [ok(None, error)]) for gate, error in (("A", 1e-3), ("A-RANDOM", 0.5)))
    tables = (
        table.assign(n=None, k=None, mu=None).astype({"n": float, "k": float, "mu": float})
        for table in (standing, fresh)
    )
    assert len(compare_with_standing(*tables)) == 1


@pytest.mark.parametrize(
    ("of_gates", "of_card", "expected"),
    [
        (["PASS"], ["PASS"], "PASS"),
        (["PASS"], ["PASS", "FAIL"], "FAIL"),
        (["PASS"], ["INCONCLUSIVE"], "INCONCLUSIVE"),
        (["FAIL"], ["INCONCLUSIVE"], "FAIL"),
        (["NOT-APPLICABLE"], ["PASS"], "ERROR"),
        ([], ["PASS", "PASS"], "ERROR"),
        ([], [], "ERROR"),
    ],
)
def test_checks_of_a_card_count_beside_a_gate_and_not_in_its_place(of_gates, of_card, expected):
    checks = [ModelCheck("mine", AGAIN, Verdict(verdict), "") for verdict in of_card]
    assert overall(pd.DataFrame({"verdict": of_gates}), checks) == expected


@pytest.mark.parametrize(
    ("again", "expected"), [(1.5, "PASS"), (1.5 + 1e-9, "PASS"), (1.5 - 3e-9, "FAIL"), (None, "FAIL")]
)
def test_a_repeated_value_is_the_same_within_what_is_allowed(again, expected):
    case = {"first": 1.5, "again": 1.5, "allowed": 2e-9}
    repeated = {"cause": "noise", "cases": [case, case | {"again": again}, case]}
    nothing_compared = pd.DataFrame(columns=["candidate", "value", "reference_value"])
    assert check_models(nothing_compared, {"mine": {"repeated": repeated}}) == [
        ModelCheck("mine", AGAIN, Verdict(expected), "noise")
    ]


def compared(same, other, reference="fscm", k=0.4, gate="A"):
    """So many values that are those of the reference, and so many that differ in the last digit."""
    row = {"gate": gate, "candidate": "mine", "reference": reference, "k": k, "reference_value": 1.5}
    return [row | {"value": 1.5}] * same + [row | {"value": 1.5 + 2.0**-52}] * other


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        (compared(4, 0), "INCONCLUSIVE"),
        (compared(3, 2), "INCONCLUSIVE"),
        (compared(2, 2), "PASS"),
        (compared(4, 0, "atlas"), "INCONCLUSIVE"),
        # A closed form, and the algebraic limit.
        (compared(4, 0, "jkr"), "PASS"),
        (compared(4, 0, k=1.0), "PASS"),
        # The problem of a file has no k.
        (compared(4, 0, k=float("nan")), "INCONCLUSIVE"),
        # Of several gates, such as the standing and the fresh cases, one is enough.
        ([*compared(3, 0), *compared(0, 20, gate="A-RANDOM")], "INCONCLUSIVE"),
    ],
)
def test_most_values_of_a_gate_are_not_those_of_a_numerical_reference(rows, expected):
    (check,) = check_models(pd.DataFrame(rows), {"mine": {}, "other": {}})
    assert check[:3] == ("mine", DIGITS, expected)


def test_where_nothing_is_compared_digits_are_not_judged():
    missing = [row | {"value": None} for row in compared(2, 0)]
    assert check_models(pd.DataFrame(missing), {"mine": {}}) == []
