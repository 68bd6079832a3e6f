"""Folders of runs that come from elsewhere: no file outside of --out is written, none outside of the folder is read."""

import json
import os
import shlex
import shutil
from dataclasses import replace
from hashlib import sha256

import pytest

from comparisons.cli.main import main
from comparisons.pipeline.board import entry_of
from comparisons.runs.record import _own_sum
from comparisons.runs.store import rows_in
from tests.paths import PAD


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """The folder of a sweep over a problem file."""
    folder = tmp_path_factory.mktemp("swept") / "shard"
    options = ("--vary", "punch.R=1, 2 um", "--model", "jkr", "--jobs", "1", "--quiet")
    assert main(["sweep", "--problem", str(PAD), *options, "--out", str(folder)]) == 0
    return folder


@pytest.fixture
def shard(swept, tmp_path):
    """A copy of that folder, in a folder with another file; `mine` has a file of the user."""
    folder = shutil.copytree(swept, tmp_path / "theirs" / "shard")
    (tmp_path / "theirs" / "evil.sh").write_text("rm -r everything\n")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "precious.txt").write_text("precious")
    (tmp_path / "mine" / "precious.txt").chmod(0o600)
    return folder


def forge(folder, change):
    """Change the record of a folder as somebody does who knows its checksum."""
    record = json.loads((folder / "run.json").read_text())
    del record["sha256"]
    change(record)
    record["sha256"] = _own_sum(record)
    (folder / "run.json").write_text(json.dumps(record))


def contents(folder):
    """Content and mode of every file below a folder, without that for results."""
    paths = [path for path in folder.rglob("*") if path.is_file() and "out" not in path.parts]
    return {path: (path.read_bytes(), path.stat().st_mode) for path in paths}


def refused(capsys, shard, *commands):
    """Commands refuse a folder in one sentence, and change nothing beside that for results; return the sentence."""
    out = shard.parents[1] / "mine" / "out"
    before = contents(shard.parents[1])
    for command in commands or ("merge",):
        assert main([command, str(shard), *(["--out", str(out)] if command == "merge" else [])]) == 2
        message = capsys.readouterr().err
        assert message.count("\n") == 1
        assert "Traceback" not in message
    assert contents(shard.parents[1]) == before
    return message


OUTSIDE = ["../evil.sh", "{folder}/mine/precious.txt", "inputs/../../evil.sh"]


@pytest.mark.parametrize("name", [*OUTSIDE, "..", "store.sqlite", ""])
def test_a_problem_file_of_the_grids(name, shard, tmp_path, capsys):
    """The copy of the grids comes from elsewhere, as the record does, and names a file."""
    grid = shard / "grid.toml"
    grid.write_text(grid.read_text().replace(PAD.name, name.format(folder=tmp_path)))
    forge(shard, lambda record: record["files"].update({"grid.toml": sha256(grid.read_bytes()).hexdigest()}))
    refused(capsys, shard)
    assert not (tmp_path / "mine" / "out" / "inputs").exists()


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_file_of_the_record(name, shard, tmp_path, capsys):
    forge(shard, lambda record: record["files"].update({name.format(folder=tmp_path): "0" * 64}))
    refused(capsys, shard, "merge", "report")


def test_a_copy_that_is_a_link_out_of_the_folder(shard, tmp_path, capsys):
    copy = shard / "inputs" / PAD.name
    copy.rename(tmp_path / "mine" / "precious.toml")
    copy.symlink_to(tmp_path / "mine" / "precious.toml")
    refused(capsys, shard, "merge", "report")


def test_copies_are_not_written_through_a_link(shard, tmp_path, capsys):
    (tmp_path / "mine" / "elsewhere").mkdir()
    (tmp_path / "mine" / "out").mkdir()
    (tmp_path / "mine" / "out" / "inputs").symlink_to(tmp_path / "mine" / "elsewhere")
    refused(capsys, shard)


@pytest.mark.parametrize(
    ("command", "name"),
    [("merge", "store.sqlite"), ("merge", "store.sqlite-wal"), ("merge", "run.json"), ("report", "results.csv")],
)
@pytest.mark.parametrize("target", ["{folder}/mine/precious.txt", "/dev/null"])
def test_a_file_of_the_folder_that_is_a_link(command, name, target, shard, tmp_path, capsys):
    """It is not written through, and a device or a pipe is not waited for."""
    (shard / name).unlink(missing_ok=True)
    (shard / name).symlink_to(target.format(folder=tmp_path))
    assert name in refused(capsys, shard, command)


def test_the_commands_in_messages_are_quoted(small_grid, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name = "$(touch x); it's"
    assert main(["run", "--jobs", "1", "--out", name]) == 0
    assert main(["judge", name]) == 0
    commands = [line.partition("next: ")[2] for line in capsys.readouterr().err.splitlines() if "next: " in line]
    assert [shlex.split(command) for command in commands] == [["fscm-bench", "report", name]] * 2
    assert os.listdir(tmp_path) == [name]


def test_texts_of_a_record_have_no_control_characters_on_the_terminal(shard, capsys):
    forge(shard, lambda record: record["models"]["jkr"].update(citation="J. \x1b[2J\x1b]0;title\x07"))
    assert main(["cite", str(shard)]) == 0
    printed = capsys.readouterr().out
    assert "\x1b" not in printed
    assert "\x07" not in printed


#: A model that loads: a merge that runs it succeeds.
EVIL = """
class Model:
    name, version, citation, domain = "evil", "1", "A. Author", "all"

    def evaluate(self, problem, quantity):
        return 1.0
"""


def test_code_that_a_record_names_as_a_model_is_not_run(shard, tmp_path, capsys):
    (tmp_path / "evil.py").write_text(EVIL)
    spec = f"{tmp_path / 'evil.py'}:Model"
    with rows_in(shard) as store:
        for row in store.items:
            store.add(replace(row, model=spec))
    forge(shard, lambda record: record["arguments"].update(model=[spec]))
    assert "unknown model" in refused(capsys, shard)
    with pytest.raises(ValueError, match="unknown model"):
        entry_of(shard)


def test_a_record_without_the_version_of_a_model(shard, capsys):
    forge(shard, lambda record: record["arguments"].update(external={"mine": "mine.py:Mine"}))
    assert "mine" in refused(capsys, shard)
