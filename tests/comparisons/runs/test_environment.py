"""Record of a run and its origin: written and read only if it fits its schema; code, versions and commit."""

import json
import shutil
import subprocess
from importlib.metadata import PathDistribution, version
from pathlib import Path

import pytest

import comparisons
import fem_reference
import fscm
from comparisons.runs import environment as provenance
from comparisons.runs.record import read_record, write_record
from tests.comparisons.records import record_of_run

COMMIT = "0123456789abcdef0123456789abcdef01234567"


def tree(root):
    for package in ("fscm", "fem_reference", "comparisons"):
        (root / package).mkdir(parents=True)
        (root / package / "a.py").write_text("x = 1\n")
    return root


def git(root, *arguments):
    identity = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]
    return subprocess.run(
        ["git", "-C", root, *identity, *arguments], check=True, capture_output=True, text=True
    ).stdout.strip()


def test_the_digest_moves_with_content_and_names_and_nothing_else(tmp_path):
    root = tree(tmp_path)
    before = provenance.code_digest(root)
    (root / "fscm" / "__pycache__").mkdir()
    (root / "fscm" / "__pycache__" / "a.pyc").touch()
    assert provenance.code_digest(root) == before
    (root / "fscm" / "a.py").rename(root / "fscm" / "b.py")
    renamed = provenance.code_digest(root)
    (root / "fscm" / "b.py").write_text("x = 2\n")
    assert len({before, renamed, provenance.code_digest(root)}) == 3


def test_the_record_has_the_digest_of_the_packages_that_run_and_their_dependencies(tmp_path):
    for package in (comparisons, fem_reference, fscm):
        shutil.copytree(Path(package.__file__).parent, tmp_path / package.__name__)
    record = json.loads(json.dumps(provenance.environment(), allow_nan=False))
    assert record["package"]["code_sha256"] == provenance.code_digest(tmp_path)
    assert record["dependencies"]["numpy"] == version("numpy")


@pytest.mark.parametrize("name", ["numpy", "scipy"])
def test_the_fingerprint_has_the_versions_that_numbers_depend_on(monkeypatch, name):
    before = provenance.fingerprint()
    monkeypatch.setattr(provenance, "version", lambda package: "0.0" if package == name else version(package))
    after = provenance.fingerprint()
    assert f"{version(name)}, now " in provenance.differences(before, after)
    assert provenance.differences(before, before) == ""


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """A function that writes what pip records of the source of an installed distribution."""
    root = tree(tmp_path / "site-packages")
    (root / "dist-info").mkdir()
    monkeypatch.setattr(provenance, "_running_root", lambda: root)
    monkeypatch.setattr(provenance, "distribution", lambda name: PathDistribution(root / "dist-info"))
    return lambda **content: (root / "dist-info" / "direct_url.json").write_text(json.dumps(content))


def test_the_commit_of_an_install_from_a_git_address_is_the_one_pip_recorded(installed):
    for source, commit in (({"vcs_info": {"commit_id": COMMIT}}, COMMIT), ({}, None)):
        installed(url="https://example.org/fscm-bench", **source)
        assert provenance._commit() == {"commit": commit, "dirty": None}


def test_the_commit_of_a_clone_is_that_of_its_head_with_or_without_changes(tmp_path, monkeypatch):
    clone = tree(tmp_path / "clone")
    monkeypatch.setattr(provenance, "_running_root", lambda: clone)
    git(clone, "init", "-q")
    git(clone, "add", ".")
    git(clone, "commit", "-q", "-m", "x")
    assert provenance._commit() == {"commit": git(clone, "rev-parse", "HEAD"), "dirty": False}
    (clone / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit()["dirty"]


def test_what_is_written_is_read(tmp_path):
    write_record(record_of_run(), tmp_path / "run.json")
    assert read_record(tmp_path / "run.json") == json.loads(json.dumps(record_of_run())) | {"files": {}}


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"parts": [{"started": "2026-01-01T00:00:00+00:00"}]}, "parts"),
        ({"cases_sha256": "short"}, "cases_sha256"),
        ({"started": "yesterday"}, "started"),
        ({"arguments": {"tier": "quick"}}, "arguments"),
        ({"gates_sha256": None}, "gates_sha256"),
    ],
)
def test_what_does_not_fit_is_neither_written_nor_read(tmp_path, change, named):
    path = tmp_path / "run.json"
    content = {name: value for name, value in (record_of_run() | change).items() if value is not None}
    with pytest.raises(RuntimeError, match=named):
        write_record(content, path)
    assert not path.exists()
    path.write_text(json.dumps({"files": {}, "sha256": "0" * 64} | content))
    with pytest.raises(ValueError, match=named):
        read_record(path)


@pytest.mark.parametrize("text", [None, "{", "[" * 200_000 + "]" * 200_000])
def test_a_folder_that_is_no_run(tmp_path, text):
    if text:
        (tmp_path / "run.json").write_text(text)
    with pytest.raises(ValueError, match=r"run.json (cannot be read|is not the record of a run)"):
        read_record(tmp_path / "run.json")
