"""The pull-off force that others are compared with, and the relative change from it."""

from __future__ import annotations

from typing import Any

from comparisons.numerics.bounds import relative_difference, relative_uncertainty
from comparisons.problem import Problem
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

__all__ = ["change_of", "force_content", "reference_force"]

#: What is stated of a force.
_STATED = ("model", "value", "u_num", "unit", "status", "reason")


def reference_force(problem: Problem) -> Row:
    """Return the pull-off force of the atlas where it has the problem, and else that of the FSCM."""
    row = evaluate("atlas", "pull_off_force", problem)
    return row if row.status == "ok" else evaluate("fscm", "pull_off_force", problem)


def force_content(force: Row) -> dict[str, Any]:
    """Return what is stated of a force."""
    return {name: getattr(force, name) for name in _STATED}


def change_of(row: Row, force: Row) -> tuple[float, float] | None:
    """Return the relative difference of a value from a force, and its bound; None where there is no value."""
    if row.value is None or row.u_num is None or force.value is None or force.u_num is None:
        return None
    bound = relative_uncertainty(row.value, row.u_num, force.value, force.u_num)
    return relative_difference(row.value, force.value), bound
