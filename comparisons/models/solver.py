"""Translation of a solver's exceptions and solutions into those of the model contract."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from comparisons.model import ComputationFailed, NotApplicable, RadialField, Result
from comparisons.numerics.curve_distance import mesh_difference

__all__ = ["result_of", "surface_of", "translated"]


_ONES = {"radius": 1.0, "traction": 1.0, "gap": 1.0}


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


def result_of(solution: Any, unit: float = 1.0) -> Result:
    """Return a solution as a result, its value and uncertainty divided by `unit`.

    Examples
    --------
    >>> result_of(Result(value=3.0, u_num=3e-9), unit=2.0).value
    1.5
    """
    order = getattr(solution, "observed_order", None)
    return Result(
        value=solution.value / unit,
        u_num=solution.u_num / unit,
        size=solution.size,
        iterations=solution.iterations,
        residual=solution.residual,
        seconds=solution.seconds,
        # Lost in rounding, it is not finite.
        observed_order=order if order is not None and math.isfinite(order) else None,
    )


def surface_of(coarse: Any, fine: Any, units: Mapping[str, float] = _ONES) -> RadialField:
    """Return the surface of the finer mesh in `units`; its uncertainty is the distance of the two meshes."""
    surfaces = [
        RadialField(state.radius / units["radius"], state.pressure / units["traction"], state.gap / units["gap"])
        for state in (coarse, fine)
    ]
    pressure, gap = (
        mesh_difference(*surfaces[0].shown(name)[:2], *surfaces[1].shown(name)[:2]) for name in ("pressure", "gap")
    )
    return replace(surfaces[1], u_distance=pressure, u_gap_distance=gap)
