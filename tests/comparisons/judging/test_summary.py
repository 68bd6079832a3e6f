"""The summary by gate: the worst case is the one nearest to a limit or farthest beyond, its uncertainty included."""

import math

import pytest

from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged, verdict_table
from comparisons.judging.summary import summarise, worst_first


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
