"""Registry of the figures, and the command that computes them."""

from importlib import import_module
from pkgutil import iter_modules

import pytest

from comparisons.cli.main import main
from comparisons.model import ComputationFailed
from comparisons.paper import registry
from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import PaperFigure
from comparisons.paper.registry import FOLDERS, NAMES, paper_figures

ATTEMPTS = []


def fail(x):
    ATTEMPTS.append(x)
    raise ComputationFailed(f"{x} does not converge")


FAILING = PaperFigure(
    "99", "failing", "", lambda: [CachedCall.of(fail, 1)], lambda results: results[CachedCall.of(fail, 1)], None
)


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_is_found_by_its_name(name):
    (figure,) = paper_figures([name])
    assert figure.name == name
    if name.isdigit():
        assert figure.stem.startswith(f"fig{int(name):02}_")
    assert figure.title
    # The same tasks every time, none twice: they are the keys of the stored results.
    assert figure.tasks() == figure.tasks()
    assert len(set(figure.tasks())) == len(figure.tasks())


def test_every_figure_of_every_module_is_found():
    """Also one whose statement the registry would not recognise."""
    declared = {
        id(value)
        for folder in FOLDERS
        for module in iter_modules(import_module(f"comparisons.paper.{folder}").__path__)
        for value in vars(import_module(f"comparisons.paper.{folder}.{module.name}")).values()
        if isinstance(value, PaperFigure)
    }
    assert {id(figure) for figure in paper_figures()} == declared


def test_figures_of_the_paper_are_first_and_in_its_order():
    assert NAMES[:17] == tuple(str(number) for number in range(1, 18))
    assert not any(name.isdigit() for name in NAMES[17:])


def test_a_new_module_is_a_new_figure(tmp_path, monkeypatch):
    for folder in FOLDERS:
        (tmp_path / folder).mkdir()
    source = 'FIGURE = PaperFigure(\n    name="{}",\n    stem="new",\n)\n'
    (tmp_path / "studies" / "new.py").write_text(source.format("new-study"))
    (tmp_path / "figures" / "later.py").write_text(source.format("18"))
    monkeypatch.setattr(registry, "files", lambda package: tmp_path / package.rpartition(".")[2])
    assert registry._places() == {
        "18": ("comparisons.paper.figures.later", "FIGURE"),
        "new-study": ("comparisons.paper.studies.new", "FIGURE"),
    }
    (tmp_path / "values" / "again.py").write_text(source.format("18"))
    with pytest.raises(ValueError, match=r"two figures have the name '18': in .*later and in .*again"):
        registry._places()


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


def test_a_failed_task_leaves_out_its_own_figure_only(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("comparisons.pipeline.figures.paper_figures", lambda names: [FAILING, *paper_figures(names)])
    assert main(["paper", "--figure", "2", "--jobs", "1", "--out", str(tmp_path)]) == 4
    printed = capsys.readouterr()
    assert "does not converge" in printed.err
    assert "fig02" in printed.out
    assert (tmp_path / "fig02_kernel_functions.csv").exists()
    assert not (tmp_path / "failing.csv").exists()


def test_a_stored_failure_is_used_and_reported_and_computed_again_on_request(tmp_path, capsys, monkeypatch):
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
