"""Version of a model: changed by every file that its numbers depend on, and by no file that a run writes."""

import os

import pytest

from comparisons.cli.main import main
from comparisons.external import fingerprint as module
from comparisons.external.model_source import close_models
from comparisons.registry import create, identify
from comparisons.runs.cases import Case
from comparisons.runs.tasks import evaluate

from .conftest import light

READS = """
text = Path({folder!r}, "table.csv").read_text()
import late
return Result(float(text) + late.VALUE, 0.0)
"""


@pytest.fixture
def folder(tmp_path, write_model):
    """A folder with a model that reads a table and imports a module late, and a program beside them."""
    (tmp_path / "table.csv").write_text("1.5")
    (tmp_path / "late.py").write_text("VALUE = 0.0\n")
    (tmp_path / "solver").write_bytes(b"\x7fELF\x00")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "points.npy").write_bytes(b"\x93NUMPY")
    write_model(READS.format(folder=str(tmp_path)))
    return tmp_path


def opened(folder, name="stranger"):
    close_models()
    return create(f"{folder / name}.py:Model")


def test_every_file_of_a_small_folder_counts(folder):
    before = opened(folder)
    assert "all files in" in before.hashed
    assert "5 files" in before.hashed
    versions = [before.version]
    for changed in ("table.csv", "late.py", "solver", "data/points.npy", "stranger.py", "new.dat"):
        with (folder / changed).open("ab") as file:
            file.write(b"\n#")
        versions.append(opened(folder).version)
    assert len(set(versions)) == 7


def test_an_old_result_is_not_taken_for_one_of_a_changed_table(folder):
    first = opened(folder)
    assert evaluate(first, "pull_off_force", Case(2, 0, 1)).value == 1.5
    (folder / "table.csv").write_text("1.6")
    second = opened(folder)
    row = evaluate(second, "pull_off_force", Case(2, 0, 1))
    assert row.value == 1.6
    assert row.model_version != first.version


def write_all_over(folder):
    """Make what is beside a model without being its own."""
    for name in (
        ".git/index",
        ".pytest_cache/x",
        "__pycache__/stranger.pyc",
        "venv/pyvenv.cfg",
        "results/runs/now/results.csv",
        "out/journal.jsonl",
        "out/results.csv",
        "old/run.json",
        "old/kappa.csv",
        "stranger.egg-info/PKG-INFO",
        "fscm-bench-abc/scratch",
        ".hidden",
        "run.log",
        "stranger.py~",
    ):
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(name)
    (folder / "link").symlink_to(folder)
    os.mkfifo(folder / "pipe")


def test_what_a_run_an_editor_or_git_writes_does_not_count(folder):
    before = opened(folder)
    write_all_over(folder)
    after = opened(folder)
    assert (after.version, after.hashed) == (before.version, before.hashed)


def test_the_file_that_takes_the_output_does_not_count(folder):
    """As in ``fscm-bench run --model stranger.py:Model > output.txt``."""
    before = opened(folder).version
    kept = os.dup(1)
    with (folder / "output.txt").open("w") as file:
        os.dup2(file.fileno(), 1)
    try:
        after = opened(folder).version
    finally:
        os.dup2(kept, 1)
        os.close(kept)
    assert after == before


@pytest.mark.parametrize(
    "enlarge",
    light(
        [
            lambda folder: [(folder / f"{number}.dat").touch() for number in range(module.MOST_FILES)],
            lambda folder: os.truncate(folder / "solver", module.MOST_BYTES),
        ],
        0,
    ),
)
def test_of_a_large_folder_what_is_imported_or_declared_counts(folder, write_model, enlarge):
    enlarge(folder)
    before = opened(folder)
    (folder / "table.csv").write_text("1.6")
    assert opened(folder).version == before.version
    assert f"over {module.MOST_FILES} files or {module.MOST_BYTES // 10**6} MB" in before.hashed
    write_model(READS.format(folder=str(folder)), more='files = ("table.csv", "data/")')
    before = opened(folder)
    assert "2 declared files" in before.hashed
    (folder / "table.csv").write_text("1.7")
    after = opened(folder)
    assert after.version != before.version
    (folder / "data" / "points.npy").write_bytes(b"")
    assert opened(folder).version != after.version


