"""Predictions as data: right ones are read exactly, wrong ones are refused with their place."""

import hashlib
import os

import pytest

from comparisons.cli.main import main
from comparisons.external import data_model
from comparisons.external.data_model import DataModel as read_submission
from comparisons.model import Model
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.tasks import evaluate

from .conftest import ROWS


def test_a_submission_is_a_model(write_data):
    model = create(str(write_data()))
    assert isinstance(model, Model)
    row = evaluate(model, "pull_off_force", Case(2, 0.4, 1))
    assert (row.model, row.value, row.u_num, row.status) == ("measured", 1.75, 1e-6, "ok")
    assert model.version.startswith("1 (")
    assert "10.1000/182" in model.citation
    assert "CC-BY-4.0" in model.citation


@pytest.mark.parametrize(
    ("quantity", "case"),
    [
        ("pull_off_force", Case(2, 0.4, 2)),
        ("jump_in_gap", Case(2, 0.4, 1)),
        ("pull_off_force", Case(1, 0, 1)),
    ],
)
def test_what_is_not_covered_is_not_applicable(write_data, quantity, case):
    assert evaluate(create(str(write_data())), quantity, case).status == "not-applicable"


def with_row(number, text):
    return [*ROWS[:number], text, *ROWS[number + 1 :]]


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (
            {"change": {'["pull_off_force"]': '[["a"]]'}},
            "quantities must be a list of quantities; it holds ['a']",
        ),
        ({"change": {'["pull_off_force"]': "[{a=1}]"}}, "quantities must be a list of quantities; it holds {'a': 1}"),
        ({"change": {"n = [2]": 'n = ["2"]'}}, "n in [[covers]] must be a list of numbers; found '2'"),
        ({"change": {"n = [2]": "n = [1" + "0" * 400 + "]"}}, "n in [[covers]] must be a list of numbers"),
        ({"change": {'name = "': "x = " + "[" * 5000 + "]" * 5000 + '\nname = "'}}, "nested too deeply"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,1_6,0")}, "line 3: value = '1_6' is not a number"),
        ({"rows": [*ROWS[:2], "", *ROWS[2:]]}, "line 4: a blank line, and rows after it"),
        ({"digest": "0" * 64}, "has the SHA-256"),
        (
            {"rows": ROWS[:-1]},
            "1 of 4 rows that [[covers]] promises are missing, the first is pull_off_force at n = 2",
        ),
        ({"rows": []}, "4 of 4 rows"),
        ({"rows": [*ROWS, ROWS[0]]}, "line 6: pull_off_force at n = 2, k = 0, mu = 0.1 has a second row"),
        (
            {"rows": [*ROWS, "pull_off_force,2,0,7,1.5,0"]},
            "line 6: pull_off_force at n = 2, k = 0, mu = 7 is not among",
        ),
        ({"rows": with_row(1, "pull_off_force,2,0,1,nan,1e-6")}, "line 3: value = nan is not a finite"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,inf,1e-6")}, "not a finite"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,,1e-6")}, "line 3: value = '' is not a number"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,=1+1,1e-6")}, "'=1+1' is not a number"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,1.6,-1")}, "u_num = -1"),
        ({"rows": with_row(1, "pull_off_force,2,0,1,1.6")}, "5 cells, not 6"),
        ({"rows": with_row(1, "<script>,2,0,1,1.6,0")}, "is not among"),
        ({"rows": with_row(1, '"pull_off_force,2,0,1,1.6,0')}, "predictions.csv, line"),
        ({"header": "quantity,k,n,mu,value,u_num"}, "the first line must be"),
        ({"change": {'"pi Q': '"2 pi Q'}}, "divide the values by that"),
        ({"change": {'pull_off_force = "': 'jump_in_gap = "'}}, "[units] must have exactly pull_off_force"),
        ({"change": {'"predictions.csv"': '"../data/predictions.csv"'}}, "must be the name of a .csv file"),
        ({"change": {'"predictions.csv"': '"/etc/passwd"'}}, "must be the name of a .csv file"),
        ({"change": {'"predictions.csv"': '"other.csv"'}}, "there is no file other.csv"),
        ({"change": {'"measured"': '"<b>measured</b>"'}}, "letters, digits"),
        ({"change": {'"A. Author"': '"A.\\nAuthor"'}}, "author must be one line"),
        ({"change": {'"A. Author"': '"A.\\u202eAuthor"'}}, "author must be one line"),
        ({"change": {'"A. Author"': '""'}}, "author = '' must be one line of 1 to 500 printable"),
        ({"change": {'doi = "10.1000/182"': 'doi = "javascript:1"'}}, "doi = 'javascript:1' must be a DOI such as"),
        ({"change": {'doi = "10.1000/182"': 'doi = "10.1000/<b>"'}}, "doi = '10.1000/<b>' must be a DOI such as"),
        ({"change": {'doi = "10.1000/182"': "doi = 1"}}, 'doi = 1 must be a DOI such as "10.1000/182", or "none"'),
        ({"change": {'"CC-BY-4.0"': '"<b>"'}}, "licence = '<b>' must be a licence of"),
        ({"digest": "..."}, "sha256 = '...' must be the SHA-256 of the predictions, 64 hex"),
        (
            {"change": {"[units]": 'limits = ["jkr", 1]\n[units]'}},
            "limits = ['jkr', 1] must be a list of names",
        ),
        ({"change": {'"pi Q^(2/n) dgamma z0^(2/n-1)"': "1"}}, "units.pull_off_force = 1 must be a unit as"),
        (
            {"change": {"[units]": "x = " + "[" * 400 + "]" * 400 + "\n[units]"}},
            "unknown key 'x'; known are name",
        ),
        ({"change": {'licence = "CC-BY-4.0"': ""}}, "licence missing; a folder of predictions has name,"),
        ({"change": {"[units]": 'colour = "red"\n[units]'}}, "unknown key 'colour'; known are"),
        ({"change": {"k = [0, 0.4]": "k = [0, 1.4]"}}, "[0, 1]"),
        ({"change": {"k = [0, 0.4]": 'k = [0, "0.4"]'}}, "k in [[covers]] must be a list of numbers"),
        ({"change": {"k = [0, 0.4]": "k = []"}}, "no case"),
        ({"change": {"k = [0, 0.4]": "q = [0, 0.4]"}}, "covers 1: unknown key 'q'; known are quantities, n, k, mu"),
        (
            {"change": {'["pull_off_force"]': '["pull_off"]'}},
            "'pull_off': did you mean pull_off_force?",
        ),
        ({"change": {"[[covers]]": "[covers]"}}, "[[covers]] table"),
        ({"change": {"[[covers]]": "[[covers"}}, "Expected"),
    ],
)
def test_what_is_wrong_is_refused_with_its_place(write_data, capsys, wrong, sentence):
    folder = write_data(**wrong)
    with pytest.raises(ValueError, match="data") as refusal:
        read_submission(folder)
    assert sentence in str(refusal.value)
    arguments = ["--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"]
    assert main(["solve", "--model", str(folder), *arguments]) == 2
    shown = capsys.readouterr()
    assert sentence in shown.err
    assert shown.err.count("\n") == 1
    assert shown.out == ""


