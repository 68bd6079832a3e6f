"""Relative errors, their uncertainty, and the verdict on printed digits."""

import io
import math
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.judging.gates import load_gates
from comparisons.judging.judge import judge
from comparisons.output.tables import (
    beside_paper_values,
    by_case,
    largest,
    largest_by_gradient,
    relative_error,
    rich_table,
    statuses,
)
from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.cache import CachedCall
from comparisons.paper.studies.error_grid import errors, errors_at
from comparisons.runs.cases import Case, Grid

GATE = """
[[gate]]
id = "JUMP-OUT"
requirement = "JKR jumps out where the FSCM does."
quantity = "jump_out_displacement"
candidate = "jkr"
reference = "fscm"
cases = { n = [1, 1] }
metric = "rel"
lower = -1
upper = 1
max_reference_uncertainty = 1e-3
basis = "derived"
grounds = "An example."
min_cases = 1
tier = "quick"
"""


def stored(model, mu, value, u_num=0.0, **other):
    content = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": math.nan, "status": "ok"}
    return content | {"model": model, "mu": mu, "value": value, "u_num": u_num} | other


def test_kappa_is_relative_to_the_reference_of_the_same_case():
    rows = [stored("m", 1, 3.0), stored("ref", 1, math.nan, status="failed")]
    rows += [stored("m", 2, math.nan, status="failed"), stored("ref", 2, 2.0), stored("ref", 3, 2.0)]
    assert relative_error(pd.DataFrame(rows), "ref").empty


def test_two_reference_rows_of_one_case_are_an_error():
    rows = pd.DataFrame([stored("m", 1, 3.0), stored("ref", 1, 2.0), stored("ref", 1, 2.1)])
    with pytest.raises(pd.errors.MergeError):
        relative_error(rows, "ref")


unit = st.floats(min_value=-1, max_value=1)


@given(st.floats(0.1, 10), st.floats(0.5, 10), st.floats(0, 1e-3), st.floats(0, 1e-3), unit, unit)
def test_u_kappa_bounds_what_the_true_values_can_give(value, reference, u, u_ref, a, b):
    rows = pd.DataFrame([stored("m", 1, value, u), stored("ref", 1, reference, u_ref)])
    (kappa,) = relative_error(rows, "ref").itertuples()
    true = (value + a * u) / (reference + b * u_ref) - 1
    # To first order: the second-order term is u_ref / reference times the first, at most 2e-3 of it.
    assert abs(true - kappa.kappa) <= kappa.u_kappa * 1.003 + 1e-13


@pytest.mark.parametrize(
    ("percent", "kappa", "u", "verdict"),
    [
        ("6.7", 0.0674, 1e-6, "agrees"),
        ("6.7", -0.0666, 1e-6, "agrees"),
        ("6.7", 0.0676, 1e-6, "agrees if truncated"),
        ("6.7", 0.0681, 1e-6, "differs"),
        ("6.7", 0.0664, 1e-6, "differs"),
        ("6.7", 0.06749, 1e-3, "undecided"),
        ("0.73", 0.00734, 1e-7, "agrees"),
        ("0.73", 0.00741, 1e-7, "differs"),
        ("65.0", 0.6504, 1e-6, "agrees"),
        ("65.0", 0.6512, 1e-6, "differs"),
    ],
)
def test_verdict_is_on_the_printed_digits(percent, kappa, u, verdict):
    assert PaperValue("", "", "", percent, "%").verdict(100 * abs(kappa), 100 * u) == verdict


def test_the_paper_values_of_the_maxima():
    table = {(p.model, p.n): p.text for p in paper_values("largest_relative_error")}
    assert table == {
        ("md-original", 1): "65.0",
        ("md-original", 1.5): "21.2",
        ("md-original", 2): "3.5",
        ("md-original", 5): "15.9",
        ("md-improved", 1): "5.8",
        ("md-improved", 1.5): "1.7",
        ("md-improved", 2): "0.73",
        ("md-improved", 5): "6.7",
    }
    assert {p.k for p in paper_values("largest_relative_error")} == {0.4}


def test_largest_error_is_signed_and_says_when_it_is_at_an_end():
    rows = [stored("ref", mu, 1.0) for mu in (0.1, 1, 10)]
    rows += [stored("md-improved", mu, value) for mu, value in [(0.1, 1.001), (1, 0.9927), (10, 1.005)]]
    rows += [stored("x", mu, value) for mu, value in [(0.1, 1.5), (1, 1.1), (10, 1.0)]]
    table = largest(relative_error(pd.DataFrame(rows), "ref")).set_index("model")
    inside = table.loc["md-improved"]
    assert (inside["mu"], inside["cases"], inside["at_end"]) == (1, 3, False)
    assert inside["kappa"] == pytest.approx(-0.0073, abs=1e-12)
    assert (inside["paper_percent"], inside["verdict"]) == ("0.73", "agrees")
    assert table.loc["x", "at_end"]
    assert (table.loc["x", "paper_percent"], table.loc["x", "verdict"]) == ("", "")


