"""Shards: parts of a sweep that are computed by separate commands, as by the jobs of an array, and merged."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from comparisons.runs.tasks import Task

__all__ = ["Shard"]

#: Models that take longest, the most expensive first (6 s, 3 s and 0.4 s, closed forms 10 ms).
_EXPENSIVE = ("fem", "fscm-stieltjes", "fscm")


@dataclass(frozen=True, slots=True)
class Shard:
    """One of several parts of a sweep, which are about equally expensive.

    Parameters
    ----------
    number, total : int
        Its number, from 1, and the number of all parts.

    Raises
    ------
    ValueError
        If there is no such part.

    Examples
    --------
    >>> str(Shard.parse("2/3"))
    '2/3'
    >>> Shard.parse("4/3")
    Traceback (most recent call last):
    ValueError: shard 4/3 is not one of 1/3, ..., 3/3
    """

    number: int
    total: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.total:
            raise ValueError(f"shard {self} is not one of 1/{self.total}, ..., {self.total}/{self.total}")

    @classmethod
    def parse(cls, text: str) -> Shard:
        """Return the shard of a text such as ``2/3``; `ValueError` if it has another form."""
        numbers = re.fullmatch(r"(\d{1,9})/0*([1-9]\d{0,8})", text, re.ASCII)
        if numbers is None:
            raise ValueError(f"shard {text!r} must be two numbers i/N, such as 2/3 for the second of three")
        return cls(int(numbers[1]), int(numbers[2]))

    def of(self, tasks: Iterable[Task]) -> list[Task]:
        """Return its tasks of those of the whole sweep, in their order.

        All quantities of one problem by one model are in one shard: a solver computes them from one path.  The problems
        of each model go round the shards, the most expensive model first; neighbours in a plan cost about the same.

        Examples
        --------
        >>> from comparisons.problem import Problem
        >>> from comparisons.runs.tasks import Task
        >>> spheres = [Problem.dimensionless(2, 0, mu) for mu in (4, 3, 2, 1)]
        >>> tasks = [Task(model, "pull_off_force", sphere) for sphere in spheres for model in ("fscm", "jkr")]
        >>> [(task.model, task.problem.mu) for task in Shard(2, 2).of(tasks)]
        [('fscm', 3.0), ('jkr', 3.0), ('fscm', 1.0), ('jkr', 1.0)]
        """
        planned = list(tasks)
        problems = dict.fromkeys(task.problem_key for task in sorted(planned, key=_rank))
        of_shard = set(list(problems)[self.number - 1 :: self.total])
        return [task for task in planned if task.problem_key in of_shard]

    def __str__(self) -> str:
        return f"{self.number}/{self.total}"


def _rank(task: Task) -> tuple[int, str]:
    """Place of a model among all, the most expensive first."""
    rank = _EXPENSIVE.index(task.model) if task.model in _EXPENSIVE else len(_EXPENSIVE)
    return rank, task.model
