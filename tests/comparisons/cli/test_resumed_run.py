"""A run that is resumed: stored failures, and the parts of the computations in its record."""

from concurrent.futures.process import BrokenProcessPool

import pytest

from comparisons.runs import computation as computing
from comparisons.runs.computation import compute
from comparisons.runs.frames import read_table
from comparisons.runs.record import read_record

from .test_run import interrupt_after, run


def test_stored_failures_are_used_and_computed_again_on_request(small_grid, tmp_path, monkeypatch, capsys):
    models = ("--model", "ten-percent", "fails")
    assert run(tmp_path, *models) == 4
    assert "stored failures" not in capsys.readouterr().err
    computed = []

    def counted(tasks, jobs, backend):
        computed.extend(task.model for task in tasks)
        return compute(tasks, jobs, backend)

    monkeypatch.setattr(computing, "compute", counted)
    assert run(tmp_path, *models) == 4
    assert computed == []
    assert "4 stored failures of fails are used; --retry-failed" in capsys.readouterr().err
    assert run(tmp_path, *models, "--retry-failed") == 4
    assert computed == ["fails"] * 4
    assert "stored failures" not in capsys.readouterr().err
    table = read_table(tmp_path / "results.parquet")
    assert not table.duplicated(["model", "quantity", "n", "k", "mu"]).any()


def test_the_record_has_every_part_with_its_own_environment(small_grid, tmp_path, monkeypatch, capsys):
    this_machine, code = computing._of_this_process()
    other_machine = this_machine | {"python": "3.99.0", "cpu": "another"}
    with monkeypatch.context() as patch:
        patch.setattr(computing, "compute", interrupt_after(5, BrokenProcessPool))
        patch.setattr(computing, "_of_this_process", lambda: (other_machine, code))
        assert run(tmp_path) == 4
    assert run(tmp_path) == 0
    record = read_record(tmp_path / "run.json")
    interrupted, resumed = sorted(record["parts"], key=lambda segment: segment["computations"])
    assert (interrupted["computations"], resumed["computations"]) == (5, 7)
    assert {name: interrupted[name] for name in other_machine} == other_machine
    assert {name: resumed[name] for name in this_machine} == this_machine
    assert record["rows"]["resumed"] == 5
    assert record["started"] == min(interrupted["started"], resumed["started"])
    assert record["seconds"]["run"] == pytest.approx(interrupted["seconds"] + resumed["seconds"])
    # A command that computes nothing is not a part, and changes none.
    assert run(tmp_path) == 0
    again = read_record(tmp_path / "run.json")
    for name in ("parts", "started"):
        assert again[name] == record[name]
    assert again["seconds"]["run"] == record["seconds"]["run"]
