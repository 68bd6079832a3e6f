"""Results that a run needs: those shipped with the package where they fit the solvers, and the others computed."""

from __future__ import annotations

from collections.abc import Collection
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass
from pathlib import Path
from random import SystemRandom
from typing import Any

from comparisons.console.progress import log, note
from comparisons.model import ComputationFailed
from comparisons.pipeline.inputs import RunInputs
from comparisons.runs.cases import Case
from comparisons.runs.computation import Completed, complete
from comparisons.runs.execution import compute
from comparisons.runs.reevaluation import evaluate_again
from comparisons.runs.rows import Key, Row
from comparisons.runs.shipped_values import SHIPPED_MODELS, ShippedValues, load_shipped
from comparisons.runs.tasks import Task
from comparisons.runs.workers import Backend, Processes, processes

__all__ = ["Results", "results"]


@dataclass(frozen=True, slots=True)
class Results:
    """The rows of a run, and what its record states of those that were not computed.

    Attributes
    ----------
    completed : Completed
        What was computed, now or in an earlier part of the run.
    shipped : list of Row
        The other rows.
    entry : dict
        What the record states of them; empty if there are none.
    """

    completed: Completed
    shipped: list[Row]
    entry: dict[str, Any]

    @property
    def rows(self) -> list[Row]:
        """All rows."""
        return [*self.completed.rows, *self.shipped]


def results(
    tasks: list[Task],
    inputs: RunInputs,
    folder: Path,
    *,
    jobs: int = 1,
    retry_failed: bool = False,
    recompute: bool = False,
    backend: Backend = processes,
) -> Results:
    """Return the rows that a run needs.

    These are those that its gates need, if the run is about the standing cases with chosen models or gates, and
    otherwise all: the tables and figures of the standing cases, and a user's own cases, are then the purpose.

    Parameters
    ----------
    tasks : list of Task
        Of all cases and models, or those of a shard.
    inputs : RunInputs
        Of the run.
    folder : Path
        Of the run.
    jobs : int
        Number of processes.
    retry_failed : bool
        Whether stored failures are computed again.
    recompute : bool
        Whether every row is computed, also those that are shipped.
    backend : Backend
        Where they are computed.

    Raises
    ------
    ValueError
        As `comparisons.runs.computation.complete`.
    comparisons.model.ComputationFailed
        As there, and if a shipped value that is computed again is not within both bounds.
    """
    cases, gates = inputs.cases, inputs.gates
    known = ShippedValues({}, {}) if recompute or cases.tier is None else _fitting(tasks)
    chosen = cases.tier is not None and gates is not None and (inputs.models is not None or gates.source is not None)

    def needed(rows: Collection[Row]) -> set[Key]:
        if gates is None or not chosen:
            return {task.key for task in tasks}
        statuses = {row.key: row.status for row in (*rows, *known.rows.values())}
        return inputs.needed(statuses)

    missing = [task for task in tasks if task.key not in known.rows]
    # The processes that computed stay for the values that are computed again.
    with Processes() as local:
        on = local if isinstance(backend, Processes) else backend
        completed = complete(missing, folder, jobs, retry_failed, on, needed)
        keys = needed(completed.rows)
        used = {task: known.rows[task.key] for task in tasks if task.key in known.rows and task.key in keys}
        entry = _entry(known, used, _confirmed(used, jobs, local)) if used else {}
    return Results(completed, list(used.values()), entry)


def _fitting(tasks: list[Task]) -> ShippedValues:
    """Return the shipped values that fit the solvers; state in one sentence if there are others that tasks need."""
    if not any(task.model in SHIPPED_MODELS for task in tasks):
        return ShippedValues({}, {})
    known = load_shipped()
    if known.obstacle:
        log(f"the shipped values are of other solvers ({known.obstacle}): everything is computed")
    return known


def _confirmed(used: dict[Task, Row], jobs: int, backend: Backend) -> dict[str, Any]:
    """Compute a few shipped values of each model again; return which, as the record holds it."""
    seed = SystemRandom().randrange(2**32)
    try:
        found = evaluate_again(used.items(), seed, lambda tasks: compute(tasks, jobs, backend))
    except BrokenExecutor:
        raise ComputationFailed(
            "a worker process ended early, perhaps for lack of memory, while it computed shipped values again"
        ) from None
    for model, again in found.items():
        if again.difference:
            raise ComputationFailed(
                f"a shipped value of {model} is not confirmed here ({again.difference}; seed {seed}), so that nothing "
                "is judged: --recompute computes every value"
            )
    count = sum(len(again.tasks) for again in found.values())
    note(
        f"{len(used)} values of {' and '.join(found)} are shipped with fscm-bench; {count} of them, computed again, "
        "agree within their bounds; --recompute computes all"
    )
    return {"seed": seed, "models": {model: again.as_json() for model, again in found.items()}}


def _entry(known: ShippedValues, used: dict[Task, Row], evaluated_again: dict[str, Any]) -> dict[str, Any]:
    """Return what the record states of the shipped rows: which they are, and where they were computed."""
    cases: dict[tuple[str, str], list[str]] = {}
    for row in used.values():
        cases.setdefault((row.model, row.quantity), []).append(Case.of_row(row).label)
    rows = [
        {"model": model, "quantity": quantity, "cases": sorted(labels)}
        for (model, quantity), labels in sorted(cases.items())
    ]
    return {"rows": rows, "origin": known.origin, "evaluated_again": evaluated_again}
