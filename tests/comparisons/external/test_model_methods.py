"""A model whose methods take other arguments than they are called with, and a model without a name."""

import pytest

from comparisons.cli.main import main
from comparisons.external.worker import check_methods
from comparisons.external.model_source import load_model, source_of
from comparisons.model import ComputationFailed

from .conftest import HEAD


def _written(tmp_path, method):
    file = tmp_path / "mine.py"
    file.write_text(f"{HEAD.format(name='mine')}\n    {method}\n        return Result(1.5, 0.0)\n", encoding="utf-8")
    return f"{file}:Model", len(file.read_text().splitlines()) - 1


@pytest.mark.parametrize("arguments", ["self", "self, p", "self, n, k, mu", "self, *, problem, quantity"])
def test_the_refusal_names_the_file_and_line_of_the_method(arguments, tmp_path, capsys):
    spec, line = _written(tmp_path, f"def evaluate({arguments}):")
    run = ["run", "--model", spec, "--out", str(tmp_path / "out")]
    for command in (["check-model", spec], *[run] * (arguments == "self")):
        assert main(command) == 2
        shown = capsys.readouterr().err
        assert shown.count("\n") == 1
        assert f"in line {line} of mine.py is called as evaluate(problem, quantity)" in shown
        assert "worker.py" not in shown


def test_a_curve_and_a_physical_method_are_checked_too(tmp_path):
    spec, _ = _written(tmp_path, "evaluate = lambda self, problem, quantity: 1\n\n    def curve(self):")
    with pytest.raises(ValueError, match=r"Model\.curve\(\) in line \d+ of mine\.py is called as curve\(problem\)"):
        load_model(spec)
    spec, _ = _written(tmp_path, "def evaluate_physical(self, problem):")
    with pytest.raises(ValueError, match=r"is called as evaluate_physical\(problem, quantity\)"):
        load_model(spec)


@pytest.mark.parametrize("arguments", ["self, problem, quantity", "self, *args", "self, case, name, accuracy=None"])
def test_any_names_and_defaults_will_do(arguments, tmp_path):
    spec, _ = _written(tmp_path, f"def evaluate({arguments}):")
    assert load_model(spec).name == "mine"


def test_a_method_of_which_nothing_is_known_is_not_refused():
    class Compiled:
        evaluate = property(lambda self: max)  # has no signature

    check_methods(Compiled(), physical=False)
    with pytest.raises(ComputationFailed, match=r"is called as evaluate\(problem, quantity\)"):
        check_methods(type("Short", (), {"evaluate": lambda self: 1})(), physical=False)


@pytest.mark.parametrize("spec", ["", " ", "\t"])
def test_an_empty_name_is_refused_wherever_the_command_is_called(spec, tmp_path, monkeypatch, capsys):
    """The working folder may hold predictions, which an empty path would name."""
    (tmp_path / "model.toml").touch()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=r"the name of a model, .* is empty: name an installed model"):
        source_of(spec)
    for command in (["run", "--model", spec], ["check-model", spec]):
        assert main(command) == 2
        shown = capsys.readouterr().err
        assert shown.count("\n") == 1
        assert "is empty" in shown
