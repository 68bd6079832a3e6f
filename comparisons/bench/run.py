"""A run of the benchmark: what is measured, compared, stored, written and printed; renewal of the committed one.

Each finished measurement is in the store of the folder before the next one begins, so that a run that is stopped can
be resumed; each keeps the record of the machine that made it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from comparisons.bench import adhesion_fft, progress
from comparisons.bench.cold_starts import COLD_STARTS
from comparisons.bench.kinds import KINDS_OF_PROBLEMS
from comparisons.bench.part import Part
from comparisons.bench.work_precision import WORK_PRECISION
from comparisons.data.file_names import BASELINE_FOLDER, BENCH, BENCH_SUMMARY
from comparisons.output.style import save
from comparisons.paper.baseline import replace_files
from comparisons.paper.cache import make_calls
from comparisons.runs.atomic_files import prepare_folder, write_file, write_json
from comparisons.runs.csv_format import csv_text
from comparisons.runs.environment import environment
from comparisons.runs.folder_lock import locked

#: Parts by name, in the order in which they are measured: the shortest first.
PARTS = {part.name: part for part in (COLD_STARTS, WORK_PRECISION, KINDS_OF_PROBLEMS)}

#: Folder of the committed benchmark, in a clone of the repository.
BENCH_BASELINE = BASELINE_FOLDER / "bench"


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
    """What a run prints, lines of at most 80 columns; and a sentence for each failure."""

    summary: list[str]
    failures: list[str]


def run_bench(
    folder: Path, only: Sequence[str] | None = None, *, full: bool = False, against: Path | None = None
) -> FinishedBench:
    """Measure what the folder does not have, or has as failures, and write tables, figures and record.

    Parameters
    ----------
    folder : Path
        For store, tables, figures and record; made if it does not exist.
    only : sequence of str, optional
        Names of parts (`PARTS`); all by default.
    full : bool
        Whether the settings that take long are measured, too.
    against : Path, optional
        Folder of another run, to which the times are compared; by default the committed one where it is at hand.

    Raises
    ------
    ValueError
        For an unknown part, or a folder that cannot be used, as one with measurements of other code, or one to compare
        with that is no benchmark.
    """
    parts = parts_of(only)
    against = against or (BENCH_BASELINE if has_bench(BENCH_BASELINE) else None)
    earlier = progress.stored_tables(against) if against else None
    with locked(prepare_folder(folder)):
        calls = [call for part in parts for call in part.calls(full)]
        computed = make_calls(calls, folder, apart=True)
        failures = [computed.outcomes[call].sentence for call in calls if computed.outcomes[call].failed]
        record = environment()
        machine = record["machine"]
        summary = [f"{machine['cpu']}, {machine['cores']} cores; ratios of one run on it:"[:80]]
        tables = {part.name: part.table(full, computed.outcomes) for part in parts}
        for part in parts:
            summary += _written(folder, part, tables[part.name])
        summary += _progress_written(folder, progress.progress(tables, earlier), against)
        if WORK_PRECISION in parts and not adhesion_fft.is_installed():
            summary.append("adhesion is left out: `pip install Adhesion` adds it")
        arguments = {"only": only and list(only), "full": full, "against": against and str(against)}
        content = {"arguments": arguments, **record, "parts": computed.parts}
        write_json({**content, "failures": len(failures)}, folder / BENCH)
        write_file(folder / BENCH_SUMMARY, "".join(f"{line}\n" for line in summary))
    return FinishedBench(summary, failures)


def _written(folder: Path, part: Part, table: pd.DataFrame) -> list[str]:
    """Write the table and the figure of a part; return what is printed."""
    finished = table[table["status"] == "ok"]
    table_file, *figure_files = part.files(folder)
    write_file(table_file, csv_text(table))
    if finished.empty:
        return []
    for figure_file in figure_files:
        save(part.draw(finished), figure_file)  # type: ignore[misc]  # it has a file
    lines = part.summary(finished).to_string(index=False, float_format="%.3g", na_rep="")
    return [f"{part.title}:", *lines.splitlines()]


def _progress_written(folder: Path, table: pd.DataFrame, against: Path | None) -> list[str]:
    """Write table and figure of the times now, then and at the floor; return what is printed."""
    if table.empty:
        return []
    table_file, figure_file = (folder / name for name in progress.FILES)
    write_file(table_file, csv_text(table.reset_index(names="row")))
    save(progress.draw(table), figure_file)
    lines = progress.summary(table).to_string(index=False, float_format="%.3g", na_rep="")
    then = [f"then is {against}"[:80]] if against else []
    return [f"{progress.TITLE}:", *lines.splitlines(), *then]


def has_bench(folder: Path) -> bool:
    """Whether a folder is that of a finished ``fscm-bench bench``."""
    return (folder / BENCH).is_file()


def renew(folder: Path, target: Path = BENCH_BASELINE) -> list[Path]:
    """Replace the committed tables, figures, summary and record by those of a run of all parts; return their paths.

    Raises
    ------
    ValueError
        If the run lacks a part, or a measurement failed; nothing is changed then.
    """
    failures = json.loads((folder / BENCH).read_text(encoding="utf-8"))["failures"]
    if failures:
        raise ValueError(f"{folder} has {failures} failed measurements: repeat `fscm-bench bench`")
    sources = {name: [folder / name] for name in (BENCH, BENCH_SUMMARY)}
    sources |= {part.name: part.files(folder) for part in parts_of(None)}
    compared = [folder / name for name in progress.FILES]
    if all(file.is_file() for file in compared):
        sources["progress"] = compared
    return replace_files(sources, folder, target)
