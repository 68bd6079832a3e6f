"""Registry of the figures, their plans, and the command that computes them."""

import pytest

from comparisons.cli.main import main
from comparisons.model import ComputationFailed
from comparisons.paper.paper_figure import PaperFigure
from comparisons.paper.plan import result_of
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.pipeline.figures import make_figures
from comparisons.pipeline.judgement import judge_folder
from comparisons.runs.record import check_files, read_record


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
