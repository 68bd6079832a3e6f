"""Sensitivity of the pull-off force to the two choices that a measured profile needs: smoothing and continuation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from comparisons.description.forces import change_of
from comparisons.problem import Problem
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task, evaluate_task

__all__ = ["profile_sensitivity"]

#: Factors on the smoothing, and the exponents of the continuation; one that the file has is left out.
_FACTORS, _GROWTHS = (0.5, 2.0), (1.5, 3.0)

#: Exponent of a file that states none.
_GROWTH = 2.0


def profile_sensitivity(problem: Problem, force: Row) -> list[dict[str, Any]]:
    """Return the relative change of the force with half and double the smoothing, and with other exponents of growth.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force.

    Returns
    -------
    list of dict
        As JSON has it; empty if the punch is not a table, or if there is no force.
    """
    if problem.punch.kind != "table" or force.value is None:
        return []
    changes = []
    for key, value in _other_choices(problem):
        # A failure with its reason where the other shape is not admissible.
        row = evaluate_task(Task("fscm", "pull_off_force", problem.with_value("punch", key, value)))
        change, bound = change_of(row, force) or (None, None)
        stated = {"key": key, "value": value, "change": change, "u_num": bound}
        changes.append(stated | {"status": row.status, "reason": row.reason})
    return changes


def _other_choices(problem: Problem) -> Iterator[tuple[str, float]]:
    smoothing = problem.punch.get("smoothing")
    if smoothing is not None:
        yield from (("smoothing", factor * smoothing) for factor in _FACTORS)
    yield from (("growth", growth) for growth in _GROWTHS if growth != problem.punch.get("growth", _GROWTH))
