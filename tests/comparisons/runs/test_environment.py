"""The origin of a run in its record."""

import hashlib
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

PACKAGES = ("fscm", "fem_reference", "comparisons")


def tree(root):
    for package in PACKAGES:
        (root / package).mkdir(parents=True)
        (root / package / "__init__.py").touch()
        (root / package / "a.py").write_text("x = 1\n")
    return root


def git(root, *arguments):
    who = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]
    return subprocess.run(
        ["git", "-C", root, *who, *arguments], check=True, capture_output=True, text=True
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


def test_the_digest_is_that_of_the_three_packages_that_run(tmp_path):
    assert provenance.code_digest() != provenance.code_digest(tmp_path) == hashlib.sha256().hexdigest()
    for package in (comparisons, fem_reference, fscm):
        shutil.copytree(Path(package.__file__).parent, tmp_path / package.__name__)
    assert provenance.code_digest(tmp_path) == provenance.code_digest()


def test_the_environment_is_json_and_right():
    record = json.loads(json.dumps(provenance.environment(), allow_nan=False))
    assert record["package"]["code_sha256"] == provenance.code_digest()
    assert record["machine"]["cores"] >= 1
    for name, stated in record["dependencies"].items():
        assert stated == version(name)


def test_the_fingerprint_has_the_versions_that_numbers_depend_on(monkeypatch):
    before = provenance.fingerprint()
    for name in ("numpy", "scipy"):
        with monkeypatch.context() as patch:
            patch.setattr(
                provenance, "version", lambda package, name=name: "0.0" if package == name else version(package)
            )
            assert f"{version(name)}, now " in provenance.differences(before, provenance.fingerprint())
    assert provenance.differences(before, before) == ""


COMMIT = "0123456789abcdef0123456789abcdef01234567"
UNKNOWN = {"commit": None, "dirty": None}


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """An installed distribution, and a function that writes what pip records of its source."""
    root = tree(tmp_path / "site-packages")
    folder = root / "fscm_bench-1.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: fscm-bench\nVersion: 1\n")
    monkeypatch.setattr(provenance, "_running_root", lambda: root)
    monkeypatch.setattr(provenance, "distribution", lambda name: PathDistribution(folder))
    return lambda **content: (folder / "direct_url.json").write_text(json.dumps(content)) and root


@pytest.mark.parametrize(
    ("source", "commit"), [({"vcs_info": {"vcs": "git", "commit_id": COMMIT}}, COMMIT), ({"archive_info": {}}, None)]
)
def test_the_commit_of_an_install_from_a_git_address_is_the_one_pip_recorded(installed, source, commit):
    installed(url="https://example.org/fscm-bench", **source)
    assert provenance._commit() == {"commit": commit, "dirty": None}


def test_the_commit_of_a_clone_is_stated_only_of_the_code_that_runs(installed, tmp_path, monkeypatch):
    clone = tree(tmp_path / "clone")
    monkeypatch.setattr(provenance, "code_digest", lambda root=None: (root or tmp_path / "site-packages").name)
    installed(url=clone.as_uri(), dir_info={})
    git(clone, "init", "-q")
    git(clone, "add", ".")
    git(clone, "commit", "-q", "-m", "x")
    assert provenance._commit() == UNKNOWN
    monkeypatch.setattr(provenance, "code_digest", lambda root=None: "the same")
    commit = git(clone, "rev-parse", "HEAD")
    assert provenance._commit() == {"commit": commit, "dirty": False}
    (clone / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit() == {"commit": commit, "dirty": True}
