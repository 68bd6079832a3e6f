"""What environment variables state to every process of a run that starts models: folders to hide, and the time left.

Hidden are the folders of the runs that judge a model, with the results of the references.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

#: The hidden folders, and when the time is over, on the clock of the system that all processes have.
_HIDDEN, _END = "FSCM_BENCH_HIDDEN_FOLDERS", "FSCM_BENCH_END_OF_TIME"


def hidden_folders() -> list[str]:
    """Return the folders that models cannot read now.

    Examples
    --------
    >>> with hidden_from_models(Path("/results")), hidden_from_models(Path("/results/mine")):
    ...     hidden_folders()
    ['/results']
    """
    folders: list[str] = json.loads(os.environ.get(_HIDDEN, "[]"))
    return folders


@contextmanager
def hidden_from_models(folder: Path) -> Iterator[None]:
    """Hide a folder, which need not exist yet, from the models whose processes start within the block."""
    path, folders = os.path.realpath(folder), hidden_folders()
    if not any(is_inside(path, other) for other in folders):
        folders.append(path)
    with _variable(_HIDDEN, json.dumps(folders)):
        yield


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Let the models that are evaluated in the block, by any process, have so much time together.

    Examples
    --------
    >>> with at_most(10.0):
    ...     9.0 < seconds_left() <= 10.0
    True
    >>> seconds_left()
    inf
    """
    with _variable(_END, repr(time.monotonic() + seconds)):
        yield


def seconds_left() -> float:
    """Return the time that is left, negative after its end; infinite where it is not limited."""
    end = os.environ.get(_END)
    return math.inf if end is None else float(end) - time.monotonic()


@contextmanager
def _variable(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        del os.environ[name]
        if before is not None:
            os.environ[name] = before


def is_inside(path: str, folder: str) -> bool:
    """Whether an absolute path is a folder or in it.

    Examples
    --------
    >>> is_inside("/a/b", "/a"), is_inside("/ab", "/a")
    (True, False)
    """
    return os.path.commonpath([path, folder]) == folder
