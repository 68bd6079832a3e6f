"""The board: submissions of every kind, judged, refused and hostile, on one site."""

import math
import re

import pandas as pd

from comparisons.cli.main import main
from comparisons.output.region_table import region_table
from comparisons.pipeline import board as board_module

from ..conftest import is_locked
from .board_pages import BODY, board, rows_of
from .conftest import ROWS


def test_every_submission_has_a_verdict_or_the_reason_why_not(submissions, write_data, tmp_path):
    submissions("mine/a", BODY.replace("2.2", "2.4"), "1.9", date="2026-03-01")
    submissions("mine/b", version="1.10", date="2026-04-01")
    submissions("mine/c", version="1.10")
    write_data([row.replace(",1.6,", ",2.0,") for row in ROWS]).rename(tmp_path / "submissions" / "measured")
    submissions("measured", name="measured", model="model.toml")
    submissions("twelve-percent", name="twelve-percent", model="twelve-percent")
    submissions("ends", "raise ComputationFailed('no root')", name="ends")
    submissions("loads-not", "return (", name="loads-not")
    submissions("outside", name="outside", model="mine/../../mine/a/mine.py:Model")
    manifest = submissions("theirs", name="other")
    manifest.write_text(manifest.read_text().replace('"other"', '"theirs"'))
    submissions("broken").write_text("name = [")
    (tmp_path / "submissions" / "empty").mkdir()
    status, page = board(tmp_path)
    assert status == 4
    models = rows_of(page, "models")
    assert [(row[0], row[1], row[2], row[5][2:]) for row in models] == [
        ("1", "mine", "10.00000", "PASS"),
        ("2", "twelve-percent", "12.00000", "FAIL"),
        ("3", "measured", "-12.50000(6)", "FAIL"),
        ("", "ends", "", "ERROR"),
    ]
    assert [row[1:3] for row in rows_of(page, "history")] == [["1.9", "20.00000"], ["1.10", "10.00000"]]
    # Small and medium mu, k = 0 and above, n = 2: a region without cases has no column.
    assert ["mine", *["10.000mean +10.0"] * 5, "pull-off force"] in rows_of(page, "regions")
    stated = {row[0]: (row[2], row[3]) for row in rows_of(page, "submissions")}
    reasons = {folder: reason for folder, (status, reason) in stated.items() if status == "not judged"}
    named = {"mine/c": "twice", "loads-not": "SyntaxError", "outside": "leads out", "theirs": "theirs"}
    named |= {"broken": "not TOML", "empty": "submission.toml"}
    assert reasons.keys() == named.keys()
    assert [folder for folder, text in named.items() if text not in reasons[folder]] == []
    verdicts = {folder: status[2:] for folder, (status, _) in stated.items() if folder not in reasons}
    judged = {"ends": "ERROR", "mine/a": "FAIL", "mine/b": "PASS", "measured": "FAIL", "twelve-percent": "FAIL"}
    assert verdicts == judged
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
    table = region_table(kappa, kappa.iloc[:1].assign(cases=1)).stored
    assert math.isnan(table.loc[0, "kappa k = 0"])
    assert table.loc[0, "kappa k > 0"] == -0.1


def test_what_has_not_changed_is_not_computed_again(submissions, tmp_path, capsys, monkeypatch):
    """And the values of the reference are computed once for all."""
    monkeypatch.setattr("comparisons.pipeline.board.REFERENCE", "exact")
    submissions("ten-percent", name="ten-percent", model="ten-percent")
    for body, counts in ((BODY, ["8", "4"]), (BODY.replace("2.2", "2.1"), ["0", "4"])):
        submissions("z", body, name="z")
        assert board(tmp_path)[0] == 0
        assert re.findall(r"(\d+) computations,", capsys.readouterr().err) == counts
    # Results of other code are removed.
    monkeypatch.setattr("comparisons.pipeline.board.fingerprint", lambda: "other code")
    for name in ("ten-percent", "z"):
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


def test_a_second_board_in_the_same_folder_is_refused(submissions, tmp_path, monkeypatch):
    submissions("ten-percent", name="ten-percent", model="ten-percent")
    at_work, real = [], board_module._judge

    def judge(*arguments):
        at_work.append(is_locked(tmp_path / "site"))
        real(*arguments)

    monkeypatch.setattr(board_module, "_judge", judge)
    for _ in range(2):
        assert board(tmp_path)[0] == 0
    assert at_work == [True, True]
    assert not is_locked(tmp_path / "site")


def test_a_removed_submission_leaves_nothing_on_the_site(submissions, tmp_path):
    for name in ("ten-percent", "twelve-percent"):
        submissions(name, name=name, model=name)
    board(tmp_path)
    reports = tmp_path / "site" / "models"
    assert len([*reports.glob("*/1/report.html")]) == len([*reports.glob("*/1/report-rows.js")]) == 2
    (tmp_path / "submissions" / "ten-percent" / "submission.toml").unlink()
    board(tmp_path)
    assert [path.parent.name for path in reports.glob("*/*")] == ["twelve-percent"]


def test_a_submission_whose_time_is_over_is_not_judged_and_the_next_one_has_its_own(submissions, tmp_path, monkeypatch):
    submissions("mine")
    submissions("ten-percent", name="ten-percent", model="ten-percent")
    monkeypatch.setattr(board_module, "TOTAL_TIME", 0.0)
    status, page = board(tmp_path)
    stated = {row[0]: (row[2], row[3]) for row in rows_of(page, "submissions")}
    assert (status, stated["mine"][0], stated["ten-percent"][0][2:]) == (4, "not judged", "PASS")
    assert "time that a submission has" in stated["mine"][1]


def test_a_full_disk_is_no_fault_of_a_submission(submissions, tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(28, "No space left on device", str(tmp_path))

    submissions("ten-percent", name="ten-percent", model="ten-percent")
    monkeypatch.setattr(board_module, "entry_of", full)
    assert main(["board", str(tmp_path / "submissions"), "--out", str(tmp_path / "site"), "--jobs", "1"]) == 4
    assert "No space left" in capsys.readouterr().err
    assert not (tmp_path / "site" / "index.html").exists()
