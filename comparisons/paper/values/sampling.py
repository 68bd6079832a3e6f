"""Grid of Fig. 11 that the paper does not state, with which all eight of its numbers have the printed digits.

A largest value over n or k depends on the points at which it was searched: here the ends of the regions of Fig. 11(b)
are the first and the last multiple of 0.001.
"""

from __future__ import annotations

import math

__all__ = ["LAST_K", "N_STEP", "first_or_last_step"]

#: Last gradient exponent and step of the shape index with which all eight numbers of Fig. 11 have the printed digits.
LAST_K, N_STEP = 0.999, 0.001


def first_or_last_step(end: float, *, first: bool) -> float:
    """Return the first multiple of `N_STEP` from a least n on, or the last up to a largest n.

    Examples
    --------
    >>> first_or_last_step(0.97395, first=True), first_or_last_step(6.21961, first=False)
    (0.974, 6.219)
    """
    steps = math.ceil(end / N_STEP) if first else math.floor(end / N_STEP)
    return round(steps * N_STEP, 3)
