"""Sweeps over a problem file: values in SI, resumption, shards, refused keys."""

import json
import math
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.problem.variation import parse_variation, parse_variations, problems_of
from comparisons.runs.csv_format import read_csv
from comparisons.runs.frames import read_table
from comparisons.runs.record import read_record

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
    assert lines[1].split() == ["punch.R", "law.work_of_adhesion", "model", "pull_off_force"]
    assert lines[3].split() == ["1", "µm", "20", "mJ/m^2", "bradley", "125.6637061435920(16)", "nN"]
    stored = pd.read_csv(tmp_path / "results.csv")
    assert "seconds" not in stored
    record = read_record(tmp_path / "run.json")
    assert record["command_name"] == "sweep"
    assert record["rows"] == {"all": 12, "resumed": 0, "ok": 12}
    assert "results.csv" in record["files"]
    assert (tmp_path / "datapackage.json").exists()


def test_rows_of_a_changed_file_are_not_used(tmp_path, capsys):
    problem = tmp_path / "pad.toml"
    problem.write_text(PAD.read_text())
    sweep(tmp_path / "out", "--model", "jkr", problem=problem)
    problem.write_text(PAD.read_text().replace("0.4 nm", "0.3 nm"))
    capsys.readouterr()
    sweep(tmp_path / "out", "--model", "jkr", problem=problem)
    assert "6 computations on" in capsys.readouterr().err


def test_the_merged_shards_are_the_whole_sweep(tmp_path, capsys):
    options = ("--model", "jkr", "bradley")
    for number in (1, 2):
        assert sweep(tmp_path / f"part{number}", *options, "--shard", f"{number}/2") == 0
    assert main(["merge", str(tmp_path / "part1"), "--out", str(tmp_path / "half")]) == 4
    assert "6 of 12 computations are in none of the folders" in capsys.readouterr().err
    assert main(["merge", *(str(tmp_path / f"part{n}") for n in (1, 2)), "--out", str(tmp_path / "merged")]) == 0
    assert sweep(tmp_path / "whole", *options) == 0
    for name in ("results.csv", "kappa.csv", f"inputs/{PAD.name}", "datapackage.json"):
        assert (tmp_path / "merged" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert sweep(tmp_path / "other", "--model", "jkr") == 0
    assert main(["merge", str(tmp_path / "part1"), str(tmp_path / "other"), "--out", str(tmp_path / "no")]) == 2


def test_a_coated_solid_with_models_that_know_power_laws_alone(tmp_path):
    """The example of docs/problem_files.md."""
    vary = ("--vary", "solid.thickness=20 nm")
    assert sweep(tmp_path, "--model", "fscm", "jkr", "atlas", "--quiet", problem=COATED, vary=vary) == 0
    table = read_table(tmp_path / "results.parquet").set_index("model")
    assert table["status"].to_dict() == {"atlas": "not-applicable", "fscm": "ok", "jkr": "ok"}
    assert table.loc["fscm", "value"] == pytest.approx(2.69461712e-8, rel=1e-8)
    assert "equivalent power law" in table.loc["jkr", "reason"]
    errors = read_table(tmp_path / "kappa.parquet")
    assert errors["model"].tolist() == ["jkr"]
    assert 0.001 < abs(errors["kappa"][0]) < 0.1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("solid.thicknes=5 nm", 'unknown key "thicknes"'),
        ("sold.E0=1 GPa", 'unknown section "sold"'),
        ("solid.E0", "names no key with values"),
        ("solid.E0=1:2:1 GPa", "1 values are outside 2 to 100000"),
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


def test_the_folder_has_copies_of_the_problem_file_and_its_tables(tmp_path):
    problem = tmp_path / "given"
    (problem / "tips").mkdir(parents=True)
    rows = "r [nm],height [nm]\n" + "".join(f"{r},{r * r / 200}\n" for r in range(40))
    text = PAD.read_text().partition("[punch]")
    (problem / "tip.toml").write_text(
        f'{text[0]}[punch]\nkind = "table"\nfile = "tips/a.csv"\n[law]{text[2].partition("[law]")[2]}'
    )
    (problem / "tips" / "a.csv").write_text(rows)
    (problem / "a.csv").write_text(rows.replace("1,0.005", "1,0.0051"))
    vary = ("--vary", "punch.file=tips/a.csv, a.csv")
    for name in ("one", "two"):
        number = {"one": 1, "two": 2}[name]
        options = ("--model", "bradley", "--shard", f"{number}/2", "--quiet")
        assert sweep(tmp_path / name, *options, problem=problem / "tip.toml", vary=vary) == 0
    record = read_record(tmp_path / "one" / "run.json")
    copies = ["inputs/tip.toml", "inputs/tips/a.csv", "inputs/a.csv"]
    assert {name for name in record["files"] if name.startswith("inputs")} == set(copies)
    given = [problem / "tip.toml", problem / "tips" / "a.csv", problem / "a.csv"]
    assert [(tmp_path / "one" / name).read_bytes() for name in copies] == [path.read_bytes() for path in given]
    # A merged folder needs the copies alone.
    for path in given:
        path.unlink()
    assert main(["merge", str(tmp_path / "one"), str(tmp_path / "two"), "--out", str(tmp_path / "all"), "--quiet"]) == 0
    assert read_table(tmp_path / "all" / "results.parquet")["status"].tolist() == ["not-applicable"] * 2
    assert (tmp_path / "all" / "inputs" / "a.csv").exists()
    # Another sweep of the folder has other copies.
    assert sweep(tmp_path / "one", "--model", "bradley", "--quiet") == 0
    assert [path.name for path in (tmp_path / "one" / "inputs").rglob("*") if path.is_file()] == [PAD.name]


def test_a_file_of_the_user_is_not_replaced_by_a_copy(tmp_path, capsys):
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / PAD.name).write_text("# mine")
    assert sweep(tmp_path, "--model", "bradley") == 2
    assert "was not written by a run, and a run would replace it" in capsys.readouterr().err


