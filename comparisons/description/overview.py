"""Overview of a problem as JSON has it: Tabor number, pull-off force, errors of the closed forms, recommendation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from comparisons.description.assumptions import errors_of_exact_sphere, exact_sphere, total_errors
from comparisons.description.choice import LIMITS, is_within, simplest_within
from comparisons.description.equivalent_ball import PARABOLOID
from comparisons.description.forces import change_of, force_content
from comparisons.description.rigid_limit import rigid_force
from comparisons.description.unusual_sizes import unusual_sizes
from comparisons.problem import Problem
from comparisons.problem.equivalent_solid import LARGEST_DEVIATION
from comparisons.problem.evaluation import REFERENCES
from comparisons.registry import MODELS
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

Json = dict[str, Any]

#: Closed forms of the limit of soft solids with forces over vertical gaps.
_OF_SOFT_SOLIDS = ("jkr", "jkr-sphere-projected", "jkr-profile")


def model_errors(problem: Problem, force: Row) -> list[Json]:
    """Return the relative errors of the closed forms that take a problem against a pull-off force, smallest first.

    Parameters
    ----------
    problem : Problem
        For the closed forms.
    force : Row
        Of this problem, or of another one that this one stands for.
    """
    changes = {row.model: change_of(row, force) for row in _closed_forms(problem)}
    errors = [{"model": name, "error": change[0], "u_num": change[1]} for name, change in changes.items() if change]
    return sorted(errors, key=lambda row: abs(row["error"]))


def _closed_forms(problem: Problem) -> list[Row]:
    """Return the pull-off forces of the closed forms that take a problem."""
    elastic = problem.without(*problem.surface)
    names = ["jkr-profile", "md-profile"] if elastic.is_of_the_paper("solid") else []
    if elastic.is_of_the_paper():
        names = [name for name in MODELS if name not in REFERENCES]
    if problem.punch.kind == "ball":
        names = ["jkr-sphere", "jkr-sphere-projected", "md-profile"]
    rows = [evaluate(name, "pull_off_force", problem) for name in names]
    return [row for row in rows if row.status == "ok"]


def overview(problem: Problem, force: Row, assumed: Json | None = None, equivalent: Json | None = None) -> Json:
    """Return what is known of a problem without a choice of a model; errors are fractions.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force at small strains.
    assumed : dict, optional
        What `assumptions` returns.  Where the error of the assumptions is known, ``total_errors`` has that of each
        model with it, and a model is recommended by what its own error and that of the assumptions make by size; none
        is where the assumptions exceed the limit.
    equivalent : dict, optional
        What `equivalent_power_law` returns.  By its closed forms a problem is classified, and a model is recommended,
        where none takes the problem itself.

    Returns
    -------
    dict
        ``closed_forms`` has the forces of closed forms where there is no pull-off force to compare them with, and is
        else empty.  ``recommended`` names a model for each limit and ``recommended_forces`` has its force; its
        ``punch`` is "ball" where the file must state this kind in place of the paraboloid.  ``corrected_force`` is the
        pull-off force without the error of the assumptions, None where that is unknown or no model can be recommended.

    Examples
    --------
    >>> from comparisons.description.forces import reference_force
    >>> problem = Problem.dimensionless(2, 0, 0.26)
    >>> overview(problem, reference_force(problem))["recommended"]["1 %"]
    'md-improved'
    """
    errors = model_errors(problem, force)
    candidates = errors or _of_power_law(equivalent)
    with_assumptions = total_errors(problem, candidates, assumed)
    choice = {
        f"{100 * limit:g} %": _recommended(with_assumptions or candidates, force, assumed, limit) for limit in LIMITS
    }
    critical = evaluate("atlas", "critical_tabor_number", problem).value if problem.is_of_the_paper() else None
    return {
        "problem": problem.content,
        "tabor_number": problem.posed.mu,
        "critical_tabor_number": critical,
        "regime": _regime(problem, candidates, force),
        "unusual_sizes": unusual_sizes(problem),
        "pull_off_force": force_content(force),
        "errors": errors,
        "closed_forms": [] if force.status == "ok" else [force_content(row) for row in _closed_forms(problem)],
        "assumptions": assumed,
        "total_errors": with_assumptions,
        "corrected_force": _corrected(force, assumed),
        "recommended": choice,
        "recommended_forces": {limit: _force_of(problem, name, force) for limit, name in choice.items()},
    }


def _corrected(force: Row, assumed: Json | None) -> Json | None:
    """The force that leads to the given one with the error of the assumptions."""
    if assumed is None or not assumed["recommendable"] or force.value is None or force.u_num is None:
        return None
    total = assumed["total"]
    if total["error"] is None:
        return None
    factor = 1.0 + total["error"]
    if factor <= total["u_num"]:
        return None
    value = force.value / factor
    ends = [force.value / (factor + side * total["u_num"]) for side in (-1.0, 1.0)]
    bound = max(abs(end - value) for end in ends) + force.u_num / (factor - total["u_num"])
    return {"value": value, "u_num": bound, "unit": force.unit}


def _force_of(problem: Problem, name: str | None, force: Row) -> Json | None:
    """The force of a model for the problem, or for the exact sphere in place of its paraboloid."""
    if name is None:
        return None
    for posed in (problem, exact_sphere(problem)):
        row = force if name == force.model else evaluate(name, "pull_off_force", posed)
        if row.value is not None:
            return {"value": row.value, "u_num": row.u_num, "unit": row.unit, "punch": posed.punch.kind}
    return None


def _of_power_law(equivalent: Json | None) -> list[Json]:
    """The closed forms of an equivalent power law, if this is near enough to the solid."""
    is_near = equivalent is not None and equivalent["compliance_deviation"] <= LARGEST_DEVIATION
    return [row for row in equivalent["closed_forms"] if "at_most" in row] if equivalent and is_near else []


def _recommended(errors: Sequence[Json], force: Row, assumed: Json | None, limit: float) -> str | None:
    """The simplest model within a limit, or the reference unless what it assumes is known to be wrong by more."""
    if assumed is None:
        return simplest_within(errors, limit) or force.model
    if not assumed["recommendable"]:
        return None
    shares_too_much = assumed["total"]["error"] is not None and not is_within(assumed["total"], limit)
    return simplest_within(errors, limit) or (None if shares_too_much else force.model)


def _regime(problem: Problem, errors: Sequence[Json], force: Row) -> str:
    """The limit whose pull-off force is within 5 %, by a sentence."""
    rigid, soft = _rigid_limit(problem, errors, force), _soft_limit(problem, errors)
    if rigid is None and soft is None:
        return "not classified, because neither the rigid limit nor that of soft solids is known for this problem"
    name = "Bradley, DMT" if any(row["model"] == "bradley" for row in errors) else "a rigid sphere"
    within = [row is not None and is_within(row, LIMITS[-1]) for row in (rigid, soft)]
    if all(within):
        return (
            f"the rigid limit ({name.partition(',')[0]}) and the limit of JKR are both within 5 % of the pull-off force"
        )
    if any(within):
        limit = f"rigid limit ({name})" if within[0] else "limit of soft solids (JKR)"
        return f"{limit}, within 5 % of the pull-off force"
    if rigid is None or soft is None:
        known, unknown = ("soft solids (JKR)", "a rigid one") if rigid is None else (name, "soft solids")
        return f"not that of {known}, which is off by more than 5 %; that of {unknown} is not known for this problem"
    return f"transition between the rigid limit ({name}) and that of soft solids (JKR)"


def _rigid_limit(problem: Problem, errors: Sequence[Json], force: Row) -> Json | None:
    """Error of the force on a rigid solid."""
    value = rigid_force(problem)
    if value is None:
        return next((row for row in errors if row["model"] == "bradley"), None)
    change = change_of(replace(force, value=value, u_num=0.0), force)
    return change and {"error": change[0], "u_num": change[1]}


def _soft_limit(problem: Problem, errors: Sequence[Json]) -> Json | None:
    """Error of the force on a solid so soft that the range of the law does not count."""
    # Of a sphere under a law of its own only the exact sphere has a closed form.
    rows = errors or (errors_of_exact_sphere(problem) if problem.punch.kind == PARABOLOID else [])
    return next((row for row in rows if row["model"] in _OF_SOFT_SOLIDS), None)
