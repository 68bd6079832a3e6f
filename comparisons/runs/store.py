"""Store of finished computations: a file with a line of JSON for each, written as soon as it exists.

An interrupted command loses nothing that was finished: with the same folder it continues from its store.  Every line
has a checksum; a damaged line is dropped and what it held is computed again.  A file that is only appended to needs no
locks and no second file, also on the disks of a cluster, and people can read it.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from shlex import quote
from typing import Any, Generic, TypeVar

from filelock import FileLock, Timeout

from comparisons.console.progress import log
from comparisons.data.contained_paths import refuse_link
from comparisons.data.input_files import LARGEST_ROWS, read_bytes
from comparisons.model import ComputationFailed
from comparisons.runs.atomic_files import atomic, writing
from comparisons.runs.environment import computing_environment, differences, fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.rows import Row

__all__ = ["Store", "alone_in", "parts_of", "rows_in"]

_Item = TypeVar("_Item")

#: Hexadecimal digits of the SHA-256 of a line that are kept: 64 bits.
_DIGITS = 16


@dataclass(frozen=True, slots=True)
class _Entry(Generic[_Item]):
    """An item, the start of the command that computed it with the environment, and when it was finished there."""

    item: _Item
    part: dict[str, str]
    seconds: float


class Store(Generic[_Item]):
    """Finished computations that are kept in a file; those it has are read when it is opened.

    A run that is interrupted and resumed has several parts, which may be computed by other interpreters, on other
    machines: each item keeps its own.

    Parameters
    ----------
    path : Path
        The file; made when it does not exist.
    fingerprint : str
        Identifies the code.  A store of another fingerprint is refused: its items may differ.
    read, write : callable
        Make an item of what JSON holds, and the other way round.

    Raises
    ------
    ValueError
        If the file is no store, or one of another fingerprint.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     store = Store(Path(folder, "journal.jsonl"), "code", dict, dict)
    ...     store.add({"n": 2})
    ...     again = Store(Path(folder, "journal.jsonl"), "code", dict, dict)
    >>> again.items, [part["computations"] for part in again.parts()]
    ([{'n': 2}], [1])
    """

    def __init__(
        self, path: Path, fingerprint: str, read: Callable[[Any], _Item], write: Callable[[_Item], Any]
    ) -> None:
        self.path = path
        self._entries: list[_Entry[_Item]] = []
        self._fingerprint = fingerprint
        self._write = write
        self._started = datetime.now(UTC).isoformat(timespec="seconds")
        self._environment = computing_environment()
        self._clock = time.perf_counter()
        refuse_link(path)
        if not (path.exists() and self._read(read)):
            path.unlink(missing_ok=True)
            self._append(self._first_line())

    @property
    def items(self) -> list[_Item]:
        """The items that are stored, in the order in which they were added."""
        return [entry.item for entry in self._entries]

    def add(self, item: _Item, environment: Mapping[str, str] | None = None) -> None:
        """Store an item that this command has computed.

        Parameters
        ----------
        item
        environment : mapping of str to str, optional
            As `comparisons.runs.environment.computing_environment` of the process that computed it; by default of this
            one.

        Raises
        ------
        ValueError
            If JSON cannot hold it, as one with a NaN.
        """
        part = {"started": self._started, **(environment or self._environment)}
        self._keep(_Entry(item, part, time.perf_counter() - self._clock))

    def take(self, other: Store[_Item], wanted: Callable[[_Item], bool]) -> None:
        """Store items of another store, with the parts that computed them."""
        for entry in other._entries:
            if wanted(entry.item):
                self._keep(entry)

    def drop(self, unwanted: Callable[[_Item], bool]) -> int:
        """Remove items, also from the file; return how many."""
        kept = [entry for entry in self._entries if not unwanted(entry.item)]
        dropped = len(self._entries) - len(kept)
        if dropped:
            self._entries = kept
            self._write_again()
        return dropped

    def parts(self, used: Callable[[_Item], bool] = lambda item: True) -> list[dict[str, Any]]:
        """Return the parts that computed the items that are used, in order, as the record of a run holds them."""
        found: dict[tuple[tuple[str, str], ...], dict[str, Any]] = {}
        for entry in self._entries:
            if used(entry.item):
                key = tuple(sorted(entry.part.items()))
                part = found.setdefault(key, entry.part | {"seconds": 0.0, "computations": 0})
                part["seconds"] = max(part["seconds"], entry.seconds)
                part["computations"] += 1
        return sorted(found.values(), key=lambda part: str(part["started"]))

    @contextmanager
    def kept(self) -> Iterator[None]:
        """State in one sentence what is safe if a computation is interrupted, or its workers end.

        Raises
        ------
        comparisons.model.ComputationFailed
            In place of `concurrent.futures.BrokenExecutor`.
        """
        try:
            yield
        except KeyboardInterrupt:
            log(self._safe())
            raise
        except BrokenExecutor as failure:
            raise ComputationFailed(f"{failure}; {self._safe()}") from None

    def _safe(self) -> str:
        folder = quote(str(self.path.parent))
        return f"{len(self._entries)} finished computations are safe; go on with --out {folder}"

    def _first_line(self) -> str:
        return _line("fingerprint", self._fingerprint, "")

    def _read(self, read: Callable[[Any], _Item]) -> bool:
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
            self._entries = [
                _Entry(read(content["item"]), dict(content["part"]), float(content["seconds"]))
                for content in found
                if content is not None
            ]
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
        lines = [self._first_line(), *(self._entry_line(entry) for entry in self._entries)]
        with atomic(self.path) as file:
            file.write("".join(lines).encode())

    def _entry_line(self, entry: _Entry[_Item]) -> str:
        content = {"item": self._write(entry.item), "part": entry.part, "seconds": entry.seconds}
        return _line("entry", content, self._fingerprint)

    def _append(self, line: str) -> None:
        with writing(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(line)

    def _keep(self, entry: _Entry[_Item]) -> None:
        self._append(self._entry_line(entry))
        self._entries.append(entry)


def rows_in(folder: Path) -> Store[Row]:
    """Return the store of the rows of a folder; `ValueError` as `Store`."""
    return Store(RunFolder(folder).journal, fingerprint(), _row, asdict)


def _row(content: dict[str, Any]) -> Row:
    return Row(**content)


def parts_of(store: Store[Row], rows: Iterable[Row]) -> list[dict[str, Any]]:
    """Return the parts that computed rows, in order, as the record of a run holds them."""
    used = {(row.key, row.model_version) for row in rows}
    return store.parts(lambda row: (row.key, row.model_version) in used)


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
