"""A run of the benchmark: what is measured, stored, written and printed.

Each finished measurement is in the journal of the folder before the next one begins, so that a run that is stopped can
be resumed; each keeps the record of the machine that made it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.bench import adhesion_package
from comparisons.bench.measuring import made
from comparisons.bench.part import Item, Measurement, Part, Settings, table_of
from comparisons.bench.registry import chosen
from comparisons.console.progress import counting, note
from comparisons.output.style import save
from comparisons.runs.atomic_files import atomic, prepare_folder, write_json
from comparisons.runs.csv_format import csv_text
from comparisons.runs.data_package import write_data_package
from comparisons.runs.environment import environment, fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.store import Store, alone_in

__all__ = ["FinishedBench", "run_bench"]


@dataclass(frozen=True, slots=True)
class FinishedBench:
    """A run whose files are written.

    Attributes
    ----------
    folder : Path
    tables : dict
        Name of the part -> its table.
    summary : list of str
        Ratios first; at most 40 lines of at most 80 columns.
    failures : list of Measurement
    """

    folder: Path
    tables: dict[str, pd.DataFrame]
    summary: list[str]
    failures: list[Measurement]


def run_bench(
    folder: Path,
    only: Sequence[str] | None = None,
    *,
    full: bool = False,
    again: bool = False,
    retry_failed: bool = False,
) -> FinishedBench:
    """Measure what the folder does not have, and write tables, figures and record.

    Parameters
    ----------
    folder : Path
        For journal, tables, figures and record; made if it does not exist.
    only : sequence of str, optional
        Names of parts (`comparisons.bench.registry.PARTS`); all by default.
    full : bool
        Whether the sizes that take long are measured, too.
    again : bool
        Whether stored measurements are dropped first, also those of another version of the code.
    retry_failed : bool
        Whether stored failures are measured again.

    Raises
    ------
    ValueError
        For an unknown part, or a folder that cannot be used.
    """
    parts = chosen(only)
    prepare_folder(folder)
    with alone_in(folder):
        path = RunFolder(folder).measurements
        if again:
            path.unlink(missing_ok=True)
        journal: Store[Measurement] = Store(path, fingerprint(), _read, _write)
        if retry_failed:
            journal.drop(lambda one: one.status != "ok")
        with journal.kept():
            _measure(parts, full, journal)
        return _written(folder, parts, journal, {"only": only and list(only), "full": full})


def _read(content: dict[str, Any]) -> Measurement:
    return Measurement(**content)


def _write(one: Measurement) -> dict[str, Any]:
    return {
        "part": one.part,
        "settings": one.settings,
        "numbers": one.numbers,
        "status": one.status,
        "reason": one.reason,
    }


def _key(part: str, settings: Settings) -> tuple[str, tuple[tuple[str, Any], ...]]:
    return part, tuple(sorted((name, str(value)) for name, value in settings.items()))


def _measure(parts: Sequence[Part], full: bool, journal: Store[Measurement]) -> None:
    """Make the measurements that the journal lacks, part by part."""
    known = {_key(one.part, one.settings) for one in journal.items}
    missing = {
        part.name: [item for item in part.items(full) if _key(part.name, item.settings) not in known] for part in parts
    }
    pending = [item for some in missing.values() for item in some]
    left = _TimeLeft(pending)
    if known:
        note(f"{len(known)} measurements are stored already, {len(pending)} are missing")
    with counting("measurements", len(pending)) as count:
        for part in parts:
            if missing[part.name]:
                note(f"{part.name}: {len(missing[part.name])} measurements")
            for item in missing[part.name]:
                journal.add(made(part, item.settings))
                count(left.after(item))


class _TimeLeft:
    """An estimate that only falls, from the seconds that the items state and the speed so far."""

    def __init__(self, items: Sequence[Item], clock: Callable[[], float] = time.perf_counter) -> None:
        self._whole = self._pending = sum(item.seconds for item in items)
        self._clock, self._started = clock, clock()
        self._left = float("inf")

    def after(self, item: Item) -> float:
        """Return the seconds left when one more item is finished."""
        self._pending -= item.seconds
        speed = (self._clock() - self._started) / (self._whole - self._pending)
        self._left = min(self._left, max(self._pending, 0.0) * speed)
        return self._left


def _written(
    folder: Path, parts: Sequence[Part], journal: Store[Measurement], arguments: dict[str, Any]
) -> FinishedBench:
    """Write the tables and figures of the parts and the record of all that is stored; return what is printed."""
    tables, lines, failures = {}, [], []
    for part in parts:
        stored = _ordered(part, [one for one in journal.items if one.part == part.name])
        failures += [one for one in stored if one.status != "ok"]
        if not stored:
            continue
        tables[part.name] = table = part.table(table_of(stored))
        table_file, figure_file = part.files(folder)
        with atomic(table_file) as file:
            file.write(csv_text(_with_short_settings(table, stored)).encode())
        if (table["status"] == "ok").any():
            save(part.draw(table), figure_file)
            lines += part.summary(table)
    record = environment()
    write_json(
        {
            "arguments": arguments,
            **record,
            "optional": adhesion_package.versions(),
            "parts": journal.parts(),
            "failures": len([one for one in journal.items if one.status != "ok"]),
        },
        RunFolder(folder).bench,
    )
    machine = record["machine"]
    head = [f"{machine['cpu']}, {machine['cores']} cores; ratios of one run on it:"[:80]]
    with atomic(RunFolder(folder).bench_summary) as file:
        file.write("".join(f"{line}\n" for line in head + lines).encode())
    write_data_package(folder, [part.files(folder)[0].name for part in parts])
    return FinishedBench(folder, tables, head + lines, failures)


def _with_short_settings(table: pd.DataFrame, stored: Sequence[Measurement]) -> pd.DataFrame:
    """Write settings as short as they can be exactly: 1e-05, not 1.0000000000000001e-05."""
    settings = {name for one in stored for name in one.settings}
    return table.assign(
        **{
            name: table[name].map(lambda value: repr(value) if isinstance(value, float) and value == value else value)
            for name in table.columns
            if name in settings
        }
    )


def _ordered(part: Part, stored: Sequence[Measurement]) -> list[Measurement]:
    """Measurements in the order of the part, whatever the order in which they were made."""
    order = {_key(part.name, item.settings): place for place, item in enumerate(part.items(True))}
    return sorted(stored, key=lambda one: order.get(_key(part.name, one.settings), len(order)))
