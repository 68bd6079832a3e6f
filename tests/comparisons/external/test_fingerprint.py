"""Version of a model: changed by every file that its numbers depend on, and by no file that a run writes."""

import os

import pytest

from comparisons.cli.main import main
from comparisons.external import fingerprint as module
from comparisons.external.model_source import GROUP, close_models
from comparisons.registry import create, identify
from comparisons.runs.tasks import evaluate

from .conftest import CASE, FORCE, GOOD

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


def opened(spec):
    close_models()
    return create(f"{spec / 'stranger.py'}:Model" if isinstance(spec, os.PathLike) else spec)


def test_every_file_of_a_small_folder_counts(folder):
    versions = [opened(folder).version]
    assert "all files in" in opened(folder).hashed
    assert "5 files" in opened(folder).hashed
    for changed in ("late.py", "solver", "data/points.npy", "stranger.py", "new.dat"):
        with (folder / changed).open("ab") as file:
            file.write(b"\n#")
        versions.append(opened(folder).version)
    (folder / "table.csv").write_text("1.6")
    row = evaluate(opened(folder), "pull_off_force", CASE)
    assert row.value == 1.6
    assert len({*versions, row.model_version}) == 7


#: What is beside a model without being its own.
OTHERS = (
    "venv/pyvenv.cfg",
    "out/journal.jsonl",
    "out/results.csv",
    "old/run.json",
    "old/kappa.csv",
    *(f"{folder}/file" for folder in (".git", "__pycache__", "results", "stranger.egg-info", "fscm-bench-abc")),
    *(".hidden", "stranger.pyc", "run.log", "stranger.py~"),
)


def test_what_a_run_an_editor_or_git_writes_does_not_count(folder):
    before = opened(folder)
    for name in OTHERS:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    (folder / "link").symlink_to(folder)
    os.mkfifo(folder / "pipe")
    # As in ``fscm-bench run --model stranger.py:Model > output.txt``.
    kept = os.dup(1)
    with (folder / "output.txt").open("w") as file:
        os.dup2(file.fileno(), 1)
    try:
        after = opened(folder)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
    assert (after.version, after.hashed) == (before.version, before.hashed)


@pytest.mark.parametrize(
    "enlarge",
    [
        lambda folder: [(folder / f"{number}.dat").touch() for number in range(module.MOST_FILES)],
        lambda folder: os.truncate(folder / "solver", module.MOST_BYTES),
        lambda folder: folder.chmod(0o1777),  # the folder for temporary files
    ],
)
def test_of_a_large_or_shared_folder_what_is_imported_or_declared_counts(folder, write_model, enlarge):
    enlarge(folder)
    write_model(f"import late\n{GOOD}", more="import late")
    before = opened(folder)
    assert "the imported modules in" in before.hashed
    (folder / "table.csv").write_text("1.6")
    assert opened(folder).version == before.version
    (folder / "late.py").write_text("VALUE = 1.0\n")
    assert opened(folder).version != before.version
    write_model(more='files = ("table.csv", "data/")')
    versions = [opened(folder).version]
    for changed in ("table.csv", "data/points.npy"):
        (folder / changed).write_text("1.7")
        versions.append(opened(folder).version)
    assert len(set(versions)) == 3


def test_a_declared_file_counts_where_others_do_not(folder, write_model):
    (folder / "results").mkdir()
    (folder / "results" / "fit.csv").write_text("1")
    write_model(more='files = ("results/fit.csv",)')
    before = opened(folder).version
    (folder / "results" / "fit.csv").write_text("2")
    assert opened(folder).version != before


@pytest.mark.parametrize("files", ['"table.csv"', "(1,)", '("tabel.csv",)', '("/etc/passwd",)', '("a\\0b",)'])
def test_wrong_names_of_files_are_refused_in_one_sentence(write_model, capsys, files):
    assert main(["solve", "--model", write_model(more=f"files = {files}"), *FORCE]) == 2
    message = capsys.readouterr().err
    assert "files" in message
    assert message.count("\n") == 1


def test_a_file_may_have_the_name_of_a_module_of_python(folder, write_model):
    spec = write_model(name="statistics")
    before = opened(spec).version
    (folder / "table.csv").write_text("2")
    assert opened(spec).version != before


@pytest.fixture
def site(tmp_path, monkeypatch):
    """An installed package with a table in it, and a module of another package beside it."""
    site = tmp_path / "site-packages"
    for name, text in {
        "stranger/__init__.py": "",
        "stranger/table.csv": "1.5",
        "stranger/model.py": "class Model:\n"
        '    name, version, citation, domain = "stranger", "1", "none", "tests"\n'
        "    def evaluate(self, problem, quantity): ...\n",
        "other.py": "",
        "stranger-1.dist-info/METADATA": "Metadata-Version: 2.1\nName: stranger\nVersion: 1\n",
        "stranger-1.dist-info/entry_points.txt": f"[{GROUP}]\nstranger = stranger.model:Model\n",
    }.items():
        (site / name).parent.mkdir(parents=True, exist_ok=True)
        (site / name).write_text(text)
    monkeypatch.syspath_prepend(site)
    return site


def test_every_file_of_an_installed_package_counts_and_none_beside_it(site):
    before = opened("stranger").version
    (site / "other.py").write_text("x = 1")
    assert opened("stranger").version == before
    (site / "stranger" / "table.csv").write_text("1.6")
    assert opened("stranger").version != before


def test_of_a_single_installed_module_what_its_package_lists_counts(site):
    """A distribution of modules without a package: its record lists its files."""
    (site / "stranger" / "model.py").rename(site / "model.py")
    (site / "table.csv").write_text("1")
    (site / "stranger-1.dist-info" / "entry_points.txt").write_text(f"[{GROUP}]\nstranger = model:Model\n")
    (site / "stranger-1.dist-info" / "RECORD").write_text("model.py,,\ntable.csv,,\nstranger-1.dist-info/METADATA,,\n")
    before = opened("stranger")
    assert "2 files" in before.hashed
    (site / "other.py").write_text("x = 1")
    assert opened("stranger").version == before.version
    (site / "table.csv").write_text("2")
    assert opened("stranger").version != before.version


def test_what_was_hashed_is_passed_on(folder):
    spec = f"{folder / 'stranger.py'}:Model"
    _, external = identify([spec, "jkr"])
    assert external["stranger"].hashed == create(spec).hashed


def test_a_class_of_this_program_or_of_python_has_no_files():
    assert module.fingerprint(module.roots_of(["json", "comparisons.model"]))[1].startswith("nothing")
