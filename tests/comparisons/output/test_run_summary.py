"""Texts of a run on the terminal: the largest errors, what does not pass, and one sentence on all gates."""

import shlex

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from comparisons.judging.decision import Verdict
from comparisons.output.gate_sentence import declared_sentence, gate_lines, gates_sentence
from comparisons.output.run_summary import largest_table, paper_sentence
from comparisons.output.terminal import records, rich_table

CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": 1.0, "nu": np.nan}


def maxima(models, shapes=(1.0, 1.5, 2.0, 5.0), quantities=("pull_off_force",)):
    return pd.DataFrame(
        {"quantity": quantity, "model": model, "n": n, "k": k, "mu": 0.8367, "kappa": -0.01 * n - k, "u_kappa": 1e-9}
        for quantity in quantities
        for model in models
        for n in shapes
        for k in (0.0, 0.4)
    )


def shown(table, width=80):
    console = Console(width=width)
    with console.capture() as capture:
        console.print(table)
    return [line.rstrip() for line in capture.get().splitlines()]


def test_each_shape_has_its_largest_error_with_its_place():
    title, heads, _, first, second = shown(largest_table(maxima(["jkr"])))
    assert title.startswith("pull_off_force: ")
    assert heads.split() == ["model", *["n", "=", "1", "n", "=", "1.5", "n", "=", "2", "n", "=", "5"]]
    assert first.split() == ["jkr", "-41.000(5)", "-41.500(5)", "-42.000(5)", "-45.000(5)"]
    assert second.split() == ["0.4,", "0.8367"] * 4


def test_the_largest_of_all_shapes_is_named_with_its_shape_and_quantity():
    lines = shown(largest_table(maxima(["jkr"], quantities=("pull_off_force", "jump_in_gap"))))
    assert [line.split() for line in lines[-2:]] == [
        [quantity, "jkr", "-45.000(5)", "5", "0.4", "0.8367"] for quantity in ("jump_in_gap", "pull_off_force")
    ]
    assert largest_table(maxima([])) is None


def gates(*verdicts):
    other = {"candidate": "jkr", "reference": "fscm", "reason": "", "error": -0.0494, "uncertainty": 3e-9}
    limits = {"lower": -0.04, "upper": 0.04}
    return pd.DataFrame(
        CASE | other | limits | {"gate": f"GATE-{number}", "verdict": verdict}
        for number, verdict in enumerate(verdicts)
    )


def test_a_gate_has_its_error_its_limits_and_its_command():
    lines = gate_lines(gates(Verdict.FAIL), {}, 80, 4)
    assert lines[0] == "FAIL GATE-0 of jkr against fscm: E = -0.049400(5), limits -0.04 to 0.04"
    command = "fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0.4 --mu 1"
    assert shlex.split("".join(lines[1:]).replace("\\", "")) == shlex.split(command)


def test_many_gates_are_counted():
    lines = gate_lines(gates(*[Verdict.INCONCLUSIVE] * 50), {}, 60, 4)
    assert len(lines) <= 4 * 5 + 1
    assert max(map(len, lines)) <= 60
    assert lines[-1].startswith("46 more")
    named = declared_sentence(gates(*[Verdict.XFAIL] * 15))
    assert "GATE-0, GATE-1" in named
    assert named.endswith("GATE-11 and 3 more")
    assert declared_sentence(gates(Verdict.PASS)) == ""


@pytest.mark.parametrize(
    ("verdicts", "bases", "sentence"),
    [
        (["PASS"] * 2, {}, "2 of 2 gates pass, 0 fail as declared, 0 unexpected"),
        # Each declared failure has the words of its own basis.
        (
            ["PASS", "XFAIL", "XFAIL"],
            {"GATE-1": "published", "GATE-2": "derived"},
            "1 of 3 gates passes, 1 differs from the paper as declared, 1 fails as declared, 0 unexpected",
        ),
        (
            ["NOT-APPLICABLE", "FAIL", "ERROR", "FAIL"],
            {},
            "0 of 4 gates pass, 0 fail as declared, 1 applies to no case, 3 unexpected: 1 ERROR, 2 FAIL",
        ),
        ([], {}, "No gate was evaluated"),
    ],
)
def test_the_sentence_on_all_gates(verdicts, bases, sentence):
    table = gates(*verdicts) if verdicts else gates("PASS").iloc[:0]
    assert gates_sentence(table, bases) == sentence


def test_verbs_on_the_numbers_of_the_paper_agree_with_their_count():
    verdicts = ["agrees", "agrees if truncated", "agrees if truncated", *["differs"] * 5, "undecided"]
    rows = pd.DataFrame({"k": 0.4, "paper_percent": "3.5", "verdict": verdicts})
    assert paper_sentence(rows).endswith(": 1 agrees, 2 agree if truncated, 5 differ, 1 undecided")


NAMES = ["carpick-ogletree-salmeron", "double-hertz-n-k"]


@pytest.mark.parametrize("width", [60, 80, 140])
def test_names_and_numbers_are_whole_and_texts_are_folded(width):
    reason = "[bold]n = 2 and k = 0, fitted to the values of another model, and to nothing else at all"
    table = pd.DataFrame({"model": NAMES, "kappa": [-1132.5, np.nan], "failed": [True, False], "reason": reason})
    for made in (rich_table(table, "[b]title", {"kappa": ".1f"}), records(table, "[b]title")):
        lines = shown(made, width)
        words = " ".join(lines).split()
        assert lines[0] == "[b]title"
        assert {*NAMES, "-1132.5", "yes"} <= {*words}
        assert "nan" not in words
        assert words.count("[bold]n") == 2
        assert max(map(len, lines)) <= width
