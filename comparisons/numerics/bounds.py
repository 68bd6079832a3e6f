r"""Relative error kappa, and the rule that combines two numerical bounds.

Every ``u_num`` is a bound on the numerical error of its value, with a safety factor of its own; it is not a standard
deviation.  So bounds add: if the exact values x* and r* are within u_x of x and within u_r of r, then
abs((x* - r*) - (x - r)) <= u_x + u_r, and no smaller number is a bound.  Gates, the normalised error E_n, tables,
figures and reports all use

    U = u_x + u_r,    E_n = (x - r) / U.

For the relative error kappa = (x - r) / abs(r) the exact change is

    kappa* - kappa = sign(r) (r (x* - x) - x (r* - r)) / (r r*),

so that abs(kappa* - kappa) <= (u_x + abs(x / r) u_r) / (abs(r) - u_r).  To first order in the bounds this is

    u_kappa = (u_x + abs(x / r) u_r) / abs(r),

smaller than the exact bound by the factor 1 - u_r / abs(r).  The gates limit u_r / abs(r), to 1e-3 or less in the
standing ones, so that the two differ by less than one part in a thousand of u_kappa.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import pandas as pd


_Numbers = TypeVar("_Numbers", float, "pd.Series")


def combined(*bounds: _Numbers) -> _Numbers:
    """Return the bound U of a sum or difference of values with these bounds, in the unit of the bounds.

    Examples
    --------
    >>> combined(0.25, 0.5)
    0.75
    """
    return sum(bounds[1:], start=bounds[0])


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
    """Return the bound u_kappa on the error of kappa, to first order (see the text of this module).

    The bound of the reference counts abs(value / reference) times, since the reference is also the unit of kappa.

    Examples
    --------
    >>> round(relative_uncertainty(1.1, 0.0, 1.0, 0.01), 12)
    0.011
    """
    return combined(u_num, abs(value / reference) * u_reference) / abs(reference)
