"""Least squares of named numbers, perhaps between limits: values, covariance and correlations.

The method is that of Levenberg and Marquardt (MINPACK, by SciPy), or a trust region where a number has limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from comparisons.model import Array

__all__ = ["Limits", "Minimum", "minimised"]

Numbers = Mapping[str, float]

#: Most evaluations for each number.
_EVALUATIONS = 40
#: Share of a range by which a number stays within its limits at first.
_INSIDE = 1e-10


class Limits(NamedTuple):
    """The least and the largest value of a number."""

    low: float = -math.inf
    high: float = math.inf


@dataclass(frozen=True, eq=False)
class Minimum:
    """The numbers of a least sum of squares.

    Attributes
    ----------
    numbers : dict of str to float
    squares : float
        The sum.
    reduced : float
        The same for each degree of freedom.
    covariance : ndarray or None
        In the order of the numbers, for residuals of the size that they have; None where the residuals do not
        determine the numbers.
    """

    numbers: dict[str, float]
    squares: float
    reduced: float
    covariance: Array | None

    @cached_property
    def deviations(self) -> dict[str, float]:
        """Standard deviations, infinite where they are unknown."""
        if self.covariance is None:
            return dict.fromkeys(self.numbers, math.inf)
        return dict(zip(self.numbers, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    def correlation(self, name: str, other: str) -> float:
        """That of two numbers; zero where it is unknown."""
        if self.covariance is None:
            return 0.0
        names, deviations = list(self.numbers), self.deviations
        covariance = float(self.covariance[names.index(name), names.index(other)])
        return covariance / (deviations[name] * deviations[other])


def minimised(
    residuals: Callable[[Numbers], Array],
    jacobian: Callable[[Numbers], Array],
    start: Numbers,
    limits: Mapping[str, Limits],
    tolerance: float,
) -> Minimum:
    """Return where the sum of squares is least near a start.

    Parameters
    ----------
    residuals, jacobian : callable
        From numbers to shape (m,) and to shape (m, number of them).
    start : mapping of str to float
    limits : mapping of str to Limits
        Of some of the numbers.
    tolerance : float
        Relative change of the sum of squares, and of the numbers, that ends the search.

    Examples
    --------
    >>> x, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([1.0, 3.1, 4.9, 7.0])
    >>> line = minimised(
    ...     lambda p: p["a"] + p["b"] * x - y,
    ...     lambda p: np.column_stack([0.0 * x + 1.0, x]),
    ...     {"a": 0.0, "b": 0.0},
    ...     {},
    ...     1e-8,
    ... )
    >>> {name: round(value, 9) for name, value in line.numbers.items()}, round(line.correlation("a", "b"), 4)
    ({'a': 1.03, 'b': 1.98}, -0.8018)
    """
    # Imported here: it takes a third of a second, and what only describes a fit does not need it.
    from scipy.optimize import least_squares

    names = list(start)

    def named(point: Array) -> dict[str, float]:
        return dict(zip(names, point.tolist(), strict=True))

    ranges = [limits.get(name, Limits()) for name in names]
    low, high = (np.array(ends) for ends in zip(*ranges, strict=True))
    is_limited = bool(np.isfinite(low).any() or np.isfinite(high).any())

    @lru_cache(maxsize=2)
    def derivatives(point: tuple[float, ...]) -> Array:
        # SciPy asks for those of the start twice, and for those of the end again.
        return jacobian(dict(zip(names, point, strict=True)))

    given = np.array([start[name] for name in names])
    result = least_squares(
        lambda point: residuals(named(point)),
        _within(given, low, high) if is_limited else given,
        jac=lambda point: derivatives(tuple(point.tolist())),
        bounds=(low, high) if is_limited else (-np.inf, np.inf),
        method="trf" if is_limited else "lm",
        x_scale="jac",
        ftol=tolerance,
        xtol=tolerance,
        gtol=np.finfo(float).eps,
        max_nfev=_EVALUATIONS * len(names),
    )
    squares = 2.0 * float(result.cost)
    reduced = squares / max(len(result.fun) - len(names), 1)
    is_at_limit = bool(np.any(result.active_mask))
    return Minimum(named(result.x), squares, reduced, None if is_at_limit else _covariance(result.jac, reduced))


def _within(point: Array, low: Array, high: Array) -> Array:
    """The point, or the nearest one inside the limits."""
    room = _INSIDE * np.where(np.isfinite(high - low), high - low, 1.0)
    return np.asarray(np.clip(point, low + room, high - room))


def _covariance(jacobian: Array, reduced: float) -> Array | None:
    """Covariance of the numbers; None where the derivatives are as good as dependent."""
    sizes = np.linalg.norm(jacobian, axis=0)
    if not np.isfinite(sizes).all() or not sizes.all():
        return None
    _, singular, axes = np.linalg.svd(jacobian / sizes, full_matrices=False)
    if singular[-1] <= np.finfo(float).eps * len(jacobian) * singular[0]:
        return None
    scaled = (axes.T / singular) / sizes[:, None]
    return np.asarray(reduced * scaled @ scaled.T)
