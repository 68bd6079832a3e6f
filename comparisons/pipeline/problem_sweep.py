"""Sweep over a problem file: every combination of values of its keys, by any models, in SI."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import closing
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from shlex import quote
from typing import Any

import pandas as pd

from comparisons.console.progress import counting, note
from comparisons.data.file_names import RUN_FILES
from comparisons.model import ComputationFailed
from comparisons.output.problem_tables import problem_errors, problem_table
from comparisons.pipeline.finished_run import described
from comparisons.pipeline.problem_inputs import ProblemInputs, inputs_of
from comparisons.pipeline.record_content import now, record_content
from comparisons.problem_file.variation import variations
from comparisons.quantities import QUANTITIES
from comparisons.registry import identify
from comparisons.runs.backends import backend_of
from comparisons.runs.computation import Completed, checked_jobs, folder_for
from comparisons.runs.folder import RunFolder
from comparisons.runs.journal import alone_in
from comparisons.runs.problem_tasks import (
    ProblemRow,
    ProblemTask,
    compute_problems,
    digest_of,
    plan_problems,
    problem_journal,
)
from comparisons.runs.record import PROBLEM_SWEEP, write_record
from comparisons.runs.reevaluation import drop_changed
from comparisons.runs.shards import Shard
from comparisons.runs.tables import write_table
from comparisons.runs.time_left import TimeLeft
from comparisons.runs.workers import LOST, Backend, Processes, processes

__all__ = ["FinishedProblemSweep", "problem_sweep", "write_problem_sweep"]

#: Names under which the columns of the tables are described.
_DESCRIBED_AS = {"results": "problem_results", "kappa": "problem_kappa"}


@dataclass(frozen=True)
class FinishedProblemSweep:
    """A finished sweep over a problem file.

    Attributes
    ----------
    folder : Path
    table : DataFrame
        A row for each model, quantity and problem; the varied keys are columns, with their units in brackets.
    errors : DataFrame
        Relative errors of the models against the reference among them; no rows without one.
    failures : tuple of ProblemRow
    """

    folder: Path
    table: pd.DataFrame
    errors: pd.DataFrame
    failures: tuple[ProblemRow, ...]


def problem_sweep(
    problem: Path,
    vary: Sequence[str],
    models: Sequence[str] = ("fscm",),
    quantities: Sequence[str] = ("pull_off_force",),
    folder: Path | None = None,
    *,
    jobs: int = 1,
    retry_failed: bool = False,
    backend: str = "processes",
    scheduler: str | None = None,
    shard: str | None = None,
) -> FinishedProblemSweep:
    """Compute quantities of a problem file for every combination of values, and write table and record into a folder.

    Parameters
    ----------
    problem : Path
        A problem file.
    vary : sequence of str
        ``SECTION.KEY=VALUES``, as of `comparisons.problem_file.variation.parse_variation`.
    models : sequence of str
        Names or SPECs.
    quantities : sequence of str
        Of `comparisons.QUANTITIES`.
    folder, jobs, retry_failed, backend, scheduler, shard
        As of `comparisons.run`.

    Raises
    ------
    ValueError
        If an argument is not admissible, or the folder holds results of other code.
    comparisons.model.ComputationFailed
        If the workers cannot compute.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> text = '''
    ... solid = {kind = "power-law", E0 = "2 GPa", c0 = "1 um", k = 0.4, nu = 0.3}
    ... punch = {kind = "sphere", R = "1 um"}
    ... law = {kind = "lennard-jones-9-3", work_of_adhesion = "50 mJ/m^2", z0 = "0.4 nm"}
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "pad.toml")
    ...     _ = file.write_text(text)
    ...     finished = problem_sweep(file, ["punch.R=1, 2 um"], ["bradley"], folder=Path(folder, "out"))
    >>> (finished.table["value"] * 1e9).round(3).tolist()  # 2 pi R dgamma, in nN
    [314.159, 628.319]
    """
    checked_jobs(jobs)
    workers = backend_of(backend, scheduler)
    part = None if shard is None else Shard.parse(shard)
    for quantity in quantities:
        if quantity not in QUANTITIES:
            raise ValueError(f"unknown quantity {quantity!r}; the quantities are {', '.join(QUANTITIES)}")
    names, external = identify(models)
    specs = {name: (external[name].spec, external[name].version) if name in external else (name, "") for name in names}
    problems = variations(problem, vary)
    inputs = inputs_of(problem, problems)
    tasks = plan_problems(problems, specs, quantities)
    whole, total = digest_of(tasks), len(tasks)
    if part is not None:
        tasks = part.of(tasks)
    start = now()
    target = RunFolder(folder_for(folder, datetime.now(UTC)))
    inputs.check(target)
    completed = _completed(tasks, target.path, jobs, retry_failed, workers)
    others = {"backend": None if backend == "processes" else backend, "scheduler": scheduler, "shard": shard}
    arguments = {
        "problem": str(problem),
        "vary": list(vary),
        "model": names,
        "external": {name: identity.spec for name, identity in external.items()},
        "quantity": list(quantities),
        "computations": total,
        "jobs": jobs,
        **{name: value for name, value in others.items() if value is not None},
        "out": str(target.path),
    }
    return write_problem_sweep(target, completed, arguments, start, whole, described(set(names), external), inputs)


def _completed(
    tasks: Sequence[ProblemTask], folder: Path, jobs: int, retry_failed: bool, backend: Backend
) -> Completed[ProblemRow]:
    wanted = {task.key: task for task in tasks}

    def usable(row: ProblemRow) -> bool:
        task = wanted.get(row.key)
        return task is not None and task.version in ("", row.model_version)

    def again(row: ProblemRow) -> bool:
        return row.status == "failed" and (retry_failed or bool(wanted[row.key].version) or row.reason == LOST)

    def rows_of(few: list[ProblemTask]) -> Iterator[ProblemRow]:
        return (row for row, _ in compute_problems(few, jobs, backend if isinstance(backend, Processes) else processes))

    with alone_in(folder):
        journal = problem_journal(folder)
        journal.drop(lambda row: usable(row) and again(row))
        try:
            external = [(wanted[row.key], row) for row in journal.items if usable(row) and wanted[row.key].version]
            evaluated_again = drop_changed(external, journal, rows_of) if external else None
            known = {row.key for row in journal.items if usable(row)}
            missing = [task for task in tasks if task.key not in known]
            note(f"{len(missing)} computations" + (f", {len(known)} are stored" if known else ""))
            left = TimeLeft(missing)
            computing = closing(compute_problems(missing, jobs, backend))
            with counting("computing", len(missing)) as count, computing as computed:
                for row, environment in computed:
                    journal.add(row, environment)
                    count(left.after(row))
        except BrokenExecutor as failure:
            stored = f"{len(journal.items)} finished computations are safe; go on with --out {quote(str(folder))}"
            raise ComputationFailed(f"{failure}; {stored}") from None
        # The parameters are those of today's plan: another --vary may name other keys of the same problem.
        rows = [row for row in journal.items if usable(row)]
        keys = {row.key for row in rows}
        parts = journal.parts(lambda row: row.key in keys)
    for row in rows:
        row.parameters.clear()
        row.parameters.update(wanted[row.key].parameters)
    return Completed(rows, len(known), parts, evaluated_again)


def write_problem_sweep(
    target: RunFolder,
    completed: Completed[ProblemRow],
    arguments: Mapping[str, Any],
    started: str,
    whole: str,
    models: Mapping[str, Any],
    inputs: ProblemInputs,
) -> FinishedProblemSweep:
    """Write the tables, the copies of the problem file and its tables, and the record of a sweep over a problem file.

    Parameters
    ----------
    target : RunFolder
    completed : Completed
        The rows and their origin.
    arguments : mapping
        For the record.
    started : str
    whole : str
        SHA-256 of the keys of all tasks, also of those of other shards.
    models : mapping
        Version, citation and domain of each.
    inputs : ProblemInputs
        The copies.
    """
    rows = completed.rows
    table = problem_table(rows)
    errors = problem_errors(table)
    inputs.write(target)
    write_table(table, target.results, leave_out_of_csv=["seconds"], described_as=_DESCRIBED_AS["results"])
    write_table(errors, target.kappa, described_as=_DESCRIBED_AS["kappa"])
    seconds: Counter[str] = Counter()
    for row in rows:
        seconds[row.model] += row.seconds  # type: ignore[assignment]
    counts = {"all": len(rows), "resumed": completed.resumed, **Counter(row.status for row in rows)}
    content = record_content(
        PROBLEM_SWEEP,
        arguments,
        started=started,
        parts=completed.parts,
        rows=counts,
        seconds=dict(sorted(seconds.items())),
        verdicts={},
    )
    content |= {"cases_sha256": whole, "models": dict(models), "inputs": inputs.entry}
    content |= {"evaluated_again": completed.evaluated_again} if completed.evaluated_again else {}
    write_record(content, target.record, [*RUN_FILES, *inputs.contents], _DESCRIBED_AS)
    return FinishedProblemSweep(target.path, table, errors, tuple(row for row in rows if row.status == "failed"))
