"""Atomic writing of files, and checks before anything is computed that they can be written."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from comparisons.console.exit_status import full_disk

_ELSEWHERE = "choose another place"


@contextmanager
def writing(path: Path, kind: str = "file", remedy: str = "") -> Iterator[None]:
    """Name a file or a folder in the error of the system when it cannot be written.

    Parameters
    ----------
    path : Path
    kind : str
        What it is, for the sentence.
    remedy : str
        What a user can do unless the disk is full; empty where nothing but room helps.

    Raises
    ------
    OSError
        One sentence with the path and the system's reason.
    ValueError
        The same with the remedy, if there is one and the disk has room.
    """
    try:
        yield
    except OSError as error:
        sentence = f"the {kind} {path} cannot be written ({error.strerror or error})"
        if remedy and not full_disk(error):
            raise ValueError(f"{sentence}; {remedy}") from None
        raise OSError(sentence) from error


def prepare_folder(path: Path) -> Path:
    """Create a folder for results and make sure that files can be written there.

    Raises
    ------
    ValueError, OSError
        As `writing`, if it cannot be created or written.
    """
    with writing(path, "output folder", "choose another one with --out"):
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            return path


def writable_file(path: Path) -> Path:
    """Make sure, before anything is computed, that a file can be written.

    Raises
    ------
    ValueError, OSError
        As `writing`, if it cannot, or if it is a folder, a device or a pipe.
    """
    _refuse_other_than_file(path)
    with writing(path, remedy=_ELSEWHERE), tempfile.TemporaryFile(dir=path.parent):
        return path


def _refuse_other_than_file(path: Path) -> None:
    """A new file takes the place of what has the name: the null device of a system, too, where one may write there."""
    if path.exists() and not path.is_file():
        what = "a folder" if path.is_dir() else "a device or a pipe"
        raise ValueError(f"the file {path} cannot be written (it is {what}); {_ELSEWHERE}")


@contextmanager
def atomic(path: Path) -> Iterator[IO[bytes]]:
    """Open a temporary file beside `path` that takes its place only when the block ends without an error.

    Raises
    ------
    ValueError, OSError
        As `writing`, if the file cannot be written there, or there is no room for its content; or if there is a
        folder, a device or a pipe.
    """
    _refuse_other_than_file(path)
    with writing(path, remedy=_ELSEWHERE):
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with writing(path):
            with os.fdopen(handle, "wb") as file:
                yield file
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_file(path: Path, content: str | bytes) -> None:
    """Write a text in UTF-8, or bytes, as `atomic`."""
    with atomic(path) as file:
        file.write(content.encode() if isinstance(content, str) else content)


def write_json(content: dict[str, Any], path: Path) -> None:
    """Write a JSON object; NaN and infinity are refused."""
    write_file(path, json.dumps(content, indent=2, allow_nan=False) + "\n")
