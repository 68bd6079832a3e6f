"""Translation of a solver's exceptions and solutions into those of the model contract."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from comparisons.model import ComputationFailed, NotApplicable, Result

__all__ = ["Solution", "result_of", "translated"]


class Solution(Protocol):
    """The attributes of a solution of every solver here."""

    @property
    def value(self) -> float:
        """The quantity."""
        ...

    @property
    def u_num(self) -> float:
        """Bound on its numerical error."""
        ...

    @property
    def size(self) -> int:
        """Unknowns of the finest mesh."""
        ...

    @property
    def iterations(self) -> int:
        """Newton iterations."""
        ...

    @property
    def residual(self) -> float:
        """Largest residual at the solution."""
        ...

    @property
    def seconds(self) -> float:
        """Wall-clock time."""
        ...


@contextmanager
def translated(no_such_event: type[Exception], not_converged: type[Exception]) -> Iterator[None]:
    """Turn a solver's own exceptions into `NotApplicable` and `ComputationFailed`.

    Examples
    --------
    >>> with translated(KeyError, ArithmeticError):
    ...     raise ArithmeticError("50 iterations were not enough")
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: 50 iterations were not enough
    """
    try:
        yield
    except no_such_event as reason:
        raise NotApplicable(str(reason)) from reason
    except not_converged as failure:
        raise ComputationFailed(str(failure)) from failure


def result_of(solution: Solution, unit: float = 1.0) -> Result:
    """Return a solution as a result, its value and uncertainty divided by `unit`.

    Examples
    --------
    >>> result_of(Result(value=3.0, u_num=3e-9), unit=2.0).value
    1.5
    """
    return Result(
        value=solution.value / unit,
        u_num=solution.u_num / unit,
        size=solution.size,
        iterations=solution.iterations,
        residual=solution.residual,
        seconds=solution.seconds,
        observed_order=_order(solution),
    )


def _order(solution: Solution) -> float | None:
    """The order over the meshes, of a solver that measures it and where it is not lost in rounding."""
    order = getattr(solution, "observed_order", None)
    return order if order is not None and math.isfinite(order) else None
