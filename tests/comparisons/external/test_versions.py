"""Version of a model: changed by every file that its numbers depend on; rows of another version are never used."""

import os

import pytest

from comparisons.cli.main import main
from comparisons.external.fingerprint import MOST_BYTES, MOST_FILES, fingerprint
from comparisons.external.model_source import close_models
from comparisons.registry import create
from comparisons.runs.csv_format import read_table
from comparisons.runs.record import read_record

from .conftest import GATE, GOOD, row_of


@pytest.fixture
def folder(tmp_path, write_model):
    """A folder with a model, a table, a module that is imported late, and a program beside them."""
    (tmp_path / "table.csv").write_text("1.5")
    (tmp_path / "late.py").write_text("VALUE = 0.0\n")
    (tmp_path / "solver").write_bytes(b"\x7fELF\x00")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "points.npy").write_bytes(b"\x93NUMPY")
    write_model()
    return tmp_path


def hashed(folder, *declared):
    """Digest and words of the files of the model in the folder, which has imported the module beside it."""
    return fingerprint({folder: folder / "stranger.py"}, declared, [folder / "late.py"])


def change(file):
    with file.open("ab") as stream:
        stream.write(b"\n#")


def test_every_file_of_a_small_folder_counts(folder):
    versions = [hashed(folder)[0]]
    assert hashed(folder)[1].startswith("all files in")
    assert "; 5 files" in hashed(folder)[1]
    # A folder of the last two names would not count.
    for name in ("late.py", "solver", "data/points.npy", "stranger.py", "new.dat", "results", "data/site-packages"):
        change(folder / name)
        versions.append(hashed(folder)[0])
    assert len({*versions}) == 8


#: What is beside a model without being its own.
OTHERS = (
    *("venv/pyvenv.cfg", "old/run.json", "old/kappa.csv", ".hidden", "stranger.pyc", "run.log", "stranger.py~"),
    *(f"{name}/file" for name in (".git", "__pycache__", "results", "stranger.egg-info", "fscm-bench-abc_1234")),
)


def test_what_a_run_an_editor_or_git_writes_does_not_count(folder):
    before = hashed(folder)
    for name in OTHERS:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    (folder / "link").symlink_to(folder)
    os.mkfifo(folder / "pipe")
    # As in ``fscm-bench run --model stranger.py:Model > output.txt``.
    stdout = os.dup(1)
    with (folder / "output.txt").open("w") as file:
        os.dup2(file.fileno(), 1)
    try:
        after = hashed(folder)
    finally:
        os.dup2(stdout, 1)
        os.close(stdout)
    assert after == before


@pytest.mark.parametrize(
    "enlarge",
    [
        lambda folder: [(folder / f"{number}.dat").touch() for number in range(MOST_FILES)],
        lambda folder: os.truncate(folder / "solver", MOST_BYTES),
        lambda folder: folder.chmod(0o1777),  # the folder for temporary files
    ],
)
def test_of_a_large_or_shared_folder_what_is_imported_or_declared_counts(folder, enlarge):
    enlarge(folder)
    (folder / "results").mkdir()
    (folder / "results" / "fit.csv").write_text("1")
    declared = ("table.csv", "data/", "results/fit.csv")
    before, of_declared = hashed(folder), [hashed(folder, *declared)[0]]
    assert "the imported modules in" in before[1]
    for name in ("table.csv", "data/points.npy", "results/fit.csv"):
        change(folder / name)
        assert hashed(folder) == before
        of_declared.append(hashed(folder, *declared)[0])
    assert len({*of_declared}) == 4
    change(folder / "late.py")
    assert hashed(folder) != before


def test_what_has_no_end_or_leads_out_of_a_submission_is_not_read(folder, tmp_path_factory):
    """The size that files of /proc state is 0; on the board a link, or a name with "..", leads to no other file."""
    up = "../" * 20
    size = sum(path.stat().st_size for path in folder.rglob("*.*")) + (folder / "solver").stat().st_size
    assert f"; 6 files, {size} bytes" in hashed(folder, f"{up}proc/version")[1]
    (folder / "pipe").mkdir()
    os.mkfifo(folder / "pipe" / "pipe")
    for name in ("pipe/pipe", f"{up}dev/zero", "\0", "x" * 300):
        with pytest.raises(ValueError, match="no such file or folder"):
            hashed(folder, name)
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "table.csv").touch()
    (folder / "link.csv").symlink_to(elsewhere / "table.csv")
    roots = {folder: folder / "stranger.py"}
    for name in ("link.csv", f"{up}{elsewhere}/table.csv", f"{up}etc"):
        with pytest.raises(ValueError, match="leads out of the folder of the submission"):
            fingerprint(roots, [name], within=folder)
    assert fingerprint(roots, ["data/../table.csv", "data"], within=folder)[0]


