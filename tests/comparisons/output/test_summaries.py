"""Relative errors, the largest of them, and the texts of a run on the terminal."""

import math

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from comparisons.judging.decision import Verdict
from comparisons.output.errors import agreement, comparison_table, largest, relative_error
from comparisons.output.summaries import largest_errors
from comparisons.output.terminal import records, rich_table
from comparisons.output.verdicts import declared_sentence, gate_lines
from comparisons.problem import Problem
from comparisons.runs.cases import Grid

CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": 1.0, "nu": np.nan}


def shown(table, width=80):
    console = Console(width=width)
    with console.capture() as capture:
        console.print(table)
    return [line.rstrip() for line in capture.get().splitlines()]


def test_each_model_and_quantity_has_its_largest_error_with_its_case():
    errors = [(n, k, -0.01 * n - k) for n in (1.0, 1.5, 2.0, 5.0) for k in (0.0, 0.4)]
    kappa = pd.DataFrame(errors, columns=["n", "k", "kappa"])
    kappa = kappa.assign(model="jkr", quantity="pull_off_force", mu=0.837, nu=np.nan, u_kappa=1e-9, reference="fscm")
    both = pd.concat([kappa, kappa.assign(quantity="jump_in_gap")], ignore_index=True)
    (table,) = largest_errors(both)
    lines = [line.split() for line in shown(table)[-2:]]
    assert lines == [[name, "jkr", "-45.000", "5", "0.4", "0.837"] for name in ("jump_in_gap", "pull_off_force")]


def test_each_reference_has_its_own_table_of_largest_errors():
    row = CASE | {"model": "jkr", "u_kappa": 1e-9}
    errors = pd.DataFrame([row | {"reference": name, "kappa": kappa} for name, kappa in (("fscm", 0.2), ("fem", 0.1))])
    tables = [shown(table) for table in largest_errors(errors)]
    assert [(lines[0].split()[-1], lines[-1].split()[2]) for lines in tables] == [
        ("fscm", "20.000"),
        ("fem", "10.000"),
    ]
    assert list(largest_errors(errors.head(0))) == []


def gates(*verdicts):
    numbers = {"error": -0.0494, "uncertainty": 3e-9, "lower": -0.04, "upper": 0.04}
    row = CASE | numbers | {"candidate": "jkr", "reference": "fscm", "reason": ""}
    return pd.DataFrame(row | {"gate": f"GATE-{index}", "verdict": verdict} for index, verdict in enumerate(verdicts))


def test_a_gate_has_its_error_its_limits_and_its_command_and_many_are_counted():
    verdict, command, more = gate_lines(gates(*[Verdict.FAIL] * 50), {}, 1)
    assert verdict == "FAIL GATE-0 of jkr against fscm: E = -0.049400, limits -0.04 to 0.04"
    assert command == "  fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0.4 --mu 1"
    assert more.startswith("49 more")
    named = declared_sentence(gates(*[Verdict.XFAIL] * 15))
    assert "GATE-0, GATE-1" in named
    assert named.endswith("GATE-11 and 3 more")
    assert declared_sentence(gates(Verdict.PASS)) == ""


@pytest.mark.parametrize("width", [60, 80, 140])
def test_names_and_numbers_are_whole_and_texts_are_folded(width):
    names = ["carpick-ogletree-salmeron", "double-hertz-n-k"]
    reason = "[bold]n = 2 and k = 0, fitted to the values of another model, and to nothing else at all"
    table = pd.DataFrame({"model": names, "kappa": [-1132.5, np.nan], "failed": [True, False], "reason": reason})
    for printed in (rich_table(table, "[b]title", {"kappa": ".1f"}), records(table, "[b]title")):
        lines = shown(printed, width)
        words = " ".join(lines).split()
        assert lines[0] == "[b]title"
        assert {*names, "-1132.5", "yes"} <= {*words}
        assert "nan" not in words
        assert words.count("[bold]n") == 2
        assert max(map(len, lines)) <= width


def stored(model, mu, value, u_num=0.0, **more):
    content = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": math.nan, "status": "ok"}
    return content | {"model": model, "mu": mu, "value": value, "u_num": u_num} | more


def test_kappa_is_relative_to_the_one_reference_of_the_same_case():
    rows = [stored("m", 1, 3.0), stored("ref", 1, math.nan, status="failed")]
    rows += [stored("m", 2, math.nan, status="failed"), stored("ref", 2, 2.0), stored("ref", 3, 2.0)]
    assert relative_error(pd.DataFrame(rows), "ref").empty
    twice = [stored("m", 1, 3.0), stored("ref", 1, 2.0), stored("ref", 1, 2.1)]
    with pytest.raises(pd.errors.MergeError):
        relative_error(pd.DataFrame(twice), "ref")


def test_two_references_are_compared_also_where_one_alone_depends_on_the_poisson_ratio():
    rows = [stored("fem", 1.0, 2.002, 0.002, nu=0.3), stored("fscm", 1.0, 2.0)]
    (row,) = agreement(pd.DataFrame(rows), "fem", "fscm").to_dict("records")
    assert (row["nu"], row["en"]) == (0.3, pytest.approx(1.0))


def test_a_comparison_states_why_the_reference_has_no_value():
    grid = Grid("g", "", "quick", "atlas", ("jkr",), ("pull_off_force",), (Problem.dimensionless(2.0, 0.4, 20.0),))
    rows = [stored("jkr", 20.0, 1.7, reason=""), stored("atlas", 20.0, math.nan, status="failed", reason="mu is large")]
    (row,) = comparison_table(pd.DataFrame(rows), [grid], None).to_dict("records")
    assert (row["status"], row["value"], row["reason"]) == ("ok", 1.7, "the reference atlas: failed: mu is large")
    assert math.isnan(row["kappa"])


def test_largest_error_is_signed_and_says_when_it_is_at_an_end():
    rows = [stored("fscm", mu, 1.0) for mu in (0.1, 1, 10)]
    rows += [stored("md-improved", mu, value) for mu, value in [(0.1, 1.001), (1, 0.9927), (10, 1.005)]]
    rows += [stored("x", mu, value) for mu, value in [(0.1, 1.5), (1, 1.1), (10, 1.0)]]
    columns = ["mu", "cases", "at_end", "kappa", "paper_percent", "verdict"]
    improved, worst = largest(relative_error(pd.DataFrame(rows), "fscm"))[columns].values.tolist()
    assert improved == [1, 3, False, pytest.approx(-0.0073, abs=1e-12), "0.73", "agrees"]
    assert worst == [0.1, 3, True, 0.5, "", ""]


def test_each_reference_has_its_own_largest_error_and_the_paper_prints_those_against_the_fscm():
    rows = [stored("fscm", mu, 1.0) for mu in (0.1, 1)] + [stored("fem", 1, 1.0)]
    rows += [stored("md-improved", 0.1, 1.0), stored("md-improved", 1, 0.9927)]
    tables = [relative_error(pd.DataFrame(rows), name) for name in ("fscm", "fem")]
    table = pd.concat(tables, ignore_index=True)
    improved = largest(table[table["model"] == "md-improved"]).set_index("reference")
    assert improved.loc["fem", ["cases", "paper_percent", "verdict"]].tolist() == [1, "", ""]
    assert improved.loc["fscm", ["cases", "paper_percent", "verdict"]].tolist() == [2, "0.73", "agrees"]
