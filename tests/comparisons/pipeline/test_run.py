"""A run, a sweep and the figures of the paper as functions: one folder, one record."""

import subprocess
import sys

import pytest

import comparisons
from comparisons.cli.main import main
from comparisons.data.file_names import VERDICT_FILES
from comparisons.output.errors import error_summary
from comparisons.output.report.board_page import standing
from comparisons.output.report.stored_run import read_folder
from comparisons.pipeline.board import entry_of
from comparisons.pipeline.figures import make_figures
from comparisons.pipeline.finished_run import write_run
from comparisons.pipeline.merge import merge
from comparisons.pipeline.run import run
from comparisons.runs.csv_format import read_table
from comparisons.runs.folder_lock import locked
from comparisons.runs.record import check_files, read_record
from comparisons.runs.store import rows_in
from tests.comparisons.conftest import GATES, is_locked, with_entries
from tests.comparisons.conftest import GRID as STANDING
from tests.comparisons.grid_text import grid_text

GRID = STANDING.replace('tier = "quick"\n', "")


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_a_sweep_has_the_record_of_a_run_and_no_verdicts_also_after_a_run(small_grid, tmp_path):
    (tmp_path / "mine.toml").write_text(GRID)
    out = tmp_path / "out"
    run("quick", folder=out)
    assert set(VERDICT_FILES) <= names(out)
    assert main(["sweep", str(tmp_path / "mine.toml"), "--jobs", "1", "--out", str(out)]) == 0
    record = read_record(out / "run.json")
    assert (record["command_name"], record["verdicts"], record["domains"]) == ("sweep", {}, {})
    assert record["arguments"]["tier"] is None
    assert record["arguments"]["grid"] == str(tmp_path / "mine.toml")
    assert (out / "grid.toml").read_text() == GRID
    assert record["parts"][0]["computations"] == 12
    assert names(out) == {*record["files"], "run.json", "store.sqlite", ".lock"}
    assert not names(out) & {*VERDICT_FILES, "gates.toml"}
    check_files(record, out)
    assert main(["report", str(out)]) == 0
    assert run("quick", folder=out).counts["resumed"] == 12
    assert set(VERDICT_FILES) <= names(out)
    assert "grid.toml" not in names(out)


def test_grids_of_a_user_can_be_judged_at_once_and_later(small_grid, tmp_path, capsys):
    assert str(run(GRID, small_grid, folder=tmp_path / "once").verdict) == "PASS"
    assert read_record(tmp_path / "once" / "run.json")["command_name"] == "run"
    run(GRID, folder=tmp_path / "later")
    assert main(["judge", str(tmp_path / "later")]) == 2
    assert "a sweep, which has no gates" in capsys.readouterr().err
    (tmp_path / "gates.toml").write_text(small_grid.replace("upper = 0.11", "upper = 0.095"))
    assert main(["judge", str(tmp_path / "later"), "--gates", str(tmp_path / "gates.toml")]) == 1
    assert read_record(tmp_path / "later" / "run.json")["command_name"] == "run"
    assert main(["judge", str(tmp_path / "later")]) == 1


def test_a_model_has_its_errors_against_each_reference_over_the_cases_of_its_grids(tmp_path):
    """JKR in two cases beside Bradley, and in one of them beside DMT, too."""
    text = "\n".join(
        grid_text(["jkr"], reference, id=reference) + f"n = [2]\nk = [0]\nmu = {mu}\n"
        for reference, mu in (("bradley", "[5, 6]"), ("dmt-strength", "[6]"))
    )
    finished = run(text, folder=tmp_path / "run")
    kappa = finished.tables.kappa
    assert list(zip(kappa["reference"], kappa["mu"], strict=True)) == [
        ("bradley", 5),
        ("bradley", 6),
        ("dmt-strength", 6),
    ]
    assert finished.tables.largest["reference"].tolist() == ["bradley", "dmt-strength"]
    stored = read_folder(tmp_path / "run")
    for summary in (error_summary(stored.evaluations()), standing(entry_of(tmp_path / "run"))):
        counts = summary.set_index(["model", "reference"])[["asked", "cases"]]
        assert counts.to_dict("index") == {
            ("jkr", "bradley"): {"asked": 2, "cases": 2},
            ("jkr", "dmt-strength"): {"asked": 1, "cases": 1},
        }


