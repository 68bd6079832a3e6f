"""The leaderboard: one row a model and quantity of each run, on one page that needs no other file."""

import math
import re
from dataclasses import replace

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.output.report.leaderboard import Entry, case_sets, standing
from comparisons.output.report.stored_run import Stored
from tests.comparisons.conftest import GATES, GRID

GATE = (
    GATES.replace('candidate = "ten-percent"', 'candidate = "given"')
    .replace("0.09", "-0.11")
    .replace("min_cases = 4", 'min_cases = 1\nnot_applicable = "leave-out"')
)


def run(tmp_path, name, *models, gate=GATE):
    """The folder of a run by a gate."""
    (tmp_path / f"{name}.toml").write_text(gate)
    options = ["--gates", str(tmp_path / f"{name}.toml"), "--jobs", "1", "--out", str(tmp_path / name)]
    main(["run", "--model", *models, *options])
    return tmp_path / name


def board(folders, tmp_path, *options):
    path = tmp_path / "board.html"
    assert main(["leaderboard", *map(str, folders), "--out", str(path), *options]) == 0
    return path.read_text(encoding="utf-8")


def table_of(page):
    """The rows of the leaderboard: the texts of their cells by the headings."""
    table = page.partition('id="table-leaderboard"')[2]
    heads = [re.sub("<[^>]*>", "", text) for text in re.findall(r"<th scope=\"col\".*?</th>", table)]
    rows = re.findall(r"<tr>(.*?)</tr>", table.partition("<tbody>")[2], flags=re.DOTALL)
    cells = [[re.sub("<[^>]*>", "", text).strip() for text in re.findall(r"<td.*?</td>", row)] for row in rows]
    return [dict(zip(heads, row, strict=True)) for row in cells]


def test_each_model_has_a_row_with_its_coverage(small_grid, tmp_path):
    """The models of the second run have values in half the cases, and in none."""
    judged, refused = run(tmp_path, "a", "ten-percent", "twelve-percent"), run(tmp_path, "b", "picky", "refuses")
    page = board([judged, refused, judged], tmp_path)
    rows = {row["model"]: row for row in table_of(page)}
    assert len(table_of(page)) == 4
    ten = rows["ten-percent"]
    assert (ten["largest |κ| (%)"], ten["rms κ (%)"], ten["verdict"]) == ("10.00000(5)", "10.00000(5)", "✓ PASS")
    counts = ("asked", "answered", "not applicable", "failed", "cases with κ")
    assert [ten[name] for name in counts] == ["4", "4", "0", "0", "4"]
    assert rows["twelve-percent"]["verdict"] == "✗ FAIL"
    # A model without a single value has its row, too.
    assert [rows["refuses"][name] for name in counts] == ["4", "0", "4", "0", "0"]
    assert [rows["picky"][name] for name in counts] == ["4", "0", "0", "4", "0"]
    assert (rows["refuses"]["largest |κ| (%)"], rows["refuses"]["reference"]) == ("", "exact")
    assert (ten["version"], ten["run"]) == ("7", str(judged))
    assert "not judged in the same way" not in page


def test_runs_of_different_gates_are_mixed_only_if_the_page_states_it(small_grid, tmp_path, refused):
    folders = [run(tmp_path, "a", "ten-percent"), run(tmp_path, "b", "ten-percent", gate=GATE.replace("0.11", "0.2"))]
    refused(["leaderboard", *folders, "--out", tmp_path / "board.html"], "(different: gates)")
    assert not (tmp_path / "board.html").exists()
    page = board(folders, tmp_path, "--mixed")
    assert "These runs were not judged in the same way" in page
    assert [row["set"] for row in table_of(page)] == ["A", "B"]


def record(**more):
    arguments = {"tier": "quick", "model": ["a"], "gates": None} | more.pop("arguments", {})
    origin = {"package": {"version": "1", "commit": None}, "finished": "2026-01-01"}
    return {"cases_sha256": "0" * 64, "gates_sha256": "f" * 64, "arguments": arguments} | origin | more


