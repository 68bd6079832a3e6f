"""Origin of the numbers: versions, commit, machine.

The commit is that of the clone that runs, or the one that pip recorded of an install from a git address.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import re
import subprocess
from collections.abc import Mapping
from importlib.metadata import distribution, requires, version
from itertools import zip_longest
from pathlib import Path
from typing import Any

DISTRIBUTION = "fscm-bench"
_PACKAGES = ("fscm", "fem_reference", "comparisons")

#: Suffixes of the files that numbers depend on.
_CODE = {".py", ".toml"}

#: Folders that are not installed, or elsewhere.
NOT_INSTALLED = tuple(Path("comparisons", name) for name in ("pytest_entry", "start_entry"))

#: Digits of a commit or digest in a text, as Git shortens them.
DIGITS = 12


def version_text() -> str:
    """Return the version, and the commit where it is known."""
    return version_of({"version": version(DISTRIBUTION), **_commit()})


def version_of(package: Mapping[str, Any]) -> str:
    """Return the version that a record states, and the commit where it is known.

    Examples
    --------
    >>> version_of({"version": "0.1.0", "commit": "0123456789abcdef", "dirty": True})
    '0.1.0 (commit 0123456789ab, with changes)'
    """
    if not package.get("commit"):
        return str(package["version"])
    changes = ", with changes" if package.get("dirty") else ""
    return f"{package['version']} (commit {package['commit'][:DIGITS]}{changes})"


def code_digest(root: Path | None = None) -> str:
    """Return the SHA-256 of the packages' Python and TOML files under `root` (by default, those that run).

    The same code has the same digest in a clone and where pip installed it.
    """
    root = root or _running_root()
    not_installed = {root / folder for folder in NOT_INSTALLED}
    digest = hashlib.sha256()
    paths = [path for package in _PACKAGES for path in (root / package).rglob("*") if path.suffix in _CODE]
    for path in sorted(paths):
        if not_installed.isdisjoint(path.parents):
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def fingerprint(digest: str | None = None) -> str:
    """Return what identifies the code that computes: the packages' files, and the versions of NumPy and SciPy.

    Parameters
    ----------
    digest : str, optional
        That of `code_digest`, where it is known.

    Examples
    --------
    >>> [part.split()[0] for part in fingerprint().split(", ")]
    ['code', 'NumPy', 'SciPy']
    """
    return f"code {digest or code_digest()}, NumPy {version('numpy')}, SciPy {version('scipy')}"


def differences(stored: str, now: str) -> str:
    """Return what differs between two fingerprints, in words.

    Examples
    --------
    >>> differences("code 123, NumPy 2.2, SciPy 1.16", "code 123, NumPy 2.3, SciPy 1.16")
    'NumPy 2.2, now NumPy 2.3'
    """
    before, after = (re.sub(r"\b([0-9a-f]{12})[0-9a-f]{52}\b", r"\1", text).split(", ") for text in (stored, now))
    return "; ".join(f"{a}, now {b}" for a, b in zip_longest(before, after) if a != b)


def computing_environment() -> dict[str, str]:
    """Return what the numbers of a computation may depend on besides its code, ready for JSON."""
    return {
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "scipy": version("scipy"),
        "system": platform.platform(),
        "host": platform.node(),
        "cpu": _cpu(),
    }


def environment() -> dict[str, Any]:
    """Return what a reader needs to know of code and machine, ready for JSON."""
    digest = code_digest()
    code = {"version": version(DISTRIBUTION), "code_sha256": digest, "fingerprint": fingerprint(digest)}
    return {
        "package": {"name": DISTRIBUTION, **code, **_commit()},
        "dependencies": _dependencies(),
        "machine": {**computing_environment(), "cores": os.cpu_count()},
    }


def _running_root() -> Path:
    return Path(__file__).resolve().parents[2]


def _commit() -> dict[str, Any]:
    """Return the commit of the code that runs, and whether a file was changed after it (None: not known)."""
    root = _running_root()
    if (root / ".git").exists():
        commit, status = _git(root, "rev-parse", "HEAD"), _git(root, "status", "--porcelain", *_PACKAGES)
        return {"commit": commit, "dirty": None if status is None else bool(status)}
    recorded = json.loads(distribution(DISTRIBUTION).read_text("direct_url.json") or "{}")
    return {"commit": recorded.get("vcs_info", {}).get("commit_id"), "dirty": None}


def _git(root: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", root, *arguments], capture_output=True, encoding="utf-8", check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def _dependencies() -> dict[str, str]:
    needed = [line for line in requires(DISTRIBUTION) or [] if "extra ==" not in line]
    names = [re.split(r"[^A-Za-z0-9._-]", line, maxsplit=1)[0] for line in needed]
    return {name: version(name) for name in sorted(names)}


def _cpu() -> str:
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        text = ""
    model = re.search(r"^model name\s*: (.+)$", text, re.MULTILINE)
    return model[1] if model else platform.processor() or platform.machine()
