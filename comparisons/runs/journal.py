"""Journal of finished computations: a file with a line of JSON for each, written as soon as it exists.

An interrupted command loses nothing that was finished: with the same folder it continues from its journal.  Every line
has a checksum; a damaged line is dropped and what it held is computed again.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from typing import Any, Generic, TypeVar

from filelock import FileLock, Timeout

from comparisons.console.progress import log
from comparisons.data.contained_paths import refuse_link
from comparisons.data.input_files import LARGEST_ROWS, read_bytes
from comparisons.runs.atomic_files import atomic, writing
from comparisons.runs.environment import differences
from comparisons.runs.folder import RunFolder

__all__ = ["Journal", "alone_in"]

_Entry = TypeVar("_Entry")

#: Hexadecimal digits of the SHA-256 of a line that are kept: 64 bits.
_DIGITS = 16


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
        self._fingerprint = fingerprint
        self._write = write
        refuse_link(path)
        if not (path.exists() and self._read(read)):
            path.unlink(missing_ok=True)
            self._append(self._first_line())

    def _first_line(self) -> str:
        return _line("fingerprint", self._fingerprint, "")

    def _read(self, read: Callable[[dict[str, Any]], _Entry]) -> bool:
        """Read the entries; return False if the first line was never finished."""
        # A line without its end was being written when the command was stopped: what it holds is computed again.
        whole, end, torn = read_bytes(self.path, LARGEST_ROWS).rpartition(b"\n")
        if not end:
            return False
        first, *lines = whole.split(b"\n")
        stored = _content(first, "fingerprint", "")
        if stored not in (None, self._fingerprint):
            raise ValueError(
                f"{self.path.parent} holds results of another version of the code, of NumPy or of SciPy "
                f"({differences(str(stored), self._fingerprint)}); choose another --out"
            )
        found = [_content(line, "entry", self._fingerprint) for line in lines]
        # The checksum of an entry covers the fingerprint: one good entry is enough if the first line is damaged.
        if stored is None and all(content is None for content in found):
            raise ValueError(f"{self.path} is not a journal of this version, or it is damaged; choose another --out")
        try:
            self.entries = [read(content) for content in found if content is not None]
        except (ValueError, TypeError, KeyError, AttributeError):
            raise ValueError(f"{self.path} is not a journal; choose another folder with --out") from None
        damaged = [stored, *found].count(None)
        if damaged:
            log(f"{self.path} has damaged lines ({damaged}): they are dropped, and what they held is computed again")
            self._write_again()
        elif torn:
            os.truncate(self.path, len(whole + end))
        return True

    def _write_again(self) -> None:
        lines = [self._first_line(), *(self._entry_line(entry) for entry in self.entries)]
        with atomic(self.path) as file:
            file.write("".join(lines).encode())

    def _entry_line(self, entry: _Entry) -> str:
        return _line("entry", self._write(entry), self._fingerprint)

    def _append(self, line: str) -> None:
        with writing(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(line)

    def add(self, entry: _Entry) -> None:
        """Keep an entry.

        Raises
        ------
        ValueError
            If JSON cannot hold it, as one with a NaN.
        """
        self._append(self._entry_line(entry))
        self.entries.append(entry)

    def drop(self, unwanted: Callable[[_Entry], bool]) -> int:
        """Remove entries, also from the file; return how many."""
        kept = [entry for entry in self.entries if not unwanted(entry)]
        dropped = len(self.entries) - len(kept)
        if dropped:
            self.entries = kept
            self._write_again()
        return dropped


def _line(name: str, content: Any, fingerprint: str) -> str:
    return json.dumps({name: content, "sha256": _checksum(content, fingerprint)}, allow_nan=False) + "\n"


def _checksum(content: Any, fingerprint: str) -> str:
    text = json.dumps(content, allow_nan=False)
    return sha256(f"{fingerprint}\n{text}".encode()).hexdigest()[:_DIGITS]


def _content(line: bytes, name: str, fingerprint: str) -> Any | None:
    """Return what a line holds, or None if it is not as it was written."""
    try:
        parsed = json.loads(line)
        if isinstance(parsed, dict) and parsed.keys() == {name, "sha256"}:
            return parsed[name] if parsed["sha256"] == _checksum(parsed[name], fingerprint) else None
    except (ValueError, RecursionError):
        pass
    return None


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other processes from computing into a folder: two would write the same entries twice.

    Raises
    ------
    ValueError
        If another process is.
    OSError
        If the lock file of the folder cannot be opened, as that of another user; one sentence gives the reason.
    """
    path = RunFolder(folder).lock
    refuse_link(path)
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
