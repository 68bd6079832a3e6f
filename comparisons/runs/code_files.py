"""Files of code that numbers depend on, and their digest."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

__all__ = ["CODE", "NOT_INSTALLED", "code_in", "files_digest"]

#: Suffixes of the files that numbers depend on.
CODE = {".py", ".toml"}

#: Folders that are not installed, or elsewhere.
NOT_INSTALLED = tuple(Path("comparisons", name) for name in ("build_step", "pytest_entry", "start_entry"))


def code_in(folder: Path) -> list[Path]:
    """Return the Python and TOML files of a folder and of those in it, sorted; no link to a folder is followed.

    Examples
    --------
    >>> [path.name for path in code_in(Path(__file__).parents[1]) if path.name.startswith("code_")]
    ['code_files.py']
    """
    # Not `rglob`, which makes a path of every file that Python compiled.
    return sorted(
        Path(where, name) for where, _, names in os.walk(folder) for name in names if os.path.splitext(name)[1] in CODE
    )


def files_digest(root: Path, paths: Iterable[Path]) -> str:
    """Return the SHA-256 of the names, relative to `root`, and the contents of the Python and TOML files of `paths`."""
    digest = hashlib.sha256()
    for path in paths:
        if path.suffix in CODE:
            digest.update(f"{path.relative_to(root).as_posix()}\0".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
