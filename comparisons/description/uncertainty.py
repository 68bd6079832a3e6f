"""Sensitivity of a quantity to the values in a problem file, and its uncertainty from theirs, as JSON has it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import fscm
from comparisons.data.validation import known_name
from comparisons.problem import Problem
from comparisons.problem.uncertain import Uncertainty
from comparisons.quantities import QUANTITIES, known_scalar

Json = dict[str, Any]
_Uncertain = Mapping[str, Uncertainty]


def check_quantity(quantity: str) -> None:
    """Refuse a quantity that has no sensitivity.

    Raises
    ------
    ValueError
        One sentence.
    """
    known_scalar(quantity, "--quantity")
    if quantity not in fscm.SENSITIVE:
        raise ValueError(
            f"the quantity {quantity} is none of those with a sensitivity, {', '.join(fscm.SENSITIVE)}: "
            "they are values at one event"
        )


def check_uncertain(problem: Problem) -> None:
    """Refuse a problem without an uncertain value, or without derivatives.

    Raises
    ------
    ValueError
        One sentence.
    """
    _check_friction(problem)
    if not problem.uncertain:
        raise ValueError(
            f'{problem.path or problem.label}: no value has an uncertainty; write one as "2 +- 0.1 GPa", '
            '"2 GPa +- 5 %" or "[1.8, 2.2] GPa"'
        )


def _check_friction(problem: Problem) -> None:
    if "solid.friction" in problem.surface:
        raise ValueError(
            f'{problem.path or problem.label}: friction = "bonded" has no exact derivatives, which are those of the '
            "integral equation; leave it out, or solve the file at two values"
        )


def uncertainty(problem: Problem, quantity: str = "pull_off_force") -> Json:
    """Return `sensitivity` of a problem to its uncertain values.

    Raises
    ------
    ValueError
        As `sensitivity` and `check_uncertain`.
    """
    check_uncertain(problem)
    return sensitivity(problem, quantity)


def sensitivity(problem: Problem, quantity: str = "pull_off_force", keys: Iterable[str] = ()) -> Json:
    """Return the derivatives of a quantity of the FSCM by the values of a problem, and its uncertainty from theirs.

    The derivatives are exact to 1e-6 of the value, by the adjoint method: no second problem is solved.

    Parameters
    ----------
    problem : Problem
        In physical units.
    quantity : str
        One of `fscm.SENSITIVE`.
    keys : iterable of str
        Names such as "solid.E0"; by default those of the uncertain values, or, where there are none, of all numbers
        but those that are 0.

    Returns
    -------
    dict
        Values in SI.  `slope` is the derivative of the quantity by a value, `elasticity` that of the logarithms, and
        `contribution` what the value alone makes of the standard deviation or of half the range, None if it is exact.
        Standard deviations are independent; at the ends of the range every value is at that end of its interval where
        the quantity is least or largest, to first order and solved there with the numerical bounds.  Without such an
        event or a converged state there is a status with its reason.

    Raises
    ------
    ValueError
        If the quantity has no sensitivity, or a key is no number of the problem.

    Examples
    --------
    >>> exact = {"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "0.3 nm"}
    >>> bead = Problem.of({"kind": "homogeneous", "E": "70 GPa", "nu": 0.2}, {"kind": "sphere", "R": "1 um"}, exact)
    >>> {row["parameter"]: round(row["elasticity"], 3) for row in sensitivity(bead)["parameters"]}
    {'solid.E': 0.046, 'solid.nu': 0.004, 'punch.R': 0.977, 'law.work_of_adhesion': 0.954, 'law.z0': 0.068}

    The force on a rigid solid is proportional to radius and work of adhesion:

    >>> from comparisons.problem import Section
    >>> R = Section("sphere", {"R": 1e-6}, uncertain={"R": Uncertainty(3e-8, False, "1 +- 0.03 um")})
    >>> values, some = {"work_of_adhesion": 0.05, "z0": 3e-10}, Uncertainty(2e-3, False, "0.05 J/m^2 +- 4 %")
    >>> law = Section("lennard-jones-9-3", values, uncertain={"work_of_adhesion": some})
    >>> found = sensitivity(Problem(Section("power-law", {"E0": 1e18, "c0": 1.0, "k": 0.0, "nu": 0.2}), R, law))
    >>> round(found["standard_deviation"] / found["value"], 6)
    0.05
    """
    _check_friction(problem)
    names, uncertain = _names(problem, keys), problem.uncertain
    uncertain = {name: spread for name, spread in uncertain.items() if name in names}
    try:
        value, u_num, slopes = _slopes(problem, quantity, names)
        intervals = {name: spread for name, spread in uncertain.items() if spread.is_interval}
        deviations = [abs(slopes[name]) * spread.size for name, spread in uncertain.items() if name not in intervals]
        return {
            "quantity": quantity,
            "model": "fscm",
            "value": value,
            "u_num": u_num,
            "unit": QUANTITIES[quantity].si_unit,
            "status": "ok",
            "parameters": [_parameter(problem, name, slopes[name], value) for name in names],
            "standard_deviation": math.hypot(*deviations) if deviations else None,
            "range": _range(problem, quantity, value, intervals, slopes) if intervals else None,
        }
    except (fscm.NoSuchEvent, fscm.NotConverged) as error:
        status = "not-applicable" if isinstance(error, fscm.NoSuchEvent) else "failed"
        return {"quantity": quantity, "status": status, "reason": str(error)}


def _parameter(problem: Problem, name: str, slope: float, value: float) -> Json:
    spread = problem.uncertain.get(name)
    size = {} if spread is None else {"half_width" if spread.is_interval else "standard_deviation": spread.size}
    return {
        "parameter": name,
        "value": problem[name],
        **size,
        "slope": slope,
        "elasticity": slope * problem[name] / value if value else None,
        "contribution": None if spread is None else abs(slope) * spread.size,
    }


def _names(problem: Problem, keys: Iterable[str]) -> list[str]:
    """The keys by which there is a derivative: those named, the uncertain ones, or all numbers but 0."""
    if problem.is_dimensionless:
        raise ValueError(
            f"{problem.label} has no values with a unit; take fscm.sensitivity(problem.posed, quantity).gradient, the "
            "derivatives by n, k and mu"
        )
    numbers = [name for name in problem.numbers_of_sections if problem[name] or name in problem.uncertain]
    for name in (named := [*keys]):
        known_name("key", name, numbers, problem.label)
    return named or [*problem.uncertain] or numbers


def _slopes(problem: Problem, quantity: str, names: Iterable[str]) -> tuple[float, float, dict[str, float]]:
    """Value and bound of the quantity, and its derivatives by values of the problem."""
    solved = fscm.sensitivity(problem.build(fscm), quantity)
    slopes = {}
    for name in names:
        form, stated = problem.form(name), problem[name]
        size = max(abs(stated), problem.uncertain[name].size if name in problem.uncertain else 0.0)
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
