"""Overview of a problem as JSON has it: Tabor number, pull-off force, errors of the closed forms, recommendation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparisons.description.assumptions import total_errors
from comparisons.description.choice import LIMITS, is_within, simplest_within
from comparisons.description.forces import change_of, force_content
from comparisons.problem import Problem
from comparisons.problem.evaluation import REFERENCES
from comparisons.registry import MODELS
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

Json = dict[str, Any]


def model_errors(problem: Problem, force: Row) -> list[Json]:
    """Return the relative errors of the closed forms that take a problem against a pull-off force, smallest first.

    Parameters
    ----------
    problem : Problem
        For the closed forms.
    force : Row
        Of this problem, or of another one that this one stands for.
    """
    is_of_the_paper = problem.without(*problem.surface).is_of_the_paper()
    names = [name for name in MODELS if name not in REFERENCES] if is_of_the_paper else []
    if problem.punch.kind == "ball":
        names = ["jkr-sphere", "jkr-sphere-projected"]
    changes = {name: change_of(evaluate(name, "pull_off_force", problem), force) for name in names}
    errors = [{"model": name, "error": change[0], "u_num": change[1]} for name, change in changes.items() if change]
    return sorted(errors, key=lambda row: abs(row["error"]))


def overview(problem: Problem, force: Row, assumed: Json | None = None) -> Json:
    """Return what is known of a problem without a choice of a model; errors are fractions.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force at small strains.
    assumed : dict, optional
        What `assumptions` returns.  Where the error of the assumptions is known, ``total_errors`` has that of each
        model with it, and a model is recommended by its total error; none is where the assumptions exceed the limit.

    Examples
    --------
    >>> from comparisons.description.forces import reference_force
    >>> problem = Problem.dimensionless(2, 0, 0.26)
    >>> overview(problem, reference_force(problem))["recommended"]["1 %"]
    'md-improved'
    """
    errors = model_errors(problem, force)
    with_assumptions = total_errors(problem, errors, assumed)
    critical = evaluate("atlas", "critical_tabor_number", problem).value if problem.is_of_the_paper() else None
    return {
        "problem": problem.content,
        "tabor_number": problem.posed.mu,
        "critical_tabor_number": critical,
        "regime": _regime(errors),
        "pull_off_force": force_content(force),
        "errors": errors,
        "assumptions": assumed,
        "total_errors": with_assumptions,
        "recommended": {
            f"{100 * limit:g} %": _recommended(with_assumptions or errors, force, assumed, limit) for limit in LIMITS
        },
    }


def _recommended(errors: Sequence[Json], force: Row, assumed: Json | None, limit: float) -> str | None:
    """The simplest model within a limit, or the reference unless what it assumes is known to be wrong by more."""
    if assumed is None:
        return simplest_within(errors, limit) or force.model
    if not assumed["recommendable"]:
        return None
    shares_too_much = assumed["total"]["error"] is not None and not is_within(assumed["total"], limit)
    return simplest_within(errors, limit) or (None if shares_too_much else force.model)


def _regime(errors: Sequence[Json]) -> str:
    """The limit whose pull-off force is within 5 %, by a sentence."""
    if not errors:
        return "not classified, because no closed form takes this problem"
    limits = [
        row["model"]
        for row in errors
        if row["model"] in ("bradley", "jkr", "jkr-sphere-projected") and is_within(row, LIMITS[-1])
    ]
    if len(limits) == 2:
        return "the rigid limit (Bradley) and the limit of JKR are both within 5 % of the pull-off force"
    if limits:
        limit = "rigid limit (Bradley, DMT)" if limits == ["bradley"] else "limit of soft solids (JKR)"
        return f"{limit}, within 5 % of the pull-off force"
    return "transition between the rigid limit (Bradley, DMT) and that of soft solids (JKR)"
