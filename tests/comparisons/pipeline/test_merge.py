"""Shards of a sweep and their merging: the tables of the whole sweep, and what is refused."""

import itertools
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.pipeline.inputs import cases_of_problem
from comparisons.pipeline.run import run
from comparisons.registry import create
from comparisons.runs.cases import load_grids
from comparisons.runs.computation import tasks_of_shard
from comparisons.runs.environment import computing_environment
from comparisons.runs.record import read_record
from comparisons.runs.tasks import plan
from tests.comparisons.conftest import GATES
from tests.comparisons.grid_text import grid_text
from tests.paths import PAD

MODELS, QUANTITIES = ["ten-percent", "refuses", "fails"], ["pull_off_force", "jump_in_gap"]
GRID = grid_text(MODELS, "exact", QUANTITIES, n=[1, 2], k=[0, 0.4], mu=[0.1, 1])


@pytest.fixture
def sweep(toys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(GRID)

    def command(folder, *options):
        return main(["sweep", "mine.toml", "--jobs", "1", "--out", folder, "--quiet", *options])

    return command


def tables(folder):
    names = ("results.csv", "kappa.csv", "largest_kappa.csv", "curves.csv", "grid.toml")
    return {name: Path(folder, name).read_bytes() for name in names}


@pytest.mark.parametrize("total", [1, 2, 3, 50])
def test_every_task_is_in_one_shard_and_the_expensive_models_are_shared(toys, total):
    models = ("bradley", "fscm", "fem", "jkr")
    tasks = [
        *plan(load_grids(GRID.replace("exact", "jkr"), tiers=None), list(models)),
        *plan(cases_of_problem(PAD, ["punch.R=1:5:5 um"], models, QUANTITIES).grids),
    ]
    shards = [tasks_of_shard(f"{number}/{total}", tasks) for number in range(1, total + 1)]
    assert sorted(tasks, key=str) == sorted(itertools.chain(*shards), key=str)
    # The quantities of one model for one problem stay together.
    problems = [{task.problem_key for task in shard} for shard in shards]
    assert sum(map(len, problems)) == len({task.problem_key for task in tasks}) == 4 * (8 + 5)
    # The fifth problem of the second most expensive model is where the fifth of the most expensive is not.
    for group in (*({model} for model in models), {"fem", "fscm"}):
        counts = [len([key for key in keys if key[0] in group]) for keys in problems]
        assert max(counts) - min(counts) <= 1


def test_merged_shards_are_the_whole_sweep(sweep, tmp_path, monkeypatch, capsys):
    assert sweep("whole") == 4
    assert "fails: pull_off_force" in capsys.readouterr().err
    environment = computing_environment()
    for number in (1, 2, 3):
        machine = environment | {"host": f"host{number}"}
        monkeypatch.setattr("comparisons.runs.store.computing_environment", lambda machine=machine: machine)
        sweep(f"part{number}", "--shard", f"{number}/3")
    assert read_record(tmp_path / "part2" / "run.json")["arguments"]["shard"] == "2/3"
    assert main(["merge", "part3", "part1", "part2", "--out", "merged"]) == 4
    assert tables("merged") == tables("whole")
    record = read_record(tmp_path / "merged" / "run.json")
    assert record["arguments"]["merged"] == ["part3", "part1", "part2"]
    assert record["arguments"]["grid"] == "mine.toml"
    parts = {part["host"]: part["computations"] for part in record["parts"]}
    assert parts == {"host1": 22, "host2": 22, "host3": 20}
    assert record["rows"]["all"] == 64
    assert main(["report", "merged"]) == 0
    # It is a folder like any other: merged again it stays the same, and a sweep finds nothing to compute.
    assert main(["merge", "part1", "part2", "part3", "--out", "merged", "--quiet"]) == 4
    capsys.readouterr()
    assert main(["sweep", "merged/grid.toml", "--jobs", "1", "--out", "merged"]) == 4
    # But for the failures.
    assert "16 computations" in capsys.readouterr().err
    assert tables("merged") == tables("whole")


def test_what_no_shard_has_is_computed_by_one_command(sweep, tmp_path, capsys):
    sweep("whole")
    sweep("part1", "--shard", "1/2")
    capsys.readouterr()
    assert main(["merge", "part1", "--out", "merged"]) == 4
    assert "32 of 64 computations" in capsys.readouterr().err
    sweep("merged")
    rows = read_record(tmp_path / "merged" / "run.json")["rows"]
    assert (rows["all"], rows["resumed"]) == (64, 24)
    assert tables("merged") == tables("whole")


def test_a_failure_gives_way_to_a_value_and_different_results_are_refused(sweep, monkeypatch, refused):
    sweep("good", "--model", "ten-percent")
    for folder, model, value in (("bad", "exact", lambda *_: 1 / 0), ("other", "ten-percent", lambda *_: 3.0)):
        with monkeypatch.context() as patch:
            patch.setattr(type(create(model)), "_value", value)
            sweep(folder, "--model", "ten-percent")
    for number, order in enumerate((["bad", "good"], ["good", "bad"])):
        assert main(["merge", *order, "--out", f"merged{number}", "--quiet"]) == 0
        assert tables(f"merged{number}") == tables("good")
    refused(["merge", "good", "other", "--out", "merged"], "other has another result")


NOT_MERGED = [
    (["part", "none"], "none is not the folder of a finished run"),
    (["part", "other"], "they differ in their cases"),
    (["part", "jkr"], "they differ in their models"),
    (["part", "part", "--out", "part"], "part is one of the folders"),
    (["part", "--out", "mine"], "mine/grid.toml was not written by a run"),
    (["empty"], "store.sqlite does not exist"),
    (["judged"], "only sweeps are merged"),
]


def test_what_is_not_merged(sweep, tmp_path, refused):
    sweep("part", "--shard", "1/2")
    sweep("jkr", "--model", "jkr", "--shard", "1/2")
    sweep("empty")
    run(GRID, GATES, folder=tmp_path / "judged")
    (tmp_path / "empty" / "store.sqlite").unlink()
    (tmp_path / "mine.toml").write_text(GRID.replace("0.1, 1", "0.1"))
    sweep("other")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "grid.toml").write_text("# mine")
    for arguments, named in NOT_MERGED:
        refused(["merge", *arguments, *([] if "--out" in arguments else ["--out", "merged"])], named)
    assert (tmp_path / "mine" / "grid.toml").read_text() == "# mine"
