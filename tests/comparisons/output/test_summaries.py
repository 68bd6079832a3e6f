"""Texts of a run on the terminal: the largest errors, what does not pass, and one sentence on all gates."""

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from comparisons.judging.decision import Verdict
from comparisons.output.summaries import largest_errors
from comparisons.output.terminal import records, rich_table
from comparisons.output.verdicts import declared_sentence, gate_lines

CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": 1.0, "nu": np.nan}


def shown(table, width=80):
    console = Console(width=width)
    with console.capture() as capture:
        console.print(table)
    return [line.rstrip() for line in capture.get().splitlines()]


def test_each_model_and_quantity_has_its_largest_error_with_its_case():
    errors = [(n, k, -0.01 * n - k) for n in (1.0, 1.5, 2.0, 5.0) for k in (0.0, 0.4)]
    kappa = pd.DataFrame(errors, columns=["n", "k", "kappa"])
    kappa = kappa.assign(model="jkr", quantity="pull_off_force", mu=0.837, nu=np.nan, u_kappa=1e-9)
    both = pd.concat([kappa, kappa.assign(quantity="jump_in_gap")], ignore_index=True)
    lines = [line.split() for line in shown(largest_errors(both))[-2:]]
    assert lines == [[name, "jkr", "-45.000(5)", "5", "0.4", "0.837"] for name in ("jump_in_gap", "pull_off_force")]


def gates(*verdicts):
    numbers = {"error": -0.0494, "uncertainty": 3e-9, "lower": -0.04, "upper": 0.04}
    row = CASE | numbers | {"candidate": "jkr", "reference": "fscm", "reason": ""}
    return pd.DataFrame(row | {"gate": f"GATE-{index}", "verdict": verdict} for index, verdict in enumerate(verdicts))


def test_a_gate_has_its_error_its_limits_and_its_command_and_many_are_counted():
    verdict, command, more = gate_lines(gates(*[Verdict.FAIL] * 50), {}, 1)
    assert verdict == "FAIL GATE-0 of jkr against fscm: E = -0.049400(5), limits -0.04 to 0.04"
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
