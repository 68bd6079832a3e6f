"""Shards: parts of a sweep that are computed by separate commands, as by the jobs of an array, and merged."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from comparisons.runs.tasks import Task, batches

__all__ = ["Shard"]


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
        """Return its tasks of those of the whole sweep, as `comparisons.runs.tasks.plan` sorts them.

        Examples
        --------
        >>> from comparisons.runs.cases import Case
        >>> tasks = [Task("jkr", "pull_off_force", Case(2, 0, mu)) for mu in (5, 4, 3, 2, 1)]
        >>> [task.case.mu for task in Shard(2, 3).of(tasks)]
        [4.0, 1.0]
        """
        # Neighbours in the order cost about the same.
        return [task for batch in batches(tasks)[self.number - 1 :: self.total] for task in batch]

    def __str__(self) -> str:
        return f"{self.number}/{self.total}"
