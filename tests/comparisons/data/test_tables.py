"""Tables of data: columns, numbers printed in the paper, and the cases that its statements are about."""

import csv

import pytest

from comparisons.data.columns import column
from comparisons.data.paper_statements import PaperStatement
from comparisons.data.paper_values import PaperValue
from tests.paths import ROOT


@pytest.mark.parametrize(
    ("computed", "u", "verdict"),
    [(8 / 3, 0.0, "agrees"), (2.6666667, 0.0, "differs"), (2.6666667, 1e-7, "agrees"), (2.67, 1e-7, "differs")],
)
def test_a_formula_has_no_last_digit_to_be_generous_with(computed, u, verdict):
    assert PaperValue("", "", "", "8/3", exact=8 / 3).verdict(computed, u) == verdict


@pytest.mark.parametrize(
    ("text", "steps", "u", "verdict"),
    [
        *[("2.880", steps, 1e-9, "agrees") for steps in (-0.49, 0.49)],
        *[("40.8", steps, 1e-9, "agrees if truncated") for steps in (0.51, 0.99)],
        # Numbers are not truncated upwards.
        *[("3.5", steps, 1e-9, "differs") for steps in (-0.51, 1.01)],
        # A bound that reaches over a border decides nothing.
        *[("3.5", steps, 1e-6, "undecided") for steps in (-0.5, 0.5, 1.0)],
        ("3.5", 55.0, 100.0, "undecided"),
    ],
)
def test_rounded_and_truncated_digits_are_distinguished(text, steps, u, verdict):
    printed = PaperValue("", "", "", text)
    assert printed.verdict(printed.value + steps * 10.0 ** -len(text.partition(".")[2]), u) == verdict


CASES = [{"n": 1.0, "mu": 1.0}, {"n": 2.0, "k": 0.6, "mu": 3.0}, {"n": 2.0, "mu": 2.0}, {"n": 2.0, "k": 0.4}]


@pytest.mark.parametrize(
    ("entries", "own", "beyond"),
    [
        ({"own": {"n": [2], "mu": [1, 3]}}, [False, True, False, True], [True, False, True, False]),
        # What is stated in general or without cases has no case beyond it.
        ({"own": {"n": [2]}, "general": True}, [False, True, True, True], [False] * 4),
        ({}, [False] * 4, [False] * 4),
    ],
)
def test_a_case_is_one_of_the_paper_or_beyond_it(entries, own, beyond):
    statement = PaperStatement("a", "Sec. 1", "It is so.", [], "It is compared.", "n = 2", "", **entries)
    assert [statement.is_own(case) for case in CASES] == own
    assert [statement.is_beyond(case) for case in CASES] == beyond


#: Folders of committed tables.
FOLDERS = ("results/baseline", "comparisons/data", "fscm/interpolation/data")
TABLES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.csv") if path.parent.name != "graded")


def header(path):
    with path.open(newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


@pytest.mark.parametrize("path", TABLES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_every_column_of_a_committed_table_has_unit_and_description(path):
    assert [name for name in header(path) if column(path.stem, name) is None] == []
    assert all(column(path.stem, name).description for name in header(path))


def test_a_column_of_a_figure_does_not_describe_that_of_a_run():
    assert column("fig03_s_curve_points", "load").unit == "P"
    assert column("results", "load") is None
    assert column("a_table_of_my_own", "load") is None
    assert column("fig10_transition", "mu") == column("results", "mu")
