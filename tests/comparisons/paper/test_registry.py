"""Every figure of the catalogue keeps the contract; the command makes them, restarts, and says what failed."""

import pytest

from comparisons.cli.main import main
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import PaperFigure
from comparisons.paper.registry import NAMES, paper_figures

ATTEMPTS = []


def fail(x):
    ATTEMPTS.append(x)
    raise ComputationFailed(f"{x} does not converge")


FAILING = PaperFigure(
    "99", "failing", "", lambda: [CachedCall.of(fail, 1)], lambda answers: answers[CachedCall.of(fail, 1)], None
)


@pytest.mark.parametrize("name", NAMES)
def test_a_plate_is_found_by_its_name(name):
    (figure,) = paper_figures([name])
    assert figure.name == name
    assert (f"fig{int(name):02}_" if name.isdigit() else name.replace("-", "_")) in figure.stem
    assert figure.title
    # The same tasks every time, none twice: they are the keys of the stored answers.
    assert figure.tasks() == figure.tasks()
    assert len(set(figure.tasks())) == len(figure.tasks())


def test_stems_differ():
    assert len({figure.stem for figure in paper_figures()}) == len(NAMES)


def test_an_unknown_figure_is_refused(tmp_path, capsys):
    assert main(["paper", "--figure", "99", "--out", str(tmp_path)]) == 2
    assert "'99'" in capsys.readouterr().err


def test_two_runs_give_the_same_bytes(tmp_path):
    for folder in ("a", "b"):
        assert main(["paper", "--figure", "2", "--jobs", "1", "--out", str(tmp_path / folder)]) == 0
    files = [sorted((tmp_path / folder).glob("fig02*")) for folder in ("a", "b")]
    assert [path.suffix for path in files[0]] == [".csv", ".pdf", ".png"]
    assert [path.read_bytes() for path in files[0]] == [path.read_bytes() for path in files[1]]


def test_a_call_that_fails_costs_its_own_plate(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("comparisons.pipeline.figures.paper_figures", lambda names: [FAILING, *paper_figures(names)])
    assert main(["paper", "--figure", "2", "--jobs", "1", "--out", str(tmp_path)]) == 4
    said = capsys.readouterr()
    assert "does not converge" in said.err
    assert "fig02" in said.out
    assert (tmp_path / "fig02_kernel_functions.csv").exists()
    assert not (tmp_path / "failing.csv").exists()


def test_a_stored_failure_is_used_and_said_and_made_again_when_asked_for(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("comparisons.pipeline.figures.paper_figures", lambda names: [FAILING])
    arguments = ["paper", "--jobs", "1", "--out", str(tmp_path)]
    assert main(arguments) == 4
    assert "stored failures" not in capsys.readouterr().err
    assert main(arguments) == 4
    assert "1 stored failures of fail are used; --retry-failed" in capsys.readouterr().err
    attempts = len(ATTEMPTS)
    assert main([*arguments, "--retry-failed"]) == 4
    assert "stored failures" not in capsys.readouterr().err
    assert len(ATTEMPTS) == attempts + 1
