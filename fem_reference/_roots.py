"""Root of a function between two places where its signs differ, by Brent's method.

`scipy.optimize` has it as well, with 0.2 s of imports: a sixth of a process that computes one force.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from fem_reference.errors import Failure, NotConverged

__all__ = ["root_between"]

#: Largest change of the root at the end: absolute, and relative to it.
TOLERANCE, RELATIVE_TOLERANCE = 2e-12, 4.0 * 2.0**-52

#: Evaluations before giving up. Bisection alone takes 53 to halve an interval to rounding, and Brent's method at most
#: a few times as many.
EVALUATIONS = 200


def root_between(
    function: Callable[[float], float],
    low: float,
    high: float,
    tolerance: float = TOLERANCE,
    relative: float = RELATIVE_TOLERANCE,
) -> float:
    """Return where a function vanishes.

    R. P. Brent, Algorithms for Minimization without Derivatives (1973), chapter 4: inverse quadratic interpolation,
    the secant, or bisection where they gain too little.

    Parameters
    ----------
    function : callable
        Continuous.
    low, high : float
        Where its signs differ.
    tolerance, relative : float
        Largest error of the root: a length, and a share of the root.

    Raises
    ------
    NotConverged
        If both signs are the same, or the evaluations do not suffice.

    Examples
    --------
    >>> round(root_between(lambda x: x**2 - 2.0, 0.0, 2.0), 12)
    1.414213562373
    """
    x, best = float(low), float(high)
    y, at_best = float(function(x)), float(function(best))
    opposite, at_opposite = x, y
    last = step = best - x
    if y * at_best > 0.0:
        raise NotConverged(
            f"a function has the same sign at {low:.9g} and {high:.9g}: {y:.1e} and {at_best:.1e}", Failure.EVENT
        )
    for _ in range(EVALUATIONS):
        if math.copysign(1.0, at_opposite) == math.copysign(1.0, at_best):
            opposite, at_opposite = x, y
            last = step = best - x
        if abs(at_opposite) < abs(at_best):
            x, best, opposite = best, opposite, best
            y, at_best, at_opposite = at_best, at_opposite, at_best
        smallest = 0.5 * (tolerance + relative * abs(best))
        half = 0.5 * (opposite - best)
        if at_best == 0.0 or abs(half) <= smallest:
            return best
        trial = _interpolated(x, y, best, at_best, opposite, at_opposite) if abs(at_best) < abs(y) else math.inf
        if abs(last) > smallest and 2.0 * abs(trial) < min(abs(last), 3.0 * abs(half) - smallest):
            last, step = step, trial
        else:
            last = step = half
        x, y = best, at_best
        best += step if abs(step) > smallest else math.copysign(smallest, half)
        at_best = float(function(best))
    raise NotConverged(
        f"the root of a function was not found between {low:.9g} and {high:.9g} in {EVALUATIONS} evaluations",
        Failure.EVENT,
    )


def _interpolated(x: float, y: float, best: float, at_best: float, opposite: float, at_opposite: float) -> float:
    """Step from the best place to the root of the secant, or of the inverse quadratic through three places."""
    if x == opposite:
        return -at_best * (best - x) / (at_best - y)
    before, across = (y - at_best) / (x - best), (at_opposite - at_best) / (opposite - best)
    divisor = across * before * (at_opposite - y)
    return -at_best * (at_opposite * across - y * before) / divisor if divisor else math.inf
