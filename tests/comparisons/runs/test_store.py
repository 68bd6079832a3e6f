"""Store: stored entries, torn lines, and refused files."""

import os
import random
import subprocess
import sys

import pytest

from comparisons.runs.store import Store, alone_in


def journal(path, fingerprint="x"):
    return Store(path, fingerprint, lambda line: line["entry"], lambda entry: {"entry": entry})


@pytest.fixture
def path(tmp_path):
    return tmp_path / "journal.jsonl"


def test_it_gives_back_what_was_added(path):
    first = journal(path)
    for entry in (1.0 / 3.0, "line\nbreak", None, {"list": [1, 2]}):
        first.add(entry)
    assert journal(path).items == first.items


@pytest.mark.parametrize("cut", range(1, 30, 7))
def test_a_line_cut_by_a_crash_is_forgotten_and_the_rest_kept(path, cut):
    first = journal(path)
    first.add("the first")
    first.add("the second, which is longer than that")
    os.truncate(path, path.stat().st_size - cut)
    again = journal(path)
    assert again.items == ["the first"]
    again.add("the third")
    assert journal(path).items == ["the first", "the third"]


@pytest.mark.parametrize("text", ["", '{"finger', '{"fingerprint": "of other code"}'])
def test_one_cut_in_its_first_line_starts_again(path, text):
    path.write_text(text)
    assert journal(path).items == []
    journal(path).add(1)
    assert journal(path).items == [1]


def test_entries_of_other_code_are_not_mixed_in(path):
    journal(path).add(1)
    with pytest.raises(ValueError, match="another version of the code"):
        journal(path, "y")


@pytest.mark.parametrize(
    "text",
    [
        *("\n", "hello\n", "[1, 2]\n", "{}\n", '{"fingerprint": "x"}\n{"other": 1}\n', '{"fingerprint": "x"}\n[1]\n'),
        *("\ud800\n", "[" * 100_000 + "\n"),
    ],
)
def test_another_file_is_not_taken_for_a_journal(path, text):
    content = text.encode(errors="surrogatepass")
    path.write_bytes(content)
    with pytest.raises(ValueError, match="not a journal"):
        journal(path)
    assert path.read_bytes() == content


ENTRIES = [{"value": 1.0 / 3.0, "model": "jkr"}, {"value": -2e-9, "model": "fem"}, {"value": None, "model": "fscm"}]
#: Bits that are flipped, one at a time; chosen by this seed.
FLIPS, SEED = 300, 20261


def test_a_flipped_bit_never_changes_an_entry(path, capsys):
    first = journal(path)
    for entry in ENTRIES:
        first.add(entry)
    whole, chosen, messages = path.read_bytes(), random.Random(SEED), 0
    for _ in range(FLIPS):
        damaged = bytearray(whole)
        damaged[chosen.randrange(len(whole))] ^= 1 << chosen.randrange(8)
        path.write_bytes(damaged)
        entries = journal(path).items
        # In the order of the file; what is missing is computed again.
        assert entries == [entry for entry in ENTRIES if entry in entries]
        assert len(entries) >= len(ENTRIES) - 2
        message = "damaged lines" in capsys.readouterr().err
        # The end of the last line is that of a line that was cut.
        assert message or entries == ENTRIES or damaged[-1] != whole[-1]
        messages += message
        assert journal(path).items == entries
        assert capsys.readouterr().err == ""
    assert messages > 0.9 * FLIPS


def test_damage_to_the_first_line_alone_loses_no_entry(path, capsys):
    journal(path).add("one")
    _, *lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(['{"fingerprint": "y"}\n', *lines]))
    assert journal(path).items == ["one"]
    assert "damaged lines (1)" in capsys.readouterr().err


def test_a_line_of_other_code_is_not_taken(path, tmp_path):
    journal(path).add(1)
    other = tmp_path / "other.jsonl"
    journal(other, "y").add(2)
    path.write_text(path.read_text() + other.read_text().splitlines(keepends=True)[1])
    assert journal(path).items == [1]


def test_what_differs_from_the_code_is_said(path):
    journal(path, "code a, NumPy 2.2").add(1)
    with pytest.raises(ValueError, match=r"\(NumPy 2.2, now NumPy 2.3\); choose another --out"):
        journal(path, "code a, NumPy 2.3")


def test_entries_that_are_dropped_are_gone_from_the_file(path):
    first = journal(path)
    for entry in range(5):
        first.add(entry)
    assert first.drop(lambda entry: entry % 2) == 2
    first.add(5)
    assert first.items == journal(path).items == [0, 2, 4, 5]


def test_a_nan_is_refused_and_not_kept(path):
    first = journal(path)
    with pytest.raises(ValueError, match="JSON"):
        first.add(float("nan"))
    assert first.items == journal(path).items == []


OTHER = """
import sys
from pathlib import Path
from comparisons.runs.store import alone_in
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
