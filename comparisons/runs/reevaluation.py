"""Check of stored rows of external models: a few of their tasks are evaluated again and compared.

The version of an external model covers the files that are hashed.  A file that it reads besides, or a program that it
calls, may change without that; then the stored numbers are no longer those of the model.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from random import SystemRandom
from typing import Any

import numpy as np

from comparisons.console.progress import log
from comparisons.runs.rows import Key, Row
from comparisons.runs.store import Store
from comparisons.runs.tasks import Task

__all__ = ["AT_MOST", "Reevaluation", "chosen", "drop_changed", "evaluate_again", "same"]

#: Stored tasks of each external model that are evaluated again.
AT_MOST = 3


@dataclass(frozen=True, slots=True)
class Reevaluation:
    """Tasks of a model that were evaluated again, and a text about the first that differs (empty if none does)."""

    tasks: list[Task]
    difference: str

    def as_json(self) -> dict[str, Any]:
        """Return its form in the record of the run."""
        return {"same": not self.difference, "tasks": [task.as_json() for task in self.tasks]}


def chosen(tasks: Iterable[Task], seed: int) -> list[Task]:
    """Return at most `AT_MOST` of the tasks of a model, at random, of as many quantities as possible.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> from comparisons.runs.tasks import Task
    >>> spheres = [Problem.dimensionless(2, 0, mu) for mu in (1, 2, 3)]
    >>> tasks = [Task("mine", name, sphere) for name in ("pull_off_force", "jump_in_gap") for sphere in spheres]
    >>> len(chosen(tasks, 1)), len({task.quantity for task in chosen(tasks, 1)})
    (3, 2)
    """
    generator = random.Random(seed)
    shuffled = sorted(tasks, key=lambda task: str(task.key))
    generator.shuffle(shuffled)
    met: Counter[str] = Counter()
    turns: dict[Key, int] = {}
    for task in shuffled:
        turns[task.key] = met[task.quantity]
        met[task.quantity] += 1
    # First one task of each quantity, then a second of each, and so on.
    return sorted(shuffled, key=lambda task: turns[task.key])[:AT_MOST]


def evaluate_again(
    stored: Iterable[tuple[Task, Row]], seed: int, compute: Callable[[list[Task]], Iterable[Row]]
) -> dict[str, Reevaluation]:
    """Evaluate a few stored tasks of each model again and compare.

    Parameters
    ----------
    stored : iterable of (task, row)
        Tasks with their stored rows.
    seed : int
        Of the choice.
    compute : callable
        Returns the rows of tasks.

    Returns
    -------
    dict of str to Reevaluation
        By the name of the model.
    """
    before: dict[Key, Row] = {}
    of_model: dict[str, list[Task]] = {}
    for task, row in stored:
        before[task.key] = row
        of_model.setdefault(task.model, []).append(task)
    again = {model: chosen(of_model[model], seed) for model in sorted(of_model)}
    now = {row.key: row for row in compute([task for tasks in again.values() for task in tasks])}
    return {
        model: Reevaluation(
            tasks, next(filter(None, (_difference(task, before[task.key], now[task.key]) for task in tasks)), "")
        )
        for model, tasks in again.items()
    }


def drop_changed(
    stored: Iterable[tuple[Task, Row]], journal: Store[Row], compute: Callable[[list[Task]], Iterable[Row]]
) -> dict[str, Any]:
    """Evaluate a few stored tasks of each external model again; drop the rows of a model whose results have changed.

    Parameters
    ----------
    stored : iterable of (task, row)
        Those of external models that a command would use.
    journal : Store of Row
        That has the rows.
    compute : callable
        Returns the rows of tasks.

    Returns
    -------
    dict
        What was evaluated again, as the record of a run holds it.
    """
    pairs = list(stored)
    seed = SystemRandom().randrange(2**32)
    found = evaluate_again(pairs, seed, compute)
    version = {row.model: row.model_version for _, row in pairs}
    for model, again in found.items():
        if again.difference:
            changed = model, version[model]
            dropped = journal.drop(lambda row, changed=changed: (row.model, row.model_version) == changed)  # type: ignore[misc]
            log(f"{model} has changed ({again.difference}): its stored results ({dropped}) are all computed again")
    return {"seed": seed, "models": {model: again.as_json() for model, again in found.items()}}


def _same_value(stored: Row, now: Row) -> bool:
    """Whether two rows of one task agree: in their status, and within the sum of both uncertainties."""
    if stored.status != now.status:
        return False
    if stored.value is None or now.value is None:
        return stored.value is now.value
    return abs(stored.value - now.value) <= (stored.u_num or 0.0) + (now.u_num or 0.0)


def same(stored: Row, now: Row) -> bool:
    """Whether two rows of one task agree: in their status, and within the sum of both uncertainties.

    The points of a curve are compared one by one, as fractions of its ranges, as its uncertainty is.
    """
    before, after = stored.points, now.points
    if stored.status == now.status and before is not None and after is not None:
        return _same_curve(before, after)
    return _same_value(stored, now)


def _same_curve(stored: tuple[list[float], list[float], float], now: tuple[list[float], list[float], float]) -> bool:
    if len(stored[0]) != len(now[0]):
        return False
    apart = []
    for before, after in zip(stored[:2], now[:2], strict=True):
        range_of = float(np.ptp(before)) or 1.0
        apart.append(np.abs(np.subtract(before, after)) / range_of)
    return bool(np.all(np.hypot(*apart) <= stored[2] + now[2]))


def _difference(task: Task, stored: Row, now: Row) -> str:
    return "" if same(stored, now) else f"{task.label} was {_text(stored)} and is {_text(now)}"


def _text(row: Row) -> str:
    if row.points is not None:
        return f"a curve of {len(row.points[0])} points"
    return row.status if row.value is None else f"{row.value:.9g}"
