"""A run of the benchmark: what is measured, stored, written and printed.

Each finished measurement is in the store of the folder before the next one begins, so that a run that is stopped can
be resumed; each keeps the record of the machine that made it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from comparisons.bench.cold_starts import COLD_STARTS
from comparisons.bench.measuring import measured
from comparisons.bench.part import Measurement, Part, key, table_of
from comparisons.bench.work_precision import WORK_PRECISION
from comparisons.console.progress import note
from comparisons.data.file_names import BENCH, BENCH_SUMMARY
from comparisons.output.style import save
from comparisons.runs.atomic_files import atomic, prepare_folder, write_json
from comparisons.runs.csv_format import csv_text
from comparisons.runs.environment import environment
from comparisons.runs.store import Form, Store

#: Parts by name, in the order in which they are measured: the shortest first.
PARTS = {part.name: part for part in (COLD_STARTS, WORK_PRECISION)}


def parts_of(names: Iterable[str] | None) -> list[Part]:
    """Return the parts of some names, all by default.

    Raises
    ------
    ValueError
        For a name that no part has.

    Examples
    --------
    >>> [part.name for part in parts_of(["cold-starts"])]
    ['cold-starts']
    """
    requested = set(PARTS if names is None else names)
    if unknown := sorted(requested - set(PARTS)):
        raise ValueError(f"there is no part {', '.join(unknown)}; the parts are {', '.join(PARTS)}")
    return [part for name, part in PARTS.items() if name in requested]


class FinishedBench(NamedTuple):
    """What a run prints, lines of at most 80 columns; and its failures."""

    summary: list[str]
    failures: list[Measurement]


def run_bench(folder: Path, only: Sequence[str] | None = None, *, full: bool = False) -> FinishedBench:
    """Measure what the folder does not have, or has as failures, and write tables, figures and record.

    Parameters
    ----------
    folder : Path
        For store, tables, figures and record; made if it does not exist.
    only : sequence of str, optional
        Names of parts (`PARTS`); all by default.
    full : bool
        Whether the settings that take long are measured, too.

    Raises
    ------
    ValueError
        For an unknown part, or a folder that cannot be used, as one with measurements of other code.
    """
    parts = parts_of(only)
    prepare_folder(folder)
    with Store(folder, FORM) as store:
        store.drop(lambda measurement: measurement["status"] != "ok")
        _measure(parts, full, store)
        return _written(folder, parts, store, {"only": only and list(only), "full": full})


#: Measurements in the store of a folder.
FORM: Form[Measurement] = Form(
    "measurements",
    key=lambda row: [row["part"], key(row["settings"])],
    read=lambda content: content,
    write=lambda row: row,
)


def _measure(parts: Sequence[Part], full: bool, store: Store[Measurement]) -> None:
    """Make the measurements that the store lacks, part by part."""
    stored = {(row["part"], key(row["settings"])) for row in store.items}
    missing = [
        (part, settings) for part in parts for settings in part.plan(full) if (part.name, key(settings)) not in stored
    ]
    note(f"{len(missing)} measurements" + (f", {len(stored)} are stored" if stored else ""))
    made = (measured(part, settings) for part, settings in missing)
    store.complete("measurements", len(missing), made)


def _written(
    folder: Path, parts: Sequence[Part], store: Store[Measurement], arguments: dict[str, object]
) -> FinishedBench:
    """Write the tables and figures of the parts and the record of all that is stored; return what is printed."""
    record = environment()
    machine = record["machine"]
    summary = [f"{machine['cpu']}, {machine['cores']} cores; ratios of one run on it:"[:80]]
    failures = []
    for part in parts:
        rows = [row for row in store.items if row["part"] == part.name]
        failures += [row for row in rows if row["status"] != "ok"]
        table = table_of(part, rows)
        finished = table[table["status"] == "ok"]
        table_file, *figure_files = part.files(folder)
        with atomic(table_file) as file:
            file.write(csv_text(table).encode())
        if finished.empty:
            continue
        for figure_file in figure_files:
            save(part.draw(finished), figure_file)  # type: ignore[misc]
        lines = part.summary(finished).to_string(index=False, float_format="%.3g", na_rep="")
        summary += [f"{part.title}:", *lines.splitlines()]
    content = {"arguments": arguments, **record, "parts": store.parts()}
    content["failures"] = sum(row["status"] != "ok" for row in store.items)
    write_json(content, folder / BENCH)
    with atomic(folder / BENCH_SUMMARY) as file:
        file.write("".join(f"{line}\n" for line in summary).encode())
    return FinishedBench(summary, failures)
