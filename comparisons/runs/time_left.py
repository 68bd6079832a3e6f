"""Time left of a computation, estimated from the cost of each model."""

from __future__ import annotations

import math
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable

from comparisons.console.progress import EVIDENCE
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task

__all__ = ["TimeLeft"]

#: A clock may not see a shorter computation.
_SHORTEST = 1e-6


class TimeLeft:
    """An estimate that only falls: one that would rise stays, until the work catches up with it.

    It is infinite until a share of the tasks of every model is finished (`comparisons.console.progress.EVIDENCE`).

    Parameters
    ----------
    tasks : iterable
        All that is to be computed, each with its model.
    clock : callable
        Returns the time in seconds.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> from comparisons.runs.tasks import Task, evaluate_task
    >>> tasks = [Task("jkr", "pull_off_force", Problem.dimensionless(2, 0, mu)) for mu in (1, 2)]
    >>> left = TimeLeft(tasks)
    >>> left.after(evaluate_task(tasks[0])) > 0, left.after(evaluate_task(tasks[1]))
    (True, 0.0)
    """

    def __init__(self, tasks: Iterable[Task], clock: Callable[[], float] = time.perf_counter) -> None:
        self._pending = Counter(task.model for task in tasks)
        self._needed = {model: math.ceil(EVIDENCE * count) for model, count in self._pending.items()}
        self._count: Counter[str] = Counter()
        self._seconds: defaultdict[str, float] = defaultdict(float)
        self._clock = clock
        self._started = clock()
        self._left = math.inf

    def after(self, row: Row) -> float:
        """Return the seconds left when one more row is finished."""
        self._pending[row.model] -= 1
        self._count[row.model] += 1
        self._seconds[row.model] += max(row.seconds, _SHORTEST)
        if all(self._count[model] >= needed for model, needed in self._needed.items()):
            # Both in seconds of one process: the work that the processes do in a second, and the work that is left.
            speed = sum(self._seconds.values()) / max(self._clock() - self._started, _SHORTEST)
            work = sum(count * self._cost(model) for model, count in self._pending.items())
            self._left = min(self._left, work / speed)
        return self._left

    def _cost(self, model: str) -> float:
        return self._seconds[model] / self._count[model]
