"""One model from three sources (package, file, data), with the same results; and what names no model."""

import csv

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models, load_model, source_of
from comparisons.external.worker import check_methods
from comparisons.model import HasCurve, Model
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.tasks import evaluate

from .conftest import EXAMPLE, GATE

FILE_SOURCE = f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz"
QUANTITY = "pull_off_force"


@pytest.fixture
def data_source(write_data):
    """Write the predictions of the example as an author would who cannot give the code away."""
    model = create(FILE_SOURCE)
    rows = []
    for k, mu in ((0, 0.1), (0, 1), (0.4, 0.1), (0.4, 1)):
        result = model.evaluate(Case(2, k, mu).problem(), QUANTITY)
        rows.append(f"{QUANTITY},2,{k},{mu},{result.value!r},{result.u_num!r}")
    return str(write_data(rows, change={'"measured"': '"double-hertz"'}))


@pytest.fixture
def once(few_cases, tmp_path):
    """Return a function that runs a model and returns the status and the rows, without what differs by its nature."""
    (tmp_path / "gates.toml").write_text(GATE.replace("0.1", "0.5"))
    options = ["--jobs", "1", "--gates", str(tmp_path / "gates.toml")]

    def go(spec, out):
        status = main(["run", *options, "--out", str(tmp_path / out), "--model", spec])
        rows = csv.DictReader((tmp_path / out / "results.csv").read_text().splitlines())
        return status, [{name: row[name] for name in row if name not in {"model_version", "seconds"}} for row in rows]

    return go


def test_all_sources_give_the_same_rows_and_verdicts(data_source, installed_example, once, tmp_path):
    tables = [once(spec, str(number)) for number, spec in enumerate((installed_example, FILE_SOURCE, data_source))]
    assert tables[0] == tables[1] == tables[2]
    assert tables[0][0] == 0
    assert [row["status"] for row in tables[0][1]] == ["ok"] * 8
    verdicts = [(tmp_path / str(number) / "verdicts.csv").read_text() for number in range(3)]
    assert verdicts[0] == verdicts[1] == verdicts[2]
    assert verdicts[0].count("PASS") == 4


def test_the_installed_example_keeps_the_contract_is_listed_and_has_a_curve(installed_example, capsys):
    model = create(installed_example)
    assert isinstance(model, Model)
    assert isinstance(model, HasCurve)
    for quantity, case in ((QUANTITY, Case(1, 0, 1)), ("jump_out_displacement", Case(2, 0, 0.1))):
        assert evaluate(model, quantity, case).status == "not-applicable"
    assert main(["list", "models"]) == 0
    assert "installed by double-hertz" in capsys.readouterr().out
    assert main(["curve", "--model", installed_example, "jkr", "--n", "2", "--k", "0.4", "--mu", "1"]) == 0
    rows = csv.DictReader(capsys.readouterr().out.splitlines())
    # The curve's own minimum, on 201 points, against the pull-off force of the same model.
    least = min(float(row["load"]) for row in rows if row["model"] == "double-hertz")
    assert -least == pytest.approx(evaluate(model, QUANTITY, Case(2, 0.4, 1)).value, rel=1e-3)


def test_a_run_goes_on_and_notices_that_a_model_changed(write_model, once, capsys):
    for value, computed in ((1.5, 4), (1.5, 0), (1.6, 4)):
        close_models()
        _, rows = once(write_model(f"return Result({value}, 0.0)"), "out")
        assert f"{computed} computations" in capsys.readouterr().err
        assert [float(row["value"]) for row in rows if row["model"] == "stranger"] == [value] * 4


def test_two_models_of_one_name_are_refused(data_source, capsys):
    assert main(["run", "--model", FILE_SOURCE, data_source]) == 2
    assert "two models have the name double-hertz" in capsys.readouterr().err


def test_a_folder_and_an_installed_model_of_its_name_are_told_apart(
    installed_example, write_data, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / installed_example).mkdir()
    assert source_of(installed_example)["kind"] == "package"
    with pytest.raises(ValueError, match=f"'./{installed_example}'"):
        create(f"./{installed_example}")
    (tmp_path / installed_example).rmdir()
    write_data().rename(tmp_path / installed_example)
    with pytest.raises(ValueError, match=f"name the folder ./{installed_example}"):
        create(installed_example)
    assert create(f"./{installed_example}/model.toml").name == "measured"


@pytest.mark.parametrize("mode", [0o644, 0o755])
def test_a_bare_table_is_told_how_to_be_data(tmp_path, monkeypatch, mode):
    """With and without a separator in the SPEC, and on a file system that marks every file as executable."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.csv").touch(mode)
    for spec in ("mine.csv", "./mine.csv"):
        with pytest.raises(ValueError, match=rf"{spec} is a table .* model\.toml"):
            source_of(spec)


@pytest.mark.parametrize("spec", ["", " \t", "./nothing", "nothing.py:Model", "model.py:2", "./model.py"])
def test_what_names_no_model_is_refused_in_one_sentence(tmp_path, monkeypatch, capsys, spec):
    """The working folder may hold predictions, which an empty path would name."""
    (tmp_path / "model.toml").touch()
    (tmp_path / "model.py").touch()
    monkeypatch.chdir(tmp_path)
    for command in (["run", "--model", spec], ["check-model", spec]):
        assert main(command) == 2
        assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(
    ("method", "called"),
    [
        ("def evaluate(self, p): ...", "evaluate(problem, quantity)"),
        ("def evaluate(self, *, problem, quantity): ...", "evaluate(problem, quantity)"),
        ("def evaluate_physical(self, problem): ...", "evaluate_physical(problem, quantity)"),
        ("def curve(self): ...", "curve(problem)"),
    ],
)
def test_methods_that_take_other_arguments_are_refused_with_their_line(write_model, method, called):
    with pytest.raises(ValueError, match=r"in line \d+ of stranger\.py is called as ") as refusal:
        load_model(write_model(more=method))
    assert called in str(refusal.value)


def test_any_names_and_defaults_will_do_and_a_compiled_method_too(write_model):
    assert load_model(write_model(more="def evaluate(self, case, name, accuracy=None): ...")).name == "stranger"
    check_methods(type("Compiled", (), {"evaluate": property(lambda self: max)})(), physical=False)
