"""Folders of runs that come from elsewhere: no file outside of --out is written, none outside of the folder is read."""

import json
import os
import shlex
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.runs.record import _own_sum
from comparisons.runs.store import rows_in

PAD = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "graded_pad.toml"


@pytest.fixture
def shard(tmp_path):
    """The folder of a sweep over a problem file, in a folder with another file."""
    folder = tmp_path / "theirs" / "shard"
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "evil.sh").write_text("rm -r everything\n")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "precious.txt").write_text("precious")
    (tmp_path / "mine" / "precious.txt").chmod(0o600)
    options = ("--vary", "punch.R=1, 2 um", "--model", "jkr", "--jobs", "1", "--quiet")
    assert main(["sweep", "--problem", str(PAD), *options, "--out", str(folder)]) == 0
    return folder


def forge(folder, change):
    """Change the record of a folder as somebody does who knows its checksum."""
    record = json.loads((folder / "run.json").read_text())
    del record["sha256"]
    change(record)
    record["sha256"] = _own_sum(record)
    (folder / "run.json").write_text(json.dumps(record))


def contents(folder):
    """Content and mode of every file below a folder."""
    return {path: (path.read_bytes(), path.stat().st_mode) for path in folder.rglob("*") if path.is_file()}


def refused(folder, capsys):
    """Merge and report refuse the folder, and change nothing beside it."""
    mine = folder.parents[1] / "mine"
    before, theirs = contents(mine), contents(folder.parent)
    for command in (["merge", str(folder), "--out", str(mine / "out")], ["report", str(folder)]):
        assert main(command) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert "Traceback" not in error
    assert {path: content for path, content in contents(mine).items() if mine / "out" not in path.parents} == before
    assert set(contents(folder.parent)) == set(theirs)
    return error


NAMES = ["../evil.sh", "{folder}/mine/precious.txt", "inputs/../../evil.sh", "..", "store.sqlite", ""]


@pytest.mark.parametrize("name", NAMES)
def test_a_problem_file_of_the_grids(name, shard, tmp_path, capsys):
    """The copy of the grids comes from elsewhere, as the record does, and names a file."""
    grid = shard / "grid.toml"
    grid.write_text(grid.read_text().replace(PAD.name, name.format(folder=tmp_path)))
    forge(shard, lambda record: record["files"].update({"grid.toml": sha256(grid.read_bytes()).hexdigest()}))
    assert main(["merge", str(shard), "--out", str(tmp_path / "mine" / "out")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "mine" / "out" / "inputs").exists()
    assert (tmp_path / "mine" / "precious.txt").read_text() == "precious"


@pytest.mark.parametrize("name", ["../evil.sh", "{folder}/mine/precious.txt", "inputs/../../evil.sh"])
def test_a_file_of_the_record(name, shard, tmp_path, capsys):
    forge(shard, lambda record: record["files"].update({name.format(folder=tmp_path): "0" * 64}))
    refused(shard, capsys)


def test_a_copy_that_is_a_link_out_of_the_folder(shard, tmp_path, capsys):
    copy = shard / "inputs" / PAD.name
    copy.rename(tmp_path / "mine" / "precious.toml")
    copy.symlink_to(tmp_path / "mine" / "precious.toml")
    refused(shard, capsys)


def test_copies_are_not_written_through_a_link(shard, tmp_path, capsys):
    out = tmp_path / "mine" / "out"
    out.mkdir()
    (tmp_path / "mine" / "elsewhere").mkdir()
    (out / "inputs").symlink_to(tmp_path / "mine" / "elsewhere")
    assert main(["merge", str(shard), "--out", str(out)]) == 2
    assert list((tmp_path / "mine" / "elsewhere").iterdir()) == []


@pytest.mark.parametrize("name", ["store.sqlite", "store.sqlite-wal"])
def test_a_file_that_is_written_in_place_is_no_link(name, shard, tmp_path, capsys):
    precious = tmp_path / "mine" / "precious.txt"
    (shard / name).unlink(missing_ok=True)
    (shard / name).symlink_to(precious)
    assert main(["merge", str(shard), "--out", str(tmp_path / "mine" / "out")]) == 2
    assert str(shard / name) in capsys.readouterr().err
    assert precious.read_text() == "precious"


@pytest.mark.parametrize("name", ["run.json", "store.sqlite", "results.parquet"])
def test_a_pipe_in_a_folder_is_not_waited_for(name, shard, tmp_path, capsys):
    (shard / name).unlink()
    (shard / name).symlink_to("/dev/null")
    command = (
        ["report", str(shard)] if name == "results.parquet" else ["merge", str(shard), "--out", str(tmp_path / "o")]
    )
    assert main(command) == 2
    assert name in capsys.readouterr().err


@pytest.mark.parametrize("name", ["my run", "$(touch x)", "it's; x"])
def test_the_commands_in_messages_are_quoted(name, small_grid, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "--jobs", "1", "--out", name]) == 0
    assert main(["judge", name]) == 0
    commands = [line.partition("next: ")[2] for line in capsys.readouterr().err.splitlines() if "next: " in line]
    assert [shlex.split(command) for command in commands] == [["fscm-bench", "report", name]] * 2
    assert os.listdir(tmp_path) == [name]


def test_texts_of_a_record_have_no_control_characters_on_the_terminal(shard, capsys):
    def change(record):
        record["models"]["jkr"]["citation"] = "J. \x1b[2J\x1b]0;title\x07"

    forge(shard, change)
    assert main(["cite", str(shard)]) == 0
    shown = capsys.readouterr().out
    assert "\x1b" not in shown
    assert "\x07" not in shown


GRID = (
    'grid = [{ id = "mine", title = "Mine", reference = "bradley", models = ["jkr"], quantities = ["pull_off_force"], '
    "n = [2], k = [0], mu = [1] }]"
)

#: A model that loads: a merge that runs it succeeds.
EVIL = """
class Model:
    name, version, citation, domain = "evil", "1", "A. Author", "all"

    def evaluate(self, problem, quantity):
        return 1.0
"""


def test_code_that_a_record_names_as_a_model_is_not_run(tmp_path, capsys):
    shard = tmp_path / "shard"
    (tmp_path / "evil.py").write_text(EVIL)
    (tmp_path / "grid.toml").write_text(GRID)
    options = ("--model", "jkr", "--jobs", "1", "--quiet")
    assert main(["sweep", str(tmp_path / "grid.toml"), *options, "--out", str(shard)]) == 0
    spec = f"{tmp_path / 'evil.py'}:Model"
    with rows_in(shard) as store:
        (row,) = (row for row in store.items if row.model == "jkr")
        store.add(replace(row, model=spec))
    forge(shard, lambda record: record["arguments"].update(model=[spec]))
    assert main(["merge", str(shard), "--out", str(tmp_path / "out")]) == 2
    assert "unknown model" in capsys.readouterr().err


def test_a_record_without_the_version_of_a_model(tmp_path, capsys):
    (tmp_path / "grid.toml").write_text(GRID)
    options = ("--model", "jkr", "--jobs", "1", "--quiet")
    assert main(["sweep", str(tmp_path / "grid.toml"), *options, "--out", str(tmp_path / "shard")]) == 0
    forge(tmp_path / "shard", lambda record: record["arguments"].update(external={"mine": "mine.py:Mine"}))
    assert main(["merge", str(tmp_path / "shard"), "--out", str(tmp_path / "out")]) == 2
    assert "mine" in capsys.readouterr().err
