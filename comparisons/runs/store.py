"""Store of finished computations: an SQLite database in a folder, in which each is as soon as it exists.

An interrupted command loses nothing that was finished: with the same folder it continues from its store.  Every entry
has a checksum; a damaged one is dropped, and what it held is computed again.  One process at a time has the store: it
needs no memory that processes share, so that it works on the disks of a cluster, too.  The folder is locked for longer
(`comparisons.runs.folder_lock`): tables and record follow from the rows.
"""

from __future__ import annotations

import json
import sqlite3
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from shlex import quote
from typing import Any, Generic, TypeVar

from comparisons.console.progress import counting, log
from comparisons.data.contained_paths import refuse_link
from comparisons.data.file_names import STORE
from comparisons.data.input_files import LARGEST_ROWS, check_regular
from comparisons.model import ComputationFailed
from comparisons.runs.environment import computing_environment, differences, fingerprint
from comparisons.runs.folder_lock import refusal
from comparisons.runs.rows import Row

_Item = TypeVar("_Item")

#: A write-ahead log needs no wait for the disk after each entry (0.1 ms in place of 2 to 13 ms), and a loss of power
#: costs the last entries only.  Exclusive: the lock is held until the store is closed, and no memory is shared.
_SETTINGS = ("trusted_schema = OFF", "locking_mode = EXCLUSIVE", "journal_mode = WAL", "synchronous = NORMAL")

_TABLES = (
    "CREATE TABLE IF NOT EXISTS environments (id INTEGER PRIMARY KEY, content TEXT UNIQUE)",
    "CREATE TABLE IF NOT EXISTS items (form TEXT, key TEXT, content TEXT, environment INTEGER, seconds REAL, "
    "sum TEXT, PRIMARY KEY (form, key)) WITHOUT ROWID",
)
_READ = (
    "SELECT items.key, items.content, environments.content, seconds, sum FROM items "
    "LEFT JOIN environments ON environments.id = environment WHERE form = ?"
)
_WRITE = "INSERT OR REPLACE INTO items SELECT ?, ?, ?, (SELECT id FROM environments WHERE content = ?), ?, ?"


@dataclass(frozen=True, slots=True)
class Form(Generic[_Item]):
    """A kind of items: its name, what identifies an item, and how it is read from JSON and written."""

    name: str
    key: Callable[[_Item], Any]
    read: Callable[[Any], _Item]
    write: Callable[[_Item], Any]


@dataclass(frozen=True, slots=True)
class _Entry(Generic[_Item]):
    """An item, the command that computed it (start, code, environment), and when it was finished there."""

    item: _Item
    part: str
    seconds: float


