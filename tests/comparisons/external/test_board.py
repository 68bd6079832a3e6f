"""The board: submissions of every kind, judged, refused and hostile, on one site."""

import math
import re

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.judging.gates import gates_text
from comparisons.output.report.board import _regions

from ..conftest import GATES
from .conftest import ROWS, model_file

BODY = "return Result(2.2, 1e-9)"
SHARED = 'authors = ["A. <b>Author</b>"]\ncitation = "none"\nlicence = "MIT"'


@pytest.fixture
def submissions(small_grid, no_cards, tmp_path, monkeypatch):
    """A function that writes a submission; its gate is a limit of 11 percent for any model."""
    gate = GATES.replace('candidate = "ten-percent"', 'candidate = "given"').replace("0.09", "-0.11")
    monkeypatch.setattr("comparisons.pipeline.inputs.gates_text", lambda path: gates_text(path) if path else gate)

    def written(folder, body=BODY, version="1", name="mine", date="2026-01-01", model="mine.py:Model"):
        path = tmp_path / "submissions" / folder
        path.mkdir(parents=True, exist_ok=True)
        model_file(path, body, name)
        (path / f"{name}.py").rename(path / "mine.py")
        manifest = path / "submission.toml"
        stated = f'name = "{name}"\nversion = "{version}"\ndate = {date}\nmodel = "{model}"\n'
        manifest.write_text(stated + SHARED)
        return manifest

    return written


def board(tmp_path):
    """The exit status of the command, and the text of the first page."""
    site = tmp_path / "site"
    status = main(["board", str(tmp_path / "submissions"), "--out", str(site), "--jobs", "1"])
    return status, (site / "index.html").read_text(encoding="utf-8")


def rows_of(page, table):
    """The rows of a table: the texts of their cells."""
    body = page.partition(f'id="table-{table}"')[2].partition("<tbody>")[2].partition("</tbody>")[0]
    rows = re.findall(r"<tr>(.*?)</tr>", body, flags=re.DOTALL)
    return [[re.sub("<[^>]*>", "", cell).strip() for cell in re.findall(r"<td>(.*?)</td>", row, re.S)] for row in rows]


def test_every_submission_has_a_verdict_or_the_reason_why_not(submissions, write_data, tmp_path):
    submissions("mine/a", BODY.replace("2.2", "2.4"), "1.9", date="2026-03-01")
    submissions("mine/b", version="1.10", date="2026-04-01")
    submissions("mine/c", version="1.10")
    write_data([row.replace(",1.6,", ",2.0,") for row in ROWS]).rename(tmp_path / "submissions" / "table")
    submissions("table", name="measured", model="model.toml")
    submissions("toy", name="twelve-percent", model="twelve-percent")
    submissions("ends", "raise ComputationFailed('no root')", name="ends")
    submissions("loads-not", "return (", name="loads-not")
    submissions("outside", name="outside", model="../mine/a/mine.py:Model")
    manifest = submissions("other-name", name="other")
    manifest.write_text(manifest.read_text().replace('"other"', '"theirs"'))
    submissions("broken").write_text("name = [")
    (tmp_path / "submissions" / "empty").mkdir()
    status, page = board(tmp_path)
    assert status == 4
    assert [(row[0], row[1][2:], row[3]) for row in rows_of(page, "models")] == [
        ("mine", "PASS", "10.00000(5)"),
        ("twelve-percent", "FAIL", "12.00000(5)"),
        ("measured", "FAIL", "-12.50000(6)"),
        ("ends", "ERROR", ""),
    ]
    assert [(row[1], row[5]) for row in rows_of(page, "history")] == [("1.9", "20.00000(5)"), ("1.10", "10.00000(5)")]
    # Small and medium mu, k = 0 and above, n = 2: a region without cases has no column.
    assert ["mine", "pull-off force", *["10.000(5)"] * 5] in rows_of(page, "regions")
    stated = {row[0]: (row[2], row[3]) for row in rows_of(page, "submissions")}
    reasons = {folder: reason for folder, (status, reason) in stated.items() if status == "not judged"}
    named = {"mine/c": "twice", "loads-not": "SyntaxError", "outside": "leads out", "other-name": "theirs"}
    named |= {"broken": "not TOML", "empty": "submission.toml"}
    assert reasons.keys() == named.keys()
    assert [folder for folder, text in named.items() if text not in reasons[folder]] == []
    verdicts = [status[2:] for folder, (status, _) in stated.items() if folder not in reasons]
    assert verdicts == ["ERROR", "FAIL", "PASS", "FAIL", "FAIL"]
    assert "<b>Author" not in page
    links = {*re.findall(r'href="(models/[^"]*)/report.html"', page.partition('id="table-submissions"')[2])}
    names = ("mine/1.9", "mine/1.10", "measured/1", "twelve-percent/1", "ends/1")
    assert links == {f"models/{name}" for name in names}
    assert all((tmp_path / "site" / link / "report.html").is_file() for link in links)


def test_a_region_in_which_a_model_has_no_error_is_empty():
    """As where the reference is zero."""
    names = {"model": ["mine"] * 2, "quantity": ["hysteresis_energy"] * 2}
    cases = {"n": [2.0, 2.0], "k": [0.0, 0.4], "mu": [1.0, 3.0]}
    kappa = pd.DataFrame({**names, **cases, "kappa": [math.nan, -0.1], "u_kappa": [math.nan, 0.0]})
    table = _regions(kappa, kappa.iloc[:1].assign(cases=1)).stored
    assert math.isnan(table.loc[0, "kappa k = 0"])
    assert table.loc[0, "kappa k > 0"] == -0.1


def test_what_has_not_changed_is_not_computed_again(submissions, tmp_path, capsys, monkeypatch):
    """And the values of the reference are computed once for all."""
    monkeypatch.setattr("comparisons.pipeline.board.REFERENCE", "exact")
    submissions("a", name="ten-percent", model="ten-percent")
    for body, counts in ((BODY, ["8", "4"]), (BODY.replace("2.2", "2.1"), ["0", "4"])):
        submissions("b", body, name="b")
        assert board(tmp_path)[0] == 0
        assert re.findall(r"(\d+) computations,", capsys.readouterr().err) == counts
    # Results of other code are removed.
    monkeypatch.setattr("comparisons.pipeline.board.fingerprint", lambda: "other code")
    for name in "ab":
        submissions(name).write_text("")
    assert board(tmp_path)[0] == 4
    assert not (tmp_path / "site" / "models").exists()


def test_a_folder_of_other_files_and_one_without_submissions_are_refused(submissions, tmp_path, refused):
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "index.html").write_text("mine")
    own = submissions("a").parent
    for folder, named in ((own, "files that are not of a board"), (tmp_path / "no", "no folder with")):
        refused(["board", folder, "--out", tmp_path / "site"], named)
    assert (tmp_path / "site" / "index.html").read_text() == "mine"
