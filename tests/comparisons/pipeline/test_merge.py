"""Shards of a sweep and their merging: the tables of the whole sweep, and what is refused."""

import itertools
import json
import sys
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.pipeline.inputs import cases_of_problem
from comparisons.registry import create
from comparisons.runs import computation
from comparisons.runs.cases import load_grids
from comparisons.runs.record import read_record
from comparisons.runs.shards import Shard
from comparisons.runs.tasks import plan

PAD = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "graded_pad.toml"
GRID = """
[[grid]]
id = "mine"
title = "Mine"
reference = "exact"
models = ["ten-percent", "refuses", "fails"]
quantities = ["pull_off_force", "jump_in_gap"]
n = [1, 2]
k = [0, 0.4]
mu = [0.1, 1]
"""
TABLES = ("results.csv", "kappa.csv", "largest_kappa.csv", "curves.csv", "grid.toml")


@pytest.fixture
def sweep(toys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(GRID)

    def command(folder, *options):
        return main(["sweep", "mine.toml", "--jobs", "1", "--out", folder, "--quiet", *options])

    return command


def tables(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


@pytest.mark.parametrize("total", [1, 2, 3, 50])
def test_every_task_is_in_one_shard(toys, total):
    tasks = plan(load_grids(GRID, tier="quick"))
    shards = [Shard(number, total).of(tasks) for number in range(1, total + 1)]
    assert sorted(tasks, key=str) == sorted(itertools.chain(*shards), key=str)
    assert max(map(len, shards)) - min(map(len, shards)) <= 2
    # The quantities of one model in one case stay together.
    assert sum(len({(task.model, task.problem) for task in shard}) for shard in shards) == 4 * 8
    for model in {task.model for task in tasks}:
        counts = [len({task.problem for task in shard if task.model == model}) for shard in shards]
        assert max(counts) - min(counts) <= 1
    # In every process the same, whatever the order of hashes.
    assert [Shard(number, total).of(list(tasks)) for number in range(1, total + 1)] == shards


def test_the_shards_of_a_problem_sweep_cut_no_path_and_share_the_expensive_model():
    models = ("bradley", "fscm", "fem", "jkr")
    quantities = ("pull_off_force", "jump_in_gap", "jump_out_gap")
    tasks = plan(cases_of_problem(PAD, ["punch.R=1:5:5 um"], models, quantities).grids)
    shards = [Shard(number, 2).of(tasks) for number in (1, 2)]
    assert sorted(task.key for shard in shards for task in shard) == sorted(task.key for task in tasks)
    for shard in shards:
        for model in models:
            digests = [task.digest for task in shard if task.model == model]
            assert len(set(digests)) in (2, 3)
            assert len(digests) == 3 * len(set(digests))
    # The fifth problem of the second most expensive model is where the fifth of the most expensive is not.
    (fem, fscm) = (
        {len([task for task in shard if task.model == model]): number for number, shard in enumerate(shards)}
        for model in ("fem", "fscm")
    )
    assert fem[9] != fscm[9]


def test_merged_shards_are_the_whole_sweep(sweep, tmp_path, capsys):
    assert sweep("whole") == 4
    assert "fails: pull_off_force" in capsys.readouterr().err
    for number in (1, 2, 3):
        sweep(f"part{number}", "--shard", f"{number}/3")
    assert read_record(tmp_path / "part2" / "run.json")["arguments"]["shard"] == "2/3"
    assert main(["merge", "part3", "part1", "part2", "--out", "merged"]) == 4
    assert tables(tmp_path / "merged") == tables(tmp_path / "whole")
    record = read_record(tmp_path / "merged" / "run.json")
    assert record["arguments"]["merged"] == ["part3", "part1", "part2"]
    assert record["arguments"]["grid"] == "mine.toml"
    assert sum(part["computations"] for part in record["parts"]) == record["rows"]["all"] == 64
    assert main(["report", "merged"]) == 0
    # It is a folder like any other: merged again it stays the same, and a sweep finds nothing to compute.
    assert main(["merge", "part1", "part2", "part3", "--out", "merged", "--quiet"]) == 4
    capsys.readouterr()
    assert main(["sweep", "merged/grid.toml", "--jobs", "1", "--out", "merged"]) == 4
    assert "0 computations" in capsys.readouterr().err
    assert tables(tmp_path / "merged") == tables(tmp_path / "whole")


def test_every_part_keeps_its_machine(sweep, tmp_path, monkeypatch):
    here, code = computation._of_this_process()
    for number, host in ((1, "first"), (2, "second")):
        there = here | {"host": host}
        monkeypatch.setattr(computation, "_of_this_process", lambda there=there: (there, code))
        sweep(host, "--shard", f"{number}/2")
    main(["merge", "second", "first", "--out", "merged", "--quiet"])
    parts = read_record(tmp_path / "merged" / "run.json")["parts"]
    assert {part["host"]: part["computations"] for part in parts} == {"first": 32, "second": 32}


def test_what_no_shard_has_is_computed_by_one_command(sweep, tmp_path, capsys):
    sweep("whole")
    sweep("part1", "--shard", "1/2")
    capsys.readouterr()
    assert main(["merge", "part1", "--out", "merged"]) == 4
    assert "32 of 64 computations are in none of the folders" in capsys.readouterr().err
    sweep("merged")
    record = read_record(tmp_path / "merged" / "run.json")
    assert (record["rows"]["all"], record["rows"]["resumed"]) == (64, 32)
    assert tables(tmp_path / "merged") == tables(tmp_path / "whole")


def test_a_failure_gives_way_to_a_value(sweep, tmp_path, monkeypatch):
    sweep("whole", "--model", "ten-percent")
    sweep("good", "--model", "ten-percent")
    with monkeypatch.context() as patch:
        patch.setattr(type(sys.modules["toy_models"].exact()), "evaluate", failing)
        sweep("bad", "--model", "ten-percent")
    for order in (["bad", "good"], ["good", "bad"]):
        merged = "-".join(order)
        assert main(["merge", *order, "--out", merged, "--quiet"]) == 0
        assert tables(tmp_path / merged) == tables(tmp_path / "whole")


def failing(model, problem, quantity):
    raise ArithmeticError("on purpose")


def test_different_results_of_one_task_are_refused(sweep, monkeypatch, capsys):
    sweep("one", "--model", "ten-percent")
    with monkeypatch.context() as patch:
        toy = type(create("ten-percent"))
        patch.setattr(toy, "_value", lambda model, problem: 3.0)
        sweep("two", "--model", "ten-percent")
    capsys.readouterr()
    assert main(["merge", "one", "two", "--out", "merged"]) == 2
    assert "two has another result than a folder before it for" in capsys.readouterr().err


NOT_MERGED = [
    (["part", "none"], "none is not the folder of a finished run"),
    (["part", "other"], "other and part are not shards of one sweep: they differ in their cases"),
    (["part", "jkr"], "jkr and part are not shards of one sweep: they differ in their models"),
    (["part", "part", "--out", "part"], "part is one of the folders that are merged"),
    (["part", "--out", "mine"], "mine has other cases than part; choose another folder with --out"),
]


def test_what_is_not_merged(sweep, tmp_path, capsys):
    sweep("part", "--shard", "1/2")
    sweep("jkr", "--model", "jkr", "--shard", "1/2")
    (tmp_path / "mine.toml").write_text(GRID.replace("0.1, 1", "0.1"))
    sweep("other")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "grid.toml").write_text("# mine")
    capsys.readouterr()
    for arguments, sentence in NOT_MERGED:
        out = [] if "--out" in arguments else ["--out", "merged"]
        assert main(["merge", *arguments, *out]) == 2
        message = capsys.readouterr().err
        assert sentence in message
        assert message.count("\n") == 1
        assert (tmp_path / "mine" / "grid.toml").read_text() == "# mine"


def test_only_sweeps_are_merged(small_grid, tmp_path, capsys):
    main(["run", "--jobs", "1", "--out", str(tmp_path / "run")])
    capsys.readouterr()
    assert main(["merge", str(tmp_path / "run"), "--out", str(tmp_path / "merged")]) == 2
    assert "only sweeps are merged" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("shard", "sentence"),
    [
        ("4/3", "shard 4/3 is not one of 1/3, ..., 3/3"),
        ("0/3", "shard 0/3 is not one of 1/3"),
        ("2", "shard '2' must be two numbers i/N, such as 2/3 for the second of three"),
        ("1/0", "must be two numbers i/N"),
    ],
)
def test_a_wrong_shard_is_refused(sweep, capsys, shard, sentence):
    assert sweep("out", "--shard", shard) == 2
    assert sentence in capsys.readouterr().err


def test_a_shard_needs_its_own_folder(sweep, capsys):
    assert main(["sweep", "mine.toml", "--shard", "1/2"]) == 2
    assert "--shard 1/2 needs --out DIR" in capsys.readouterr().err


def test_a_journal_that_is_gone_is_missed(sweep, tmp_path, capsys):
    sweep("part")
    (tmp_path / "part" / "store.sqlite").unlink()
    assert main(["merge", "part", "--out", "merged"]) == 2
    assert "only folders with their store are merged" in capsys.readouterr().err
    assert json.loads((tmp_path / "part" / "run.json").read_text())["command_name"] == "sweep"
