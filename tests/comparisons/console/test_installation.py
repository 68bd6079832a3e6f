"""Start of the program and its messages: another package of its name, extras that are missing, bars on a terminal."""

import io
import os
import re
import subprocess
import sys

import pandas as pd
import pytest

from comparisons.cli.screen import output, print_text
from comparisons.console.exit_status import EXTRAS, FAILED, WRONG_INPUT, guarded
from comparisons.console.progress import log, note
from comparisons.output.terminal import rich_table
from tests.comparisons.grid_text import grid_text
from tests.paths import ROOT

ENTRY = ROOT / "comparisons" / "start_entry"


def started(*folders):
    """Start the program with some folders before all others."""
    code = f"import sys; sys.path[:0] = {list(map(str, folders))}; from fscm_bench import main; sys.exit(main())"
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    # Not in the clone, and without site-packages: the packages of either would be found.
    return subprocess.run(
        [sys.executable, "-S", "-c", code, "--help"], cwd=folders[0], env=clean, capture_output=True, text=True
    )


@pytest.mark.parametrize("package", ["comparisons", None])
def test_the_program_starts_unless_a_package_of_the_same_name_is_found_first(tmp_path, package):
    if package:
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").touch()
    done = started(tmp_path, ROOT, ENTRY)
    if package is None:
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.startswith("usage: fscm-bench")
    else:
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (WRONG_INPUT, "", 1)
        assert done.stderr.startswith("fscm-bench: Python finds ")
        assert str(tmp_path / package) in done.stderr


@pytest.mark.parametrize(
    ("package", "command"),
    [("comparisons", ["sweep", "grid.toml", "--jobs", "2", "--out", "out"]), ("fscm_bench", ["list", "models"])],
)
def test_no_module_of_the_working_folder_is_imported_by_any_process_of_the_program(tmp_path, package, command):
    """Of the standard library, of a dependency, and of this program; started by ``python -m``, perhaps with workers."""
    for name in ("typing", "random", "signal", "socket", "pickle", "pandas", "mpmath", "fem_reference"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'imported')!r}, 'a').write({name!r})\n1 / 0")
    (tmp_path / "grid.toml").write_text(grid_text(["jkr", "dmt"], n=[2], k=[0, 0.4], mu=[1]))
    done = subprocess.run(
        [sys.executable, "-m", package, *command],
        cwd=tmp_path, env=os.environ | {"PYTHONPATH": f"{ROOT}{os.pathsep}{ENTRY}"}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not (tmp_path / "imported").exists()


def test_without_pyamg_the_finite_elements_say_so_in_one_sentence():
    """And a command that does not need it works."""
    solve = ["solve", "--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1", "--model"]
    for model, status, words in (("fem", FAILED, "the package pyamg"), ("jkr", 0, "")):
        code = (
            "import sys; sys.modules['pyamg'] = None; from comparisons.__main__ import main; "
            f"sys.argv[1:] = {[*solve, model]!r}; sys.exit(main())"
        )
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        assert words in done.stderr
        assert done.stderr.count("\n") == (1 if words else 0)
        assert "internal error" not in done.stderr


class Screen(io.StringIO):
    """A terminal."""

    def isatty(self):
        return True


@pytest.mark.parametrize("stream", [Screen, io.StringIO])
def test_a_terminal_shows_a_long_message_in_lines_of_80_characters_and_a_command_whole(stream, monkeypatch):
    """Anything else gets one line for each message, which a search finds."""
    sentence, order = " ".join(["word"] * 40), "fscm-bench solve --model jkr --quantity pull_off_force " + "--n 2 " * 9

    def refuse():
        raise ValueError(sentence)

    for write in (lambda: log(sentence), lambda: guarded(refuse)):
        monkeypatch.setattr(sys, "stderr", stream())
        write()
        lines = sys.stderr.getvalue().splitlines()
        assert len(lines) == (3 if stream is Screen else 1)
        assert (max(map(len, lines)) <= 80) is (stream is Screen)
        assert " ".join(map(str.strip, lines)).endswith(sentence)
    monkeypatch.setattr(sys, "stderr", stream())
    log(order)
    assert sys.stderr.getvalue().count("\n") == 1


@pytest.mark.parametrize("extra", EXTRAS)
def test_no_module_imports_an_extra(extra):
    """Only a report with plots needs its files; every other command works without."""
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "comparisons").rglob("*.py")]
    assert not any(re.search(rf"(?m)^\s*(import|from) {extra}\b", text) for text in texts)


def print_table(text):
    output().print(rich_table(pd.DataFrame({"reason": [text]}), text))


@pytest.mark.parametrize(
    "write", [log, note, print_table, lambda text: output().print(text), lambda text: print_text([text])]
)
def test_control_characters_do_not_reach_the_terminal(write, capsys):
    write("fails: \x1b[2J\x1b]0;title\x07 \x9b2K \u202e [red]plain[/] \r gone")
    printed = "".join(capsys.readouterr())
    assert "fails" in printed
    assert "[red]plain[/]" in printed
    assert [character for character in printed if not character.isprintable() and character != "\n"] == []
