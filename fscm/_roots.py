"""Root of a function in a bracket.

`scipy.optimize` has such a function, but its import takes as long as a pull-off force.
"""

from __future__ import annotations

import math
from collections.abc import Callable

__all__ = ["bracketed_root"]

#: Tolerances by default, absolute and relative: the second is four roundings.
_ABSOLUTE, _RELATIVE = 2e-12, 2.0**-50
#: Largest number of evaluations: bisection alone needs 1100 for the whole range of numbers.
_MOST = 1200


def bracketed_root(
    function: Callable[[float], float], a: float, b: float, absolute: float = _ABSOLUTE, relative: float = _RELATIVE
) -> float:
    """Root of a function that changes its sign between two points, by Chandrupatla's method.

    The method takes inverse quadratic interpolation where three points show that it will do, and bisection elsewhere
    (T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149).

    Parameters
    ----------
    function : callable
    a, b : float
        Ends of the bracket, in any order.
    absolute, relative : float
        The root is in a bracket no wider than absolute + relative * abs(root).

    Returns
    -------
    float
        The end of the last bracket where the function is smaller.

    Raises
    ------
    ValueError
        If the function has the same sign at both ends.

    Examples
    --------
    >>> round(bracketed_root(lambda x: x * x - 2.0, 1.0, 2.0), 12)
    1.414213562373
    """
    f_a, f_b = function(a), function(b)
    if f_a == 0.0 or f_b == 0.0:
        return float(a if f_a == 0.0 else b)
    if (f_a > 0.0) == (f_b > 0.0):
        raise ValueError(f"the function has one sign at both ends of [{a}, {b}]: {f_a:.3g} and {f_b:.3g}")
    share = f_a / (f_a - f_b)  # of the secant
    for _ in range(_MOST):
        best = a if abs(f_a) < abs(f_b) else b
        least = 0.5 * (absolute + relative * abs(best)) / abs(b - a)
        if least >= 0.5:
            return float(best)
        x = a + min(max(share, least), 1.0 - least) * (b - a) if math.isfinite(share) else 0.5 * (a + b)
        f_x = function(x)
        if f_x == 0.0:
            return float(x)
        # a is the latest point, b beyond the root, and c the point before.
        if (f_x > 0.0) == (f_a > 0.0):
            c, f_c = a, f_a
        else:
            (b, f_b), (c, f_c) = (a, f_a), (b, f_b)
        a, f_a = x, f_x
        share = _share(a, b, c, f_a, f_b, f_c)
    raise ValueError(f"no root was found in {_MOST} evaluations; the last bracket is from {a} to {b}")


def _share(a: float, b: float, c: float, f_a: float, f_b: float, f_c: float) -> float:
    """Where the next point lies, as a share of the way from a to b."""
    place, height = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
    if not 1.0 - math.sqrt(1.0 - place) < height < math.sqrt(place):
        return 0.5
    by_b = f_a / (f_b - f_a) * f_c / (f_b - f_c)
    by_c = (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
    return by_b + by_c
