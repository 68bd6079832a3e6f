"""Origin of the numbers: versions, commit, machine.

The commit is only stated when the code that runs is, byte for byte, the code in a git work tree: beside the
packages (an editable install or a clone) or where pip installed them from.  If pip installed them from a git address,
the commit is the one that pip recorded.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import platform
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution, requires, version
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

from threadpoolctl import threadpool_info

from comparisons.runs.code_files import NOT_INSTALLED, code_in, files_digest

__all__ = [
    "code_digest",
    "computing_environment",
    "differences",
    "environment",
    "fingerprint",
    "package_version",
    "version_text",
]

DISTRIBUTION = "fscm-bench"
_PACKAGES = ("fscm", "fem_reference", "comparisons")

#: Digits of a commit in the text of the version.
_SHOWN = 12


def package_version() -> str:
    """Return the version of the installed distribution, ``"not installed"`` when run from a bare clone."""
    try:
        return version(DISTRIBUTION)
    except PackageNotFoundError:
        return "not installed"


def version_text() -> str:
    """Return the version, and the commit where it is known: by ``git describe`` in a clone, or as pip recorded it."""
    digest = code_digest()
    found = _commit(digest)
    if found["commit"] is None:
        return package_version()
    described = (_git(root, "describe", "--tags", "--always", f"--abbrev={_SHOWN}") for root in _clones(digest))
    name = next(filter(None, described), found["commit"][:_SHOWN])
    return f"{package_version()} (commit {name}{', with changes' if found['dirty'] else ''})"


def code_digest(root: Path | None = None) -> str:
    """Return the SHA-256 of the packages' Python and TOML files under `root` (by default, those that run).

    The same code has the same digest in a clone and where pip installed it.

    Raises
    ------
    RuntimeError
        If the packages that run are not there: the digest would be that of no file, and equal for every version.
    """
    if root is None:
        root = _running_root()
        if missing := [package for package in _PACKAGES if not (root / package / "__init__.py").is_file()]:
            raise RuntimeError(f"the code of {', '.join(missing)} is not in {root}, so that its digest is unknown")
    not_installed = {root / folder for folder in NOT_INSTALLED}
    paths = [path for package in _PACKAGES for path in code_in(root / package)]
    return files_digest(root, [path for path in paths if not_installed.isdisjoint(path.parents)])


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
    then, today = stored.split(", "), now.split(", ")
    if len(then) != len(today):
        return f"{stored}, now {now}"
    apart = [f"{_short(a)}, now {_short(b)}" for a, b in zip(then, today, strict=True) if a != b]
    return "; ".join(apart)


def _short(text: str) -> str:
    """Keep what tells two digests apart."""
    return re.sub(r"\b([0-9a-f]{12})[0-9a-f]{52}\b", r"\1", text)


def computing_environment() -> dict[str, str]:
    """Return what the numbers of a computation may depend on besides its code, ready for JSON."""
    return {
        "python": sys.version.split()[0],
        "numpy": version("numpy"),
        "scipy": version("scipy"),
        "system": platform.platform(),
        "host": platform.node(),
        "cpu": _cpu(),
    }


def environment() -> dict[str, Any]:
    """Return what a reader needs to know of code and machine, ready for JSON."""
    digest = code_digest()
    return {
        "package": {
            "name": DISTRIBUTION,
            "version": package_version(),
            "code_sha256": digest,
            "fingerprint": fingerprint(digest),
            **_commit(digest),
        },
        "python": sys.version.split()[0],
        "dependencies": _dependencies(),
        "machine": {"system": platform.platform(), "cpu": _cpu(), "cores": os.cpu_count()},
        "blas": [
            {
                "library": library["internal_api"],
                "version": library["version"],
                "threads": library["num_threads"],
            }
            for library in threadpool_info()
            if library["user_api"] == "blas"
        ],
    }


def _running_root() -> Path:
    return Path(__file__).resolve().parents[2]


def _clones(digest: str) -> Iterator[Path]:
    """Yield the git work trees whose code has a digest, which is that of the code that runs."""
    running = _running_root()
    for root in filter(None, (running, _installed_from())):
        if (root / ".git").exists() and (root == running or code_digest(root) == digest):
            yield root


def _commit(digest: str) -> dict[str, Any]:
    """Return the commit of the code of a digest, which is that of the code that runs."""
    for root in _clones(digest):
        commit, status = _git(root, "rev-parse", "HEAD"), _git(root, "status", "--porcelain", *_PACKAGES)
        if commit is not None and status is not None:
            return {"commit": commit, "dirty": bool(status)}
    return _installed_commit() or {"commit": None, "dirty": None}


def _distribution() -> Distribution | None:
    try:
        return distribution(DISTRIBUTION)
    except PackageNotFoundError:
        return None


def _direct_url() -> dict[str, Any]:
    """Return what pip recorded of where it installed the packages from; empty for a package index."""
    installed = _distribution()
    record = installed.read_text("direct_url.json") if installed else None
    return dict(json.loads(record)) if record else {}


def _installed_from() -> Path | None:
    url = urlsplit(_direct_url().get("url", ""))
    return Path(url2pathname(url.path)) if url.scheme == "file" else None


def _installed_commit() -> dict[str, Any] | None:
    """Return the commit that pip installed from a git address, and whether a file was changed after that."""
    source = _direct_url().get("vcs_info", {})
    installed, root = _distribution(), _running_root()
    if source.get("vcs") != "git" or installed is None or Path(str(installed.locate_file(""))).resolve() != root:
        return None
    recorded = {file.as_posix(): file.hash for file in installed.files or []}
    running = [path for package in _PACKAGES for path in code_in(root / package)]
    unchanged = all(_is_recorded(path, recorded.get(path.relative_to(root).as_posix())) for path in running)
    return {"commit": source.get("commit_id"), "dirty": not unchanged}


def _is_recorded(path: Path, stored: Any) -> bool:
    digest = base64.urlsafe_b64encode(hashlib.sha256(path.read_bytes()).digest()).decode().rstrip("=")
    return stored is not None and stored.mode == "sha256" and bool(stored.value == digest)


def _git(root: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def _dependencies() -> dict[str, str]:
    try:
        needed = [line for line in requires(DISTRIBUTION) or [] if "extra ==" not in line]
    except PackageNotFoundError:
        return {}
    names = [re.split(r"[^A-Za-z0-9._-]", line, maxsplit=1)[0] for line in needed]
    return {name: version(name) for name in sorted(names)}


def _cpu() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.machine()
