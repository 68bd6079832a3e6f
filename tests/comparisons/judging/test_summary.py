"""The summary by gate: the worst case is the one nearest to a limit or farthest beyond, its uncertainty included."""

import math

import pandas as pd
import pytest

from comparisons.judging.decision import Verdict
from comparisons.judging.judge import Judged
from comparisons.judging.summary import summarise, worst_first


def case(mu, error, uncertainty=0.0, verdict="PASS", lower=-1.0, upper=1.0, gate="A", reason=""):
    return Judged(
        gate=gate,
        quantity="pull_off_force",
        candidate="mine",
        reference="fscm",
        n=2.0,
        k=0.0,
        mu=mu,
        nu=None,
        value=1.0,
        u_num=0.0,
        reference_value=1.0,
        u_reference=0.0,
        error=error,
        uncertainty=uncertainty,
        lower=lower,
        upper=upper,
        verdict=Verdict(verdict),
        reason=reason,
    )


def table(*cases):
    return pd.DataFrame([{name: getattr(one, name) for name in Judged.__slots__} for one in cases])


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


def test_cases_that_do_not_apply_are_counted_apart():
    cases = table(case(1.0, 0.1), case(2.0, None, None, "NOT-APPLICABLE"), case(3.0, 0.2))
    assert summarise(cases)[["verdict", "mu", "cases", "skipped"]].to_numpy().tolist() == [["PASS", 3.0, 2, 1]]


def test_an_error_of_the_gate_as_a_whole_is_no_case():
    cases = table(case(1.0, 0.1), case(None, None, None, "ERROR", reason="1 case was evaluated, 2 are declared"))
    (row,) = summarise(cases).to_dict("records")
    assert (row["verdict"], row["cases"], row["skipped"]) == ("ERROR", 1, 0)
    assert row["reason"].startswith("1 case")


def test_gates_and_cases_are_sorted_worst_first_in_widths_of_their_gate():
    wide = [case(1.0, 9.5, gate="WIDE", lower=-10.0, upper=10.0), case(2.0, 0.9, gate="NARROW")]
    failed = case(3.0, 2.0, gate="FAILED", verdict="FAIL")
    assert summarise(table(*wide, failed))["gate"].tolist() == ["FAILED", "WIDE", "NARROW"]
    assert worst_first(table(*wide, failed))["gate"].tolist() == ["FAILED", "WIDE", "NARROW"]
