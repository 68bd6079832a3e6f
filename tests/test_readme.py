"""README: its length, its two commands, and the numbers that it prints."""

import re
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
LARGEST = pd.read_csv(ROOT / "results" / "baseline" / "largest_kappa.csv")
PRINTED = re.findall(r"^([a-z-]+) +(\d+\.\d+)\(5\) +([\d.]+) +([\d.]+) +([\d.]+)$", TEXT, flags=re.MULTILINE)


def test_it_is_one_screen_and_a_half():
    assert len(TEXT.splitlines()) <= 95


@pytest.mark.parametrize("part", ["fscm-bench run", "-m pytest"])
def test_each_command_is_one_line(part):
    """The script that tests a change takes the lines from here."""
    (line,) = [line for line in TEXT.splitlines() if line.startswith("python3 -m venv ") and part in line]
    assert line.endswith(part) or line.endswith(f"{part} -n 2")


def test_the_python_has_about_eight_lines():
    (code,) = re.findall(r"^```python\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)
    assert len(code.splitlines()) <= 9


@pytest.mark.parametrize("row", PRINTED, ids=lambda row: row[0])
def test_the_printed_errors_are_those_of_the_baseline(row):
    model, percent, n, k, mu = row
    of_model = LARGEST[LARGEST["model"] == model]
    worst = of_model.loc[of_model["kappa"].abs().idxmax()]
    assert float(percent) == pytest.approx(100 * abs(worst["kappa"]), abs=5e-3)
    assert (float(n), float(k)) == (worst["n"], worst["k"])
    assert float(mu) == pytest.approx(worst["mu"], rel=1e-3)


def test_some_errors_are_printed():
    assert {row[0] for row in PRINTED} >= {"jkr", "md-improved"}
