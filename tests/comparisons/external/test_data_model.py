"""Predictions as data: right ones are read exactly, wrong ones are refused with their place."""

import os

import pytest

from comparisons.cli.main import main
from comparisons.external import data_model
from comparisons.external.data_model import DataModel
from comparisons.model import Model
from comparisons.problem import Problem
from comparisons.problem.variation import problems_of
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.tasks import evaluate

from .conftest import FORCE, ROWS, row_of


def test_a_submission_is_a_model(write_data):
    model = create(str(write_data()))
    assert isinstance(model, Model)
    row = row_of(model)
    assert (row.model, row.value, row.u_num, row.status) == ("measured", 1.75, 1e-6, "ok")
    assert model.version.startswith("1 (")
    assert "10.1000/182" in model.citation
    assert "CC-BY-4.0" in model.citation
    for row in (row_of(model, 2), row_of(model, quantity="jump_in_gap")):
        assert row.status == "not-applicable"


def with_row(text):
    return [ROWS[0], text, *ROWS[2:]]


CASES = "n = [2]\nk = [0, 0.4]\nmu = [0.1, 1]\n"
UNIT = QUANTITIES["pull_off_force"].unit
#: Changes of the manifest, and the rows, of two coated pads.
PADS = {
    "change": {UNIT: "N", CASES: 'problem = "pad.toml"\nvary = { "solid.thickness" = ["12 nm", "35 nm"] }\n'},
    "header": "quantity,problem,value,u_num",
    "rows": [f"pull_off_force,pad.toml; solid.thickness={h} nm,{force},1e-9" for h, force in ((12, 3e-8), (35, 4e-8))],
}
PAD = """
solid = { kind = "coating", E_coating = "1 GPa", E_substrate = "3 GPa", thickness = "20 nm", nu = 0.3 }
punch = { kind = "sphere", R = "100 nm" }
law = { kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm" }
"""


def test_numbers_in_newtons_are_those_of_a_problem_file(write_data, capsys):
    folder = write_data(**PADS, more={"pad.toml": PAD})
    model = create(str(folder))
    vary = {"solid.thickness": ["12 nm", "35 nm"]}
    problems = list(problems_of(folder / "pad.toml", vary))
    rows = [evaluate(model, "pull_off_force", problem) for problem in problems]
    assert [row.unit for row in rows] == ["N", "N"]
    assert [row.value for row in rows] == pytest.approx([3e-8, 4e-8], rel=1e-14)
    assert [row.u_num for row in rows] == pytest.approx([1e-9, 1e-9], rel=1e-14)
    assert main(["check-model", str(folder)]) == 0
    assert "not checked  gives the same result again" in capsys.readouterr().out
    # Another problem of the same name, another quantity, another kind of case.
    (folder / "pad.toml").write_text(PAD.replace("100 nm", "99 nm"))
    others = [("pull_off_force", problem) for problem in problems_of(folder / "pad.toml", vary)]
    others += [("jump_in_gap", problems[0]), ("pull_off_force", Problem.dimensionless(2, 0, 1))]
    assert {evaluate(model, *case).status for case in others} == {"not-applicable"}


