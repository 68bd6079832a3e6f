"""Checks of a report card: they are not gates of the user, and each can fail."""

import pandas as pd
import pytest

from comparisons.judging.report_card import DIFFERS, judge_cards, judge_digits, overall


@pytest.mark.parametrize(
    ("verdicts", "expected"),
    [
        ({"A": "PASS", "CARD-SAME-AGAIN": "PASS"}, "PASS"),
        ({"A": "PASS", "CARD-SAME-AGAIN": "FAIL"}, "FAIL"),
        ({"A": "PASS", "CARD-DIFFERS": "INCONCLUSIVE"}, "INCONCLUSIVE"),
        ({"A": "FAIL", "CARD-DIFFERS": "INCONCLUSIVE"}, "FAIL"),
        ({"CARD-SAME-AGAIN": "PASS", "CARD-DIFFERS": "PASS"}, "ERROR"),
        ({"A": "NOT-APPLICABLE", "CARD-SAME-AGAIN": "PASS"}, "ERROR"),
        ({}, "ERROR"),
    ],
)
def test_checks_of_a_card_count_beside_a_gate_and_not_in_its_place(verdicts, expected):
    assert overall(pd.DataFrame({"gate": [*verdicts], "verdict": [*verdicts.values()]})) == expected


@pytest.mark.parametrize(
    ("again", "expected"), [(1.5, "PASS"), (1.5 + 1e-9, "PASS"), (1.5 - 3e-9, "FAIL"), (None, "FAIL")]
)
def test_a_repeated_value_is_the_same_within_what_is_allowed(again, expected):
    case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "first": 1.5, "again": again}
    judged = judge_cards({"mine": {"repeated": {"cause": "noise", "cases": [case | {"allowed": 2e-9}]}}})
    assert judged["verdict"].tolist() == [expected]


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
    judged = judge_digits(pd.DataFrame(rows), ["mine", "other"])
    assert judged[["gate", "candidate", "verdict"]].values.tolist() == [[DIFFERS, "mine", expected]]


def test_where_nothing_is_compared_digits_are_not_judged():
    missing = [row | {"value": None} for row in compared(2, 0)]
    assert judge_digits(pd.DataFrame(missing), ["mine"]).empty
