"""The command-line contract: arguments, streams, exit statuses."""

import csv
import io
import json
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pandas as pd
import pytest

from comparisons import __main__ as start
from comparisons.cli.main import main
from comparisons.judging.gates import gates_text, load_gates
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.cases import Case, grids

CASE = ["--n", "2", "--k", "0.4", "--mu", "1"]


def solve(model, *more, quantity="pull_off_force", case=CASE):
    return main(["solve", "--model", model, "--quantity", quantity, *case, *more])


def test_json_is_one_object_on_stdout_and_nothing_else(capsys):
    assert solve("jkr", "--format", "json") == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    assert shown.out.count("\n") == 1
    content = json.loads(shown.out)
    assert list(content) == ["model", "quantity", "case", "value", "u_num", "status", "unit", "seconds"]
    assert content["case"] == {"n": 2.0, "k": 0.4, "mu": 1.0}
    assert content["value"] == pytest.approx(1.7, abs=1e-12)  # (k + 3) / 2, Eq. 57 at n = 2
    assert content["status"] == "ok"
    assert content["unit"] == "pi Q^(2/n) dgamma z0^(2/n-1)"


def test_poissons_ratio_is_part_of_the_case_when_given(capsys):
    assert solve("jkr", "--nu", "0.3", "--format", "json") == 0
    assert json.loads(capsys.readouterr().out)["case"] == {"n": 2.0, "k": 0.4, "mu": 1.0, "nu": 0.3}


def test_text_shows_the_digits_the_uncertainty_leaves(toys, capsys):
    assert solve("exact") == 0
    assert "-P_c = 2.0000000000(10) pi Q^(2/n)" in capsys.readouterr().out


@pytest.mark.parametrize(("k", "shown"), [("0", True), ("0.4", False)])
def test_text_shows_maugis_lambda_beside_the_tabor_number(capsys, k, shown):
    assert solve("jkr", case=["--n", "2", "--k", k, "--mu", "2"]) == 0
    assert ("Maugis's lambda = 2.314 with the strength" in capsys.readouterr().out) == shown


def test_csv_is_a_header_and_a_row(capsys):
    assert solve("jkr", "--format", "csv") == 0
    table = pd.read_csv(io.StringIO(capsys.readouterr().out))
    assert table.loc[0, ["model", "quantity", "n", "k", "mu", "status"]].tolist() == [
        "jkr",
        "pull_off_force",
        2,
        0.4,
        1,
        "ok",
    ]


@pytest.mark.parametrize("form", ["text", "json", "csv"])
def test_not_applicable_is_an_answer(toys, capsys, form):
    assert solve("refuses", "--format", form) == 0
    shown = capsys.readouterr().out
    assert "not-applicable" in shown
    assert "it has no such [thing]" in shown


@pytest.mark.parametrize("form", ["text", "json", "csv"])
@pytest.mark.parametrize("model", ["fails", "broken", "nonsense"])
def test_a_failed_computation_has_status_4_and_no_value(toys, capsys, model, form):
    assert solve(model, "--format", form) == 4
    shown = capsys.readouterr()
    assert "failed" in shown.out
    assert "Traceback" not in shown.out + shown.err
    if form == "json":
        content = json.loads(shown.out)
        assert (content["value"], content["u_num"], content["status"]) == (None, None, "failed")
        assert content["reason"]


def with_case(n="2", k="0.4", mu="1", nu="0.3"):
    return [
        "solve",
        "--model",
        "jkr",
        "--quantity",
        "pull_off_force",
        "--n",
        n,
        "--k",
        k,
        "--mu",
        mu,
        "--nu",
        nu,
    ]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        *[(with_case(n=n), "(0, inf)") for n in ("0", "-1", "-1e-3", "nan", "inf", "-inf")],
        *[(with_case(k=k), "[0, 1]") for k in ("-0.1", "-1e-9", "1.0001", "nan", "inf")],
        *[(with_case(mu=mu), "(0, inf)") for mu in ("0", "-1", "nan", "inf", "-inf")],
        *[(with_case(nu=nu), "[0, 0.5)") for nu in ("-0.1", "0.5", "0.6", "nan", "inf")],
        *[(with_case(**{name: "two"}), f"--{name}: 'two' is not a number") for name in ("n", "k", "mu", "nu")],
        (["solve", "--model", "hertz", "--quantity", "pull_off_force", *CASE], "the models are"),
        (["solve", "--model", "jkr", "--quantity", "pull_off", *CASE], "the quantities are"),
        (["solve", "--model", "jkr", "--quantity", "pull_off_force", "--n", "2"], "--k, --mu"),
        ([*with_case(), "--format", "xml"], "'xml'"),
        (with_case(n="1e300"), "(0, 300]"),
        *[(with_case(mu=mu), "[1e-30, 1e+15]") for mu in ("1e300", "1e-300")],
        (["curve", "--model", "hertz", *CASE], "the models are"),
        (["curve", "--model", "jkr", *CASE, "--plot", "curve.doc"], ".png"),
        (["run", "--jobs", "0"], "at least one process"),
        (["run", "--jobs", "many"], "--jobs"),
        (["run", "--tier", "slow"], "'slow'"),
        (["run", "--model", "hertz"], "the models are"),
        (["list", "colours"], "'colours'"),
        (["dance"], "'dance'"),
        ([], "COMMAND"),
    ],
)
def test_wrong_input_gets_one_sentence_and_status_2(capsys, arguments, sentence):
    assert main(arguments) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("fscm-bench: ")
    assert shown.err.count("\n") == 1
    assert sentence in shown.err