def test_names_are_exported_and_the_import_is_light():
    assert all(getattr(comparisons, name) is not None for name in comparisons.__all__)
    assert set(comparisons.__all__) <= set(dir(comparisons))
    with pytest.raises(AttributeError, match="no attribute 'nonesuch'"):
        _ = comparisons.nonesuch
    code = "import sys, comparisons; print('pandas' in sys.modules, 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False False\n"


def test_a_sweep_of_curves_alone_has_no_errors_in_its_tables(toys, tmp_path):
    finished = run(GRID.replace("pull_off_force", "force_curve"), folder=tmp_path)
    assert finished.tables.kappa.empty
    assert not finished.tables.curves.empty


#: Two of the four cases.
HALF = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
#: Two others, for a candidate that has no value.
REFUSED = (
    HALF.replace("TEN-PERCENT", "REFUSES")
    .replace('"ten-percent"', '"refuses"')
    .replace("mu = [1, 1]", "k = [0, 0]")
    .replace("min_cases = 2", 'min_cases = 1\nnot_applicable = "leave-out"')
)


def test_a_run_of_models_has_the_rows_that_its_gates_need(small_grid, tmp_path):
    finished = run("quick", HALF + REFUSED, ["ten-percent", "refuses"], tmp_path)
    rows = finished.tables.results
    assert {model: len(group) for model, group in rows.groupby("model")} == {"exact": 3, "refuses": 2, "ten-percent": 2}
    assert set(rows.loc[rows["model"] == "ten-percent", "mu"]) == {1.0}
    assert set(rows.loc[rows["model"] == "refuses", "k"]) == {0.0}
    verdicts = finished.judgement.verdicts.astype({"verdict": str}).set_index("gate")["verdict"]
    assert verdicts["TEN-PERCENT"].tolist() == ["PASS", "PASS"]
    assert set(verdicts["REFUSES"]) == {"NOT-APPLICABLE", "ERROR"}
    with rows_in(tmp_path) as store:
        assert len(store.items) == 7
    # A model that no gate names is in the tables of errors.
    named = run("quick", HALF, ["ten-percent", "twelve-percent"], tmp_path / "named").tables.results
    assert named["model"].value_counts().to_dict() == {"exact": 4, "twelve-percent": 4, "ten-percent": 2}


def test_other_gates_compute_what_they_need_into_the_same_folder(small_grid, tmp_path, capsys):
    run("quick", HALF, ["ten-percent"], tmp_path / "new")
    (tmp_path / "all.toml").write_text(GATES)
    assert main(["judge", str(tmp_path / "new"), "--gates", str(tmp_path / "all.toml")]) == 4
    assert "a gate is in error: TEN-PERCENT of ten-percent: ten-percent has no row" in capsys.readouterr().err
    finished = run("quick", GATES, ["ten-percent"], tmp_path / "new")
    assert finished.counts == {"all": 8, "resumed": 4, "ok": 8}
    assert str(finished.verdict) == "PASS"


def test_gates_need_no_other_rows_of_standing_cases_and_all_of_others(small_grid, tmp_path):
    finished = run("quick", HALF, folder=tmp_path / "standing")
    assert finished.counts == {"all": 4, "resumed": 0, "ok": 4}
    assert set(finished.tables.results["model"]) == {"exact", "ten-percent"}
    assert run(GRID, HALF, folder=tmp_path / "mine").counts["all"] == 12


