"""Committed benchmark: renewed from a whole run without failures."""

import json
from pathlib import Path

import pandas as pd
import pytest

from comparisons import baseline
from comparisons.bench.baseline import BENCH_BASELINE, renew
from comparisons.bench.run import PARTS, run_bench


def test_the_baseline_has_the_files_of_the_last_run_only(tiny, tmp_path):
    run_bench(tmp_path / "run")
    target = tmp_path / "baseline"
    target.mkdir()
    (target / "stale.csv").write_text("")
    written = renew(tmp_path / "run", target)
    assert {path.name for path in written} == {path.name for path in target.iterdir()}
    assert {path.name for path in written} == {"bench.json", "bench.txt", "tiny.csv", "tiny.png"}
    assert (target / "tiny.csv").read_bytes() == (tmp_path / "run" / "tiny.csv").read_bytes()


def test_the_command_renews_it(tiny, tmp_path, monkeypatch, capsys):
    run_bench(tmp_path / "run")
    monkeypatch.chdir(tmp_path)
    assert baseline.main(["run"]) == 0
    assert "renewed 4 files of results/baseline/bench" in capsys.readouterr().out
    assert baseline.main(["--check", "run"]) == 2


@pytest.mark.parametrize("lost", ["tiny.csv", "tiny.png"])
def test_a_run_that_lacks_a_part_changes_nothing(tiny, tmp_path, lost):
    run_bench(tmp_path / "run")
    (tmp_path / "run" / lost).unlink()
    with pytest.raises(ValueError, match=f"lacks {lost}"):
        renew(tmp_path / "run", tmp_path / "baseline")
    assert not (tmp_path / "baseline").exists()


def test_a_run_with_a_failure_changes_nothing(tiny, tmp_path):
    tiny(plan=lambda full: [{"size": -1}, {"size": 1}])
    run_bench(tmp_path / "run")
    with pytest.raises(ValueError, match="1 failed"):
        renew(tmp_path / "run", tmp_path / "baseline")


COMMITTED = Path(__file__).parents[3] / BENCH_BASELINE


@pytest.mark.parametrize("name", list(PARTS))
def test_the_committed_benchmark_has_every_measurement_of_every_part(name):
    record = json.loads((COMMITTED / "bench.json").read_text())
    assert record["machine"]["cpu"]
    assert record["failures"] == 0
    table = pd.read_csv(PARTS[name].files(COMMITTED)[0])
    assert set(table["status"]) == {"ok"}
    part = PARTS[name]
    # The package adhesion need not be installed where this test runs.
    assert len(table) >= len([row for row in part.plan(False) if row.get("model") != "adhesion"])
