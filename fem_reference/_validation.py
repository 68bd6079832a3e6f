"""Checks of numbers that describe a problem."""

from __future__ import annotations

import math

__all__ = ["check_positive"]


def check_positive(name: str, value: float) -> None:
    """Raise ValueError with the value and the admissible range unless a number is positive and finite."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"{name} = {value} is outside (0, infinity)")
