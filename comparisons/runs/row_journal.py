"""Journal of the rows of a folder, each with the part of the run that computed it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from comparisons.runs.environment import computing_environment, fingerprint
from comparisons.runs.journal import Journal
from comparisons.runs.rows import Row

__all__ = ["RowJournal"]


@dataclass(frozen=True, slots=True)
class _Entry:
    """A row, the environment and start of the command that computed it, and when in that command it was finished."""

    row: Row
    part: dict[str, str]
    seconds: float


def _read(line: dict[str, Any]) -> _Entry:
    return _Entry(Row(**line["row"]), dict(line["part"]), float(line["seconds"]))


class RowJournal:
    """Rows that are stored in a folder.

    A run that is interrupted and resumed has several parts, which may be computed by other interpreters, on other
    machines: each row keeps its own.

    Parameters
    ----------
    folder : Path
        Of the run.

    Raises
    ------
    ValueError
        As `comparisons.runs.journal.Journal`.
    """

    def __init__(self, folder: Path) -> None:
        self._journal = Journal(folder / "journal.jsonl", fingerprint(), _read, asdict)
        self._part = {"started": datetime.now(UTC).isoformat(timespec="seconds"), **computing_environment()}
        self._clock = time.perf_counter()

    @property
    def rows(self) -> list[Row]:
        """The rows that are stored."""
        return [entry.row for entry in self._journal.entries]

    def add(self, row: Row) -> None:
        """Store a row that this command has computed."""
        self._journal.add(_Entry(row, self._part, time.perf_counter() - self._clock))

    def drop(self, unwanted: Callable[[Row], bool]) -> int:
        """Remove rows for ever; return how many."""
        return self._journal.drop(lambda entry: unwanted(entry.row))

    def drop_model(self, name: str, version: str) -> int:
        """Remove all rows of one version of a model for ever; return how many."""
        return self.drop(lambda row: (row.model, row.model_version) == (name, version))

    def parts(self, rows: Iterable[Row]) -> list[dict[str, Any]]:
        """Return the parts that computed rows, in order, as ``run.json`` holds them."""
        used = {(row.key, row.model_version) for row in rows}
        found: dict[tuple[tuple[str, str], ...], dict[str, Any]] = {}
        for entry in self._journal.entries:
            if (entry.row.key, entry.row.model_version) in used:
                part = found.setdefault(
                    tuple(sorted(entry.part.items())), entry.part | {"seconds": 0.0, "computations": 0}
                )
                part["seconds"] = max(part["seconds"], entry.seconds)
                part["computations"] += 1
        return sorted(found.values(), key=lambda part: str(part["started"]))
