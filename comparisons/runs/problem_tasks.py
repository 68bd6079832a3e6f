"""Tasks of a sweep over a problem file: one quantity of one problem by one model, and the row of each."""

from __future__ import annotations

import json
import time
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import lru_cache
from hashlib import sha256
from operator import attrgetter
from pathlib import Path
from typing import Any

from comparisons.external.identity import contradiction
from comparisons.problem_file.description import ProblemFile
from comparisons.problem_file.evaluation import SI_UNITS, evaluate_problem, model_for
from comparisons.problem_file.variation import Varied
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.environment import computing_environment, differences, fingerprint
from comparisons.runs.folder import RunFolder
from comparisons.runs.part_journal import PartJournal
from comparisons.runs.workers import LOST, Backend, each, processes

__all__ = [
    "ProblemRow",
    "ProblemTask",
    "compute_problems",
    "digest_of",
    "evaluate_problem_task",
    "plan_problems",
    "problem_journal",
]


@dataclass(frozen=True)
class ProblemTask:
    """One evaluation of one model; `spec` names the model, `version` is that of an external one, else empty."""

    model: str
    spec: str
    version: str
    quantity: str
    problem: ProblemFile
    parameters: Mapping[str, float | str]
    digest: str

    @property
    def key(self) -> tuple[str, str, str]:
        """The key of its row."""
        return self.model, self.quantity, self.digest

    @property
    def problem_key(self) -> tuple[str, str]:
        """Model and problem: its quantities are computed together, from one path."""
        return self.model, self.digest

    @property
    def label(self) -> str:
        """The quantity and the varied keys, for a sentence."""
        return f"{self.quantity} at " + ", ".join(f"{name} = {value}" for name, value in self.parameters.items())

    def as_json(self) -> dict[str, Any]:
        """Return its form in the record of a sweep."""
        return {"quantity": self.quantity, "parameters": dict(self.parameters)}


@dataclass(frozen=True, slots=True)
class ProblemRow:
    """The result of one evaluation, in SI.

    Attributes
    ----------
    model, model_version, quantity : str
    parameters : dict
        The varied keys, as the columns of the table.
    digest : str
        SHA-256 of the whole problem with its tables: rows of another file are not used.
    value, u_num, unit, status, reason, seconds
        As of `comparisons.problem_file.evaluation.PhysicalValue`.
    dimensionless : dict or None
        As there.
    """

    model: str
    model_version: str
    quantity: str
    parameters: dict[str, float | str]
    digest: str
    value: float | None
    u_num: float | None
    unit: str
    status: str
    reason: str
    seconds: float
    dimensionless: dict[str, float | str] | None = None

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies the evaluation."""
        return self.model, self.quantity, self.digest


def plan_problems(
    problems: Sequence[Varied], models: Mapping[str, tuple[str, str]], quantities: Sequence[str]
) -> list[ProblemTask]:
    """Return every task once, those of a problem together: every model begins early, and its cost is known.

    Parameters
    ----------
    problems : sequence of Varied
    models : mapping of str to (str, str)
        Name -> SPEC and version (empty for a model of fscm-bench).
    quantities : sequence of str
    """
    digests = [varied.problem.digest for varied in problems]
    tasks = [
        ProblemTask(name, spec, version, quantity, varied.problem, varied.parameters, digest)
        for varied, digest in zip(problems, digests, strict=True)
        for name, (spec, version) in models.items()
        for quantity in quantities
    ]
    return list({task.key: task for task in tasks}.values())


def digest_of(tasks: Sequence[ProblemTask]) -> str:
    """Return the SHA-256 of the keys of all tasks of a sweep."""
    return sha256(json.dumps(sorted(task.key for task in tasks)).encode()).hexdigest()


def evaluate_problem_task(task: ProblemTask) -> ProblemRow:
    """Return the row of a task, whatever happens."""
    started = time.perf_counter()
    version = task.version
    try:
        model = model_for(task.problem, task.spec)
        if version and model.version != version:
            raise ValueError(contradiction((task.model, version), (model.name, model.version)))
        version = model.version
        found = evaluate_problem(task.problem, model, task.quantity)
    except ValueError as refusal:
        return _failed(task, version, str(refusal), time.perf_counter() - started)
    return ProblemRow(
        task.model,
        version,
        task.quantity,
        dict(task.parameters),
        task.digest,
        found.value,
        found.u_num,
        found.unit,
        found.status,
        found.reason,
        found.seconds,
        found.dimensionless,
    )


def _failed(task: ProblemTask, version: str, reason: str, seconds: float) -> ProblemRow:
    unit = SI_UNITS[QUANTITIES[task.quantity].scale]
    parameters = dict(task.parameters)
    return ProblemRow(
        task.model, version, task.quantity, parameters, task.digest, None, None, unit, "failed", reason, seconds
    )


def problem_journal(folder: Path) -> PartJournal[ProblemRow]:
    """Return the journal of the rows of a folder."""
    return PartJournal(RunFolder(folder).journal, fingerprint(), _row, asdict)


def _row(line: dict[str, Any]) -> ProblemRow:
    return ProblemRow(**line)


@lru_cache(maxsize=1)
def _of_this_process() -> tuple[dict[str, str], str]:
    return computing_environment(), fingerprint()


_Computed = tuple[ProblemRow, dict[str, str], str]


def _evaluated(task: ProblemTask) -> _Computed:
    return (evaluate_problem_task(task), *_of_this_process())


def _lost(task: ProblemTask) -> _Computed:
    version = task.version or create(task.spec).version
    return (_failed(task, version, LOST, 0.0), *_of_this_process())


def compute_problems(
    tasks: Sequence[ProblemTask], jobs: int, backend: Backend = processes
) -> Generator[tuple[ProblemRow, dict[str, str]]]:
    """Evaluate tasks and yield each row, as it is finished, with the environment of its process.

    Raises
    ------
    ValueError
        If a worker runs other code than this process.
    concurrent.futures.BrokenExecutor
        If the backend cannot work.
    """
    _, here = _of_this_process()
    with closing(
        each(_evaluated, tasks, jobs, lost=_lost, alike=attrgetter("problem_key"), backend=backend)
    ) as finished:
        for row, environment, code in finished:
            if changed := differences(here, code):
                raise ValueError(
                    f"a worker runs another version of the code, of NumPy or of SciPy than this command ({changed}): "
                    "install the same on every machine, and start the workers again"
                )
            yield row, environment
