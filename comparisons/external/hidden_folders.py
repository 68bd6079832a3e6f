"""Folders that the process of a model cannot read: those of the runs that judge it, with the results of the references.

An environment variable holds them, so that they reach every process of a run.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_VARIABLE = "FSCM_BENCH_HIDDEN_FOLDERS"


def hidden_folders() -> list[str]:
    """Return the folders that models cannot read now.

    Examples
    --------
    >>> with hidden_from_models(Path("/results")), hidden_from_models(Path("/results/mine")):
    ...     hidden_folders()
    ['/results']
    """
    folders: list[str] = json.loads(os.environ.get(_VARIABLE, "[]"))
    return folders


@contextmanager
def hidden_from_models(folder: Path) -> Iterator[None]:
    """Hide a folder, which need not exist yet, from the models whose processes start within the block."""
    path, before = os.path.realpath(folder), os.environ.get(_VARIABLE)
    folders = hidden_folders()
    if not any(is_inside(path, other) for other in folders):
        os.environ[_VARIABLE] = json.dumps([*folders, path])
    try:
        yield
    finally:
        if before is None:
            os.environ.pop(_VARIABLE, None)
        else:
            os.environ[_VARIABLE] = before


def is_inside(path: str, folder: str) -> bool:
    """Whether an absolute path is a folder or in it.

    Examples
    --------
    >>> is_inside("/a/b", "/a"), is_inside("/ab", "/a")
    (True, False)
    """
    return os.path.commonpath([path, folder]) == folder