def test_more_files_than_may_be_declared_are_refused(folder, monkeypatch):
    names = ["table.csv", "solver", "data/points.npy"]
    monkeypatch.setattr("comparisons.external.fingerprint._MOST_DECLARED", 3)
    assert hashed(folder, *names)[0]
    monkeypatch.setattr("comparisons.external.fingerprint._MOST_DECLARED", 2)
    with pytest.raises(ValueError, match="more than 2 files"):
        hashed(folder, *names)


def test_a_folder_of_folders_without_end_is_large(folder, monkeypatch):
    monkeypatch.setattr("comparisons.external.fingerprint._MOST_ENTRIES", 20)
    monkeypatch.setattr("comparisons.external.fingerprint._MOST_DECLARED", 20)
    for number in range(20):
        (folder / "data" / str(number)).mkdir()
    assert "the imported modules in" in hashed(folder)[1]
    with pytest.raises(ValueError, match="more than 20 files"):
        hashed(folder, "data")


def test_a_process_names_what_it_has_imported_and_what_the_model_declares(folder, write_model):
    folder.chmod(0o1777)
    model = create(write_model(f"import late\n{GOOD}", more='import late\nfiles = ("table.csv",)'))
    assert model.hashed.startswith("the imported modules in")
    assert "and 1 declared file; 3 files," in model.hashed
    assert row_of(model).model_version == model.version


INSTALLED = "import other\nclass Model: name = version = citation = domain = 'stranger'; evaluate = max"


@pytest.mark.parametrize(("package", "count"), [("stranger/", 3), ("", 2)])
def test_every_file_that_was_installed_with_a_model_counts_and_none_beside_it(install, package, count):
    """A package, and a distribution of modules without one, whose record lists its files."""
    names = (f"{package}{name}" for name in ("__init__.py", "table.csv", "model.py"))
    files = dict.fromkeys(names, INSTALLED) | {
        "other.py": "",
        "stranger-1.0.dist-info/RECORD": "model.py,,\ntable.csv,,\n",
    }
    install("stranger", f"{package.replace('/', '.')}model:Model", files)
    assert f"; {count} files, {count * len(INSTALLED)} bytes" in create("stranger").hashed


def test_a_process_that_had_to_be_started_again_is_compared_with_the_one_before(write_model, tmp_path):
    by_process = create(
        write_model(f"if problem.mu == 7:\n    os._exit(1)\n{GOOD}", more="version = os.urandom(8).hex()")
    )
    rows = [row_of(by_process, mu) for mu in (1, 7, 1, 1)]
    assert [row.status for row in rows] == ["ok", "failed", "failed", "failed"]
    assert "exit status 1" in rows[1].reason
    assert "name, version or files changed" in rows[2].reason == rows[3].reason
    (tmp_path / "table.csv").write_text("1")
    model = create(write_model(name="other"))
    model.close()
    (tmp_path / "table.csv").write_text("2")
    row = row_of(model)
    assert row.status == "failed"
    assert "files changed" in row.reason


def test_an_old_pass_does_not_stand_when_the_data_have_changed(
    write_model, few_cases, tmp_path, tmp_path_factory, capsys
):
    """The data are not in the folder of the model, whose digest would show the change."""
    out, gates = tmp_path / "out", tmp_path / "gates.toml"
    gates.write_text(GATE)
    data = tmp_path_factory.mktemp("elsewhere") / "data.txt"
    spec = write_model(f"return Result(float(Path({str(data)!r}).read_text()), 0.0)")

    def run_with(text):
        """Exit status, messages, what was evaluated again, and the values."""
        data.write_text(text)
        close_models()
        status = main(["run", "--gates", str(gates), "--jobs", "1", "--out", str(out), "--model", spec, "jkr"])
        again = read_record(out / "run.json").get("evaluated_again", {}).get("stranger")
        table = read_table(out / "results.csv")
        return status, capsys.readouterr().err, again, table.loc[table["model"] == "stranger", "value"].tolist()

    assert run_with("2.0")[2] is None
    status, messages, again, values = run_with("2.5")
    assert (status, again["same"], values) == (1, False, [2.5] * 4)
    assert "stranger has changed" in messages
    # The rows that were not trusted are gone for good.
    _, messages, again, _ = run_with("2.5")
    assert ("0 computations" in messages, again) == (True, {"same": True, "tasks": 3})
    status, messages, _, values = run_with("two")
    assert status == 4
    assert "is failed" in messages
    assert 2.5 not in values
