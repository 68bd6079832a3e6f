"""Smooth forms of the components of the atlas, which the series expand, and their inverses.

The forms are those whose coefficients fall fastest.  At the critical Tabor number the two folds of the displacement
merge in a cusp: with w, the share of the way from there to mu = 10, the difference of their displacements starts like
w^(3/2), that of their gaps like w^(1/2) and the hysteresis energy like w^2.  The quotients are smooth.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fscm._typing import Array

__all__ = ["FORMS", "Form", "Points", "critical_of_smooth", "smooth_of_critical"]

#: Pole beyond n = 1, in 1/n: the load integral of the 9-3 law diverges at n = 2/3.
_DIVERGES = 1.5


class Points(NamedTuple):
    """Parameters of points, and the share w of the way through their patch; arrays of shape (m,)."""

    n: Array
    k: Array
    mu: Array
    share: Array


class Form(NamedTuple):
    """A smooth form of a value.

    Attributes
    ----------
    smooth : callable
        Value, Points -> smooth form.
    value : callable
        The inverse.

    Examples
    --------
    >>> at = Points(*(np.array([x]) for x in (2.0, 0.4, 1.0, 0.25)))
    >>> form = FORMS["power_3_2"]
    >>> round(float(form.value(form.smooth(0.3, at), at)[0]), 12)
    0.3
    """

    smooth: Callable[[Array, Points], Array]
    value: Callable[[Array, Points], Array]


def _force_factor(at: Points) -> Array:
    # Radii in units of (n Q z0)^(1/n), and the pole of the tail's load.
    return at.n ** (2.0 / at.n) / (_DIVERGES - 1.0 / at.n)


def _power(exponent: float) -> Form:
    return Form(
        lambda value, at: np.log(value / at.share**exponent),
        lambda smooth, at: np.exp(smooth) * at.share**exponent,
    )


#: Smooth forms of quantities, to which series are fitted, by name.
FORMS: dict[str, Form] = {
    "force": Form(
        lambda value, at: np.log(value / _force_factor(at)), lambda smooth, at: np.exp(smooth) * _force_factor(at)
    ),
    # For small mu a value is smooth in M', of which mu is another power.
    "plain": Form(lambda value, at: value, lambda smooth, at: smooth),
    "displacement": Form(lambda value, at: value / (1.0 + at.mu), lambda smooth, at: smooth * (1.0 + at.mu)),
    "logarithm": _power(0.0),
    "minus_logarithm": Form(lambda value, at: np.log(-value), lambda smooth, at: -np.exp(smooth)),
    "root": Form(lambda value, at: value / np.sqrt(at.mu), lambda smooth, at: smooth * np.sqrt(at.mu)),
    "power_3_2": _power(1.5),
    "power_1_2": _power(0.5),
    "quarter": Form(lambda value, at: (value / at.share**2) ** 0.25, lambda smooth, at: smooth**4 * at.share**2),
}


def smooth_of_critical(n: Array, k: Array, mu: Array) -> Array:
    """ln(M' / 2) at the critical Tabor number, the smooth form in the plane (n, k).

    Examples
    --------
    >>> float(smooth_of_critical(np.array([1.0]), np.array([0.5]), np.array([1.0]))[0])
    0.0
    """
    return ((2.0 * n + k - 1.0) * np.log(mu) + (1.0 - k) * np.log(n)) / n


def critical_of_smooth(n: Array, k: Array, smooth: Array) -> Array:
    """The inverse of `smooth_of_critical`."""
    return np.exp((n * smooth - (1.0 - k) * np.log(n)) / (2.0 * n + k - 1.0))
