"""Where numbers come from: versions, commit, machine.

The commit is only stated when the code that runs is, byte for byte, the code in a git work tree: beside the
packages (an editable install or a clone) or where pip installed them from.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution, requires, version
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from urllib.request import url2pathname

from threadpoolctl import threadpool_info

__all__ = ["code_digest", "environment", "package_version"]

DISTRIBUTION = "fscm-bench"
_PACKAGES = ("fscm", "fem_reference", "comparisons")


def package_version() -> str:
    """Return the version of the installed distribution, ``"not installed"`` when run from a bare clone."""
    try:
        return version(DISTRIBUTION)
    except PackageNotFoundError:
        return "not installed"


def code_digest(root: Path | None = None) -> str:
    """Return the SHA-256 of the packages' Python and TOML files under `root` (by default, those that run)."""
    root = root or _running_root()
    digest = hashlib.sha256()
    for package in _PACKAGES:
        for path in sorted((root / package).rglob("*")):
            if path.suffix in {".py", ".toml"}:
                digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()


def environment() -> dict[str, Any]:
    """Return what a reader needs to know of code and machine, ready for JSON."""
    return {
        "package": {
            "name": DISTRIBUTION,
            "version": package_version(),
            "code_sha256": code_digest(),
            **_commit(),
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
    return Path(__file__).resolve().parent.parent


def _commit() -> dict[str, Any]:
    digest = code_digest()
    for root in filter(None, (_running_root(), _installed_from())):
        if (root / ".git").exists() and code_digest(root) == digest:
            commit, status = _git(root, "rev-parse", "HEAD"), _git(root, "status", "--porcelain", *_PACKAGES)
            if commit is not None and status is not None:
                return {"commit": commit, "dirty": bool(status)}
    return {"commit": None, "dirty": None}


def _installed_from() -> Path | None:
    try:
        record = distribution(DISTRIBUTION).read_text("direct_url.json")
    except PackageNotFoundError:
        return None
    url = urlsplit(json.loads(record)["url"]) if record else None
    return Path(url2pathname(url.path)) if url and url.scheme == "file" else None


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