def test_a_declared_file_counts_where_others_do_not(tmp_path, write_model):
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "fit.csv").write_text("1")
    write_model("return Result(1.5, 0.0)", more='files = ("results/fit.csv",)')
    before = opened(tmp_path).version
    (tmp_path / "results" / "fit.csv").write_text("2")
    assert opened(tmp_path).version != before


@pytest.mark.parametrize(
    ("files", "sentence"),
    light(
        [
            ('"table.csv"', "files = 'table.csv' is not a tuple of texts"),
            ("(1,)", "files = (1,) is not a tuple of texts"),
            ('("tabel.csv",)', "files has 'tabel.csv', but there is no such file or folder beside the model"),
            ('("/etc/passwd",)', "but the names are relative to the folder of the model"),
            ('("a\\0b",)', "no such file"),
        ],
        0,
        2,
    ),
)
def test_wrong_names_of_files_are_refused_in_one_sentence(write_model, capsys, files, sentence):
    spec = write_model("return Result(1.5, 0.0)", more=f"files = {files}")
    assert main(["solve", "--model", spec, "--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"]) == 2
    message = capsys.readouterr().err
    assert sentence in message
    assert message.count("\n") == 1
    assert "Traceback" not in message


def test_a_file_may_have_the_name_of_a_module_of_python(folder, write_model):
    write_model("return Result(1.5, 0.0)", name="statistics")
    before = opened(folder, "statistics").version
    (folder / "table.csv").write_text("2")
    assert opened(folder, "statistics").version != before


def test_the_folder_for_temporary_files_is_not_hashed(folder):
    folder.chmod(0o1777)
    before = opened(folder)
    (folder / "table.csv").write_text("2")
    assert opened(folder).version == before.version
    assert "which has other uses" in before.hashed


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """An installed package with a table in it, and a module of another package beside it."""
    site = tmp_path / "site-packages"
    (site / "stranger").mkdir(parents=True)
    (site / "stranger" / "__init__.py").touch()
    (site / "stranger" / "table.csv").write_text("1.5")
    (site / "stranger" / "model.py").write_text(
        "from comparisons.model import Result\n"
        "class Model:\n"
        '    name, version, citation, domain = "stranger", "1", "none", "tests"\n'
        "    def evaluate(self, problem, quantity):\n"
        "        return Result(1.5, 0.0)\n"
    )
    (site / "other.py").touch()
    info = site / "stranger-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: stranger\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[fscm_bench.models]\nstranger = stranger.model:Model\n")
    monkeypatch.syspath_prepend(site)
    return site


def test_every_file_of_an_installed_package_counts_and_none_beside_it(installed):
    before = create("stranger")
    assert "all files in stranger; 3 files" in before.hashed
    (installed / "other.py").write_text("x = 1")
    close_models()
    assert create("stranger").version == before.version
    (installed / "stranger" / "table.csv").write_text("1.6")
    close_models()
    assert create("stranger").version != before.version


def test_of_a_single_installed_module_what_its_package_lists_counts(installed):
    """A distribution of modules without a package: its record lists its files."""
    info = installed / "stranger-1.dist-info"
    (installed / "stranger" / "model.py").rename(installed / "model.py")
    (installed / "table.csv").write_text("1")
    (info / "entry_points.txt").write_text("[fscm_bench.models]\nstranger = model:Model\n")
    (info / "RECORD").write_text("model.py,,\ntable.csv,,\nstranger-1.dist-info/METADATA,,\n")
    before = create("stranger")
    assert "2 installed files of the model" in before.hashed
    (installed / "table.csv").write_text("2")
    close_models()
    assert create("stranger").version != before.version


def test_what_was_hashed_is_passed_on(folder, write_data):
    spec = f"{folder / 'stranger.py'}:Model"
    _, external = identify([spec, "jkr"])
    assert external["stranger"].hashed == create(spec).hashed
    _, external = identify([str(write_data())])
    assert "4 rows" in external["measured"].hashed


def test_check_model_says_what_was_hashed(folder, capsys):
    main(["check-model", f"{folder / 'stranger.py'}:Model"])
    assert "hashed: all files in" in capsys.readouterr().out


def test_a_class_of_this_program_or_of_python_has_no_files():
    assert module.fingerprint(["json", "comparisons.model"]).hashed.startswith("nothing")
