"""Journal of computations, each with the part of the run that made it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Generic, TypeVar

from comparisons.runs.environment import computing_environment
from comparisons.runs.journal import Journal

__all__ = ["PartJournal"]

_Item = TypeVar("_Item")


@dataclass(frozen=True, slots=True)
class _Entry(Generic[_Item]):
    """An item, the start of the command that computed it with the environment, and when it was finished there."""

    item: _Item
    part: dict[str, str]
    seconds: float


class PartJournal(Generic[_Item]):
    """Finished computations that are stored in a file.

    A run that is interrupted and resumed has several parts, which may be computed by other interpreters, on other
    machines: each item keeps its own.

    Parameters
    ----------
    path, fingerprint
        As of `comparisons.runs.journal.Journal`.
    read, write : callable
        Make an item of what JSON holds (a dictionary), and the other way round.

    Raises
    ------
    ValueError
        As `comparisons.runs.journal.Journal`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     journal = PartJournal(Path(folder, "journal.jsonl"), "code", dict, dict)
    ...     journal.add({"n": 2})
    ...     journal.items, [part["computations"] for part in journal.parts()]
    ([{'n': 2}], [1])
    """

    def __init__(
        self,
        path: Path,
        fingerprint: str,
        read: Callable[[dict[str, Any]], _Item],
        write: Callable[[_Item], dict[str, Any]],
    ) -> None:
        def read_entry(line: dict[str, Any]) -> _Entry[_Item]:
            return _Entry(read(line["item"]), dict(line["part"]), float(line["seconds"]))

        def write_entry(entry: _Entry[_Item]) -> dict[str, Any]:
            return {"item": write(entry.item), "part": entry.part, "seconds": entry.seconds}

        self._journal = Journal(path, fingerprint, read_entry, write_entry)
        self._started = datetime.now(UTC).isoformat(timespec="seconds")
        self._environment = computing_environment()
        self._clock = time.perf_counter()

    @property
    def items(self) -> list[_Item]:
        """The items that are stored."""
        return [entry.item for entry in self._journal.entries]

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
        self._journal.add(_Entry(item, part, time.perf_counter() - self._clock))

    def take(self, other: PartJournal[_Item], wanted: Callable[[_Item], bool]) -> None:
        """Store items of another journal, with the parts that computed them."""
        for entry in other._journal.entries:
            if wanted(entry.item):
                self._journal.add(entry)

    def drop(self, unwanted: Callable[[_Item], bool]) -> int:
        """Remove items, also from the file; return how many."""
        return self._journal.drop(lambda entry: unwanted(entry.item))

    def parts(self, used: Callable[[_Item], bool] = lambda item: True) -> list[dict[str, Any]]:
        """Return the parts that computed the items that are used, in order, as the record of a run holds them."""
        found: dict[tuple[tuple[str, str], ...], dict[str, Any]] = {}
        for entry in self._journal.entries:
            if used(entry.item):
                part = found.setdefault(
                    tuple(sorted(entry.part.items())), entry.part | {"seconds": 0.0, "computations": 0}
                )
                part["seconds"] = max(part["seconds"], entry.seconds)
                part["computations"] += 1
        return sorted(found.values(), key=lambda part: str(part["started"]))
