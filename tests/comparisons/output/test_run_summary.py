"""Summary of a run: at most 40 lines, whatever its models and gates."""

import shlex

import numpy as np
import pandas as pd
import pytest

from comparisons.console.shell_text import wrapped_command
from comparisons.judging.decision import Verdict
from comparisons.output.run_summary import declared_lines, gates_line, largest_table, not_passed

CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": 1.0, "nu": np.nan}


def maxima(models, shapes=(1.0, 1.5, 2.0, 5.0), gradients=(0.0, 0.4), quantities=("pull_off_force",)):
    rows = [
        {"quantity": quantity, "model": model, "n": n, "k": k, "mu": 0.8367, "kappa": -0.01 * n - k, "u_kappa": 1e-9}
        for quantity in quantities
        for model in models
        for n in shapes
        for k in gradients
    ]
    return pd.DataFrame(rows)


def names(count):
    return [f"a-model-with-a-long-name-{number}" for number in range(count)]


def test_each_shape_has_its_largest_error_with_its_place():
    table = largest_table(maxima(["jkr"]), 80, 30)
    assert list(table.texts) == ["model", "n = 1", "n = 1.5", "n = 2", "n = 5"]
    assert table.texts.loc[0, "n = 5"] == "-45.000(5)\n0.4, 0.8367"
    assert "below it k and mu" in table.title


@pytest.mark.parametrize("width", [60, 80, 120])
@pytest.mark.parametrize("count", [1, 5, 12, 40, pytest.param(200, marks=pytest.mark.heavy)])
@pytest.mark.parametrize("shapes", [(2.0,), (1.0, 1.5, 2.0, 5.0), tuple(np.linspace(1, 10, 19))])
def test_the_table_has_no_more_lines_than_there_are(width, count, shapes):
    room = 25
    shown = largest_table(maxima(names(count), shapes), width, room)
    text = shown.lines(width)
    assert len(text) + 2 <= room
    assert max(map(len, text)) <= width
    if shown.row_count < count:
        assert f"the first {shown.row_count} of {count} rows" in shown.title


def test_the_largest_of_all_shapes_is_named_with_its_shape():
    table = largest_table(maxima(["jkr"]), 80, 4)
    assert table.texts.values.tolist() == [["jkr", "-45.000(5)", "5", "0.4", "0.8367"]]
    assert "--verbose prints every n" in table.title


def test_without_errors_there_is_no_table():
    assert largest_table(maxima([]), 80, 30) is None


def test_several_quantities_have_a_column():
    table = largest_table(maxima(["jkr", "dmt"], quantities=("pull_off_force", "jump_in_gap")), 80, 30)
    assert sorted(set(table.texts["quantity"])) == ["jump_in_gap", "pull_off_force"]


def gates(*verdicts):
    rows = [
        CASE
        | {"gate": f"GATE-{number}", "candidate": "jkr", "reference": "fscm", "verdict": verdict, "reason": ""}
        | {"error": -0.0494, "uncertainty": 3e-9, "lower": -0.04, "upper": 0.04}
        for number, verdict in enumerate(verdicts)
    ]
    return pd.DataFrame(rows)


def test_what_does_not_pass_has_its_error_its_limits_and_its_command():
    shown = not_passed(gates(Verdict.FAIL, Verdict.PASS, Verdict.XFAIL), {}, 80, 4)
    assert shown[0] == "FAIL GATE-0 of jkr against fscm: E = -0.049400(5), limits -0.04 to 0.04"
    words = shlex.split("".join(shown[1:]).replace("\\", ""))
    assert words == shlex.split("fscm-bench solve --model jkr --quantity pull_off_force --n 2 --k 0.4 --mu 1")


@pytest.mark.parametrize("width", [60, 80])
def test_many_gates_that_fail_are_counted(width):
    shown = not_passed(gates(*[Verdict.INCONCLUSIVE] * 50), {}, width, 4)
    assert len(shown) <= 4 * 5 + 1
    assert max(map(len, shown)) <= width
    assert shown[-1] == "46 more do not pass; --verbose prints all"


def test_gates_that_fail_as_declared_are_named():
    shown = declared_lines(gates(*[Verdict.XFAIL] * 15), 80)
    assert "GATE-0, GATE-1" in shown[0]
    assert " ".join(" ".join(shown).split()).endswith("GATE-11 and 3 more")
    assert declared_lines(gates(Verdict.PASS), 80) == []


@pytest.mark.parametrize(
    ("verdicts", "basis", "sentence"),
    [
        (["PASS", "PASS"], "derived", "2 of 2 gates pass, 0 fail as declared, 0 unexpected (2 cases: 2 PASS)"),
        (
            ["PASS", "XFAIL"],
            "published",
            "1 of 2 gates passes, 1 differs from the paper as declared, 0 unexpected (2 cases: 1 PASS, 1 XFAIL)",
        ),
        (
            ["XFAIL", "XPASS", "ERROR"],
            "measured",
            "0 of 3 gates pass, 1 fails as declared, 2 unexpected: 1 ERROR, 1 XPASS "
            "(3 cases: 1 XFAIL, 1 XPASS, 1 ERROR)",
        ),
    ],
)
def test_one_sentence_on_all_gates(verdicts, basis, sentence):
    table = gates(*map(Verdict, verdicts))
    assert gates_line(table, table, dict.fromkeys(table["gate"], basis)) == sentence


def test_a_folded_command_is_the_same_for_a_shell():
    line = "fscm-bench check-model '/a folder/model.py:Model' --out 'x y'"
    folded = wrapped_command(line, 30)
    assert len(folded) > 1
    assert shlex.split("\n".join(folded).replace("\\\n", "")) == shlex.split(line)