def test_input_a_model_refuses_has_status_2(toys, capsys):
    assert solve("picky") == 2
    assert "nearly homogeneous" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "--out", "{file}/folder"],
        ["curve", "--model", "jkr", *CASE, "--csv", "{file}/a.csv"],
        ["curve", "--model", "jkr", *CASE, "--plot", "{file}/a.png"],
    ],
)
def test_a_place_that_cannot_be_written_is_found_before_computing(tmp_path, capsys, arguments, monkeypatch):
    monkeypatch.setattr("comparisons.runs.computation.compute_with_environment", None)
    (tmp_path / "file").touch()
    assert main([argument.format(file=tmp_path / "file") for argument in arguments]) == 2
    assert "cannot be written" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["solve", "--help"], ["run", "--help"]])
def test_help_is_on_stdout(capsys, arguments):
    assert main(arguments) == 0
    assert "fscm-bench" in capsys.readouterr().out


def test_lists(capsys):
    for what, names in {"models": MODELS, "quantities": QUANTITIES, "cases": ["transition"]}.items():
        assert main(["list", what]) == 0
        shown = capsys.readouterr().out
        assert [name for name in names if name not in shown] == []
    assert main(["list", "gates"]) == 0


@pytest.mark.parametrize("form", ["csv", "json"])
def test_the_listed_cases_are_the_standing_ones_to_the_last_digit(capsys, form):
    assert main(["list", "cases", "--format", form]) == 0
    shown = capsys.readouterr().out
    every = list(csv.DictReader(io.StringIO(shown))) if form == "csv" else json.loads(shown)
    missing = "" if form == "csv" else None
    listed = [
        (
            row["grid"],
            Case(*(float(row[x]) for x in ("n", "k", "mu")), None if row["nu"] == missing else float(row["nu"])),
        )
        for row in every
    ]
    assert listed == [(grid.id, case) for grid in grids("full") for case in grid.cases]
    assert {row["reference"] for row in every} >= {"fscm"}


@pytest.mark.parametrize("what", ["models", "quantities", "gates"])
def test_every_list_has_a_form_for_programs(capsys, what):
    shown = {}
    for form in ("csv", "json"):
        assert main(["list", what, "--format", form]) == 0
        shown[form] = capsys.readouterr().out
    objects = json.loads(shown["json"])
    first, *rows = csv.reader(io.StringIO(shown["csv"]))
    assert [list(one) for one in objects] == [first] * len(rows)
    if what == "gates":
        limits = {(gate.id, gate.lower, gate.upper) for gate in load_gates(gates_text())}
        assert {(row[0], float(row[-2]), float(row[-1])) for row in rows} == limits


@pytest.mark.parametrize("asked", [[], ["--csv", "-"]])
def test_curve_goes_to_stdout_as_csv(capsys, tmp_path, monkeypatch, asked):
    monkeypatch.chdir(tmp_path)
    assert main(["curve", "--model", "jkr", "bradley", *CASE, *asked]) == 0
    assert list(tmp_path.iterdir()) == []
    shown = capsys.readouterr()
    table = pd.read_csv(io.StringIO(shown.out))
    assert list(table)[:3] == ["model", "displacement", "load"]
    assert set(table["model"]) == {"jkr", "bradley"}
    jkr = table[table["model"] == "jkr"]
    assert -jkr["load"].min() == pytest.approx(1.7, rel=1e-3)


def test_curve_goes_to_files(tmp_path, capsys):
    files = [tmp_path / "curve.csv", tmp_path / "curve.png"]
    assert main(["curve", "--model", "jkr", *CASE, "--csv", str(files[0]), "--plot", str(files[1])]) == 0
    assert capsys.readouterr().out == ""
    assert pd.read_csv(files[0])["model"].eq("jkr").all()
    assert files[1].read_bytes().startswith(b"\x89PNG")


