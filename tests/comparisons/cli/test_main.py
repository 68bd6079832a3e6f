"""The command-line contract: arguments, streams, exit statuses."""

import csv
import io
import json
import subprocess
import sys
from types import ModuleType

import numpy as np
import pandas as pd
import pytest

from comparisons import __main__ as start
from comparisons.cli.main import main
from comparisons.problem import Problem
from comparisons.problem.kinds import KINDS
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.cases import grids
from tests.comparisons.grid_text import PAD

CASE = ["--n", "2", "--k", "0.4", "--mu", "1"]
SOLVE_JKR = ["solve", "--model", "jkr", "--quantity", "pull_off_force"]


def solve(model, *more, case=CASE):
    return main(["solve", "--model", model, "--quantity", "pull_off_force", *case, *more])


@pytest.mark.parametrize("nu", [None, 0.3])
def test_json_is_one_object_on_stdout_and_nothing_else(capsys, nu):
    assert solve("jkr", "--format", "json", *([] if nu is None else ["--nu", str(nu)])) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert captured.out.count("\n") == 1
    content = json.loads(captured.out)
    assert list(content) == ["model", "quantity", "case", "value", "u_num", "status", "unit", "seconds"]
    assert content["case"] == {"n": 2.0, "k": 0.4, "mu": 1.0} | ({} if nu is None else {"nu": nu})
    assert content["value"] == pytest.approx(1.7, abs=1e-12)  # (k + 3) / 2, Eq. 57 at n = 2
    assert content["status"] == "ok"
    assert content["unit"] == "pi Q^(2/n) dgamma z0^(2/n-1)"


@pytest.mark.parametrize(("k", "has_it"), [("0", True), ("0.4", False)])
def test_text_shows_maugis_lambda_beside_the_tabor_number(capsys, k, has_it):
    assert solve("jkr", case=["--n", "2", "--k", k, "--mu", "2"]) == 0
    assert ("lambda = 2.314" in capsys.readouterr().out) == has_it


@pytest.mark.parametrize("form", ["text", "json", "csv"])
@pytest.mark.parametrize(
    ("model", "status", "word"),
    [("refuses", 0, "not-applicable"), *((m, 4, "failed") for m in ("fails", "broken", "nonsense"))],
)
def test_a_refusal_is_an_answer_and_a_failure_has_status_4(toys, capsys, model, status, word, form):
    assert solve(model, "--format", form) == status
    out, err = capsys.readouterr()
    assert word in out
    assert "Traceback" not in out + err
    if form == "json":
        content = json.loads(out)
        assert (content["value"], content["u_num"], content["status"]) == (None, None, word)
        assert content["reason"]
    elif form == "csv":
        names = ["model", "quantity", "n", "k", "mu", "status"]
        assert pd.read_csv(io.StringIO(out))[names].to_numpy().tolist() == [[model, "pull_off_force", 2, 0.4, 1, word]]


def with_case(**changed):
    case = {"n": "2", "k": "0.4", "mu": "1", "nu": "0.3"} | changed
    return [*SOLVE_JKR, *(word for name, value in case.items() for word in (f"--{name}", value))]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        *[(with_case(n=n), "(0, inf)") for n in ("0", "-1", "-1e-3", "nan", "-inf")],
        *[(with_case(k=k), "[0, 1]") for k in ("-.1", "-1e-9", "1.0001", "nan", "inf")],
        *[(with_case(mu=mu), "(0, inf)") for mu in ("0", "-1", "nan", "inf")],
        *[(with_case(nu=nu), "[0, 0.5)") for nu in ("-0.1", "0.5", "nan")],
        *[(with_case(**{name: "two"}), f"--{name}: ") for name in ("n", "k", "mu", "nu")],
        (["solve", "--model", "hertz", "--quantity", "pull_off_force", *CASE], "md-improved"),
        (["solve", "--model", "jkr", "--quantity", "pull_off", *CASE], "pull_off_force"),
        ([*SOLVE_JKR, "--n", "2"], "--k, --mu"),
        ([*with_case(), "--format", "xml"], "'xml'"),
        (with_case(n="1e300"), "(0, 300]"),
        *[(with_case(mu=mu), "[1e-30, 1e+15]") for mu in ("1e300", "1e-300")],
        (["curve", "--model", "jkr", *CASE, "--plot", "curve.doc"], ".png"),
        (["curve", "--model", "jkr", *CASE, "--csv", "a.png", "--plot", "a.png"], "a.png"),
        (["curve", "--model", "jkr", *CASE, "--nu", "0.5"], "nu"),
        (["run", "--jobs", "0"], "--jobs 0"),
        (["run", "--tier", "slow"], "'slow'"),
        (["bench", "--only", "speed"], "speed"),
        (["bench", "--out", "/dev/null/x"], "/dev/null/x"),
        *[
            (["run", *words.split()], "--random")
            for words in ("--model jkr --random -1", "--model jkr --seed 1", "--random 3")
        ],
        *[(["sweep", "no.toml", "--out", "out", "--shard", shard], shard) for shard in ("4/3", "0/3", "2", "1/0")],
        (["sweep", "no.toml", "--shard", "1/2"], "--out DIR"),
        (["sweep", "no.toml", "--vary", "solid.k=0"], "--vary is for --problem FILE"),
        (["fem"], "nothing to do"),
        (["fem", "--vtu", "x.vtu", "--n", "2"], "--k, --mu"),
        (["fem", *CASE, "--vtu", "x.vtk"], "vtu"),
        (["list", "colours"], "'colours'"),
        (["dance"], "'dance'"),
        ([], "COMMAND"),
    ],
)
def test_wrong_input_gets_one_sentence_and_status_2(refused, tmp_path, monkeypatch, arguments, word):
    monkeypatch.chdir(tmp_path)
    assert refused(arguments, word).startswith("fscm-bench: ")
    assert list(tmp_path.rglob("*.*")) == []


