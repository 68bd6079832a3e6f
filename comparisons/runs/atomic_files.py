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

__all__ = ["atomic", "prepare_folder", "writable_file", "write_json", "writing"]


def prepare_folder(path: Path) -> Path:
    """Create a folder for results and make sure that files can be written there.

    Raises
    ------
    ValueError
        If it cannot be created or written; the sentence gives the system's reason.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        if full_disk(error):
            raise OSError(f"the output folder {path} cannot be written ({error.strerror})") from error
        raise ValueError(
            f"the output folder {path} cannot be written ({error.strerror}); choose another one with --out"
        ) from None
    return path


def writable_file(path: Path) -> Path:
    """Make sure, before anything is computed, that a file can be written.

    Raises
    ------
    ValueError
        If it cannot; the sentence gives the system's reason.
    """
    if path.is_dir():
        raise ValueError(f"the file {path} cannot be written (it is a folder); choose another place")
    with _explained(path), tempfile.TemporaryFile(dir=path.parent):
        return path


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if full_disk(error):
            raise OSError(f"the file {path} cannot be written ({error.strerror})") from error
        raise ValueError(f"the file {path} cannot be written ({error.strerror}); choose another place") from None


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Name the file in the error of the system when its content cannot be written, as on a full disk.

    Raises
    ------
    OSError
        One sentence with the path and the system's reason.
    """
    try:
        yield
    except OSError as error:
        raise OSError(f"the file {path} cannot be written ({error.strerror or error})") from error


@contextmanager
def atomic(path: Path) -> Iterator[IO[bytes]]:
    """Open a temporary file beside `path` that takes its place only when the block ends without an error.

    Raises
    ------
    ValueError
        If the file cannot be written there; the sentence gives the system's reason.
    OSError
        If there is no room for its content; the sentence gives the system's reason.
    """
    with _explained(path):
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


def write_json(content: dict[str, Any], path: Path) -> None:
    """Write a JSON object; NaN and infinity are refused."""
    with atomic(path) as file:
        file.write(json.dumps(content, indent=2, allow_nan=False).encode() + b"\n")
