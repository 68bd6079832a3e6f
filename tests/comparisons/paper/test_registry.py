"""Registry of the figures, the functions that they call, and the command that computes them."""

import json
from importlib import import_module
from pkgutil import iter_modules

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.model import ComputationFailed
from comparisons.paper import registry
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, given, results_by
from comparisons.paper.registry import FOLDERS, NAMES, paper_figures
from comparisons.paper.tasks import curve, profile, quantity
from comparisons.problem import Problem
from comparisons.registry import create

ATTEMPTS = []


def fail(x):
    ATTEMPTS.append(x)
    raise ComputationFailed(f"{x} does not converge")


FAILING = PaperFigure("99", "failing", "", lambda: results_by({"": CachedCall.of(fail, 1)}))


def test_every_figure_of_every_module_is_found_by_its_name():
    """Also one whose statement the registry would not recognise."""
    declared = {
        id(value)
        for folder in FOLDERS
        for module in iter_modules(import_module(f"comparisons.paper.{folder}").__path__)
        for value in vars(import_module(f"comparisons.paper.{folder}.{module.name}")).values()
        if isinstance(value, PaperFigure)
    }
    figures = paper_figures()
    assert {id(figure) for figure in figures} == declared
    assert tuple(figure.name for figure in figures) == NAMES
    assert NAMES[:17] == tuple(str(number) for number in range(1, 18))
    assert len({figure.stem for figure in figures}) == len(NAMES)
    for figure in figures:
        assert figure.stem.startswith(f"fig{int(figure.name):02}_" if figure.name.isdigit() else "")
        # The same tasks every time, none twice: they are the keys of the stored results.
        assert figure.tasks() == list(dict.fromkeys(figure.tasks()))


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


def test_a_plan_that_yields_twice_is_refused():
    def twice():
        yield ()
        yield ()

    with pytest.raises(RuntimeError, match="once"):
        given(twice(), Results())


def test_an_unknown_figure_is_refused(tmp_path, capsys):
    assert main(["paper", "--figure", "99", "--out", str(tmp_path)]) == 2
    assert "'99'" in capsys.readouterr().err


def test_two_runs_give_the_same_bytes_also_of_a_sketch_without_data(tmp_path):
    for folder in ("a", "b"):
        assert main(["paper", "--figure", "1", "2", "--jobs", "1", "--out", str(tmp_path / folder)]) == 0
    files = [sorted((tmp_path / folder).glob("fig*")) for folder in ("a", "b")]
    assert [path.suffix for path in files[0]] == [".pdf", ".png", ".csv", ".pdf", ".png"]
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


@pytest.mark.parametrize(
    ("function", "arguments", "status", "reason"),
    [
        (quantity, ("bradley", "jump_in_gap", 2, 0.4, 1), "not-applicable", "rigid pair"),
        (quantity, ("fscm", "pull_off_force", 0.5, 0.4, 1), "failed", "diverges"),
        (curve, ("dmt", 0.4, 0.1, 1), "failed", "shape index"),
        (profile, ("bradley", 2, 0.4, 1), "not-applicable", "no profile"),
        (profile, ("fscm", 2, 0.4, -1), "failed", "Tabor number"),
    ],
)
def test_a_refusal_is_a_result(function, arguments, status, reason):
    found = function(*arguments)
    assert found["status"] == status
    assert reason in found["reason"]
    assert found.get("value") is None


def test_quantity_curve_and_profile_are_those_of_the_model():
    # Closed form: 3/2 for a paraboloid on a homogeneous solid.
    found = quantity("jkr", "pull_off_force", 2, 0.0, 1.0)
    assert (found["value"], found["status"], found["reason"]) == (pytest.approx(1.5, rel=1e-14), "ok", "")
    path, shape = curve("fscm", 2, 0.4, 0.5), profile("fscm", 2, 0.4, 0.5)
    json.dumps([found, path, shape], allow_nan=False)
    force = quantity("fscm", "pull_off_force", 2, 0.4, 0.5)["value"]
    assert -min(path["load"]) == pytest.approx(force, abs=path["u_load"] + 1e-9)
    # The bounds are the fraction of the picture times its size.
    ratio = np.ptp(path["load"]) / np.ptp(path["displacement"])
    assert path["u_load"] / path["u_displacement"] == pytest.approx(ratio)
    # The edge is not defined before contact.
    assert path["columns"]["edge_radius"][0] is None
    assert path["columns"]["edge_radius"][-1] > 0
    whole = create("fscm").pull_off_profile(Problem.dimensionless(2, 0.4, 0.5))
    assert max(shape["gap"]) <= 10
    assert shape["pressure"] == whole.pressure[: len(shape["pressure"])].tolist()