def test_points_and_plot_of_a_curve_are_two_files(tmp_path, capsys):
    one = str(tmp_path / "curve.png")
    assert main(["curve", "--model", "jkr", *CASE, "--csv", one, "--plot", one]) == 2
    assert "one would replace the other" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("quantity", "y"), [("pull_off_pressure", "pressure"), ("pull_off_gap", "gap")])
def test_curve_asks_for_the_surface_at_pull_off(tmp_path, monkeypatch, capsys, quantity, y):
    drawn = []
    monkeypatch.setattr("comparisons.cli.commands.curve.save", lambda figure, path: drawn.append(figure))
    csv, case = tmp_path / "surface.csv", ["--n", "2", "--k", "0", "--mu", "0.3", "--nu", "0.2"]
    files = ["--csv", str(csv), "--plot", str(tmp_path / "surface.png")]
    assert main(["curve", "--model", "fscm", "jkr", "--quantity", quantity, *case, *files]) == 0
    assert "jkr: not-applicable: the model does not know the surface" in capsys.readouterr().err
    # Numbers as texts first: the parser of pandas 2 loses the last bit.
    table = pd.read_csv(csv, dtype=str).astype({"radius": float, y: float})
    assert list(table) == ["model", "radius", y]
    expected = CURVES[quantity].evaluate(create("fscm"), Case(2, 0, 0.3).problem())
    np.testing.assert_array_equal(table["radius"], expected.x)
    np.testing.assert_array_equal(table[y], expected.y)
    (axes,) = drawn[0].axes
    assert axes.get_xlabel().startswith("radius")
    assert axes.get_ylabel().startswith(y)
    np.testing.assert_array_equal(axes.get_lines()[0].get_ydata(), expected.y)


def test_curve_hands_on_poissons_ratio(toys, monkeypatch):
    created = []
    monkeypatch.setattr(
        "comparisons.cli.commands.curve.create", lambda name, nu: created.append(nu) or create(name, nu)
    )
    assert main(["curve", "--model", "exact", *CASE, "--nu", "0.25"]) == 0
    assert created == [0.25]
    assert main(["curve", "--model", "exact", *CASE, "--nu", "0.5"]) == 2


@pytest.mark.parametrize(("model", "status"), [("refuses", 0), ("fails", 4)])
def test_a_model_without_a_curve_does_not_stop_the_others(toys, capsys, model, status):
    assert main(["curve", "--model", model, "exact", *CASE]) == status
    shown = capsys.readouterr()
    assert set(pd.read_csv(io.StringIO(shown.out))["model"]) == {"exact"}
    assert model in shown.err


PROGRAM = [sys.executable, "-c", "import sys; from comparisons.cli.main import main; sys.exit(main())"]


def test_as_a_process():
    done = subprocess.run(
        [*PROGRAM, "solve", "--model", "jkr", "--quantity", "pull_off_force", *CASE], capture_output=True
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"1.7000" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "unneeded"),
    [
        (["--help"], {"numpy", "rich"}),
        (["--version"], {"numpy"}),
        (
            ["solve", "--model", "jkr", "--quantity", "pull_off_force", *CASE],
            {"pandas", "pyarrow", "matplotlib", "scipy.optimize", "fem_reference"},
        ),
        (["run", "--help"], {"matplotlib", "scipy.interpolate", "fem_reference"}),
    ],
)
def test_a_command_does_not_wait_for_libraries_that_it_does_not_need(arguments, unneeded):
    program = (
        f"import sys; from comparisons.cli.main import main; main({arguments!r}); "
        f"print(sorted({unneeded!r} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_reader_that_leaves_is_no_disaster():
    with subprocess.Popen(
        [*PROGRAM, "curve", "--model", "jkr", *CASE], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        message = process.stderr.read()
    assert (process.returncode, message) == (141, b"")


class _Interrupted(ModuleType):
    # Only this name: pytest's plugins ask every module for others.
    def __getattr__(self, name):
        if name == "main":
            raise KeyboardInterrupt
        raise AttributeError(name)


def test_an_interruption_of_the_imports_is_one_sentence(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["fscm-bench"])
    monkeypatch.setitem(sys.modules, "comparisons.cli.main", _Interrupted("comparisons.cli.main"))
    assert start.main() == 130
    assert capsys.readouterr().err == "fscm-bench: interrupted\n"


def test_the_console_script_imports_nothing_slow_before_it_can_be_interrupted():
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text(encoding="utf-8"))
    module, _, name = project["project"]["scripts"]["fscm-bench"].partition(":")
    # An installation has the package beside the others.
    place = Path(__file__).parents[3] / "comparisons" / "start_entry"
    program = f"import sys; sys.path.insert(0, {str(place)!r}); from {module} import {name}; "
    program += "sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