def test_errors_against_the_reference_among_the_models(tmp_path, capsys):
    """JKR is (3 + k)/4 of Bradley: the reference of the solvers is not needed for the table of a test."""
    vary = ("--vary", "punch.R=1, 2 um")
    assert sweep(tmp_path, "--model", "jkr", "bradley", "atlas", vary=vary) == 0
    values = read_table(tmp_path / "results.parquet").set_index(["model", "punch.R [m]"])
    errors = read_csv(tmp_path / "kappa.csv", {"model", "quantity", "problem", "unit", "reference"})
    assert errors["model"].tolist() == ["bradley", "bradley", "jkr", "jkr"]
    assert set(errors["reference"]) == {"atlas"}
    for row in errors.to_dict("records"):
        key = row["punch.R [m]"]
        ratio = values.loc[(row["model"], key), "value"] / values.loc[("atlas", key), "value"]
        assert row["kappa"] == pytest.approx(ratio - 1.0, rel=1e-12)
        bound = values.loc[("atlas", key), "u_num"] / values.loc[("atlas", key), "value"] * ratio
        assert row["u_kappa"] == pytest.approx(bound, rel=1e-3)
    assert "largest abs(kappa)" in capsys.readouterr().out
    # In the unit of the paper, Bradley's force is 2.
    assert values.loc["bradley", "dimensionless_value"].tolist() == pytest.approx([2.0, 2.0], rel=1e-12)


def test_every_column_is_described_in_si(tmp_path):
    assert sweep(tmp_path, "--model", "jkr", "atlas", "--quiet") == 0
    package = json.loads((tmp_path / "datapackage.json").read_text())
    tables = {table["name"]: table for table in package["resources"]}
    for table in (tables["results"], tables["kappa"]):
        fields = {field["name"]: field for field in table["schema"]["fields"]}
        assert [name for name, field in fields.items() if not field.get("description")] == []
        assert fields["punch.R [m]"]["unit"] == "m"
        assert "SI" in fields["unit"]["description"]


def test_values_of_a_range_have_no_rounding():
    assert parse_variation("solid.nu=0.1:0.4:4").values == (0.1, 0.2, 0.3, 0.4)
    assert parse_variation("punch.R=50 nm, 1 um, 2").values == ("50 nm", "1 um", 2.0)
    (thin, thick) = problems_of(COATED, parse_variations(["solid.thickness=5, 10 nm"]))
    assert (thin.parameters, thick.solid["thickness"]) == ({"solid.thickness [m]": 5e-9}, 1e-8)
    assert json.dumps(thick.parameters) == '{"solid.thickness [m]": 1e-08}'


GATE = """
[[gate]]
id = "PULL-OFF"
requirement = "The pull-off force of JKR-n-k is 0.85 times that of a rigid solid."
quantity = "pull_off_force"
candidate = "jkr"
reference = "bradley"
cases = { "punch.R" = ["0.5 um", "3 um"] }
metric = "rel"
lower = -0.16
upper = -0.14
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "(3 + k)/2 and 2"
min_cases = 6
tier = "quick"
"""


def test_the_folder_is_judged_and_drawn_like_any_other(tmp_path):
    assert sweep(tmp_path / "out", "--model", "jkr", "bradley", "--quiet") == 0
    (tmp_path / "gates.toml").write_text(GATE)
    assert main(["judge", str(tmp_path / "out"), "--gates", str(tmp_path / "gates.toml")]) == 0
    (tmp_path / "gates.toml").write_text(GATE.replace("-0.14", "-0.151"))
    assert main(["judge", str(tmp_path / "out"), "--gates", str(tmp_path / "gates.toml")]) == 1
    assert main(["cite", str(tmp_path / "out")]) == 0
