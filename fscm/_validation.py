"""Check of the numbers that a user passes."""

from __future__ import annotations

import math
from numbers import Real

__all__ = ["real_number"]


def real_number(
    name: str,
    value: object,
    *,
    low: float,
    high: float,
    reason: str,
    closed_low: bool = False,
    closed_high: bool = False,
) -> float:
    """Return `value` as a float when it is a real number of the given interval.

    Parameters
    ----------
    name : str
        Name of the number in the message.
    value : object
        Python or numpy real scalar; bool, complex, str and arrays are not real numbers.
    low, high : float
        Ends of the admissible interval; infinite where there is no bound.
    reason : str
        Why the interval ends there, completing "... is outside (low, high): reason".
    closed_low, closed_high : bool
        Whether the ends belong to the interval.

    Raises
    ------
    ValueError
        With the value, the admissible interval and the reason.
    """
    interval = f"{'[' if closed_low else '('}{low:g}, {high:g}{']' if closed_high else ')'}"
    # bool is an int for Python, but never a length or an exponent.
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"{name} = {value!r} is not a real number in {interval}: {reason}{_remedy(value)}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    above = number >= low if closed_low else number > low
    below = number <= high if closed_high else number < high
    if not (above and below and math.isfinite(number)):
        raise ValueError(f"{name} = {value} is outside {interval}: {reason}")
    return number


def _remedy(value: object) -> str:
    """Where a value with a unit or an uncertainty is taken: a text, or a number of pint or uncertainties."""
    if isinstance(value, str) or hasattr(value, "magnitude") or hasattr(value, "nominal_value"):
        return "; take plain numbers in one system of units, or pose the problem by comparisons.Problem.of"
    return ""
