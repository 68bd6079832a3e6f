"""Texts and files of verdicts: digits, Markdown, LaTeX, JUnit XML."""

import math
import re
from functools import partial
from html import unescape
from xml.etree import ElementTree

import pandas as pd
import pytest
from markdown_it import MarkdownIt

from comparisons.data.file_names import VERDICT_FILES, is_of_verdicts
from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import ModelCheck
from comparisons.output.junit import junit
from comparisons.output.markup import markdown
from comparisons.output.verdicts import command, write_verdicts
from comparisons.runs.csv_format import read_table

ROW = {
    **{"gate": "ONE", "quantity": "pull_off_force", "candidate": "jkr", "reference": "fscm"},
    **{"n": 2.0, "k": 0.4, "mu": 1.0, "nu": math.nan, "value": 1.7, "u_num": 1e-16},
    **{"reference_value": 1.78848171, "u_reference": 3e-9, "error": -0.0494, "uncertainty": 3e-9},
    **{"lower": -0.1, "upper": 0.1, "verdict": "PASS", "reason": "", "status": "ok"},
}
REFUSED = {"verdict": "NOT-APPLICABLE", "reason": "jkr: no \x00 such | thing", "status": "not-applicable"}
WHOLE_GATE = {"n": None, "k": None, "mu": None, "verdict": "ERROR", "reason": "0 cases", "status": "", "error": None}
JUDGED = pd.DataFrame(
    [
        ROW,
        ROW | {"mu": 5.0, "verdict": "FAIL", "error": 0.2},
        ROW | {"gate": "TWO", "verdict": "XFAIL", "reason": "known & <printed>"},
        ROW | {"gate": "TWO", "error": math.nan, **REFUSED},
        ROW | {"gate": "THREE", **WHOLE_GATE},
        ROW | {"gate": "FOUR", "verdict": "INCONCLUSIVE", "nu": 0.25},
        ROW | {"gate": "FIVE", "verdict": "XPASS"},
    ]
)
AGAIN = partial(command, specs={})


def test_junit_has_one_test_case_a_gate_and_case():
    root = ElementTree.fromstring(junit(JUDGED, [], AGAIN))
    assert root.attrib == {"name": "fscm-bench", "tests": "7", "errors": "1", "failures": "3", "skipped": "2"}
    assert [suite.get("name") for suite in root] == ["ONE", "TWO", "THREE", "FOUR", "FIVE"]
    cases = root.findall(".//testcase")
    tags = ["system-out", "failure", "skipped", "skipped", "error", "failure", "failure"]
    assert [[child.tag for child in case] for case in cases] == [[tag] for tag in tags]
    assert len({(case.get("classname"), case.get("name")) for case in cases}) >= 5
    assert AGAIN(JUDGED.iloc[1]) in root.find(".//failure").text


def test_junit_has_an_error_where_no_gate_of_the_user_was_evaluated():
    passed = JUDGED[JUDGED["verdict"] == Verdict.PASS]
    for checks in ([ModelCheck("jkr", "digits", Verdict.PASS, "")], []):
        root = ElementTree.fromstring(junit(JUDGED.iloc[:0], checks, AGAIN))
        assert (root.get("tests"), root.get("errors")) == (str(len(checks) + 1), "1")
        assert len(root.findall(".//error")) == 1
    assert ElementTree.fromstring(junit(passed, [], AGAIN)).get("errors") == "0"


def test_junit_has_a_failure_where_a_report_card_fails():
    passed = JUDGED[JUDGED["verdict"] == Verdict.PASS]
    verdicts = (Verdict.PASS, Verdict.INCONCLUSIVE, Verdict.FAIL)
    checks = [ModelCheck("jkr", "digits", verdict, f"\x00 {verdict}") for verdict in verdicts]
    root = ElementTree.fromstring(junit(passed, checks, AGAIN))
    assert (root.get("tests"), root.get("failures")) == (str(len(passed) + 3), "2")
    assert [failure.text for failure in root.findall(".//failure")] == ["? INCONCLUSIVE", "? FAIL"]


AT = "--quantity pull_off_force --n 2 --k 0.4 --mu 1"


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ({"nu": 0.1 + 0.2}, f"solve --model jkr {AT} --nu 0.30000000000000004"),
        ({"quantity": "pull_off_gap"}, f"curve --model jkr {AT}".replace("force", "gap")),
        ({"candidate": "mine"}, f"solve --model 'my m/j.py:J' {AT}"),
        (
            {"problem": "pad.toml; punch.R=1e-06; solid.k=0.4"},
            "sweep --model jkr --quantity pull_off_force --problem pad.toml "
            "--vary 'punch.R=1e-06 m' --vary solid.k=0.4",
        ),
        (
            {"problem": "pad.toml; punch.R=1 um"},
            "sweep --model jkr --quantity pull_off_force --problem pad.toml --vary 'punch.R=1 um'",
        ),
    ],
)
def test_the_command_of_a_row(row, words):
    assert command(pd.Series(ROW | row), {"mine": "my m/j.py:J"}) == f"fscm-bench {words}"


def test_a_whole_gate_has_no_command():
    assert command(pd.Series(ROW | WHOLE_GATE), {}) == ""


def test_the_files_are_worst_first(tmp_path):
    write_verdicts(tmp_path, JUDGED, [], [], {})
    files = {path.name for path in tmp_path.iterdir()}
    assert files == {*VERDICT_FILES, "verdicts.md", "verdicts.tex"}
    assert all(map(is_of_verdicts, files))
    page = (tmp_path / "verdicts.md").read_text()
    assert read_table(tmp_path / "verdicts.csv")["verdict"].tolist() == JUDGED["verdict"].tolist()
    worst = ["ERROR", "FAIL", "XPASS", "INCONCLUSIVE", "XFAIL"]
    assert read_table(tmp_path / "summary.csv")["verdict"].tolist() == worst
    rows = [line.removeprefix("| ").split(" | ") for line in page.splitlines()[4:]]
    assert [row[0] for row in rows] == worst
    assert [row[4] for row in rows] == ["", "2 of 2", "1 of 1", "1 of 1", "1 of 2 (1 n/a)"]


HOSTILE = [
    "[free coffee](https://example.com) ![pixel](https://example.com/a.png)",
    "https://example.com and www.example.com, WWW.example.com",
    "`code` *emphasis* ~~gone~~ \\",
    "\\[a](b) \\| c",
    "<script>&| a@example.com",
]


def test_a_text_is_no_markdown():
    page = markdown(pd.DataFrame({"reason": HOSTILE}), "T")
    html = MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(page)
    cells = [cell.replace("<!-- -->", "") for cell in re.findall("<td>(.*)</td>", html)]
    assert list(map(unescape, cells)) == HOSTILE
    assert "<" not in "".join(cells)
    # Other readers take these for an address without any mark.
    assert not re.search(r"://|www\.|@[a-z]", page, re.IGNORECASE)
