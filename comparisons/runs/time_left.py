"""Time left of a computation, estimated from the cost of each model."""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable

from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task

__all__ = ["TimeLeft"]

#: Seconds of one evaluation, averaged over the standing cases on one core of a server of 2023; of a model that is not
#: here, as a closed form or an external one, `_OTHER`.  They are used until the model has been measured.
_SECONDS = {"fem": 6.0, "fscm": 0.4, "fscm-stieltjes": 3.0}
_OTHER = 0.01

#: A clock may not see a shorter computation.
_SHORTEST = 1e-6


class TimeLeft:
    """An estimate that only falls: one that would rise stays, until the work catches up with it.

    Parameters
    ----------
    tasks : iterable of Task
        All that is to be computed.
    clock : callable
        Returns the time in seconds.

    Examples
    --------
    >>> from comparisons.runs.cases import Case
    >>> from comparisons.runs.tasks import evaluate_task
    >>> tasks = [Task("jkr", "pull_off_force", Case(2, 0, mu)) for mu in (1, 2)]
    >>> left = TimeLeft(tasks)
    >>> left.after(evaluate_task(tasks[0])) > 0, left.after(evaluate_task(tasks[1]))
    (True, 0.0)
    """

    def __init__(self, tasks: Iterable[Task], clock: Callable[[], float] = time.perf_counter) -> None:
        self._pending = Counter(task.model for task in tasks)
        self._count: Counter[str] = Counter()
        self._seconds: defaultdict[str, float] = defaultdict(float)
        self._clock = clock
        self._started = clock()
        self._left = float("inf")

    def after(self, row: Row) -> float:
        """Return the seconds left when one more row is finished."""
        self._pending[row.model] -= 1
        self._count[row.model] += 1
        self._seconds[row.model] += max(row.seconds, _SHORTEST)
        # Both in seconds of one process: the work that the processes do in a second, and the work that is left.
        speed = sum(self._seconds.values()) / max(self._clock() - self._started, _SHORTEST)
        work = sum(count * self._cost(model) for model, count in self._pending.items())
        self._left = min(self._left, work / speed)
        return self._left

    def _cost(self, model: str) -> float:
        if self._count[model]:
            return self._seconds[model] / self._count[model]
        return _SECONDS.get(model, _OTHER)
