"""Registry of the figures, their plans, the command that computes them, and the cache of finished calls."""

import os

import pytest

from comparisons.cli.main import main
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.paper.cache import CachedCall, make_calls
from comparisons.paper.paper_figure import PaperFigure
from comparisons.paper.plan import result_of
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.pipeline.figures import make_figures
from comparisons.pipeline.judgement import judge_folder
from comparisons.runs.record import check_files, read_record
from comparisons.runs.workers import LOST
from tests.comparisons.calls import defect, end, process


def fail(x):
    raise ComputationFailed(f"{x} does not converge")


FAILING = PaperFigure("99", "failing", "", lambda: result_of(fail, 1))


def test_every_figure_has_a_name_files_of_its_own_and_the_same_calls_every_time():
    figures = paper_figures()
    assert tuple(figure.name for figure in figures) == NAMES
    assert NAMES[:16] == tuple(str(number) for number in range(2, 18))
    assert len({figure.stem for figure in figures}) == len(NAMES)
    for figure in figures:
        assert figure.title
        assert figure.stem.startswith(f"fig{int(figure.name):02}_" if figure.name.isdigit() else "")
        assert figure.plan().needed == figure.plan().needed


def test_a_failed_call_leaves_out_its_own_figure_only_and_a_resumed_run_gives_the_same_bytes(
    tmp_path, capsys, refused, monkeypatch
):
    refused(["paper", "--figure", "99", "--out", tmp_path / "a"], "'99'")
    (finished,) = make_figures(["2"], tmp_path / "a")
    record = read_record(tmp_path / "a" / "run.json")
    assert (record["command_name"], record["arguments"]) == ("paper", {"figure": ["2"]})
    assert set(record["files"]) == {path.name for path in finished.files}
    check_files(record, tmp_path / "a")
    with pytest.raises(ValueError, match="which no gate judges"):
        judge_folder(tmp_path / "a")
    files = sorted((tmp_path / "a").glob("fig*"))
    assert [path.suffix for path in files] == [".csv", ".pdf", ".png"]
    written = [path.read_bytes() for path in files]
    monkeypatch.setattr("comparisons.pipeline.figures.paper_figures", lambda names: [FAILING, *paper_figures(names)])
    assert main(["paper", "--figure", "2", "--jobs", "1", "--out", str(tmp_path / "a")]) == 4
    printed = capsys.readouterr()
    assert "does not converge" in printed.err
    assert "fig02" in printed.out
    assert read_record(tmp_path / "a" / "run.json")["rows"]["resumed"] == record["rows"]["all"]
    assert [path.read_bytes() for path in files] == written


MADE = []


def double(x):
    MADE.append(x)
    return {"value": 2 * x, "name": "double"}


def refuse(x):
    raise NotApplicable(f"{x} is refused")


def test_each_call_is_made_once_and_its_result_or_failure_is_read_again(tmp_path):
    MADE.clear()
    calls = [CachedCall.of(double, 1), CachedCall.of(double, 2.5), CachedCall.of(fail, 3), CachedCall.of(refuse, 4)]
    assert (make_calls([*calls, calls[0]], tmp_path).made, MADE) == (4, [1, 2.5])
    # A failure and a refusal are made again.
    made = make_calls([*calls, CachedCall.of(double, 2)], tmp_path)
    assert (made.made, MADE) == (3, [1, 2.5, 2])
    outcomes = [made.outcomes[call] for call in calls]
    assert outcomes[1].get() == {"value": 5.0, "name": "double"}
    for outcome, reason in ((outcomes[2], r"fail\(3\): 3 does not converge"), (outcomes[3], r"refuse\(4\): 4 is re")):
        with pytest.raises(ComputationFailed, match=reason):
            outcome.get()
    assert [outcome.failed for outcome in outcomes] == [False, False, True, True]


def test_a_call_apart_has_a_process_of_its_own_and_a_defect_costs_its_own_result(tmp_path):
    calls = [*(CachedCall.of(process, x) for x in range(2)), CachedCall.of(end, "always"), CachedCall.of(defect, 4)]
    outcomes = make_calls(calls, tmp_path, apart=True).outcomes
    assert len({os.getpid(), *(outcomes[call].result for call in calls[:2])}) == 3
    assert outcomes[calls[2]].failure == LOST
    assert outcomes[calls[3]].failure.startswith("TypeError: ")