#: A run of other cases and gates, which takes a moment.
OTHER_GRID = grid_text(["dmt"], "bradley", id="other", n=[2], k=[0, 0.2, 0.4], mu=[3])
OTHER_GATES = with_entries(GATES, id="DMT", candidate="dmt", reference="bradley", cases="{}", min_cases=3)


@pytest.mark.parametrize("command", ["run", "judge"])
def test_no_other_process_writes_into_a_folder_between_its_rows_and_its_record(
    small_grid, tmp_path, monkeypatch, command
):
    (tmp_path / "other.toml").write_text(OTHER_GRID)
    (tmp_path / "gates.toml").write_text(OTHER_GATES)
    grid, gates, out = str(tmp_path / "other.toml"), str(tmp_path / "gates.toml"), tmp_path / "out"
    arguments = {
        "run": ["--cases", grid, "--gates", gates, "--out", str(out)],
        "judge": [str(out), "--gates", gates],
    }
    others = []

    def meanwhile(*given, **options):
        program = [sys.executable, "-c", "import sys; from comparisons.cli.main import main; sys.exit(main())"]
        call = [*program, command, *arguments[command]]
        others.append(subprocess.run(call, capture_output=True, text=True, check=False))
        return write_run(*given, **options)

    run("quick", small_grid, folder=out)
    monkeypatch.setattr("comparisons.pipeline.run.write_run", meanwhile)
    finished = run("quick", small_grid, folder=out)
    assert [other.returncode for other in others] == [2]
    assert str(out) in others[0].stderr
    assert others[0].stderr.count("\n") == 1
    record = read_record(out / "run.json")
    check_files(record, out)
    assert record["rows"]["all"] == len(read_table(out / "results.csv")) == 8
    assert (str(finished.verdict), record["verdicts"]["all"]) == ("PASS", "PASS")
    with rows_in(out) as store:
        assert {row.model for row in store.items} == {"exact", "ten-percent"}


def test_a_lock_is_free_after_a_kill_and_for_the_same_command(tmp_path):
    program = "import sys; from comparisons.runs.folder_lock import locked; from pathlib import Path"
    program += "\nwith locked(Path(sys.argv[1])):\n    print('mine', flush=True)\n    sys.stdin.read()"
    command = [sys.executable, "-c", program, tmp_path]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "mine\n"
        with pytest.raises(ValueError, match="another process"), locked(tmp_path):
            pass
        process.kill()
    with locked(tmp_path), locked(tmp_path, wait=True):
        pass


def test_a_link_in_place_of_the_lock_is_refused_and_its_target_stays(tmp_path):
    own = tmp_path / "thesis.tex"
    own.write_text("1")
    (tmp_path / ".lock").symlink_to(own)
    with pytest.raises(ValueError, match="symbolic link"), locked(tmp_path):
        pass
    assert own.read_text() == "1"


def test_what_a_command_writes_last_is_written_under_the_lock(toys, tmp_path, monkeypatch):
    at_end = []

    def watched(module, function):
        original = getattr(sys.modules[f"comparisons.pipeline.{module}"], function)
        folder = tmp_path / module

        def checking(*given, **options):
            at_end.append((module, is_locked(folder)))
            return original(*given, **options)

        monkeypatch.setattr(f"comparisons.pipeline.{module}.{function}", checking)
        return folder

    one = {"n": [2], "k": [0], "mu": [1], "reference": "exact"}
    comparisons.compare(["ten-percent"], folder=watched("compare", "write_record"), **one)
    for shard in ("1/2", "2/2"):
        run(GRID, folder=tmp_path / shard[0], shard=shard)
    merge([tmp_path / "1", tmp_path / "2"], watched("merge", "write_run"))
    make_figures(["12"], watched("figures", "write_record"))
    assert at_end == [("compare", True), ("merge", True), ("figures", True)]
    assert not any(is_locked(tmp_path / module) for module, _ in at_end)
