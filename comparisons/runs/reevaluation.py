"""Check of stored rows of external models: a few of their tasks are evaluated again and compared.

The version of an external model covers the files that are hashed.  A file that it reads besides, or a program that it
calls, may change without that; then the stored numbers are no longer those of the model.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from comparisons.runs.execution import compute
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task
from comparisons.runs.workers import Backend, processes

__all__ = ["AT_MOST", "Comparable", "Reevaluation", "chosen", "evaluate_again", "same", "same_value"]

#: Stored tasks of each external model that are evaluated again.
AT_MOST = 3


@dataclass(frozen=True, slots=True)
class Reevaluation:
    """Tasks of a model that were evaluated again, and a text about the first that differs (empty if none does)."""

    tasks: list[Task]
    difference: str

    def as_json(self) -> dict[str, Any]:
        """Return its form in the record of the run."""
        tasks = [
            {"quantity": task.quantity, "n": task.case.n, "k": task.case.k, "mu": task.case.mu, "nu": task.case.nu}
            for task in self.tasks
        ]
        return {"same": not self.difference, "tasks": tasks}


def chosen(tasks: Iterable[Task], seed: int) -> list[Task]:
    """Return at most `AT_MOST` of the tasks of a model, at random, of as many quantities as possible.

    Examples
    --------
    >>> from comparisons.runs.cases import Case
    >>> tasks = [Task("mine", name, Case(2, 0, mu)) for name in ("pull_off_force", "jump_in_gap") for mu in (1, 2, 3)]
    >>> len(chosen(tasks, 1)), len({task.quantity for task in chosen(tasks, 1)})
    (3, 2)
    """
    generator = random.Random(seed)
    shuffled = sorted(tasks, key=lambda task: tuple(map(str, task.key)))
    generator.shuffle(shuffled)
    met: Counter[str] = Counter()
    turns: dict[Task, int] = {}
    for task in shuffled:
        turns[task] = met[task.quantity]
        met[task.quantity] += 1
    # First one task of each quantity, then a second of each, and so on.
    return sorted(shuffled, key=turns.__getitem__)[:AT_MOST]


def evaluate_again(
    stored: dict[Task, Row], seed: int, jobs: int, backend: Backend = processes
) -> dict[str, Reevaluation]:
    """Evaluate a few stored tasks of each model again and compare.

    Parameters
    ----------
    stored : dict of Task to Row
        The stored tasks of external models.
    seed : int
        Of the choice.
    jobs : int
        Number of processes.
    backend : Backend
        Where they are evaluated.

    Returns
    -------
    dict of str to Reevaluation
        By the name of the model.
    """
    models = sorted({task.model for task in stored})
    again = {model: chosen((task for task in stored if task.model == model), seed) for model in models}
    rows = {row.key: row for row in compute([task for tasks in again.values() for task in tasks], jobs, backend)}
    return {
        model: Reevaluation(
            tasks, next(filter(None, (_difference(stored[task], rows[task.key]) for task in tasks)), "")
        )
        for model, tasks in again.items()
    }


class Comparable(Protocol):
    """A row with a status, and with a value and its bound where there is one."""

    @property
    def status(self) -> str:
        """One of "ok", "not-applicable" and "failed"."""

    @property
    def value(self) -> float | None:
        """The result, None where there is none."""

    @property
    def u_num(self) -> float | None:
        """Its bound."""


def same_value(stored: Comparable, now: Comparable) -> bool:
    """Whether two rows of one task agree: in their status, and within the sum of both uncertainties."""
    if stored.status != now.status:
        return False
    if stored.value is None or now.value is None:
        return stored.value is now.value
    return abs(stored.value - now.value) <= (stored.u_num or 0.0) + (now.u_num or 0.0)


def same(stored: Row, now: Row) -> bool:
    """Whether two rows of one task agree as in `same_value`.

    The points of a curve are compared one by one, as fractions of its ranges, as its uncertainty is.
    """
    if stored.status == now.status and stored.points is not None and now.points is not None:
        return _same_curve(stored.points, now.points)
    return same_value(stored, now)


def _same_curve(stored: tuple[list[float], list[float], float], now: tuple[list[float], list[float], float]) -> bool:
    if len(stored[0]) != len(now[0]):
        return False
    apart = []
    for before, after in zip(stored[:2], now[:2], strict=True):
        range_of = float(np.ptp(before)) or 1.0
        apart.append(np.abs(np.subtract(before, after)) / range_of)
    return bool(np.all(np.hypot(*apart) <= stored[2] + now[2]))


def _difference(stored: Row, now: Row) -> str:
    if same(stored, now):
        return ""
    case = f"{stored.quantity} at n = {stored.n:g}, k = {stored.k:g}, mu = {stored.mu:g}"
    return f"{case} was {_text(stored)} and is {_text(now)}"


def _text(row: Row) -> str:
    if row.points is not None:
        return f"a curve of {len(row.points[0])} points"
    return row.status if row.value is None else f"{row.value:.9g}"
