"""Checks of what a model returns: real numbers, counts and columns, each with one sentence for an error."""

from __future__ import annotations

import math
import numbers

import numpy as np

from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

__all__ = ["LARGEST_CURVE", "column", "count", "kind", "real"]

#: Most points of a curve.
LARGEST_CURVE = 1_000_000
#: Counts (of unknowns, of iterations) are below it: tables store them with 64 bits and a sign.
_LARGEST_COUNT = 2**63


def real(name: str, value: object) -> float:
    """Return a finite real number.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it is none.

    Examples
    --------
    >>> real("value", "1.5")
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: the model gave str '1.5' as value, which is not a real number
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        raise ComputationFailed(f"the model gave {kind(value)} as {name}, which is not a real number")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ComputationFailed(f"the model gave {number} as {name}, which is not a finite number")
    return number


def count(name: str, value: object) -> int:
    """Return a count, as the stored tables have it.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it is none.

    Examples
    --------
    >>> count("size", 3.0)
    3
    """
    number = int(real(name, value))
    if not 0 <= number < _LARGEST_COUNT:
        raise ComputationFailed(
            f"the model gave {kind(value)} as {name}, which is outside [0, 2^63): it is a number of steps or unknowns"
        )
    return number


def column(name: str, values: object) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a column of a curve.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it is not a list of finite real numbers.

    Examples
    --------
    >>> column("load", [0, 1.5]).tolist()
    [0.0, 1.5]
    """
    try:
        array = np.asarray(values)
    except ValueError:  # lists of different lengths
        array = np.empty((0, 0))
    if array.ndim != 1 or array.dtype.kind not in "fiu" or not 1 <= len(array) <= LARGEST_CURVE:
        raise ComputationFailed(
            f"column {one_line(name, 60)} of the curve is {kind(values)}, not 1 to {LARGEST_CURVE} real numbers"
        )
    if not np.isfinite(array).all():
        raise ComputationFailed(f"column {one_line(name, 60)} of the curve has values that are not finite")
    return array.astype(float)


def kind(value: object) -> str:
    """Describe a value; of its own text at most one line.

    Examples
    --------
    >>> kind(None), kind([1])
    ('NoneType None', 'an object of type list')
    """
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and type {value.dtype}"
    if isinstance(value, str | int | float | complex | None):
        return one_line(f"{type(value).__name__} {value!r}", 80)
    return f"an object of type {one_line(type(value).__name__, 60)}"
