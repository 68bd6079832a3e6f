"""Checks of numbers that describe a problem."""

from __future__ import annotations

import math
from numbers import Real

__all__ = ["check_positive", "check_tension"]


def check_positive(name: str, value: float) -> None:
    """Raise ValueError with the value and the admissible range unless a number is positive and finite."""
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    if not (is_number and math.isfinite(value) and value > 0):
        shown = value if is_number else repr(value)
        raise ValueError(f"{name} = {shown} is outside (0, infinity): it is a real number{_with_unit(value)}")


def check_tension(value: float) -> None:
    """Raise ValueError with the value and the admissible range unless a surface tension is not negative, and finite."""
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    if not (is_number and math.isfinite(value) and value >= 0):
        shown = value if is_number else repr(value)
        raise ValueError(
            f"surface_tension = {shown} is outside [0, infinity): it is a force per length, and a surface that gains "
            "energy by growing is unstable"
        )


def _with_unit(value: object) -> str:
    """What to write in place of a text, or of a number of pint or uncertainties."""
    if any(hasattr(value, name) for name in ("strip", "magnitude", "nominal_value")):
        return "; values with a unit or an uncertainty are those of comparisons.Problem.of"
    return ""
