"""Relative error kappa, its sign and its uncertainty: the one rule for tables, figures, gates and report."""

from __future__ import annotations

from typing import TypeVar

import pandas as pd

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
    """Return what two uncertainties, as bounds, allow of a relative error; the reference is also its unit.

    Examples
    --------
    >>> round(relative_uncertainty(1.1, 0.0, 1.0, 0.01), 12)
    0.011
    """
    return (u_num + abs(value / reference) * u_reference) / abs(reference)
