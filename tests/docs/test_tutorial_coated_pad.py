"""Tutorial of the coated pad: its file, its three commands and what they print."""

import re
import shlex
from contextlib import chdir
from pathlib import Path

import pytest

from comparisons.cli.main import main

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = (DOCS / "tutorial_coated_pad.md").read_text(encoding="utf-8")
(TOML,) = re.findall(r"^```toml\n(.*?)^```", PAGE, flags=re.M | re.S)
PRINTED = re.findall(r"^```text\n(.*?)^```", PAGE, flags=re.M | re.S)
COMMANDS = [shlex.split(line)[1:] for line in re.findall(r"^fscm-bench .*$", PAGE, flags=re.M)]
#: Stated in the text, in nN.
FORCE = 138.242085


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "coated_pad.toml").write_text(TOML)
    with chdir(tmp_path):
        yield tmp_path


def stable(line):
    """A line without what differs between machines: the digits of a bound, and the time."""
    return re.sub(r"\(\d+(e-?\d+)?\)|\([\d.]+ s\)", "", line)


def test_the_file_of_the_page_is_that_of_the_examples():
    assert (DOCS / "examples" / "problems" / "coated_pad.toml").read_text(encoding="utf-8") == TOML
    assert [command[0] for command in COMMANDS] == ["describe", "solve", "curve"]
    assert [f"{FORCE}" in text for text in PRINTED[:2]] == [True, True]


@pytest.mark.heavy
def test_describe_prints_what_the_page_shows_without_the_uncertain_values(folder, capsys):
    assert main([word for word in COMMANDS[0] if word != "--uncertain"]) == 0
    printed, on_page = capsys.readouterr().out.splitlines(), PRINTED[0].splitlines()
    assert [stable(line)[:60] for line in printed] == [stable(line)[:60] for line in on_page[: len(printed)]]
    assert printed[1].startswith(f"  pull-off force {FORCE}")
    assert on_page[len(printed)].startswith("uncertainty of pull_off_force")


@pytest.mark.heavy
def test_the_finite_elements_print_what_the_page_shows(folder, capsys):
    assert main(COMMANDS[1]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert [stable(line) for line in printed] == [stable(line) for line in PRINTED[1].splitlines()]
    assert f"{FORCE}(" in printed[1]
