"""Relative error kappa: its sign and its bound, for tables, figures, gates and report."""

from __future__ import annotations

from typing import TypeVar

import pandas as pd

from comparisons.numerics.bounds import combined

__all__ = ["relative_difference", "relative_uncertainty"]

_Numbers = TypeVar("_Numbers", float, pd.Series)


def relative_difference(candidate: _Numbers, reference: _Numbers) -> _Numbers:
    """Return kappa = (candidate - reference) / abs(reference).

    The sign is that of candidate - reference, also where the reference is negative, as a displacement at jump-out is.

    Examples
    --------
    >>> [round(relative_difference(*pair), 12) for pair in ((1.1, 1.0), (-1.1, -1.0))]
    [0.1, -0.1]
    """
    return (candidate - reference) / abs(reference)


def relative_uncertainty(value: _Numbers, u_num: _Numbers, reference: _Numbers, u_reference: _Numbers) -> _Numbers:
    """Return the bound u_kappa on the error of kappa, to first order (see `comparisons.numerics.bounds`).

    The bound of the reference counts abs(value / reference) times, since the reference is also the unit of kappa.

    Examples
    --------
    >>> round(relative_uncertainty(1.1, 0.0, 1.0, 0.01), 12)
    0.011
    """
    return combined(u_num, abs(value / reference) * u_reference) / abs(reference)