def rewritten(folder, content):
    """Replace the CSV and the hash of it."""
    manifest = (folder / "model.toml").read_text()
    before = hashlib.sha256((folder / "predictions.csv").read_bytes()).hexdigest()
    (folder / "predictions.csv").write_bytes(content)
    (folder / "model.toml").write_text(manifest.replace(before, hashlib.sha256(content).hexdigest()))
    return folder


@pytest.mark.parametrize("wrap", [lambda text: b"\xef\xbb\xbf" + text, lambda text: text + b"\n\n\r\n"])
def test_what_spreadsheets_and_editors_add_does_no_harm(write_data, wrap):
    folder = write_data()
    rows = read_submission(folder).rows
    assert read_submission(rewritten(folder, wrap((folder / "predictions.csv").read_bytes()))).rows == rows


def test_bytes_that_are_no_text_are_named_by_file_and_line(write_data):
    folder = write_data()
    content = (folder / "predictions.csv").read_bytes()
    rewritten(folder, content.replace(b"0.4,0.1", b"0.4\xb1,0.1"))
    with pytest.raises(ValueError, match=r"predictions.csv, line 4: byte 0xb1 is not UTF-8"):
        read_submission(folder)
    (folder / "model.toml").write_bytes(b"# \xe9\n")
    with pytest.raises(ValueError, match=r"model.toml, line 1: byte 0xe9 is not UTF-8"):
        read_submission(folder)


def test_a_link_that_leads_out_is_not_followed(write_data, tmp_path):
    folder = write_data()
    target = tmp_path / "elsewhere.csv"
    os.rename(folder / "predictions.csv", target)
    (folder / "predictions.csv").symlink_to(target)
    with pytest.raises(ValueError, match=r"is not in the folder of model\.toml"):
        read_submission(folder)


def test_nothing_in_the_folder_is_executed(write_data, tmp_path):
    folder = write_data()
    trace = tmp_path / "trace"
    for name in ("model.py", "__init__.py", "conftest.py", "predictions.py"):
        (folder / name).write_text(f"open({str(trace)!r}, 'w')")
    assert create(str(folder)).name == "measured"
    assert not trace.exists()


def test_a_folder_without_a_manifest_is_no_model(tmp_path, capsys):
    assert main(["run", "--model", str(tmp_path)]) == 2
    assert "model.toml" in capsys.readouterr().err


MANY = ", ".join(str(number) for number in range(2, 90))
TABLE = f"""
[[covers]]
quantities = ["pull_off_force"]
n = [{MANY}]
k = [0, 0.4]
mu = [{MANY}]
"""


@pytest.mark.parametrize(
    ("tables", "sentence"),
    [
        (TABLE.replace("0.4", ", ".join(f"0.{i}" for i in range(1, 90))) * 2, "promise 1270020 cases, more than"),
        (TABLE, "promises 15488 cases, but the predictions have 5 lines"),
    ],
)
def test_too_many_promised_cases_are_refused_before_any_is_built(write_data, monkeypatch, tables, sentence):
    """A file of 1 kB must not cost a minute and 400 MB."""
    folder = write_data(change={"[[covers]]": f"{tables}\n[[covers]]"})
    built = []
    monkeypatch.setattr(data_model, "Problem", lambda *case: built.append(case))
    with pytest.raises(ValueError, match=sentence) as refusal:
        read_submission(folder)
    assert "\n" not in str(refusal.value)
    assert not built


def test_a_value_that_is_listed_twice_is_one_case(write_data):
    folder = write_data(change={"mu = [0.1, 1]": f"mu = [0.1{', 1' * 2000}]"})
    assert len(read_submission(folder).rows) == len(ROWS)
