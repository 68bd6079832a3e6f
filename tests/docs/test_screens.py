"""Screens of the commands in docs/screens: nothing is shortened, and a terminal shows the same today."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.judging.gates import gates_text, load_gates
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS
from comparisons.runs.cases import grids

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "screens"
sys.path.insert(0, str(FOLDER))
from make_screens import COLUMNS, SCREENS, captured  # noqa: E402

sys.path.remove(str(FOLDER))

#: Lines of the whole output of a run at 80 columns or more.
MOST_LINES = 40


def lines(name, columns):
    """The lines of a screen without the command."""
    return (FOLDER / f"{name}_{columns}.txt").read_text(encoding="utf-8").splitlines()[1:]


@pytest.mark.parametrize("columns", COLUMNS)
@pytest.mark.parametrize("name", SCREENS)
def test_a_screen_fits_its_columns_and_shortens_nothing(name, columns):
    shown = lines(name, columns)
    assert shown
    assert max(map(len, shown)) <= columns
    assert not re.search(r"…|\w\.\.\.(\s|$)", "\n".join(shown))
    assert "Traceback" not in "\n".join(shown)


def test_there_are_no_other_screens():
    names = {f"{name}_{columns}.txt" for name in SCREENS for columns in COLUMNS}
    assert {path.name for path in FOLDER.glob("*.txt")} == names


@pytest.mark.parametrize("columns", COLUMNS)
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("list_models", list(MODELS)),
        ("list_quantities", list(ALL_QUANTITIES)),
        ("list_cases", [grid.id for grid in grids("full")]),
        ("list_gates", [gate.id for gate in load_gates(gates_text())]),
    ],
)
def test_every_name_is_whole(name, words, columns):
    found = set(re.split(r"[\s,]+", " ".join(lines(name, columns))))
    assert [word for word in words if word not in found] == []


@pytest.mark.parametrize("columns", [80, 120])
@pytest.mark.parametrize("name", ["run", "judge"])
def test_a_run_has_at_most_40_lines(name, columns):
    shown = lines(name, columns)
    assert len(shown) <= MOST_LINES
    text = " ".join(shown)
    assert re.search(r"\d+ of \d+ gates pass, \d+ (fail|differ from the paper) as declared, \d+ unexpected", text)
    assert shown[-1].startswith("next: fscm-bench report ")


@pytest.mark.skipif(shutil.which("tmux") is None, reason="tmux is not installed")
@pytest.mark.parametrize(
    "columns", [COLUMNS[0], *(pytest.param(columns, marks=pytest.mark.heavy) for columns in COLUMNS[1:])]
)
def test_a_terminal_shows_the_stored_screen(tmp_path, columns):
    shown = captured(SCREENS["list_quantities"], columns, tmp_path)
    assert shown.splitlines() == lines("list_quantities", columns)


def test_an_unknown_screen_is_refused():
    done = subprocess.run(
        [sys.executable, str(FOLDER / "make_screens.py"), "nothing"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "no screen is called nothing" in done.stderr
