"""Uncertainty of a quantity from those of the values in a problem file, to first order."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import fscm
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.problem.form import limits_of
from comparisons.problem.problem import Problem
from comparisons.problem.uncertain import Uncertainty
from comparisons.quantities import QUANTITIES
from fscm import NoSuchEvent, NotConverged, ValueSensitivity, sensitivity

__all__ = ["Contribution", "Propagated", "Range", "propagated"]


@dataclass(frozen=True, slots=True)
class Contribution:
    """What one uncertain value of the file contributes.

    Attributes
    ----------
    section, key : str
    value : float
        In SI.
    uncertainty : Uncertainty
    slope : float
        Derivative of the quantity by the value, in SI.
    elasticity : float or None
        d ln(quantity) / d ln(value): the slope times the value over the quantity; None where the quantity is 0.

    Examples
    --------
    >>> Contribution("punch", "R", 1e-6, Uncertainty(1e-7, False, "1 um +- 10 %"), -0.5, None).size
    5e-08
    """

    section: str
    key: str
    value: float
    uncertainty: Uncertainty
    slope: float
    elasticity: float | None

    @property
    def name(self) -> str:
        """Section and key with a dot between them."""
        return f"{self.section}.{self.key}"

    @property
    def size(self) -> float:
        """Standard deviation of the quantity from this value alone, or half the width of its range."""
        return abs(self.slope) * self.uncertainty.size


@dataclass(frozen=True, slots=True)
class Range:
    """Range of a quantity over the intervals of the file.

    Attributes
    ----------
    low, high : float
        To first order, in SI; every value is at the end of its interval where the quantity is least or largest.
    solved : tuple of float, or None
        The same with the quantity solved at both places, their numerical bounds included; None where there is no value.
    is_monotone : bool or None
        Whether every slope has the same sign there as in the middle.
    """

    low: float
    high: float
    solved: tuple[float, float] | None
    is_monotone: bool | None


@dataclass(frozen=True, slots=True)
class Propagated:
    """A quantity with what follows from the uncertainties of the file.

    Attributes
    ----------
    quantity : str
    value, u_num : float
        Of the FSCM at the values of the file, in `unit`; the bound is that of the numerical error.
    unit : str
        In SI.
    contributions : tuple of Contribution
    standard_deviation : float or None
        From all standard deviations, which are independent: the root of the sum of squares; None where there are none.
    range : Range or None
        From all intervals; None where there are none.
    """

    quantity: str
    value: float
    u_num: float
    unit: str
    contributions: tuple[Contribution, ...]
    standard_deviation: float | None
    range: Range | None


def propagated(problem: Problem, quantity: str = "pull_off_force") -> Propagated:
    """Propagate the uncertainties of the values of a file to a quantity of the FSCM, by exact derivatives.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `fscm.SENSITIVE`.

    Raises
    ------
    ValueError
        If the file has no uncertain value, or the quantity has no sensitivity.
    NotApplicable
        If the problem has no such event.
    ComputationFailed
        If the FSCM does not converge.

    Examples
    --------
    The force on a rigid solid is proportional to radius and work of adhesion:

    >>> from comparisons.problem import Problem, Section
    >>> R = Section("sphere", {"R": 1e-6}, uncertain={"R": Uncertainty(3e-8, False, "1 +- 0.03 um")})
    >>> values, some = {"work_of_adhesion": 0.05, "z0": 3e-10}, Uncertainty(2e-3, False, "0.05 J/m^2 +- 4 %")
    >>> law = Section("lennard-jones-9-3", values, uncertain={"work_of_adhesion": some})
    >>> solid = Section("power-law", {"E0": 1e18, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> found = propagated(Problem(solid, R, law))
    >>> round(found.standard_deviation / found.value, 6)
    0.05
    """
    uncertain = [(*key, uncertainty) for key, uncertainty in problem.uncertain.items()]
    if not uncertain:
        raise ValueError(
            f'{problem.path}: no value has an uncertainty; write one as "2 +- 0.1 GPa", "2 GPa +- 5 %" or '
            '"[1.8, 2.2] GPa"'
        )
    try:
        found = _contributions(problem, quantity, uncertain)
        value, u_num, contributions = found
        deviations = [one.size for one in contributions if not one.uncertainty.is_interval]
        intervals = [one for one in contributions if one.uncertainty.is_interval]
        unit = QUANTITIES[quantity].si_unit
        deviation = math.hypot(*deviations) if deviations else None
        range_ = _range(problem, quantity, value, intervals) if intervals else None
        return Propagated(quantity, value, u_num, unit, contributions, deviation, range_)
    except NoSuchEvent as missing:
        raise NotApplicable(str(missing)) from missing
    except NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure


def _varied(problem: Problem, section: str, key: str) -> Callable[[float], fscm.Problem]:
    return lambda value: problem.with_value(section, key, value).build(fscm)


def _contributions(
    problem: Problem, quantity: str, uncertain: list[tuple[str, str, Uncertainty]]
) -> tuple[float, float, tuple[Contribution, ...]]:
    """Value and bound of the quantity, and the contributions of uncertain values."""
    solved: ValueSensitivity = sensitivity(problem.build(fscm), quantity)
    value, found = solved.solution.value, []
    for section, key, uncertainty in uncertain:
        part = getattr(problem, section)
        at = part[key]
        slope = solved.derivative(
            _varied(problem, section, key),
            at,
            max(abs(at), uncertainty.size),
            *limits_of(section, part.kind, key),
        )
        found.append(Contribution(section, key, at, uncertainty, slope, slope * at / value if value else None))
    return value, solved.solution.u_num, tuple(found)


def _range(problem: Problem, quantity: str, value: float, intervals: list[Contribution]) -> Range:
    """The range to first order, and the values and slopes where it ends."""
    half = sum(one.size for one in intervals)
    names = [(one.section, one.key, one.uncertainty) for one in intervals]
    ends, monotone = [], True
    try:
        for side in (-1.0, 1.0):
            there = problem
            for one in intervals:
                low, high = one.uncertainty.limits(one.value)
                there = there.with_value(one.section, one.key, high if side * one.slope > 0.0 else low)
            end, u_num, slopes = _contributions(there, quantity, names)
            ends.append(end + side * u_num)
            monotone &= all(a.slope * b.slope >= 0.0 for a, b in zip(slopes, intervals, strict=True))
    except (NoSuchEvent, NotConverged, ValueError):
        return Range(value - half, value + half, None, None)
    return Range(value - half, value + half, (min(ends), max(ends)), monotone)
