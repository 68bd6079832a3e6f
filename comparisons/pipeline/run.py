"""Function for a whole run: its computation, tables, verdicts and record."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from comparisons.data.file_names import GATES_TEXT, GRID_TEXT, VERDICT_FILES
from comparisons.judging.decision import Verdict
from comparisons.pipeline.inputs import Cases, Gates, load_cases, read_gates
from comparisons.pipeline.judgement import Judgement, judge_and_write
from comparisons.pipeline.record_content import now, record_content
from comparisons.pipeline.results import Results, results
from comparisons.pipeline.tables import RunTables, make_tables, write_pictures, write_tables
from comparisons.registry import ExternalIdentity, create, identify
from comparisons.runs.atomic_files import atomic
from comparisons.runs.backends import backend_of
from comparisons.runs.computation import Completed, checked_jobs, folder_for
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import write_record
from comparisons.runs.rows import Row
from comparisons.runs.shards import Shard
from comparisons.runs.tasks import Task, plan

__all__ = ["FinishedRun", "RunInputs", "run", "write_run"]


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """A finished run.

    Attributes
    ----------
    folder : Path
        With the files of the run.
    tables : RunTables
    counts : dict of str to int
        Numbers of rows: all, resumed, shipped if there are any, and by status.
    failures : tuple of Row
        The rows of computations that failed.
    judgement : Judgement or None
        None if there were no gates.
    """

    folder: Path
    tables: RunTables
    counts: dict[str, int]
    failures: tuple[Row, ...]
    judgement: Judgement | None

    @property
    def verdict(self) -> Verdict | None:
        """The verdict over all gates; None if there were no gates."""
        return self.judgement.verdict if self.judgement else None


@dataclass(frozen=True, slots=True)
class RunInputs:
    """What a run computes and judges.

    Attributes
    ----------
    cases : Cases
    gates : Gates or None
        None if nothing is judged.
    models : list of str or None
        Names of the candidates in place of those each grid names.
    external : mapping of str to ExternalIdentity
        Those of them that are external.
    """

    cases: Cases
    gates: Gates | None
    models: list[str] | None
    external: Mapping[str, ExternalIdentity]

    def plan(self) -> list[Task]:
        """Return every task once, as `comparisons.runs.tasks.plan`."""
        return plan(self.cases.grids, self.models, self.external)


def run(
    cases: str | Path = "quick",
    gates: str | Path | None = None,
    models: Sequence[str] | None = None,
    folder: Path | None = None,
    *,
    jobs: int = 1,
    retry_failed: bool = False,
    recompute: bool = False,
    backend: str = "processes",
    scheduler: str | None = None,
    shard: str | None = None,
) -> FinishedRun:
    """Compute cases, judge the results, and write tables, verdicts and the record into a folder.

    What the folder holds already is not computed again, and in the standing cases neither is what is shipped with the
    package.  With models and gates, only the results that the gates need are computed.

    Parameters
    ----------
    cases : str or Path
        A tier of the standing cases ("quick" or "full"), a file of [[grid]] tables without a tier, or the text of one.
    gates : str, Path or None
        A gates file, or the text of one; by default the standing gates for the standing cases, and no gates for others.
    models : sequence of str, optional
        Names or SPECs of the candidates, in place of those each grid names.
    folder : Path, optional
        For the results; by default one in results/runs that is named by the time.
    jobs : int
        Number of processes.  With more than one, a script needs the guard ``if __name__ == "__main__":``.
    retry_failed : bool
        Whether stored failures are computed again.
    recompute : bool
        Whether the values of the references are computed although they are shipped.
    backend : str
        Where it is computed: "processes" of this machine, or "dask" for a Dask cluster.
    scheduler : str, optional
        The address of the scheduler of a Dask cluster; by default a cluster is started on this machine.
    shard : str, optional
        The part i/N of cases without gates, as "2/3"; `comparisons.pipeline.merge.merge` puts the N folders together.

    Returns
    -------
    FinishedRun

    Raises
    ------
    ValueError
        If an argument is not admissible, or the folder holds results of other code or files of a user.
    comparisons.model.ComputationFailed
        If the workers cannot compute, or a shipped value is not confirmed.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> grid = '''
    ... [[grid]]
    ... id = "mine"
    ... title = "JKR beside Bradley"
    ... reference = "bradley"
    ... models = ["jkr"]
    ... quantities = ["pull_off_force"]
    ... n = [2]
    ... k = [0]
    ... mu = [1]
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     finished = run(grid, folder=Path(folder))
    >>> finished.verdict, finished.counts["ok"], finished.tables.kappa["kappa"].round(6).tolist()
    (None, 2, [-0.25])
    """
    checked_jobs(jobs)
    workers = backend_of(backend, scheduler)
    part = None if shard is None else Shard.parse(shard)
    # Before anything is computed or written, every model is loaded and every text is read.
    names, external = identify(models or [])
    chosen_models = None if models is None else names
    chosen = load_cases(cases, chosen_models)
    rules = None if chosen.tier is None and gates is None else read_gates(gates, chosen, chosen_models)
    if part is not None and rules is not None:
        raise ValueError(f"shard {part} of a run cannot be judged: only cases without gates are computed in shards")
    started, start = datetime.now(UTC), now()
    target = RunFolder(folder_for(folder, started))
    _texts(target, chosen, rules)
    inputs = RunInputs(chosen, rules, chosen_models, external)
    tasks = inputs.plan() if part is None else part.of(inputs.plan())
    found = results(
        tasks,
        chosen,
        rules,
        chosen_models,
        target.path,
        jobs=jobs,
        retry_failed=retry_failed,
        recompute=recompute,
        backend=workers,
    )
    others = {"backend": None if backend == "processes" else backend, "scheduler": scheduler, "shard": shard}
    arguments = {"jobs": jobs, **{name: value for name, value in others.items() if value is not None}}
    return write_run(target, inputs, found, arguments, start)


def write_run(
    target: RunFolder, inputs: RunInputs, found: Results, arguments: Mapping[str, Any], started: str
) -> FinishedRun:
    """Write what follows from the rows of a run into its folder: tables, pictures, verdicts and the record.

    Parameters
    ----------
    target : RunFolder
    inputs : RunInputs
    found : Results
        The rows.
    arguments : mapping
        How they were computed, as the record holds it beside the inputs.
    started : str
        When the command began.
    """
    chosen, rules, chosen_models, external = inputs.cases, inputs.gates, inputs.models, inputs.external
    texts = _texts(target, chosen, rules)
    completed, rows = found.completed, found.rows
    tables = make_tables(rows, chosen, chosen_models)
    write_tables(tables, target)
    if chosen.tier is not None:
        write_pictures(tables, target)
    for path, text in texts.items():
        with atomic(path) as file:
            file.write(text.encode())
    specs = {name: model.spec for name, model in external.items()}
    judgement = None
    if rules is not None:
        judgement = judge_and_write(target, rules, chosen, tables.results, tables.curves, chosen_models, specs)
    stale = {GRID_TEXT} if rules is not None else {GATES_TEXT, *VERDICT_FILES}
    _remove_stale(target, stale - {path.name for path in texts})
    shipped = {"shipped": len(found.shipped)} if found.shipped else {}
    counts = {"all": len(rows), "resumed": completed.resumed, **shipped, **_statuses(rows)}
    content = record_content(
        "sweep" if rules is None else "run",
        {
            "tier": chosen.tier,
            "grid": chosen.source,
            "model": chosen_models,
            "external": specs,
            "gates": None if rules is None else rules.source,
            **arguments,
            "out": str(target.path),
        },
        started=started,
        parts=completed.parts,
        rows=counts,
        seconds=_seconds(completed.rows),
        verdicts=judgement.counts if judgement else {},
    )
    content |= _digests(chosen, rules) | _evaluated_again(completed)
    if found.entry:
        content["shipped"] = found.entry
    content["models"] = _described({task.model for task in inputs.plan()}, external)
    write_record(content, target.record)
    failures = tuple(row for row in rows if row.status == "failed")
    return FinishedRun(target.path, tables, counts, failures, judgement)


def _texts(folder: RunFolder, cases: Cases, gates: Gates | None) -> dict[Path, str]:
    """Return what the run keeps of its gates and grids; refuse to replace files that are not of a run."""
    texts = {} if gates is None else {folder.gates_text: gates.text}
    if cases.tier is None:
        texts[folder.grid_text] = cases.text
    for path, text in texts.items():
        if path.exists() and not folder.journal.exists() and path.read_bytes() != text.encode():
            raise ValueError(
                f"{path} was not written by a run, and a run would replace it; choose another folder with --out"
            )
    return texts


def _remove_stale(folder: RunFolder, names: Collection[str]) -> None:
    """Remove files that an earlier run of the folder has written and that this one does not have."""
    try:
        written = json.loads(folder.record.read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return
    for name in names:
        if name in written:
            (folder.path / name).unlink(missing_ok=True)


def _statuses(rows: Sequence[Row]) -> Counter[str]:
    return Counter(row.status for row in rows)


def _seconds(rows: Sequence[Row]) -> dict[str, float]:
    """Return the computing time summed over the processes, by model."""
    seconds: dict[str, float] = {}
    for row in rows:
        seconds[row.model] = seconds.get(row.model, 0.0) + row.seconds
    return dict(sorted(seconds.items()))


def _digests(cases: Cases, gates: Gates | None) -> dict[str, Any]:
    return {"cases_sha256": cases.sha256} | ({} if gates is None else {"gates_sha256": gates.sha256})


def _evaluated_again(completed: Completed) -> dict[str, Any]:
    return {"evaluated_again": completed.evaluated_again} if completed.evaluated_again else {}


def _described(names: set[str], external: Mapping[str, ExternalIdentity]) -> dict[str, dict[str, str]]:
    """Return version, citation and domain of each model, and which files the version of an external one covers."""
    models = {name: external.get(name) or create(name) for name in sorted(names)}
    described = {
        name: {"version": model.version, "citation": model.citation, "domain": model.domain}
        for name, model in models.items()
    }
    for name, model in external.items():
        if model.hashed:
            described[name]["hashed"] = model.hashed
    return described