MANY = ", ".join(str(number) for number in range(2, 90))
MANY_PADS = f'problem = "pad.toml"\nvary = {{ "law.m" = [{MANY}], "law.n" = [{MANY}] }}\n'
TABLE = f'[[covers]]\nquantities = ["pull_off_force"]\nn = [{MANY}]\nk = [0, 0.4]\nmu = [{MANY}]\n'


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"change": {'["pull_off_force"]': '["pull_off"]'}}, "did you mean pull_off_force?"),
        ({"change": {"n = [2]": 'n = ["2"]'}}, "n must be a list of numbers"),
        ({"change": {"k = [0, 0.4]": "k = [0, 1.4]"}}, "[0, 1]"),
        ({"change": {"k = [0, 0.4]": "k = []"}}, "no case"),
        ({"change": {'"A. Author"': '"A.\\u202eAuthor"'}}, "must be one line"),
        ({"rows": with_row("pull_off_force,2,0,1,nan,1e-6")}, "line 3: value = 'nan' is not a finite"),
        ({"change": {'name = "': "x = " + "[" * 5000 + "]" * 5000 + '\nname = "'}}, "nested too deeply"),
        ({"change": {'"pi Q': '"2 pi Q'}}, "state the values in that"),
        ({"change": {'pull_off_force = "': 'jump_in_gap = "'}}, "[units] must have exactly pull_off_force"),
        ({"change": {'"predictions.csv"': '"../data/predictions.csv"'}}, "must be the name of a .csv file"),
        ({"change": {'"predictions.csv"': '"other.csv"'}}, "other.csv"),
        ({"change": {'"measured"': '"<b>measured</b>"'}}, "letters, digits"),
        ({"change": {'doi = "10.1000/182"': 'doi = "javascript:1"'}}, "doi = "),
        ({"change": {"[[covers]]": f"{TABLE}\n[[covers]]"}}, "promise 15492 cases"),
        ({"digest": "0" * 64}, "has the SHA-256"),
        ({"rows": ROWS[:-1]}, "1 of 4 rows that [[covers]] promises are missing, the first is pull_off_force at n = 2"),
        ({"rows": [*ROWS, ROWS[0]]}, "line 6: pull_off_force at n = 2, k = 0, mu = 0.1 has a second row"),
        ({"rows": [*ROWS, "pull_off_force,2,0,7,1.5,0"]}, "line 6: pull_off_force at n = 2, k = 0, mu = 7 is not"),
        ({"rows": with_row("pull_off_force,2,0,1,1_6,0")}, "line 3: value = '1_6' is not a finite number"),
        ({"rows": with_row("pull_off_force,2,0,1,1.6,-1")}, "line 3: u_num = -1"),
        ({"rows": with_row("pull_off_force,2,0,1,1.6")}, "line 3: 5 cells, not 6"),
        ({"rows": with_row('"pull_off_force,2,0,1,1.6,0')}, "predictions.csv, line"),
        ({"header": "quantity,k,n,mu,value,u_num"}, "the first line must be"),
        ({"change": {"n = [2]": 'problem = "pad.toml"'}}, "n, k and mu"),
        ({"change": {"n = [2]": 'vary = {"x" = ["a"]}\nn = [2]'}}, "n, k and mu"),
        ({"change": {'name = "': f'limits{".a" * 3000} = 1\nname = "'}}, "nested too deeply"),
        (PADS | {"change": PADS["change"] | {CASES: MANY_PADS}}, "promise 7744 cases"),
        (PADS | {"change": PADS["change"] | {UNIT: "mN"}}, 'is compared in "N"'),
        (
            PADS | {"more": {"pad.toml": PAD}, "rows": [PADS["rows"][0].replace("12", "13")]},
            "line 2: pull_off_force at pad.toml; solid.thickness=13 nm",
        ),
        (PADS | {"more": {"pad.toml": PAD.replace("GPa", "nm")}}, "pad.toml, line 2"),
        ({"change": {'name = "': f'limits = [{"1, " * 100_000}]\nname = "'}}, "limits = [1, 1"),
        ({"change": {'name = "': "limits = [" + 21 * '"a", ' + ']\nname = "'}}, "at most 20 names"),
        ({"change": {'name = "': f'# {"x" * 400_000}\nname = "'}}, "more than 400000"),
        ({"rows": with_row("," * 1_000_000)}, "a line of 1000000 characters"),
        ({"rows": with_row("\n" * 1_000_001)}, "more than 1000000 lines"),
        ({"rows": with_row("pull_off_force,2,0,1,=1+1,0")}, "line 3: value = '=1+1' is not a finite number"),
        ({"rows": with_row("pull_off_force,2,0,\u0661,1.6,0")}, "line 3: mu"),
    ],
)
def test_what_is_wrong_is_refused_with_its_place(write_data, refused, monkeypatch, wrong, sentence):
    folder = write_data(**wrong)
    built, real = [], data_model.Problem.dimensionless
    monkeypatch.setattr(
        data_model.Problem, "dimensionless", lambda *case, **numbers: built.append(case) or real(*case, **numbers)
    )
    refused(["solve", "--model", folder, *FORCE], sentence)
    # A file of 1 kB must not cost a minute and 400 MB.
    assert len(built) <= 1 + len(ROWS)


@pytest.mark.parametrize(
    "wrap", [lambda text: b"\xef\xbb\xbf" + text.encode(), lambda text: text.encode() + b"\n\n\r\n"]
)
def test_what_spreadsheets_and_editors_add_does_no_harm(write_data, wrap):
    rows = DataModel(write_data()).rows
    assert DataModel(write_data(wrap=wrap)).rows == rows
    assert DataModel(write_data(change={"mu = [0.1, 1]": f"mu = [0.1{', 1' * 2000}]"})).rows == rows


def test_a_link_that_leads_out_is_not_followed(write_data, tmp_path):
    folder = write_data()
    os.rename(folder / "predictions.csv", tmp_path / "elsewhere.csv")
    (folder / "predictions.csv").symlink_to(tmp_path / "elsewhere.csv")
    with pytest.raises(ValueError, match="leads out of the folder"):
        DataModel(folder)


def test_nothing_in_the_folder_is_executed(write_data, tmp_path):
    folder = write_data()
    for name in ("model.py", "__init__.py", "conftest.py", "predictions.py"):
        (folder / name).write_text(f"open({str(tmp_path / 'trace')!r}, 'w')")
    assert create(str(folder)).name == "measured"
    assert not (tmp_path / "trace").exists()
