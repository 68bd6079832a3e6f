"""README: its length, its two commands, and the numbers that it prints."""

import re

import pandas as pd
import pytest

from comparisons.judging.gates import gates_text, load_gates, of_tier
from comparisons.judging.selection import relevant
from comparisons.runs.cases import grids, grids_for
from tests.paths import ROOT

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
LARGEST = pd.read_csv(ROOT / "results" / "baseline" / "largest_kappa.csv")
PRINTED = re.findall(
    r"^pull_off_force +([a-z-]+) +(-?\d+\.\d+) +([\d.]+) +([\d.]+) +([\d.]+)$", TEXT, flags=re.MULTILINE
)


def test_it_is_one_screen_and_a_half():
    assert len(TEXT.splitlines()) <= 95


@pytest.mark.parametrize("command", ["fscm-bench run", "-m pytest"])
def test_each_command_is_one_line(command):
    """The script that tests a change takes the lines from here."""
    (line,) = [line for line in TEXT.splitlines() if line.startswith("python3 -m venv ") and command in line]
    assert line.endswith(command) or line.endswith(f"{command} -n 2")


@pytest.mark.parametrize("path", ["README.md", "docs", ".ci", ".github"])
def test_what_is_installed_has_its_bytecode(path):
    """Where Python may not write bytecode, as in many containers, every process would compile all modules again."""
    files = [file for file in [ROOT / path, *(ROOT / path).rglob("*")] if file.is_file()]
    assert not [file for file in files if b"--no-compile" in file.read_bytes()]


def test_the_printed_errors_are_those_of_the_baseline():
    assert {row[0] for row in PRINTED} >= {"jkr", "md-improved"}
    for model, *numbers in PRINTED:
        percent, n, k, mu = map(float, numbers)
        of_model = LARGEST[LARGEST["model"] == model]
        worst = of_model.loc[of_model["kappa"].abs().idxmax()]
        assert percent == pytest.approx(100 * worst["kappa"], abs=5e-3)
        assert (n, k) == (worst["n"], worst["k"])
        assert mu == pytest.approx(worst["mu"], rel=1e-3)


def test_the_number_of_gates_that_is_stated_is_that_of_a_run():
    standing = grids_for(grids("quick"), None)
    count = len(relevant(of_tier(load_gates(gates_text()), "quick"), standing, None))
    paper = (ROOT / ".github" / "joss" / "paper.md").read_text(encoding="utf-8")
    stated = [re.findall(r"of (\d+) gates pass", TEXT), re.findall(r"(\d+) gates in the quick tier", paper)]
    assert stated == [[str(count)]] * 2
