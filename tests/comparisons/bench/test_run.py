"""A run of the benchmark: files, record, resumption, failures, refusals; renewal of the committed one."""

import dataclasses
import json
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from comparisons import baseline
from comparisons.bench import run
from comparisons.bench.part import Part
from comparisons.bench.run import BENCH_BASELINE, renew, run_bench
from comparisons.cli.main import main
from comparisons.paper.cache import make_calls

#: Sizes that were measured.
SIZES = []


def counted(size):
    SIZES.append(size)
    if size < 0:
        raise ArithmeticError("a negative size")
    return {"cpu_seconds": 0.5 * size}


def drawn(table):
    figure = Figure()
    figure.subplots().plot(table["size"], table["cpu_seconds"])
    return figure


def made_here(calls, folder, *, apart):
    assert apart
    return make_calls(calls, folder)


TINY = Part(
    "tiny",
    "a part for tests",
    lambda full: [{"size": size} for size in ((1, 2, 8) if full else (1, 2))],
    counted,
    lambda rows: rows.assign(ratio=rows["cpu_seconds"]),
    lambda rows: rows[["size"]],
    drawn,
)


@pytest.fixture
def tiny(monkeypatch):
    """The only part is the tiny one; returns a function that gives it another plan."""

    def change(**changed):
        monkeypatch.setattr(run, "PARTS", {"tiny": dataclasses.replace(TINY, **changed)})

    monkeypatch.setattr(run, "make_calls", made_here)
    SIZES.clear()
    change()
    return change


def sizes_in(folder):
    return pd.read_csv(folder / "tiny.csv")["size"].tolist()


def test_a_run_writes_table_figure_and_record_and_a_later_one_measures_what_is_missing(tiny, tmp_path):
    finished = run_bench(tmp_path)
    assert (tmp_path / "tiny.csv").read_text() == "size,cpu_seconds,status,reason,ratio\n1,0.5,ok,,0.5\n2,1,ok,,1\n"
    assert (tmp_path / "tiny.png").read_bytes().startswith(b"\x89PNG")
    record = json.loads((tmp_path / "bench.json").read_text())
    assert record["machine"].keys() >= {"system", "cpu", "cores"}
    assert [part["computations"] for part in record["parts"]] == [2]
    assert {"host", "cpu", "numpy", "started"} <= record["parts"][0].keys()
    assert (tmp_path / "bench.txt").read_text().splitlines() == finished.summary
    assert (finished.summary[1:], finished.failures) == (["a part for tests:", " size", "    1", "    2"], [])
    run_bench(tmp_path, full=True)
    assert SIZES == sizes_in(tmp_path) == [1, 2, 8]
    run_bench(tmp_path)
    assert (SIZES, sizes_in(tmp_path)) == ([1, 2, 8], [1, 2])


def test_the_command_prints_ratios_and_a_failure_is_retried_and_is_no_baseline(tiny, tmp_path, capsys):
    assert main(["bench", "--out", str(tmp_path / "a")]) == 0
    assert capsys.readouterr().out.splitlines()[2:] == [" size", "    1", "    2"]
    tiny(plan=lambda full: [{"size": -1}])
    for _ in range(2):
        assert main(["bench", "--out", str(tmp_path / "b"), "--quiet"]) == 4
        assert capsys.readouterr() == ("", "counted(-1): ArithmeticError: a negative size\n")
    assert SIZES == [1, 2, -1, -1]
    # A part without a value has a table and no figure.
    assert pd.read_csv(tmp_path / "b" / "tiny.csv")["status"].tolist() == ["failed"]
    assert not (tmp_path / "b" / "tiny.png").exists()
    with pytest.raises(ValueError, match="1 failed"):
        renew(tmp_path / "b", tmp_path / "baseline")


def test_only_a_whole_run_renews_the_baseline(tiny, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_bench(Path("run"))
    BENCH_BASELINE.mkdir(parents=True)
    (BENCH_BASELINE / "stale.csv").write_text("")
    assert baseline.main(["run"]) == 0
    assert {path.name for path in BENCH_BASELINE.iterdir()} == {"bench.json", "bench.txt", "tiny.csv", "tiny.png"}
    assert (BENCH_BASELINE / "tiny.csv").read_bytes() == Path("run", "tiny.csv").read_bytes()
    assert baseline.main(["--check", "run"]) == 2
    Path("run", "tiny.png").unlink()
    with pytest.raises(ValueError, match="lacks tiny:"):
        renew(Path("run"))
    assert len(list(BENCH_BASELINE.iterdir())) == 4