def test_one_row_a_case_for_reading():
    rows = [stored("ref", 1, 2.0, 1e-9), stored("a", 1, 2.2), stored("b", 1, 1.8)]
    shown, formats = by_case(relative_error(pd.DataFrame(rows), "ref"))
    assert shown[["a", "b"]].to_numpy().tolist() == [[pytest.approx(10), pytest.approx(-10)]]
    assert shown["reference"].tolist() == ["2.0000000000(10)"]
    assert set(formats) <= set(shown)


def test_statuses_are_counted_by_model():
    rows = pd.DataFrame([stored("a", 1, 1), stored("a", 2, 1), stored("b", 1, 1, status="failed")])
    assert statuses(rows).to_dict("list") == {"model": ["a", "b"], "failed": [0, 1], "ok": [2, 0]}


def test_external_text_is_not_markup():
    stream = io.StringIO()
    table = pd.DataFrame({"reason": ["[bold]k in [0, 1]"], "x": [math.nan], "y": [0.5]})
    Console(file=stream, width=80).print(rich_table(table, "t", {"y": ".3f"}))
    assert "[bold]k in [0, 1]" in stream.getvalue()
    assert "nan" not in stream.getvalue()
    assert "0.500" in stream.getvalue()


def test_maxima_for_reading_keep_their_sign_and_their_place():
    rows = [stored("ref", mu, 1.0, k=k) for mu in (0.1, 1, 10) for k in (0, 0.4)]
    rows += [stored("md-improved", mu, 0.9, k=k) for mu in (0.1, 1, 10) for k in (0, 0.4)]
    maxima = largest(relative_error(pd.DataFrame(rows), "ref"))
    wide, _ = largest_by_gradient(maxima)
    assert wide[["k = 0", "k = 0.4"]].to_numpy().tolist() == [[pytest.approx(-10)] * 2]
    stated, _ = beside_paper_values(maxima)
    assert stated[["n", "k", "kappa", "paper_percent", "verdict"]].to_numpy().tolist() == [
        [2, 0.4, "-10.00000(5)", "0.73", "differs"]
    ]


@pytest.mark.parametrize(("value", "reference"), [(-2.1, -2.0), (-1.9, -2.0), (0.5, -2.0), (1.9, 2.0), (-1.0, 2.0)])
def test_one_sign_of_kappa_in_tables_gates_and_error_maps(value, reference):
    """Positive where the model is above the reference, also where both are negative."""
    case = {"quantity": "jump_out_displacement", "n": 1.0}
    rows = pd.DataFrame([stored("jkr", 1, value, 1e-9, **case), stored("fscm", 1, reference, 1e-9, **case)])
    expected = (value - reference) / abs(reference)
    (kappa,) = relative_error(rows, "fscm")["kappa"]
    grid = Grid("g", "", "quick", "fscm", ("jkr",), ("jump_out_displacement",), (Case(1.0, 0.4, 1),))
    (gate,) = load_gates(GATE)
    (judged,) = judge([gate], [grid], rows.assign(reason=""))["error"]
    call = CachedCall.of(errors_at, 1.0, 0.4, 1)
    found = {row["model"]: {"value": row["value"], "u_num": 1e-9, "reason": ""} for row in rows.to_dict("records")}
    others = dict.fromkeys(("md-improved", "md-original"), found["jkr"])
    (mapped, *_) = errors(
        {call: {"jump_out_displacement": found | others}}, [(1.0, 0.4, 1)], ["jump_out_displacement"]
    )["kappa"]
    assert kappa == judged == mapped == expected


def test_the_committed_errors_of_the_jumps_have_the_sign_of_the_tables():
    table = pd.read_csv(Path(__file__).parents[3] / PAPER_BASELINE / "error_bands_jumps.csv")
    known = table[(table["quantity"] == "jump_out_displacement") & table["kappa"].notna()]
    rows = [known.assign(status="ok", nu=math.nan)]
    reference = known.drop_duplicates(["n", "k", "mu"])
    rows.append(
        reference.assign(model="fscm", value=reference["fscm"], u_num=reference["u_fscm"], status="ok", nu=math.nan)
    )
    again = relative_error(pd.concat(rows), "fscm").merge(known, on=["model", "n", "k", "mu"], suffixes=("", "_map"))
    assert (again["reference_value"] < 0.0).all()
    assert again["kappa"].to_numpy() == pytest.approx(again["kappa_map"].to_numpy(), rel=0.0, abs=1e-14)
    (jkr,) = again.loc[
        (again["model"] == "jkr") & (again["n"] == 1.0) & (again["k"] == 0.4) & (again["mu"] == 2.0), "kappa"
    ]
    assert jkr == pytest.approx(0.0524, abs=5e-5)
