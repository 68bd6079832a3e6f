r"""The rule that combines two numerical bounds.

Every ``u_num`` is a bound on the numerical error of its value, with a safety factor of its own; it is not a standard
deviation.  So bounds add: if the exact values x* and r* are within u_x of x and within u_r of r, then
abs((x* - r*) - (x - r)) <= u_x + u_r, and no smaller number is a bound.  Gates, the normalised error E_n, tables,
figures and reports all use

    U = FACTOR (u_x + u_r),    E_n = (x - r) / U.

For the relative error kappa = (x - r) / abs(r) the exact change is

    kappa* - kappa = sign(r) (r (x* - x) - x (r* - r)) / (r r*),

so that abs(kappa* - kappa) <= (u_x + abs(x / r) u_r) / (abs(r) - u_r).  To first order in the bounds this is

    u_kappa = FACTOR (u_x + abs(x / r) u_r) / abs(r),

smaller than the exact bound by the factor 1 - u_r / abs(r).  The gates limit u_r / abs(r), to 1e-3 or less in the
standing ones, so that the two differ by less than one part in a thousand of u_kappa.
"""

from __future__ import annotations

from typing import TypeVar

import pandas as pd

__all__ = ["FACTOR", "combined"]

_Bounds = TypeVar("_Bounds", float, pd.Series)

#: Factor on the sum of the bounds: one, since each bound has a safety factor of its own.
FACTOR = 1.0


def combined(*bounds: _Bounds) -> _Bounds:
    """Return the bound U of a sum or difference of values with these bounds, in the unit of the bounds.

    Examples
    --------
    >>> combined(0.25, 0.5)
    0.75
    """
    return FACTOR * sum(bounds[1:], start=bounds[0])
