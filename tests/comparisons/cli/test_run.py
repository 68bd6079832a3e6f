"""A run: complete, repeatable, not lost when it is interrupted, and resumed with what is stored."""

from concurrent.futures.process import BrokenProcessPool

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.data.file_names import VERDICT_FILES
from comparisons.pipeline.run import run as run_cases
from comparisons.runs import computation as computing
from comparisons.runs.cases import load_grids
from comparisons.runs.computation import compute
from comparisons.runs.environment import computing_environment
from comparisons.runs.record import read_record
from tests.comparisons.grid_text import grid_text

TABLES = ("results", "kappa", "largest_kappa", "curves")
FILES = {
    *(".lock", "store.sqlite", "run.json", "gates.toml"),
    *(f"{table}.csv" for table in TABLES),
    *VERDICT_FILES,
    *("verdicts.md", "verdicts.tex"),
}


def run(folder, *more):
    return main(["run", "--jobs", "1", "--out", str(folder), *more])


def read(folder, name="results.csv"):
    return (folder / name).read_bytes()


def test_the_function_and_the_command_leave_the_same_tables_and_record(small_grid, tmp_path, capsys):
    finished = run_cases("quick", folder=tmp_path / "function")
    assert str(finished.verdict) == "PASS"
    assert finished.counts == {"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4}
    assert finished.failures == ()
    capsys.readouterr()
    assert run(tmp_path / "out") == 0
    for folder in ("function", "out"):
        assert {path.name for path in (tmp_path / folder).iterdir()} == FILES
    for name in FILES - {"run.json", "store.sqlite"}:
        assert read(tmp_path / "function", name) == read(tmp_path / "out", name), name
    captured = capsys.readouterr()
    plain = "12 results: 8 with a value, 4 not-applicable (a case or a quantity that the model does not have)"
    words = " ".join(captured.out.split())
    assert [word for word in ("ten-percent", "10.000", plain) if word not in words] == []
    assert "results are in" in captured.err
    kappa = pd.read_csv(tmp_path / "out" / "kappa.csv")
    assert kappa["kappa"].tolist() == pytest.approx([0.1] * 4)
    assert kappa["u_kappa"].tolist() == pytest.approx([(1e-9 + 1.1e-9) / 2] * 4)


def test_the_figure_of_the_paper_is_drawn_where_there_are_its_cases(tmp_path, monkeypatch):
    grid = grid_text(["md-improved"], "fscm", tier="quick", n=[2], k=[0, 0.4], mu=[0.5, 1])
    monkeypatch.setattr("comparisons.pipeline.inputs.grids", lambda tier: load_grids(grid))
    for options, has_pdf in ((["--pdf"], True), ([], False)):
        run(tmp_path, *options)
        assert (tmp_path / "fig16b_kappa.png").exists()
        # A figure that is not written again would be of other rows.
        assert (tmp_path / "fig16b_kappa.pdf").exists() == has_pdf
        assert ("fig16b_kappa.pdf" in read_record(tmp_path / "run.json")["files"]) == has_pdf
    assert main(["supplement", str(tmp_path), "--out", str(tmp_path / "paper")]) == 0
    assert (tmp_path / "paper" / "figures" / "fig16b_kappa.pdf").read_bytes().startswith(b"%PDF")
    assert "fig16b_kappa.pdf" in (tmp_path / "paper" / "supplement.tex").read_text()


def interrupt_after(count, error=KeyboardInterrupt):
    def interrupted(tasks, jobs):
        for number, row in enumerate(compute(tasks, jobs)):
            if number == count:
                raise error
            yield row

    return interrupted


@pytest.mark.parametrize(("error", "status"), [(KeyboardInterrupt, 130), (BrokenProcessPool, 4)])
def test_an_interrupted_run_goes_on_where_it_was(small_grid, tmp_path, monkeypatch, capsys, error, status):
    """On another machine: the record has every part with its own environment."""
    this_machine = computing_environment()
    other_machine = this_machine | {"python": "3.99.0", "cpu": "another"}
    run(tmp_path / "whole")
    with monkeypatch.context() as patch:
        patch.setattr(computing, "compute", interrupt_after(5, error))
        patch.setattr("comparisons.runs.store.computing_environment", lambda: other_machine)
        assert run(tmp_path / "cut") == status
    assert "computations that are safe: 5; go on with --out " in capsys.readouterr().err
    assert run(tmp_path / "cut") == 0
    assert "7 computations, 1 at a time, 5 are stored" in capsys.readouterr().err
    assert read(tmp_path / "cut") == read(tmp_path / "whole")
    record = read_record(tmp_path / "cut" / "run.json")
    assert record["rows"]["resumed"] == 5
    interrupted, resumed = sorted(record["parts"], key=lambda segment: segment["computations"])
    assert (interrupted["computations"], resumed["computations"]) == (5, 7)
    assert {name: interrupted[name] for name in other_machine} == other_machine
    assert {name: resumed[name] for name in this_machine} == this_machine
    assert record["started"] == min(interrupted["started"], resumed["started"])
    assert record["seconds"]["run"] == pytest.approx(interrupted["seconds"] + resumed["seconds"])
    # A command that computes nothing is not a part, and changes none.
    assert run(tmp_path / "cut") == 0
    assert read_record(tmp_path / "cut" / "run.json")["parts"] == record["parts"]


def test_a_failed_computation_costs_its_own_rows_and_the_exit_status(small_grid, tmp_path, capsys):
    assert run(tmp_path, "--model", "ten-percent", "fails", "--model", "broken", "picky", "nonsense") == 4
    table = pd.read_csv(tmp_path / "results.csv").set_index("model")
    assert set(table.loc["ten-percent", "status"]) == {"ok"}
    for name, why in {
        "fails": "100 iterations",
        "broken": "ZeroDivisionError",
        "picky": "outside",
        "nonsense": "nan",
    }.items():
        assert set(table.loc[name, "status"]) == {"failed"}
        assert table.loc[name, "reason"].str.contains(why).all()
        assert table.loc[name, "value"].isna().all()
    captured = capsys.readouterr()
    assert "16 failed" in captured.out
    assert "more computations failed" in captured.err


def test_quiet_prints_what_does_not_pass_and_nothing_else(small_grid, tmp_path, capsys):
    assert run(tmp_path / "right", "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    (tmp_path / "gates.toml").write_text(small_grid.replace("upper = 0.11", "upper = 0.095"))
    assert run(tmp_path / "wrong", "--quiet", "--gates", str(tmp_path / "gates.toml")) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("FAIL TEN-PERCENT of ten-percent against exact: E = 0.100000")
    assert main(["judge", str(tmp_path / "wrong"), "--quiet"]) == 1
    assert capsys.readouterr().err.startswith("FAIL TEN-PERCENT")
