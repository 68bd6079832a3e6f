"""Store: stored items, damage, refused files, other processes and full disks."""

import random
import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

from comparisons.data.file_names import STORE
from comparisons.runs.store import Form, Store

FORM = Form("entries", lambda entry: entry["id"], dict, dict)
ENTRIES = [{"id": number, "value": value} for number, value in enumerate((1.0 / 3.0, "line\nbreak", None, [1, -2e-9]))]


def opened(folder, code="x"):
    return Store(folder, FORM, code)


def stored(folder):
    with opened(folder) as store:
        return store.items


@pytest.fixture
def folder(tmp_path):
    """A folder whose store has all entries."""
    with opened(tmp_path) as store:
        for entry in ENTRIES:
            store.add(entry)
    return tmp_path


def test_it_gives_back_what_was_added(folder):
    assert stored(folder) == ENTRIES
    assert [path.name for path in folder.iterdir()] == [STORE]


def test_a_new_item_replaces_that_of_its_key_and_dropped_ones_are_gone(folder):
    with opened(folder) as store:
        store.add({"id": 1, "value": 2})
        assert store.drop(lambda entry: entry["id"] > 1) == 2
        assert sum(part["computations"] for part in store.parts()) == 2
        with pytest.raises(ValueError, match="JSON"):
            store.add({"id": 1, "value": float("nan")})
    assert stored(folder) == [ENTRIES[0], {"id": 1, "value": 2}]


def test_items_of_another_form_are_apart(folder):
    with Store(folder, Form("numbers", FORM.key, dict, dict), "x") as numbers:
        numbers.add({"id": 1, "value": "another"})
    assert stored(folder) == ENTRIES


def test_results_of_other_code_are_refused_and_the_difference_is_named(tmp_path):
    with opened(tmp_path, "code a, NumPy 2.2") as store:
        store.add(ENTRIES[0])
    with pytest.raises(ValueError, match=r"\(NumPy 2.2, now NumPy 2.3\)"):
        opened(tmp_path, "code a, NumPy 2.3")


@pytest.mark.parametrize("content", [b"hello\n" * 999, b"[" * 100_000, b"SQLite format 3\0" + bytes(5000), None])
def test_the_file_of_another_program_is_refused_and_stays(tmp_path, content):
    path = tmp_path / STORE
    if content is None:
        with closing(sqlite3.connect(path)) as database:
            database.execute("CREATE TABLE items (a)")
    else:
        path.write_bytes(content)
    with pytest.raises(ValueError, match=STORE):
        opened(tmp_path)
    assert content in (None, path.read_bytes())


#: Bits that are flipped or places at which the file is cut, one at a time; chosen by this seed.
DAMAGES, SEED = 100, 20261


def test_damage_never_changes_an_entry(folder, capsys):
    intact, rng, lost = (folder / STORE).read_bytes(), random.Random(SEED), 0
    for number in range(DAMAGES):
        damaged = bytearray(intact)
        if number % 3:
            damaged[rng.randrange(len(intact))] ^= 1 << rng.randrange(8)
        else:
            del damaged[rng.randrange(len(intact)) :]
        (folder / STORE).write_bytes(damaged)
        try:
            entries = stored(folder)
        except ValueError:  # refused in one sentence
            continue
        assert entries == [entry for entry in ENTRIES if entry in entries]
        if entries != ENTRIES:
            lost += 1
            assert "is damaged" in capsys.readouterr().err or not damaged
        assert stored(folder) == entries
    assert lost > 0


def changed(folder, command):
    with closing(sqlite3.connect(folder / STORE)) as database, database:
        database.execute(command)


def test_a_damaged_store_is_written_again(folder, capsys):
    changed(folder, "UPDATE items SET seconds = seconds + 1 WHERE key = '1'")
    for damaged in (True, False):
        assert len(stored(folder)) == len(ENTRIES) - 1
        assert ("is damaged" in capsys.readouterr().err) == damaged


def test_an_entry_of_another_form_is_not_taken(folder):
    changed(folder, "UPDATE items SET form = 'calls'")
    with Store(folder, Form("calls", lambda entry: entry["id"], dict, dict), "x") as store:
        assert store.items == []


def test_the_code_that_computed_an_entry_cannot_be_changed(folder):
    changed(folder, "UPDATE environments SET content = replace(content, '\"x\"', '\"y\"')")
    assert stored(folder) == []


OTHER = """
import sys
from pathlib import Path
from comparisons.runs.store import Form, Store
store = Store(Path(sys.argv[1]), Form("entries", lambda entry: entry["id"], dict, dict), "x")
store.add({"id": 5})
print("alone", flush=True)
sys.stdin.read()
"""


def test_two_processes_do_not_compute_into_one_folder_and_a_kill_loses_nothing(folder):
    command = [sys.executable, "-c", OTHER, folder]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "alone\n"
        with pytest.raises(ValueError, match="another process"):
            opened(folder)
        process.kill()
    assert stored(folder) == [*ENTRIES, {"id": 5}]


def test_a_full_disk_loses_nothing_that_was_stored(folder):
    with opened(folder) as store:
        store._connection.execute("PRAGMA max_page_count = 1")
        with pytest.raises(OSError, match=rf"{STORE} cannot be written \(database or disk is full\).* safe: 4;"):
            store.add({"id": 9, "value": "x" * 100_000})
        assert store.items == ENTRIES
    assert stored(folder) == ENTRIES
