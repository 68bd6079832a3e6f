"""Shards: parts of a sweep that are computed by separate commands, as by the jobs of an array, and merged."""

from __future__ import annotations

import re
from collections.abc import Iterable

from comparisons.runs.tasks import Task


def parse_shard(text: str) -> tuple[int, int]:
    """Return the number of a shard, from 1, and that of all shards.

    Raises
    ------
    ValueError
        If the text has another form, or there is no such shard.

    Examples
    --------
    >>> parse_shard("2/3")
    (2, 3)
    >>> parse_shard("4/3")
    Traceback (most recent call last):
    ValueError: shard 4/3 is not one of 1/3, ..., 3/3
    """
    match = re.fullmatch(r"(\d{1,9})/0*([1-9]\d{0,8})", text, re.ASCII)
    if match is None:
        raise ValueError(f"shard {text!r} must be two numbers i/N, such as 2/3 for the second of three")
    number, total = int(match[1]), int(match[2])
    if not 1 <= number <= total:
        raise ValueError(f"shard {number}/{total} is not one of 1/{total}, ..., {total}/{total}")
    return number, total


def tasks_of_shard(shard: str, tasks: Iterable[Task]) -> list[Task]:
    """Return the tasks of a shard of those of the whole sweep, in their order; all shards are about equally expensive.

    All quantities of one problem by one model are in one shard: a solver computes them from one path.  The problems
    of one model after the other go round the shards; neighbours in a plan cost about the same.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> spheres = [Problem.dimensionless(2, 0, mu) for mu in (4, 3, 2, 1)]
    >>> tasks = [Task(model, "pull_off_force", sphere) for sphere in spheres for model in ("fscm", "jkr")]
    >>> [(task.model, task.problem.mu) for task in tasks_of_shard("2/2", tasks)]
    [('fscm', 3.0), ('jkr', 3.0), ('fscm', 1.0), ('jkr', 1.0)]
    """
    number, total = parse_shard(shard)
    planned = list(tasks)
    problems = dict.fromkeys(task.problem_key for task in sorted(planned, key=lambda task: task.model))
    selected = set(list(problems)[number - 1 :: total])
    return [task for task in planned if task.problem_key in selected]
