"""The cohesive stress of the Dugdale law: the theoretical strength (Eq. 73) or eta(n) (Eqs. 76-78).

Stresses are in dgamma / z0.  eta makes the rigid limit of the Maugis-Dugdale pull-off equal that of the 9-3
law (Eq. 74).  Eq. 77 is 0/0 in the exponent at n = 2; with e = 1 - 2/n its logarithm is

    log eta = [ -log(1 + e/8) + log(Gamma(2+e) Gamma(2-e)) - (2+e)/6 sum_{j=3..8} log(1 + e/j) ] / e,

because 168 B(4 - 2/n, 6) = prod_{j=3..8} (1 + e/j)^-1, and every term of the bracket vanishes at e = 0.
"""

from __future__ import annotations

import math

from scipy.special import gammaln, zeta

#: Largest tension of the 9-3 law (Eq. 73).
THEORETICAL_STRENGTH = 16.0 * math.sqrt(3.0) / 27.0

#: At n <= 2/3 the tail -(8/3) H^-3 of the 9-3 law integrates to an infinite load over r^n / n.
SMALLEST_SHAPE_INDEX = 2.0 / 3.0

#: Below this e the even term is summed from its Taylor series, of which 16 terms leave 0.25^32 = 5e-20.
_SERIES_BELOW = 0.25
_SERIES_TERMS = 16


def _log1p_over(x: float) -> float:
    """log(1 + x) / x, 1 at x = 0."""
    return math.log1p(x) / x if x != 0.0 else 1.0


def _even_term(e: float) -> float:
    """log(Gamma(2 + e) Gamma(2 - e)) / e, odd in e; (1 - e^2) pi e / sin(pi e) is its argument."""
    if abs(e) >= _SERIES_BELOW:
        return float(gammaln(2.0 + e) + gammaln(2.0 - e)) / e
    series = sum(float(zeta(2 * m)) * e ** (2 * m - 1) / m for m in range(1, _SERIES_TERMS + 1))
    return series - e * _log1p_over(-e * e)


def eta(n: float) -> float:
    """Cohesive stress of the rigid-limit-consistency condition, in dgamma / z0 (Eq. 77).

    Parameters
    ----------
    n : float
        Shape index, > 2/3; ``math.inf`` gives the flat-punch limit.

    Returns
    -------
    float
        eta(n), from 0.347 at n = 1 to the theoretical strength 1.0264 at n = infinity.

    Raises
    ------
    ValueError
        If n <= 2/3.

    Examples
    --------
    >>> [round(eta(n), 3) for n in (1, 1.5, 2, 5)]
    [0.347, 0.499, 0.588, 0.803]
    """
    if not n > SMALLEST_SHAPE_INDEX:
        raise ValueError(f"eta(n) is not defined at n = {n}: for n <= 2/3 the rigid pull-off force is infinite")
    e = 1.0 - 2.0 / n
    sum_logs = sum(_log1p_over(e / j) / j for j in range(3, 9))
    return math.exp(-_log1p_over(e / 8.0) / 8.0 + _even_term(e) - (2.0 + e) / 6.0 * sum_logs)
