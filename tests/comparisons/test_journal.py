"""The journal gives back what was added, forgets what was torn, and refuses what is none or of other code."""

import os
import subprocess
import sys

import pytest

from comparisons.journal import Journal, alone_in


def journal(path, fingerprint="x"):
    return Journal(path, fingerprint, lambda line: line["entry"], lambda entry: {"entry": entry})


@pytest.fixture
def path(tmp_path):
    return tmp_path / "journal.jsonl"


def test_it_gives_back_what_was_added(path):
    first = journal(path)
    for entry in (1.0 / 3.0, "line\nbreak", None, {"list": [1, 2]}):
        first.add(entry)
    assert journal(path).entries == first.entries


@pytest.mark.parametrize("cut", range(1, 30, 7))
def test_a_line_cut_by_a_crash_is_forgotten_and_the_rest_kept(path, cut):
    first = journal(path)
    first.add("the first")
    first.add("the second, which is longer than that")
    os.truncate(path, path.stat().st_size - cut)
    again = journal(path)
    assert again.entries == ["the first"]
    again.add("the third")
    assert journal(path).entries == ["the first", "the third"]


@pytest.mark.parametrize("text", ["", '{"finger', '{"fingerprint": "of other code"}'])
def test_one_cut_in_its_first_line_starts_again(path, text):
    path.write_text(text)
    assert journal(path).entries == []
    journal(path).add(1)
    assert journal(path).entries == [1]


def test_entries_of_other_code_are_not_mixed_in(path):
    journal(path).add(1)
    with pytest.raises(ValueError, match="another version of the code"):
        journal(path, "y")


@pytest.mark.parametrize(
    "text", ["\n", "hello\n", "[1, 2]\n", "{}\n", '{"fingerprint": "x"}\n{"other": 1}\n', '{"fingerprint": "x"}\n[1]\n']
)
def test_another_file_is_not_taken_for_a_journal(path, text):
    path.write_text(text)
    with pytest.raises(ValueError, match="not a journal"):
        journal(path)
    assert path.read_text() == text


def test_a_nan_is_refused_and_not_kept(path):
    first = journal(path)
    with pytest.raises(ValueError, match="JSON"):
        first.add(float("nan"))
    assert first.entries == journal(path).entries == []


OTHER = """
import sys
from pathlib import Path
from comparisons.journal import alone_in
with alone_in(Path(sys.argv[1])):
    print("alone", flush=True)
    sys.stdin.read()
"""


def test_two_processes_do_not_compute_into_one_folder(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", OTHER, tmp_path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout.readline() == "alone\n"
        with pytest.raises(ValueError, match="another process"), alone_in(tmp_path):
            pass
        other.kill()
    # What a process that was killed held is free.
    with alone_in(tmp_path):
        pass
