"""What a run says of its origin is true."""

import json
import subprocess
from importlib.metadata import version

from comparisons import provenance

PACKAGES = ("fscm", "fem_reference", "comparisons")


def tree(root):
    for package in PACKAGES:
        (root / package).mkdir(parents=True)
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


def test_the_commit_is_stated_only_of_the_code_that_runs(tmp_path, monkeypatch):
    clone, installed = tree(tmp_path / "clone"), tree(tmp_path / "installed")
    git(clone, "init", "-q")
    git(clone, "add", ".")
    git(clone, "commit", "-q", "-m", "x")
    monkeypatch.setattr(provenance, "_running_root", lambda: installed)
    monkeypatch.setattr(provenance, "_installed_from", lambda: clone)
    commit = git(clone, "rev-parse", "HEAD")
    assert provenance._commit() == {"commit": commit, "dirty": False}
    (clone / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit() == {"commit": None, "dirty": None}
    (installed / "fscm" / "a.py").write_text("x = 2\n")
    assert provenance._commit() == {"commit": commit, "dirty": True}


def test_the_environment_is_json_and_right():
    record = json.loads(json.dumps(provenance.environment(), allow_nan=False))
    assert record["package"]["code_sha256"] == provenance.code_digest()
    assert record["machine"]["cores"] >= 1
    for name, stated in record["dependencies"].items():
        assert stated == version(name)
