"""Bound on deviations of which a sample is known, by the statistics of its largest members.

The deviations above a high threshold are taken to be distributed exponentially: the heaviest tail of a bounded
quantity's that is usual (a generalised Pareto tail with shape zero; that of a bounded one is negative).
"""

from __future__ import annotations

import math

import numpy as np

from fscm._typing import Array

__all__ = ["FACTOR", "tail_bound"]

# Part of the sample above the threshold, and the least number of members there.
_UPPER, _FEWEST = 1.0 / 3.0, 6
# Probability that a point of the cell has a larger deviation.
_EXCEEDED = 1e-5
#: The bound is at least this many times the largest member: the nodes of a cell are few.
FACTOR = 3.0


def tail_bound(sample: Array) -> float:
    """Bound on the size of a quantity of which a sample is known.

    Parameters
    ----------
    sample : ndarray
        Its signs do not matter.

    Raises
    ------
    ValueError
        If the sample has fewer than 18 members.

    Examples
    --------
    >>> 3.0 < tail_bound(np.random.default_rng(1).normal(size=100)) < 12.0
    True
    """
    sizes = np.sort(np.abs(sample))
    above = round(_UPPER * len(sizes))
    if above < _FEWEST:
        raise ValueError(f"a sample of {len(sizes)} is outside [{math.ceil(_FEWEST / _UPPER)}, inf): it has no tail")
    threshold = sizes[-above - 1]
    excess = float(np.mean(sizes[-above:] - threshold))
    return float(max(threshold + excess * math.log(above / len(sizes) / _EXCEEDED), FACTOR * sizes[-1]))
