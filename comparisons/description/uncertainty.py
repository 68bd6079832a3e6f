"""Uncertainty of a quantity from those of the values in a problem file, to first order, as JSON has it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import fscm
from comparisons.problem import Problem
from comparisons.problem.kinds import KINDS
from comparisons.problem.uncertain import Uncertainty
from comparisons.quantities import QUANTITIES

__all__ = ["uncertainty"]

Json = dict[str, Any]
_Uncertain = Mapping[tuple[str, str], Uncertainty]


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
    if not uncertain:
        raise ValueError(
            f'{problem.path}: no value has an uncertainty; write one as "2 +- 0.1 GPa", "2 GPa +- 5 %" or '
            '"[1.8, 2.2] GPa"'
        )
    try:
        value, u_num, slopes = _slopes(problem, quantity, uncertain)
        intervals = {key: spread for key, spread in uncertain.items() if spread.is_interval}
        deviations = [abs(slopes[key]) * spread.size for key, spread in uncertain.items() if key not in intervals]
        return {
            "quantity": quantity,
            "model": "fscm",
            "value": value,
            "u_num": u_num,
            "unit": QUANTITIES[quantity].si_unit,
            "status": "ok",
            "parameters": [_parameter(problem, key, spread, slopes[key], value) for key, spread in uncertain.items()],
            "standard_deviation": math.hypot(*deviations) if deviations else None,
            "range": _range(problem, quantity, value, intervals, slopes) if intervals else None,
        }
    except (fscm.NoSuchEvent, fscm.NotConverged) as error:
        status = "not-applicable" if isinstance(error, fscm.NoSuchEvent) else "failed"
        return {"quantity": quantity, "status": status, "reason": str(error)}


def _parameter(problem: Problem, key: tuple[str, str], spread: Uncertainty, slope: float, value: float) -> Json:
    name = ".".join(key)
    return {
        "parameter": name,
        "value": problem[name],
        "half_width" if spread.is_interval else "standard_deviation": spread.size,
        "slope": slope,
        "elasticity": slope * problem[name] / value if value else None,
        "contribution": abs(slope) * spread.size,
    }


def _slopes(
    problem: Problem, quantity: str, uncertain: _Uncertain
) -> tuple[float, float, dict[tuple[str, str], float]]:
    """Value and bound of the quantity, and its derivatives by uncertain values."""
    solved = fscm.sensitivity(problem.build(fscm), quantity)
    slopes = {}
    for (section, key), spread in uncertain.items():
        section_values = getattr(problem, section)
        form = KINDS[section][section_values.kind].keys[key]
        size = max(abs(section_values[key]), spread.size)
        slopes[section, key] = solved.derivative(
            _varied(problem, section, key), section_values[key], size, form.low, form.high
        )
    return solved.solution.value, solved.solution.u_num, slopes


def _varied(problem: Problem, section: str, key: str) -> Callable[[float], fscm.Problem]:
    return lambda value: problem.with_value(section, key, value).build(fscm)


def _range(
    problem: Problem, quantity: str, value: float, intervals: _Uncertain, slopes: Mapping[tuple[str, str], float]
) -> Json:
    """The range over the intervals to first order, and the values and slopes where it ends."""
    half = sum(abs(slopes[key]) * spread.size for key, spread in intervals.items())
    stated: Json = {"first_order": [value - half, value + half], "solved": None, "is_monotone": None}
    ends, monotone = [], True
    try:
        for side in (-1.0, 1.0):
            at_end = problem
            for key, spread in intervals.items():
                low, high = spread.limits(problem[".".join(key)])
                at_end = at_end.with_value(*key, high if side * slopes[key] > 0.0 else low)
            end, u_num, end_slopes = _slopes(at_end, quantity, intervals)
            ends.append(end + side * u_num)
            monotone &= all(end_slopes[key] * slopes[key] >= 0.0 for key in intervals)
    except (fscm.NoSuchEvent, fscm.NotConverged, ValueError):
        return stated
    return stated | {"solved": sorted(ends), "is_monotone": monotone}