def test_input_a_model_refuses_has_status_2(toys, capsys):
    assert solve("picky") == 2
    assert "nearly homogeneous" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["run --out", "curve --csv", "curve --plot"])
def test_an_output_that_cannot_be_written_is_refused_before_computing(tmp_path, capsys, command, monkeypatch):
    monkeypatch.setattr("comparisons.runs.computation.compute", None)
    (tmp_path / "file").touch()
    case = ["--model", "jkr", *CASE] if "curve" in command else []
    assert main([*command.split(), str(tmp_path / "file" / "a.png"), *case]) == 2
    assert "cannot be written" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("listed_kind", "names"),
    [
        ("models", MODELS),
        ("quantities", QUANTITIES),
        ("cases", ["transition"]),
        ("gates", ["JKR-LIMIT-PULL-OFF"]),
        ("kinds", KINDS["solid"]),
    ],
)
def test_every_list_has_a_form_for_people_and_two_for_programs(capsys, listed_kind, names):
    captured = {}
    for form in ("text", "csv", "json"):
        assert main(["list", listed_kind, "--format", form]) == 0
        captured[form] = capsys.readouterr().out
    assert all(name in captured["text"] for name in names)
    objects = json.loads(captured["json"])
    header, *rows = csv.reader(io.StringIO(captured["csv"]))
    assert [list(row) for row in objects] == [header] * len(rows)
    if listed_kind == "cases":
        declared = [(grid.id, *problem.key) for grid in grids("full") for problem in grid.cases]
        assert [tuple(row[name] for name in ("grid", "n", "k", "mu", "nu", "problem")) for row in objects] == declared


@pytest.mark.parametrize("more", [[], ["--csv", "-"]])
def test_curve_goes_to_stdout_as_csv(capsys, more):
    assert main(["curve", "--model", "jkr", "bradley", *CASE, *more]) == 0
    table = pd.read_csv(io.StringIO(capsys.readouterr().out))
    assert list(table)[:3] == ["model", "displacement", "load"]
    assert set(table["model"]) == {"jkr", "bradley"}
    assert -table.loc[table["model"] == "jkr", "load"].min() == pytest.approx(1.7, rel=1e-3)


@pytest.mark.parametrize(("quantity", "y"), [("pull_off_pressure", "pressure"), ("pull_off_gap", "gap")])
def test_curve_writes_and_draws_the_surface_at_pull_off(tmp_path, capsys, quantity, y):
    points, picture = tmp_path / "surface.csv", tmp_path / "surface.png"
    case = ["--n", "2", "--k", "0", "--mu", "0.3", "--nu", "0.2"]
    files = ["--csv", str(points), "--plot", str(picture)]
    assert main(["curve", "--model", "fscm", "jkr", "--quantity", quantity, *case, *files]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert [words for words in ("jkr: not-applicable", *files[1::2]) if words not in captured.err] == []
    # Numbers as texts first: the parser of pandas 2 loses the last bit.
    table = pd.read_csv(points, dtype=str).astype({"radius": float, y: float})
    assert list(table) == ["model", "radius", y]
    expected = CURVES[quantity].evaluate(create("fscm"), Problem.dimensionless(2, 0, 0.3))
    np.testing.assert_array_equal(table["radius"], expected.x)
    np.testing.assert_array_equal(table[y], expected.y)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_curve_of_a_problem_file_is_drawn_in_its_units(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr("comparisons.cli.commands.curve.save", lambda figure, path: figures.append(figure))
    (tmp_path / "pad.toml").write_text(PAD)
    arguments = ["curve", "--model", "jkr", "--problem", str(tmp_path / "pad.toml"), "--plot", str(tmp_path / "a.png")]
    assert main(arguments) == 0
    axes = figures[0].axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("displacement δ (nm)", "load P (nN)")
    (line,) = axes.containers[0].lines[:1]
    assert -line.get_ydata().min() == pytest.approx(1.5 * np.pi * 1e3 * 0.05, rel=1e-3)


@pytest.mark.parametrize(("model", "status"), [("refuses", 0), ("fails", 4)])
def test_a_model_without_a_curve_does_not_stop_the_others(toys, capsys, model, status):
    assert main(["curve", "--model", model, "exact", *CASE]) == status
    captured = capsys.readouterr()
    assert set(pd.read_csv(io.StringIO(captured.out))["model"]) == {"exact"}
    assert model in captured.err


#: Commands, each of which imports more than those before, and libraries that it does not need.
UNNEEDED = [
    (["--help"], {"numpy", "rich"}),
    (["--version"], {"numpy", "rich"}),
    (["cite"], {"numpy", "rich"}),
    (["list", "models"], {"numpy", "jsonschema", "rich.progress"}),
    ([*SOLVE_JKR, *CASE], {"pandas.core", "pyarrow", "matplotlib", "scipy.optimize", "fem_reference"}),
    (["run", "--help"], {"matplotlib", "scipy.interpolate", "fem_reference"}),
]


def test_a_command_does_not_wait_for_libraries_that_it_does_not_need():
    program = f"""
import sys
from comparisons.cli.main import main
for arguments, unneeded in {UNNEEDED!r}:
    main(arguments)
    assert not unneeded & set(sys.modules), arguments
"""
    subprocess.run([sys.executable, "-c", program], stdout=subprocess.DEVNULL, check=True)


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
