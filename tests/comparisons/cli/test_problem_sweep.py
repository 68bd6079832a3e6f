"""Sweeps over a problem file: values in SI, resumption, shards, refused keys."""

import json
import math
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.problem.variation import parse_variation, parse_variations, problems_of
from comparisons.runs.csv_format import read_table
from comparisons.runs.record import read_record
from tests.paths import PAD

COATED = PAD.with_name("coated_solid.toml")
VARY = ("--vary", "punch.R=1, 2 um", "--vary", "law.work_of_adhesion=20:60:3 mJ/m^2")


def command(out, *options, problem=PAD, vary=VARY):
    return ["sweep", "--problem", str(problem), *vary, "--jobs", "1", "--out", str(out), *options]


def sweep(out, *options, **settings):
    return main(command(out, *options, **settings))


def test_every_combination_by_every_model(tmp_path, capsys):
    assert sweep(tmp_path, "--model", "bradley", "jkr", "--quantity", "pull_off_force") == 0
    table = read_table(tmp_path / "results.csv")
    assert len(table) == 2 * 2 * 3
    for row in table.to_dict("records"):
        # k = 0.4 for JKR-n-k; Bradley is 2 pi R dgamma for every k.
        factor = {"jkr": (3 + 0.4) / 2, "bradley": 2.0}[row["model"]]
        force = factor * math.pi * row["punch.R [m]"] * row["law.work_of_adhesion [J/m^2]"]
        assert row["value"] == pytest.approx(force, rel=1e-12)
        assert (row["unit"], row["status"]) == ("N", "ok")
    assert sorted(set(table["law.work_of_adhesion [J/m^2]"])) == [0.02, 0.04, 0.06]
    lines = capsys.readouterr().out.splitlines()
    assert lines[3].split() == ["1", "µm", "20", "mJ/m^2", "bradley", "125.6637061435920(16)", "nN"]
    assert (tmp_path / "values.png").stat().st_size > 10_000
    # The file as it is.
    assert sweep(tmp_path / "one", "--model", "bradley", "jkr", vary=()) == 0
    assert not (tmp_path / "one" / "values.png").exists()
    assert set(read_table(tmp_path / "one" / "results.csv")["problem"]) == {PAD.name}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--vary", "solid.thicknes=5 nm"], "unknown key 'thicknes'"),
        (["--vary", "sold.E0=1 GPa"], "unknown section 'sold'"),
        (["--vary", "solid.E0"], "names no key with values"),
        (["--vary", "solid.E0=1:2:1 GPa"], "1 values are outside 2 to 100000"),
        (["--vary", "solid.k=0.2, 1.5"], "solid.k = 1.5"),
        (["--vary", "solid.E0=1:2:3"], "the value 1 has no unit; write it as 1 Pa"),
        (["--vary", "punch.R=1 um, 2 um, 3"], "the value 3 has no unit; write it as 3 m"),
        (["--vary", "punch.R=1 um, , 3 um"], "a value is missing beside a comma"),
        (["--vary", "punch.R.=1 um"], "names no key"),
        (["--vary", "pun ch.R=1 um"], "unknown section 'pun ch'"),
        (["--vary", "solid.kind=coating"], "a kind is not varied"),
        (["--vary", "punch.R=1 um", "--vary", "punch.R=3 um"], "is there twice"),
        (["--vary", "solid.E0=1:2:1000 GPa", "--vary", "punch.R=1:2:200 um"], "more than 100000"),
        (["grid.toml"], "a sweep is of one file"),
    ],
)
def test_bad_keys_and_options_give_one_sentence(options, words, refused):
    refused(command("never", *options, vary=()), words)
    assert not Path("never").exists()


@pytest.mark.parametrize("name", ["pad.toml", "my pad.toml"])
def test_a_refused_value_is_one_of_the_problem_file_and_of_no_grid(name, tmp_path, refused):
    (tmp_path / name).write_bytes(COATED.read_bytes())
    options = ["--vary", "solid.thickness=0, 5 nm", "--out", tmp_path / "never"]
    said = refused(["sweep", "--problem", tmp_path / name, *options], "E_substrate")
    assert "grid" not in said.replace(str(tmp_path), "")


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
    for number, name in enumerate(("one", "two"), start=1):
        options = ("--model", "bradley", "--shard", f"{number}/2", "--quiet")
        assert sweep(tmp_path / name, *options, problem=problem / "tip.toml", vary=vary) == 0
    record = read_record(tmp_path / "one" / "run.json")
    copies = ["inputs/tip.toml", "inputs/tips/a.csv", "inputs/a.csv"]
    assert {name for name in record["files"] if name.startswith("inputs")} == set(copies)
    originals = [problem / "tip.toml", problem / "tips" / "a.csv", problem / "a.csv"]
    assert [(tmp_path / "one" / name).read_bytes() for name in copies] == [path.read_bytes() for path in originals]
    # A merged folder needs the copies alone.
    for path in originals:
        path.unlink()
    assert main(["merge", str(tmp_path / "one"), str(tmp_path / "two"), "--out", str(tmp_path / "all"), "--quiet"]) == 0
    assert read_table(tmp_path / "all" / "results.csv")["status"].tolist() == ["not-applicable"] * 2
    assert (tmp_path / "all" / "inputs" / "a.csv").exists()


def test_a_file_of_the_user_is_not_replaced_by_a_copy(tmp_path, refused):
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / PAD.name).write_text("# mine")
    refused(command(tmp_path, "--model", "bradley"), "was not written by a run, and a run would replace it")


def test_values_of_a_range_have_no_rounding():
    assert parse_variation("solid.nu=0.1:0.4:4")[1] == [0.1, 0.2, 0.3, 0.4]
    assert parse_variation("punch.R=50 nm, 1 um, 2")[1] == ["50 nm", "1 um", 2.0]
    (thin, thick) = problems_of(COATED, parse_variations(["solid.thickness=5, 10 nm"]))
    assert (thin.parameters, thick.solid["thickness"]) == ({"solid.thickness [m]": 5e-9}, 1e-8)
    assert json.dumps(thick.parameters) == '{"solid.thickness [m]": 1e-08}'
