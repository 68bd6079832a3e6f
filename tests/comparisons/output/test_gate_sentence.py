"""The sentence on all gates: one text for the terminal and for the report, with verbs that agree with their number."""

from types import SimpleNamespace

import pandas as pd
import pytest

from comparisons.output.gate_sentence import gates_sentence
from comparisons.output.report.headline import gates_of
from comparisons.output.run_summary import gates_line, paper_sentence


def summary(*verdicts):
    return pd.DataFrame({"gate": [f"GATE-{number}" for number in range(len(verdicts))], "verdict": verdicts})


ALL = (*["PASS"] * 33, *["XFAIL"] * 6)
PUBLISHED = {f"GATE-{number}": "published" for number in range(len(ALL))}


@pytest.mark.parametrize(
    ("verdicts", "bases", "sentence"),
    [
        (ALL, PUBLISHED, "33 of 39 gates pass, 6 differ from the paper as declared, 0 unexpected"),
        (ALL, {}, "33 of 39 gates pass, 6 fail as declared, 0 unexpected"),
        # Each declared failure has the words of its own basis.
        (
            ALL,
            PUBLISHED | {"GATE-38": "derived"},
            "33 of 39 gates pass, 5 differ from the paper as declared, 1 fails as declared, 0 unexpected",
        ),
        (["XFAIL"], PUBLISHED, "0 of 1 gate passes, 1 differs from the paper as declared, 0 unexpected"),
        (["PASS"], PUBLISHED, "1 of 1 gate passes, 0 fail as declared, 0 unexpected"),
        (
            ["NOT-APPLICABLE", "FAIL", "ERROR", "FAIL"],
            {},
            "0 of 4 gates pass, 0 fail as declared, 1 applies to no case, 3 unexpected: 1 ERROR, 2 FAIL",
        ),
        ([], {}, "No gate was evaluated"),
    ],
)
def test_the_sentence_on_all_gates(verdicts, bases, sentence):
    assert gates_sentence(summary(*verdicts), bases) == sentence


@pytest.mark.parametrize("basis", ["published", "derived"])
def test_terminal_and_report_say_the_same(basis):
    gates = summary("PASS", "XFAIL", "XFAIL", "FAIL")
    required = pd.DataFrame({"id": gates["gate"], "basis": basis})
    terminal = gates_line(gates, gates, dict(zip(required["id"], required["basis"], strict=True)))
    report = gates_of(SimpleNamespace(judged=True, summary=gates, gates=required))
    assert terminal == f"{report} (4 cases: 1 PASS, 2 XFAIL, 1 FAIL)"


def test_a_folder_without_stored_gates_has_a_sentence():
    stored = SimpleNamespace(judged=True, summary=summary("XFAIL"), gates=None)
    assert gates_of(stored) == "0 of 1 gate passes, 1 fails as declared, 0 unexpected"


def test_verbs_on_the_numbers_of_the_paper_agree_with_their_count():
    verdicts = ["agrees", "agrees if truncated", "agrees if truncated", *["differs"] * 5, "undecided"]
    rows = pd.DataFrame({"k": 0.4, "paper_percent": "3.5", "verdict": verdicts})
    assert paper_sentence(rows).endswith(": 1 agrees, 2 agree if truncated, 5 differ, 1 undecided")