def entry(record, kappa=(), results=None, planned=None):
    columns = ["quantity", "model", "n", "k", "mu", "nu", "reference", "kappa", "u_kappa"]
    empty = pd.DataFrame(columns=["gate", "candidate", "quantity", "verdict"])
    stored = Stored(record, results, empty, pd.DataFrame(list(kappa), columns=columns), *[empty] * 5)
    return Entry("name", stored, planned)


@pytest.mark.parametrize(
    ("facts", "different"),
    [
        ({"cases_sha256": "1" * 64}, "cases"),
        ({"gates_sha256": "1" * 64}, "gates"),
        ({"judged_again": {"gates_sha256": "1" * 64}}, "gates"),
        ({"arguments": {"tier": "full"}}, "tier"),
        ({"arguments": {"model": None}}, "chosen by gates"),
    ],
)
def test_every_difference_counts(facts, different):
    entries = [entry(record()), entry(record()), entry(record(**facts))]
    with pytest.raises(ValueError, match=rf"different: {different}\)"):
        case_sets(entries, mixed=False)
    assert case_sets(entries, mixed=True) == ["A", "A", "B"]
    assert case_sets(entries[:2], mixed=False) == ["A", "A"]


CASE = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "nu": math.nan, "status": "ok", "model_version": "1"}


def test_cases_of_the_verification_and_fresh_ones_do_not_count():
    results = pd.DataFrame([CASE | {"model": model, "mu": mu} for model in ("a", "exact") for mu in (0.1, 0.2, 7.0)])
    kappa = [
        ("pull_off_force", "a", 2.0, 0.0, mu, math.nan, "exact", x, u)
        for mu, x, u in ((0.1, -0.3, 1e-9), (0.2, 0.4, 0.0))
    ]
    planned = {(("a", "pull_off_force", 2.0, 0.0, mu, None, ""), "exact") for mu in (0.1, 0.2)}
    for keys, asked in ((planned, 2), (None, 3)):
        (row,) = standing(entry(record(), kappa, results, keys)).to_dict("records")
        assert (row["asked"], row["answered"], row["cases"], row["mu"], row["largest"]) == (asked, asked, 2, 0.2, 0.4)
        assert (row["rms"], row["u"]) == (pytest.approx(math.sqrt(0.125)), 1e-9)


def test_a_verdict_on_the_whole_model_counts_for_every_quantity():
    results = pd.DataFrame([CASE | {"model": model, "mu": 1.0} for model in ("a", "exact")])
    run_entry = entry(record(), [("pull_off_force", "a", 2.0, 0.0, 1.0, math.nan, "exact", 0.0, 0.0)], results)
    rows = [("A", "a", "jump_in_gap", "ERROR"), ("A", "b", "pull_off_force", "FAIL")]
    passed, on_whole = ("A", "a", "pull_off_force", "PASS"), ("CARD-DIFFERS", "a", "", "INCONCLUSIVE")
    for more, expected in (([passed], "PASS"), ([passed, on_whole], "INCONCLUSIVE"), ([on_whole], "")):
        verdicts = pd.DataFrame([*rows, *more], columns=["gate", "candidate", "quantity", "verdict"])
        (row,) = standing(replace(run_entry, stored=replace(run_entry.stored, verdicts=verdicts))).to_dict("records")
        assert row["verdict"] == expected


def test_a_part_of_a_sweep_and_a_wrong_path_are_refused(toys, tmp_path, refused):
    (tmp_path / "grid.toml").write_text(GRID.replace('tier = "quick"\n', ""))
    sweep = ["sweep", str(tmp_path / "grid.toml"), "--jobs", "1", "--quiet"]
    assert main([*sweep, "--shard", "1/2", "--out", str(tmp_path / "part")]) == 0
    assert main([*sweep, "--out", str(tmp_path / "whole")]) == 0
    refused(["leaderboard", tmp_path / "part", "--out", tmp_path / "a.html"], "is the part 1/2 of a sweep")
    refused(["leaderboard", tmp_path / "whole", "--out", tmp_path / "a.txt"], "must end in .html")
    # Nothing was judged.
    assert "verdict" not in table_of(board([tmp_path / "whole"], tmp_path))[0]
