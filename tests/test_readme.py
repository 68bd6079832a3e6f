"""README: its length, its two commands, and the numbers that it prints."""

import re
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
LARGEST = pd.read_csv(ROOT / "results" / "baseline" / "largest_kappa.csv")
_ERRORS = re.findall(r"^([a-z-]+)((?: +-?\d+\.\d+\(5\)){4})\n((?: +[\d.]+, [\d.]+){4})$", TEXT, flags=re.MULTILINE)
PRINTED = [
    (model, n, float(kappa[:-3]), *map(float, case.split(", ")))
    for model, kappas, places in _ERRORS
    for n, kappa, case in zip((1.0, 1.5, 2.0, 5.0), kappas.split(), re.findall(r"[\d.]+, [\d.]+", places), strict=True)
]


def test_it_is_one_screen_and_a_half():
    assert len(TEXT.splitlines()) <= 95


@pytest.mark.parametrize("command", ["fscm-bench run", "-m pytest"])
def test_each_command_is_one_line(command):
    """The script that tests a change takes the lines from here."""
    (line,) = [line for line in TEXT.splitlines() if line.startswith("python3 -m venv ") and command in line]
    assert line.endswith(command) or line.endswith(f"{command} -n 2")


def test_the_printed_errors_are_those_of_the_baseline():
    assert {row[0] for row in PRINTED} >= {"jkr", "md-improved"}
    for model, n, percent, k, mu in PRINTED:
        of_shape = LARGEST[(LARGEST["model"] == model) & (LARGEST["n"] == n)]
        worst = of_shape.loc[of_shape["kappa"].abs().idxmax()]
        assert percent == pytest.approx(100 * worst["kappa"], abs=5e-3)
        assert k == worst["k"]
        assert mu == pytest.approx(worst["mu"], rel=1e-3)
