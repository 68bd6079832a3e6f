"""What has been computed, a line of JSON each, on disk as soon as it exists.

An interrupted command loses nothing that was finished: given the same folder, it goes on from its journal.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Generic, TypeVar

from filelock import FileLock, Timeout

from comparisons.store import writing

__all__ = ["Journal", "alone_in"]

_Entry = TypeVar("_Entry")


class Journal(Generic[_Entry]):
    """Entries that are kept in a file; those it has are read when it is opened.

    Parameters
    ----------
    path : Path
        The file; made when it does not exist.
    fingerprint : str
        Identifies the code.  A journal of another fingerprint is refused: its entries may differ.
    read, write : callable
        Make an entry of what JSON holds (a dictionary), and the other way round.

    Attributes
    ----------
    path : Path
    entries : list
        In the order in which they were added.

    Raises
    ------
    ValueError
        If the file is not a journal, or one of another fingerprint.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     Journal(Path(folder, "journal.jsonl"), "code", dict, dict).add({"n": 2})
    ...     Journal(Path(folder, "journal.jsonl"), "code", dict, dict).entries
    [{'n': 2}]
    """

    def __init__(
        self,
        path: Path,
        fingerprint: str,
        read: Callable[[dict[str, Any]], _Entry],
        write: Callable[[_Entry], dict[str, Any]],
    ) -> None:
        self.path = path
        self.entries: list[_Entry] = []
        self._write = write
        header = self._read(read) if path.exists() else None
        if header is None:
            path.unlink(missing_ok=True)
            self._append({"fingerprint": fingerprint})
        elif header != {"fingerprint": fingerprint}:
            raise ValueError(f"{path.parent} holds results of another version of the code; choose another --out")

    def _read(self, read: Callable[[dict[str, Any]], _Entry]) -> dict[str, Any] | None:
        """Read the entries and return the first line, or None if it was never finished."""
        text = self.path.read_text(encoding="utf-8")
        # A line without its end was being written when the command was stopped: what it says is computed again.
        whole, end, torn = text.rpartition("\n")
        if not end:
            return None
        try:
            header, *lines = [json.loads(line) for line in whole.splitlines()]
            if not (isinstance(header, dict) and header.keys() == {"fingerprint"}):
                raise ValueError("the first line is not that of a journal")
            self.entries = [read(line) for line in lines]
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            raise ValueError(f"{self.path} is not a journal; choose another folder with --out") from None
        if torn:
            os.truncate(self.path, len(f"{whole}{end}".encode()))
        return header

    def _append(self, content: dict[str, Any]) -> None:
        line = json.dumps(content, allow_nan=False) + "\n"
        with writing(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(line)

    def add(self, entry: _Entry) -> None:
        """Keep an entry.

        Raises
        ------
        ValueError
            If JSON cannot hold it, as one with a NaN.
        """
        self._append(self._write(entry))
        self.entries.append(entry)


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other processes from computing into a folder: two would write the same entries twice.

    Raises
    ------
    ValueError
        If another process is.
    OSError
        If the folder's file `.lock` cannot be opened, as that of another user; one sentence says why.
    """
    path = folder / ".lock"
    # Not `blocking=False`, which filelock 3.13 does not know; one attempt is the same.
    lock = FileLock(path, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise ValueError(
            f"another process is computing into {folder}: wait for it, or choose another folder with --out"
        ) from None
    except (OSError, NotImplementedError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise OSError(
            f"the file {path}, which keeps two processes from computing into one folder, cannot be locked ({reason}); "
            "choose another folder with --out"
        ) from error
    try:
        yield
    finally:
        lock.release()