class Store(Generic[_Item]):
    """Finished computations of a folder; those it has are read when it is opened, and no other process can open it.

    A run that is interrupted and resumed has several parts, which may be computed by other interpreters, on other
    machines: each item keeps its own.  A new item replaces one of the same key.

    Parameters
    ----------
    folder : Path
    form : Form
        Of the items.
    code : str, optional
        Identifies the code, by default `fingerprint()`.  A store of other code is refused: its items may differ.

    Raises
    ------
    ValueError
        If another process has the store, the file is no store, or one of other code.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> form = Form("numbers", lambda item: item["n"], dict, dict)
    >>> with TemporaryDirectory() as folder:
    ...     with Store(Path(folder), form, "code") as store:
    ...         store.add({"n": 2})
    ...     with Store(Path(folder), form, "code") as store:
    ...         store.items, [part["computations"] for part in store.parts()]
    ([{'n': 2}], [1])
    """

    def __init__(self, folder: Path, form: Form[_Item], code: str | None = None) -> None:
        self.path = folder / STORE
        self._form = form
        self._code = code or fingerprint()
        started = datetime.now(UTC).isoformat(timespec="seconds")
        self._part = json.dumps({"started": started, "code": self._code, **computing_environment()})
        self._clock = time.perf_counter()
        self._entries: dict[str, _Entry[_Item]] = {}
        with _explained(self.path):
            self._connection = _connected(self.path)
            try:
                self._read()
            except BaseException:
                self._connection.close()
                raise

    def __enter__(self) -> Store[_Item]:
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    @property
    def items(self) -> list[_Item]:
        """The items that are stored."""
        return [entry.item for entry in self._entries.values()]

    def add(self, item: _Item) -> None:
        """Store an item that this command has computed.

        Raises
        ------
        ValueError
            If JSON cannot hold it, as one with a NaN.
        """
        self._write([_Entry(item, self._part, time.perf_counter() - self._clock)], f"; {self._safe()}")

    def copy(self, source: Store[_Item], wanted: Callable[[_Item], bool]) -> None:
        """Store items of another store, with the parts that computed them."""
        self._write([entry for entry in source._entries.values() if wanted(entry.item)], f"; {self._safe()}")

    def drop(self, unwanted: Callable[[_Item], bool]) -> int:
        """Remove items; return how many."""
        keys = [key for key, entry in self._entries.items() if unwanted(entry.item)]
        with _explained(self.path), self._connection:
            self._connection.executemany(
                "DELETE FROM items WHERE form = ? AND key = ?", [(self._form.name, key) for key in keys]
            )
        for key in keys:
            del self._entries[key]
        return len(keys)

    def parts(self, used: Callable[[_Item], bool] = lambda item: True) -> list[dict[str, Any]]:
        """Return the parts that computed the items that are used, in order, as the record of a run holds them."""
        parts: dict[str, dict[str, Any]] = {}
        for entry in sorted(self._entries.values(), key=lambda entry: (entry.part, entry.seconds)):
            if used(entry.item):
                part = parts.setdefault(entry.part, json.loads(entry.part) | {"seconds": 0.0, "computations": 0})
                part["seconds"] = entry.seconds
                part["computations"] += 1
        for part in parts.values():
            del part["code"]
        return sorted(parts.values(), key=lambda part: str(part["started"]))

    def complete(self, description: str, count: int, computed: Generator[_Item]) -> None:
        """Store items as they are computed, with a progress bar.

        Parameters
        ----------
        description : str
            Of the bar.
        count : int
            Number of items.
        computed : generator

        Raises
        ------
        comparisons.model.ComputationFailed
            If the workers cannot compute.
        """
        with self.interruptible(), counting(description, count) as advance, closing(computed):
            for item in computed:
                self.add(item)
                advance()

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Say in one sentence what is safe if a computation is interrupted, or its workers end."""
        try:
            yield
        except KeyboardInterrupt:
            log(self._safe())
            raise
        except BrokenExecutor as failure:
            raise ComputationFailed(f"{failure}; {self._safe()}") from None

    def _safe(self) -> str:
        folder = quote(str(self.path.parent))
        return f"computations that are safe: {len(self._entries)}; go on with --out {folder}"

    def _read(self) -> None:
        lines: list[tuple[str, str, str, float, str]] = []
        try:
            lines.extend(self._connection.execute(_READ, [self._form.name]))
            sound = self._connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        except sqlite3.DatabaseError as error:
            if error.sqlite_errorcode == sqlite3.SQLITE_ERROR:  # tables of another program
                raise
            sound = False
        for key, content, part, seconds, stated in lines:
            if part is None or stated != self._sum(key, content, part, seconds):
                sound = False
                continue
            if (code := json.loads(part)["code"]) != self._code:
                raise ValueError(
                    f"{self.path.parent} holds results of another version of the code, of NumPy or of SciPy "
                    f"({differences(code, self._code)}); choose another --out"
                )
            self._entries[key] = _Entry(self._form.read(json.loads(content)), part, seconds)
        if not sound:
            log(f"{self.path} is damaged: its sound entries ({len(self._entries)}) are used, and others computed again")
            self._write_again()

    def _write_again(self) -> None:
        self._connection.close()
        for path in _files(self.path):
            path.unlink(missing_ok=True)
        self._connection = _connected(self.path)
        self._write(list(self._entries.values()))

    def _write(self, entries: Iterable[_Entry[_Item]], safe: str = "") -> None:
        written = {json.dumps(self._form.key(entry.item), allow_nan=False): entry for entry in entries}
        with _explained(self.path, safe), self._connection:
            for key, entry in written.items():
                content = json.dumps(self._form.write(entry.item), allow_nan=False)
                values = (key, content, entry.part, entry.seconds)
                self._connection.execute("INSERT OR IGNORE INTO environments (content) VALUES (?)", [entry.part])
                self._connection.execute(_WRITE, [self._form.name, *values, self._sum(*values)])
        self._entries |= written

    def _sum(self, *values: str | float) -> str:
        return sha256(repr((self._form.name, *values)).encode()).hexdigest()


def _connected(path: Path) -> sqlite3.Connection:
    for file in _files(path):
        refuse_link(file)
    if path.exists():
        check_regular(path, path.stat(), LARGEST_ROWS)
    connection = sqlite3.connect(path, timeout=0)
    # A damaged text is one whose checksum is wrong.
    connection.text_factory = lambda text: text.decode(errors="replace")
    try:
        for setting in _SETTINGS:
            connection.execute(f"PRAGMA {setting}")
        with connection:
            for table in _TABLES:
                connection.execute(table)
    except BaseException:
        connection.close()
        raise
    return connection


def _files(path: Path) -> list[Path]:
    """Return the files of a database."""
    return [path.with_name(path.name + suffix) for suffix in ("", "-wal", "-journal", "-shm")]


@contextmanager
def _explained(path: Path, safe: str = "") -> Iterator[None]:
    """Say in one sentence why the database cannot be used, and if it is full what is safe."""
    try:
        yield
    except sqlite3.Error as error:
        code = error.sqlite_errorcode & 0xFF
        if code == sqlite3.SQLITE_BUSY:
            raise refusal(path.parent) from None
        if isinstance(error, sqlite3.OperationalError) and code != sqlite3.SQLITE_ERROR:
            raise OSError(f"the file {path} cannot be written ({error}){safe}") from error
        raise ValueError(
            f"{path} is not a store of this version, or it is damaged ({error}); choose another --out"
        ) from None


def rows_in(folder: Path) -> Store[Row]:
    """Return the store of the rows of a folder, as `Store`."""
    return Store(folder, _ROWS)


_ROWS: Form[Row] = Form("rows", lambda row: [*row.key, row.digest], lambda content: Row(**content), asdict)
