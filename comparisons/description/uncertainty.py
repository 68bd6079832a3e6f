"""Uncertainty of a quantity from those of the values in a problem file, to first order, as JSON has it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import fscm
from comparisons.problem import Problem
from comparisons.problem.uncertain import Uncertainty
from comparisons.quantities import QUANTITIES

Json = dict[str, Any]
_Uncertain = Mapping[str, Uncertainty]


def uncertainty(problem: Problem, quantity: str = "pull_off_force") -> Json:
    """Propagate the uncertainties of the values of a file to a quantity of the FSCM, by exact derivatives.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `fscm.SENSITIVE`.

    Returns
    -------
    dict
        Values in SI.  `slope` is the derivative of the quantity by a value, `elasticity` that of the logarithms, and
        `contribution` what the value alone makes of the standard deviation or of half the range.  Standard deviations
        are independent; at the ends of the range every value is at that end of its interval where the quantity is
        least or largest, to first order and solved there with the numerical bounds.  Without such an event or a
        converged state there is a status with its reason.

    Raises
    ------
    ValueError
        If the file has no uncertain value, or the quantity has no sensitivity.

    Examples
    --------
    The force on a rigid solid is proportional to radius and work of adhesion:

    >>> from comparisons.problem import Section
    >>> R = Section("sphere", {"R": 1e-6}, uncertain={"R": Uncertainty(3e-8, False, "1 +- 0.03 um")})
    >>> values, some = {"work_of_adhesion": 0.05, "z0": 3e-10}, Uncertainty(2e-3, False, "0.05 J/m^2 +- 4 %")
    >>> law = Section("lennard-jones-9-3", values, uncertain={"work_of_adhesion": some})
    >>> found = uncertainty(Problem(Section("power-law", {"E0": 1e18, "c0": 1.0, "k": 0.0, "nu": 0.2}), R, law))
    >>> round(found["standard_deviation"] / found["value"], 6)
    0.05
    """
    uncertain = problem.uncertain
    if "solid.friction" in problem.surface:
        raise ValueError(
            f'{problem.path}: friction = "bonded" has no exact derivatives, which are those of the integral equation; '
            "leave it out, or solve the file at two values"
        )
    if not uncertain:
        raise ValueError(
            f'{problem.path}: no value has an uncertainty; write one as "2 +- 0.1 GPa", "2 GPa +- 5 %" or '
            '"[1.8, 2.2] GPa"'
        )
    try:
        value, u_num, slopes = _slopes(problem, quantity, uncertain)
        intervals = {name: spread for name, spread in uncertain.items() if spread.is_interval}
        deviations = [abs(slopes[name]) * spread.size for name, spread in uncertain.items() if name not in intervals]
        return {
            "quantity": quantity,
            "model": "fscm",
            "value": value,
            "u_num": u_num,
            "unit": QUANTITIES[quantity].si_unit,
            "status": "ok",
            "parameters": [_parameter(problem, name, slopes[name], value) for name in uncertain],
            "standard_deviation": math.hypot(*deviations) if deviations else None,
            "range": _range(problem, quantity, value, intervals, slopes) if intervals else None,
        }
    except (fscm.NoSuchEvent, fscm.NotConverged) as error:
        status = "not-applicable" if isinstance(error, fscm.NoSuchEvent) else "failed"
        return {"quantity": quantity, "status": status, "reason": str(error)}


def _parameter(problem: Problem, name: str, slope: float, value: float) -> Json:
    spread = problem.uncertain[name]
    return {
        "parameter": name,
        "value": problem[name],
        "half_width" if spread.is_interval else "standard_deviation": spread.size,
        "slope": slope,
        "elasticity": slope * problem[name] / value if value else None,
        "contribution": abs(slope) * spread.size,
    }


def _slopes(problem: Problem, quantity: str, uncertain: _Uncertain) -> tuple[float, float, dict[str, float]]:
    """Value and bound of the quantity, and its derivatives by uncertain values."""
    solved = fscm.sensitivity(problem.build(fscm), quantity)
    slopes = {}
    for name, spread in uncertain.items():
        form, stated = problem.form(name), problem[name]
        size = max(abs(stated), spread.size)
        slopes[name] = solved.derivative(_varied(problem, name), stated, size, form.low, form.high)
    return solved.solution.value, solved.solution.u_num, slopes


def _varied(problem: Problem, name: str) -> Callable[[float], fscm.Problem]:
    return lambda value: problem.with_value(name, value).build(fscm)


def _range(problem: Problem, quantity: str, value: float, intervals: _Uncertain, slopes: Mapping[str, float]) -> Json:
    """The range over the intervals to first order, and the values and slopes where it ends."""
    half = sum(abs(slopes[name]) * spread.size for name, spread in intervals.items())
    stated: Json = {"first_order": [value - half, value + half], "solved": None, "is_monotone": None}
    ends, monotone = [], True
    try:
        for side in (-1.0, 1.0):
            at_end = problem
            for name, spread in intervals.items():
                low, high = spread.limits(problem[name])
                at_end = at_end.with_value(name, high if side * slopes[name] > 0.0 else low)
            end, u_num, end_slopes = _slopes(at_end, quantity, intervals)
            ends.append(end + side * u_num)
            monotone &= all(end_slopes[name] * slopes[name] >= 0.0 for name in intervals)
    except (fscm.NoSuchEvent, fscm.NotConverged, ValueError):
        return stated
    return stated | {"solved": sorted(ends), "is_monotone": monotone}
