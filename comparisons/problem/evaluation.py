"""Evaluation of a model for a problem, in the units of the problem: SI, or dimensionless."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from comparisons.domain import declared_domain
from comparisons.model import Model, NotApplicable, Result
from comparisons.problem.problem import Problem
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES, Points

#: Models that solve the equations; every other one is a closed form or another approximation.
REFERENCES = ("fscm", "fem", "fscm-stieltjes", "fscm-stieltjes-400", "atlas", "fem-large-strain")


def unit_of(problem: Problem, quantity: str) -> str:
    """Return the unit of a quantity of a problem.

    Examples
    --------
    >>> unit_of(Problem.dimensionless(2, 0, 1), "jump_in_gap")
    'z0'
    """
    row = ALL_QUANTITIES[quantity]
    return row.si_unit if problem.name else row.unit


def evaluated(problem: Problem, model: Model, quantity: str) -> Result | Points:
    """Return a quantity by a model, in the units of the problem.

    A scalar of a model that knows n, k and mu alone is that of the equivalent power law where the solid is another one.
    One of a closed form is that without surface tension and friction, which its reason names.

    Raises
    ------
    NotApplicable, ComputationFailed
        As the model; also if it does not take the problem.

    Examples
    --------
    >>> from comparisons.models.bradley import Bradley
    >>> evaluated(Problem.dimensionless(2, 0, 1), Bradley(), "pull_off_force").value
    2.0
    """
    row = ALL_QUANTITIES[quantity]
    only_the_solid_differs = problem.is_of_the_paper("punch", "law") and not problem.is_of_the_paper("solid")
    checks_problems = getattr(model, "checks_problems", False)
    is_closed_form = model.name not in REFERENCES and not checks_problems
    if quantity in QUANTITIES and problem.surface and getattr(model, "neglects_surface", is_closed_form):
        return _without_surface(problem, model, quantity)
    if quantity in QUANTITIES and only_the_solid_differs and is_closed_form and problem.punch_solid is None:
        return _with_equivalent_solid(problem, model, quantity)
    _check(problem, model, quantity)
    return row.in_units(row.evaluate(model, problem), problem.units)  # type: ignore[arg-type]  # of its own kind


def _with_equivalent_solid(problem: Problem, model: Model, quantity: str) -> Result:
    """Evaluate a model that knows n, k and mu alone with the power law that stands for the solid of a problem."""
    # Imported here: other problems do not need the spectrum of the elastic energy.
    from comparisons.problem.equivalent_solid import equivalent_solids

    with_law, coarser = equivalent_solids(problem)
    result, of_coarser = (cast(Result, evaluated(with_solid, model, quantity)) for with_solid in (with_law, coarser))
    return replace(
        result,
        u_num=result.u_num + abs(result.value - of_coarser.value),
        reason=f"with the equivalent power law of the {problem.solid.kind} solid, k = {with_law.solid['k']:.4f}",
    )


def _without_surface(problem: Problem, model: Model, quantity: str) -> Result:
    """Evaluate a model that knows elasticity alone without the surface tension and the friction of a problem."""
    result = cast(Result, evaluated(problem.without(*problem.surface), model, quantity))
    neglected = " and ".join(f"{name} = {value}" for name, value in problem.surface.items())
    return replace(result, reason="; ".join(filter(None, (result.reason, f"{model.name} neglects {neglected}"))))


def _check(problem: Problem, model: Model, quantity: str) -> None:
    """Raise `NotApplicable` where a model does not take the parts of a problem, or is outside its domain."""
    if problem.is_of_the_paper():
        domain = declared_domain(model)
        if domain is not None and not domain.contains(quantity, problem.numbers):
            raise NotApplicable(domain.refusal(quantity))
    elif not getattr(model, "checks_problems", False):
        raise NotApplicable(
            f"{model.name} takes a power-law or homogeneous solid, or two of one k, with neither surface tension nor "
            f"friction, a sphere, cone or power-law punch and the 9-3 law; this problem has {problem.parts}"
        )
    elif quantity == "critical_tabor_number":
        raise NotApplicable("the critical Tabor number is that of a power-law solid and punch with the 9-3 law")


def dimensionless_result(problem: Problem, quantity: str, result: Result) -> tuple[float, float, str] | None:
    """Return value, u_num and unit of a result in SI in the units of the paper; None where these are not defined."""
    row = QUANTITIES[quantity]
    if not problem.name or row.scale == "number" or not problem.is_of_the_paper("punch"):
        return None
    unit = problem.units[row.scale]
    return result.value / unit, result.u_num / unit, row.unit
