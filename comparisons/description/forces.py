"""The pull-off force that others are compared with, relative changes of it, and those by the choices of a profile."""

from __future__ import annotations

from typing import Any

from comparisons.models.fscm_model import SharedAnalysis
from comparisons.numerics.bounds import relative_difference, relative_uncertainty
from comparisons.problem import Problem
from comparisons.problem.punch_shapes import FEWEST_ROWS
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task, evaluate, evaluate_task

#: What is stated of a force.
_STATED = ("model", "value", "u_num", "unit", "status", "reason")


def reference_force(problem: Problem) -> Row:
    """Return the pull-off force of the atlas where it has the problem, and else that of the FSCM.

    The FSCM has no friction: with friction the force is that of the finite elements.
    """
    if "solid.friction" in problem.surface:
        return evaluate("fem", "pull_off_force", problem)
    row = evaluate("atlas", "pull_off_force", problem)
    return row if row.status == "ok" else fscm_force(problem)


def fscm_force(problem: Problem) -> Row:
    """Return the pull-off force of the FSCM; its path is shared with the profile, and with a second call."""
    model: Any = SharedAnalysis()
    return evaluate(model, "pull_off_force", problem)


def force_content(force: Row) -> dict[str, Any]:
    """Return what is stated of a force."""
    return {name: getattr(force, name) for name in _STATED}


def change_of(row: Row, force: Row) -> tuple[float, float] | None:
    """Return the relative difference of a value from a force, and its bound; None where there is no value."""
    if row.value is None or row.u_num is None or force.value is None or force.u_num is None:
        return None
    bound = relative_uncertainty(row.value, row.u_num, force.value, force.u_num)
    return relative_difference(row.value, force.value), bound


#: Factors on the smoothing, or without one the share of z0 that is the smoothing of a curve through the rows; and the
#: exponents of the continuation, of which one that the file has is left out.
_FACTORS, _CURVE, _GROWTHS = (0.5, 2.0), 1e-3, (1.5, 3.0)

#: Exponent of a file that states none.
_GROWTH = 2.0


def profile_sensitivity(problem: Problem, force: Row) -> list[dict[str, Any]]:
    """Return the relative change of the force with other smoothing, and with other exponents of growth.

    Other smoothing is half and double of it, or if the file has none a curve through the rows in place of segments.

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
    smoothing, growth = problem.punch.get("smoothing"), problem.punch.get("growth", _GROWTH)
    if smoothing is not None:
        choices = [("smoothing", factor * smoothing) for factor in _FACTORS]
    elif len(problem.punch.columns["r"]) >= FEWEST_ROWS:
        choices = [("smoothing", _CURVE * problem.units["displacement"])]
    else:
        choices = []
    choices += [("growth", other) for other in _GROWTHS if other != growth]
    changes = []
    for key, value in choices:
        # A failure with its reason where the other shape is not admissible.
        row = evaluate_task(Task("fscm", "pull_off_force", problem.with_value(f"punch.{key}", value)))
        change, bound = change_of(row, force) or (None, None)
        stated = {"key": key, "value": value, "change": change, "u_num": bound}
        changes.append(stated | {"status": row.status, "reason": row.reason})
    return changes
