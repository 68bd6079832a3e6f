"""Evaluation of a model for a problem, in the units of the problem: SI, or dimensionless."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np
import scipy

from comparisons.domain import declared_domain, skip
from comparisons.model import HasCurve, HasCurveTo, HasSkip, Model, NotTaken, Result, refuse
from comparisons.problem.problem import Problem
from comparisons.quantities import ALL_QUANTITIES, CURVES, QUANTITIES, Points, points_of

#: Models that solve the equations, and the series of their values; others are closed forms or other approximations.
REFERENCES = ("fscm", "fem", "fscm-stieltjes", "fscm-stieltjes-400", "atlas", "fem-large-strain")

#: Models that solve the equations.
SOLVERS = tuple(name for name in REFERENCES if name != "atlas")


def unit_of(problem: Problem, quantity: str) -> str:
    """Return the unit of a quantity of a problem.

    Examples
    --------
    >>> unit_of(Problem.dimensionless(2, 0, 1), "jump_in_gap")
    'z0'
    """
    row = ALL_QUANTITIES[quantity]
    return row.unit if problem.is_dimensionless else row.si_unit


def evaluated(problem: Problem, model: Model, quantity: str) -> Result | Points:
    """Return a quantity by a model, in the units of the problem.

    Where a model that does not solve the equations does not take the problem (`comparisons.domain.skip`), its number is
    that without surface tension and friction, and of the equivalent power law where the solid is another one.  The
    reason names both.

    Raises
    ------
    NotApplicable, ComputationFailed
        As the model.

    Examples
    --------
    >>> from comparisons.models.bradley import Bradley
    >>> evaluated(Problem.dimensionless(2, 0, 1), Bradley(), "pull_off_force").value
    2.0
    """
    try:
        # A model of this repository refuses a number by itself; not every one has the method of a curve.
        if quantity not in QUANTITIES or not isinstance(model, HasSkip):
            refuse(skip(model, problem, quantity))
        row = ALL_QUANTITIES[quantity]
        return row.in_units(row.evaluate(model, problem), problem.units)  # type: ignore[arg-type]  # of its own kind
    except NotTaken as refusal:
        reason = str(refusal)
    domain = declared_domain(model)
    is_solved = model.name in REFERENCES or (domain is not None and domain.is_list)
    if quantity not in QUANTITIES or is_solved:
        raise NotTaken(reason)
    elastic = problem.without(*problem.surface)
    if problem.surface:
        result = cast(Result, evaluated(elastic, model, quantity))
    elif problem.punch_solid is None and problem.is_of_the_paper("punch", "law") and not problem.is_of_the_paper():
        result = _with_equivalent_solid(problem, model, quantity)
    else:
        raise NotTaken(reason)
    neglected = " and ".join(f"{name} = {value}" for name, value in problem.surface.items())
    sentences = result.reason, f"{model.name} neglects {neglected}" if neglected else ""
    return replace(result, reason="; ".join(filter(None, sentences)))


def force_curve_to(problem: Problem, model: Model, load: float) -> Points:
    """Return the force curve of a model up to a compressive load, both in the units of the problem.

    It ends at this load, or where the curve of a model ends that cannot go on (see `comparisons.model.HasCurveTo`).

    Raises
    ------
    NotApplicable, ComputationFailed
        As the model.

    Examples
    --------
    >>> from comparisons.models.jkr import JKR
    >>> round(force_curve_to(Problem.dimensionless(2, 0, 1), JKR(), 5.0).y[-1], 12)
    5.0
    """
    refuse(skip(model, problem, "force_curve"))
    quantity, units = CURVES["force_curve"], problem.units
    if isinstance(model, HasCurveTo):
        curve = model.curve_to(problem, load / units["load"])
    else:
        curve = cast(HasCurve, model).curve(problem)
    return _up_to(quantity.in_units(points_of(curve), units), load)


def _up_to(points: Points, load: float) -> Points:
    """Return the points with the state of a load, on the cubic through its neighbours, as the last one."""
    y = np.array(points.y)
    beyond = int(np.argmin(y)) + np.flatnonzero(y[np.argmin(y) :] >= load)
    if not beyond.size:
        return points
    last = int(beyond[0])
    near = slice(max(last - 2, int(np.argmin(y))), last + 2)

    def ended(values: Sequence[float]) -> list[float]:
        column = np.array(values, float)
        between = scipy.interpolate.BarycentricInterpolator(y[near], column[near])
        return [*column[:last], float(between(load))]

    columns = {name: np.array(ended(values)) for name, values in points.columns.items()}
    return Points(ended(points.x), [*points.y[:last], load], points.u_distance, columns)


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


def dimensionless_result(problem: Problem, quantity: str, result: Result) -> tuple[float, float, str] | None:
    """Return value, u_num and unit of a result in SI in the units of the paper; None where these are not defined."""
    row = QUANTITIES[quantity]
    if problem.is_dimensionless or row.scale == "number" or not problem.is_of_the_paper("punch"):
        return None
    unit = problem.units[row.scale]
    return result.value / unit, result.u_num / unit, row.unit
