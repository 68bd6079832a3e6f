"""Steps and ranges that the paper does not state: which of them give the printed digits.

A largest value over n, k or mu depends on the points at which it was searched.  Here the ends of the regions of
Fig. 11(b) are the first and the last multiple of 0.001, and the largest relative errors of Fig. 16(b) those of a
series of Tabor numbers that begins above 0.01, or that lacks the place of the maximum.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from comparisons.data.paper_values import PaperValue
from comparisons.paper.studies.tabor_curve import RANGE, Extreme, TaborCurve, largest_error
from fscm.physical import PhysicalProblem

__all__ = ["JIN_NU", "LAST_K", "N_STEP", "first_or_last_step", "jin_start", "rounding_starts", "without_place"]

Array = NDArray[np.float64]

#: Last gradient exponent and step of the shape index with which all eight numbers of Fig. 11 have the printed digits.
LAST_K, N_STEP = 0.999, 0.001
#: Poisson's ratio of Jin et al. (2021), whose Tabor number of 0.01 is 0.0109 at n = 1, k = 0.4.
JIN_NU = 0.3
#: Points of the search for the ends of an interval of Tabor numbers.
_SEARCH = 40001
#: Digits of the ends that are shown: the interval is rounded inwards, a place that is left out outwards.
_DIGITS = 4


def first_or_last_step(end: float, *, first: bool) -> float:
    """Return the first multiple of `N_STEP` from a least n on, or the last up to a largest n.

    Examples
    --------
    >>> first_or_last_step(0.97395, first=True), first_or_last_step(6.21961, first=False)
    (0.974, 6.219)
    """
    steps = math.ceil(end / N_STEP) if first else math.floor(end / N_STEP)
    return round(steps * N_STEP, 3)


def jin_start(n: float, k: float) -> float:
    """Return the Tabor number where that of Jin et al. (Eq. 30) is 0.01 at their Poisson's ratio.

    Examples
    --------
    >>> round(jin_start(1, 0.4), 5)
    0.0109
    """
    problem = PhysicalProblem(E0=1.0, c0=1.0, k=k, nu=JIN_NU, Q=1.0, n=n, work_of_adhesion=1.0, z0=1.0)
    return RANGE[0] * problem.tabor_number / problem.tabor_number_jin


def rounding_starts(paper_value: PaperValue, model: TaborCurve, exact: TaborCurve) -> tuple[float, float] | None:
    """Return the least and the largest smallest mu with which the error rounds to the printed one, or None.

    The error must be largest at the smallest mu; both numbers are rounded inwards to four decimals.
    """
    half = 0.5 * 10.0 ** -len(paper_value.text.partition(".")[2])
    mu = np.geomspace(*RANGE, _SEARCH)
    size = 100.0 * np.abs(model(mu) / exact(mu) - 1.0)
    inside = np.abs(size - paper_value.value) < half
    if size.argmax() != 0 or inside[0] or not inside.any():
        return None
    chosen = mu[inside]
    step = 10.0**-_DIGITS
    return math.ceil(chosen[0] / step) * step, math.floor(chosen[-1] / step) * step


def without_place(paper_value: PaperValue, model: TaborCurve, exact: TaborCurve) -> tuple[float, float, Extreme] | None:
    """Return the interval of mu around the maximum without which the error rounds to the printed one, and that error.

    None if the maximum is at an end of the range or is not above what rounds to the printed number.
    """
    half = 0.5 * 10.0 ** -len(paper_value.text.partition(".")[2])
    mu = np.geomspace(*RANGE, _SEARCH)
    size = 100.0 * np.abs(model(mu) / exact(mu) - 1.0)
    # With its bound, so that the error beside the interval certainly rounds to the printed one.
    above = size + 100.0 * (1.0 + 0.01 * size) * (model.error + exact.error) >= paper_value.value + half
    if not above.any() or above[0] or above[-1]:
        return None
    step = 10.0**-_DIGITS
    first, last = np.flatnonzero(above)[[0, -1]]
    low, high = math.floor(mu[first - 1] / step) * step, math.ceil(mu[last + 1] / step) * step
    sides = (largest_error(model, exact, high=low), largest_error(model, exact, low=high))
    return low, high, max(sides, key=lambda found: abs(found.kappa))
