"""Shards: parts of a sweep that are computed by separate commands, as by the jobs of an array, and merged."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Iterable
from dataclasses import dataclass

from comparisons.runs.tasks import Task

__all__ = ["Shard", "cost"]

#: Seconds of one evaluation, averaged over the standing cases on one core of a server of 2023; of a model that is not
#: here, as a closed form, `_OTHER`.
_SECONDS = {"fem": 6.0, "fscm": 0.4, "fscm-stieltjes": 3.0}
_OTHER = 0.01


def cost(model: str) -> float:
    """Return about how many seconds an evaluation of a model takes.

    Examples
    --------
    >>> cost("fem") > cost("fscm") > cost("jkr")
    True
    """
    return _SECONDS.get(model, _OTHER)


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
        found = re.fullmatch(r"(\d{1,9})/0*([1-9]\d{0,8})", text, re.ASCII)
        if found is None:
            raise ValueError(f"shard {text!r} must be two numbers i/N, such as 2/3 for the second of three")
        return cls(int(found[1]), int(found[2]))

    def of(self, tasks: Iterable[Task]) -> list[Task]:
        """Return its tasks of those of the whole sweep, in their order.

        All quantities of one problem by one model are in one shard: a solver computes them from one path.  Each model
        is spread evenly, and what does not divide evenly goes where least is to be computed.

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
        shard_of = _spread(planned, self.total)
        return [task for task in planned if shard_of[task.problem_key] == self.number - 1]

    def __str__(self) -> str:
        return f"{self.number}/{self.total}"


def _spread(tasks: Iterable[Task], total: int) -> dict[Hashable, int]:
    """Return the index of the shard of every problem of every model, the same in every process."""
    problems: dict[str, Counter[Hashable]] = {}
    for task in tasks:
        problems.setdefault(task.model, Counter())[task.problem_key] += 1
    shard_of: dict[Hashable, int] = {}
    loads = [0.0] * total
    # The most expensive model first: the cheaper ones even out what it leaves.
    for model in sorted(problems, key=lambda name: (-cost(name), name)):
        # Neighbours in the order of a plan cost about the same: each shard gets one of every `total`.
        for index, (problem, count) in enumerate(problems[model].items()):
            if index % total == 0:
                least_first = sorted(range(total), key=loads.__getitem__)
            shard_of[problem] = least_first[index % total]
            loads[shard_of[problem]] += count * cost(model)
    return shard_of
