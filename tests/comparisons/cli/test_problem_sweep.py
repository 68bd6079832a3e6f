"""Sweeps over a problem file: values in SI, resumption, shards, refused keys."""

import json
import math
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.problem_file.variation import parse_variation, variations
from comparisons.runs.record import read_record
from comparisons.runs.tables import read_table

PAD = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "graded_pad.toml"
COATED = PAD.with_name("coated_solid.toml")
VARY = ("--vary", "punch.R=1, 2 um", "--vary", "law.work_of_adhesion=20:60:3 mJ/m^2")


def sweep(out, *options, problem=PAD, vary=VARY):
    return main(["sweep", "--problem", str(problem), *vary, "--jobs", "1", "--out", str(out), *options])


def refused(capsys, *options, **given):
    """The sentence of a sweep that is refused."""
    assert sweep("never", *options, **given) == 2
    error = capsys.readouterr().err
    assert "Traceback" not in error
    assert error.count("\n") == 1
    assert not Path("never").exists()
    return error


def test_every_combination_by_every_model(tmp_path, capsys):
    assert sweep(tmp_path, "--model", "bradley", "jkr", "--quantity", "pull_off_force") == 0
    table = read_table(tmp_path / "results.parquet")
    assert len(table) == 2 * 2 * 3
    for row in table.to_dict("records"):
        # k = 0.4 for JKR-n-k; Bradley is 2 pi R dgamma for every k.
        factor = {"jkr": (3 + 0.4) / 2, "bradley": 2.0}[row["model"]]
        force = factor * math.pi * row["punch.R [m]"] * row["law.work_of_adhesion [J/m^2]"]
        assert row["value"] == pytest.approx(force, rel=1e-12)
        assert (row["unit"], row["status"]) == ("N", "ok")
    assert sorted(set(table["law.work_of_adhesion [J/m^2]"])) == [0.02, 0.04, 0.06]
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["punch.R", "law.work_of_adhesion", "model", "pull_off_force"]
    assert len(lines) == 13
    stored = pd.read_csv(tmp_path / "results.csv")
    assert "seconds" not in stored
    record = read_record(tmp_path / "run.json")
    assert record["command_name"] == "problem-sweep"
    assert record["rows"] == {"all": 12, "resumed": 0, "ok": 12}
    assert "results.csv" in record["files"]
    assert (tmp_path / "datapackage.json").exists()


def test_it_goes_on_where_it_stopped(tmp_path, capsys):
    assert sweep(tmp_path, "--model", "jkr") == 0
    before = (tmp_path / "results.csv").read_bytes()
    lines = (tmp_path / "journal.jsonl").read_text().splitlines(keepends=True)
    (tmp_path / "journal.jsonl").write_text("".join(lines[:-2]))
    capsys.readouterr()
    assert sweep(tmp_path, "--model", "jkr") == 0
    assert "2 computations, 4 are stored" in capsys.readouterr().err
    assert (tmp_path / "results.csv").read_bytes() == before


def test_rows_of_a_changed_file_are_not_used(tmp_path, capsys):
    problem = tmp_path / "pad.toml"
    problem.write_text(PAD.read_text())
    sweep(tmp_path / "out", "--model", "jkr", problem=problem)
    problem.write_text(PAD.read_text().replace("0.4 nm", "0.3 nm"))
    capsys.readouterr()
    sweep(tmp_path / "out", "--model", "jkr", problem=problem)
    assert "6 computations\n" in capsys.readouterr().err


