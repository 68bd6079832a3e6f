"""The origin of a run in its record."""

import base64
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
    nothing = provenance.code_digest(tmp_path)
    assert nothing == hashlib.sha256().hexdigest() != provenance.code_digest()
    for package in (comparisons, fem_reference, fscm):
        name = package.__name__
        shutil.copytree(Path(package.__file__).parent, tmp_path / name)
    assert provenance.code_digest(tmp_path) == provenance.code_digest()


def test_code_that_is_not_found_has_no_digest(tmp_path, monkeypatch):
    tree(tmp_path)
    (tmp_path / "fscm" / "__init__.py").unlink()
    monkeypatch.setattr(provenance, "_running_root", lambda: tmp_path)
    with pytest.raises(RuntimeError, match="the code of fscm is not in "):
        provenance.code_digest()


def test_the_commit_is_stated_only_of_the_code_that_runs(tmp_path, monkeypatch):
    clone, installed = tree(tmp_path / "clone"), tree(tmp_path / "installed")
    git(clone, "init", "-q")
    git(clone, "add", ".")
    git(clone, "commit", "-q", "-m", "x")
    monkeypatch.setattr(provenance, "_running_root", lambda: installed)
    monkeypatch.setattr(provenance, "_installed_from", lambda: clone)
    commit = git(clone, "rev-parse", "HEAD")
    assert provenance._commit(provenance.code_digest()) == {"commit": commit, "dirty": False}
    (clone / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit(provenance.code_digest()) == {"commit": None, "dirty": None}
    (installed / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit(provenance.code_digest()) == {"commit": commit, "dirty": True}


def test_the_environment_is_json_and_right():
    record = json.loads(json.dumps(provenance.environment(), allow_nan=False))
    assert record["package"]["code_sha256"] == provenance.code_digest()
    assert record["machine"]["cores"] >= 1
    for name, stated in record["dependencies"].items():
        assert stated == version(name)


def test_the_fingerprint_has_the_versions_that_numbers_depend_on(monkeypatch):
    before = provenance.fingerprint()
    assert provenance.code_digest() in before
    for name in ("numpy", "scipy"):
        with monkeypatch.context() as patch:
            patch.setattr(
                provenance, "version", lambda package, name=name: "0.0" if package == name else version(package)
            )
            assert provenance.fingerprint() != before
            assert f"{version(name)}, now " in provenance.differences(before, provenance.fingerprint())
    assert provenance.differences(before, before) == ""


COMMIT = "0123456789abcdef0123456789abcdef01234567"
URL = "https://example.org/fscm-bench"


def recorded(root):
    for name in ("a.py", "__init__.py"):
        code = (root / "fscm" / name).read_bytes()
        digest = base64.urlsafe_b64encode(hashlib.sha256(code).digest()).decode().rstrip("=")
        yield f"{name},sha256={digest},{len(code)}"


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """An installed distribution as pip makes one, with a function that writes its direct_url.json."""
    root = tree(tmp_path / "site-packages")
    folder = root / "fscm_bench-1.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: fscm-bench\nVersion: 1\n")
    (folder / "RECORD").write_text("".join(f"{package}/{line}\n" for package in PACKAGES for line in recorded(root)))
    monkeypatch.setattr(provenance, "_running_root", lambda: root)
    monkeypatch.setattr(provenance, "distribution", lambda name: PathDistribution(folder))

    def write(**content):
        (folder / "direct_url.json").write_text(json.dumps(content))
        return root

    return write


def test_the_commit_of_an_install_from_a_git_address_is_the_one_pip_recorded(installed):
    root = installed(url=URL, vcs_info={"vcs": "git", "commit_id": COMMIT})
    assert provenance._commit(provenance.code_digest()) == {"commit": COMMIT, "dirty": False}
    (root / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit(provenance.code_digest()) == {"commit": COMMIT, "dirty": True}


@pytest.mark.parametrize("source", [{"archive_info": {}}, {"vcs_info": {"vcs": "hg", "commit_id": COMMIT}}])
def test_no_commit_is_stated_for_other_installs(installed, source):
    installed(url=URL, **source)
    assert provenance._commit(provenance.code_digest()) == {"commit": None, "dirty": None}


def test_no_commit_is_stated_for_code_beside_the_installed(installed, tmp_path, monkeypatch):
    installed(url=URL, vcs_info={"vcs": "git", "commit_id": COMMIT})
    other = tree(tmp_path / "other")
    monkeypatch.setattr(provenance, "_running_root", lambda: other)
    assert provenance._commit(provenance.code_digest()) == {"commit": None, "dirty": None}