def test_the_merged_shards_are_the_whole_sweep(tmp_path, capsys):
    options = ("--model", "jkr", "bradley")
    for number in (1, 2):
        assert sweep(tmp_path / f"part{number}", *options, "--shard", f"{number}/2") == 0
    assert main(["merge", str(tmp_path / "part1"), "--out", str(tmp_path / "half")]) == 4
    assert "6 of 12 computations are in none of the folders" in capsys.readouterr().err
    assert main(["merge", *(str(tmp_path / f"part{n}") for n in (1, 2)), "--out", str(tmp_path / "merged")]) == 0
    assert sweep(tmp_path / "whole", *options) == 0
    for name in ("results.csv",):
        assert (tmp_path / "merged" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert sweep(tmp_path / "other", "--model", "jkr") == 0
    assert main(["merge", str(tmp_path / "part1"), str(tmp_path / "other"), "--out", str(tmp_path / "no")]) == 2


def test_two_processes_give_the_same(tmp_path):
    vary = ("--vary", "punch.R=1, 2 um")
    options = ("--model", "fscm", "jkr", "--quiet")
    assert sweep(tmp_path / "one", *options, vary=vary) == 0
    assert sweep(tmp_path / "two", *options, "--jobs", "2", vary=vary) == 0
    table = read_table(tmp_path / "two" / "results.parquet")
    assert table["status"].tolist() == ["ok"] * 4
    first = read_table(tmp_path / "one" / "results.parquet")
    assert first["value"].tolist() == pytest.approx(table["value"].tolist(), rel=1e-9)


def test_a_coated_solid_with_a_model_that_does_not_take_it(tmp_path):
    """The example of docs/problem_files.md."""
    vary = ("--vary", "solid.thickness=20 nm")
    assert sweep(tmp_path, "--model", "fscm", "jkr", "--quiet", problem=COATED, vary=vary) == 0
    table = read_table(tmp_path / "results.parquet")
    assert table["status"].tolist() == ["ok", "not-applicable"]
    assert table["value"][0] == pytest.approx(2.69461712e-8, rel=1e-8)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("solid.thicknes=5 nm", 'unknown key "thicknes"'),
        ("sold.E0=1 GPa", 'unknown section "sold"'),
        ("solid.E0", "names no key with values"),
        ("solid.E0=", "names no key with values"),
        ("solid.E0=1, 1 GPa", "one value twice"),
        ("solid.E0=1,, 2 GPa", "empty value"),
        ("solid.E0=1:2:1 GPa", "1 values are outside 2 to 100000"),
        ("solid.E0=1 nm, 2 nm", "has the unit nm"),
        ("solid.k=0.2, 1.5", "must be at most 1"),
        ("solid.kind=coating", "a kind is not varied"),
    ],
)
def test_a_bad_key_gives_one_sentence(text, words, capsys):
    error = refused(capsys, vary=("--vary", text))
    assert words in error
    assert "--vary" in error


def test_bad_combinations_of_options(capsys, tmp_path):
    assert "is there twice" in refused(capsys, "--vary", "punch.R=3 um")
    assert "needs --vary" in refused(capsys, vary=())
    assert "unknown quantity 'force'" in refused(capsys, "--quantity", "force")
    assert "unknown model" in refused(capsys, "--model", "nobodys")
    assert "more than 100000" in refused(capsys, "--vary", "solid.E0=1:2:50000 GPa")
    assert "a sweep is of one file" in refused(capsys, "grid.toml")
    assert main(["sweep", "grid.toml", "--vary", "solid.k=0"]) == 2
    assert "--vary is for --problem FILE" in capsys.readouterr().err
    assert main(["sweep"]) == 2


def test_other_commands_refuse_the_folder_in_one_sentence(tmp_path, capsys):
    assert sweep(tmp_path / "out", "--model", "jkr", "--quiet") == 0
    for command in ("judge", "report"):
        assert main([command, str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err
        assert "Traceback" not in error
        assert error.count("\n") == 1
    assert main(["cite", str(tmp_path / "out")]) == 0


def test_values_of_a_range_have_no_rounding():
    assert parse_variation("solid.nu=0.1:0.4:4").values == (0.1, 0.2, 0.3, 0.4)
    assert parse_variation("punch.R=50 nm, 1 um, 2").values == ("50 nm", "1 um", 2.0)
    (first, second) = variations(COATED, ["solid.thickness=5, 10 nm"])
    assert (first.parameters, second.problem.solid["thickness"]) == ({"solid.thickness [m]": 5e-9}, 1e-8)
    assert json.dumps(second.parameters) == '{"solid.thickness [m]": 1e-08}'
