r"""A flat punch and a paraboloid on a homogeneous half-space with surface tension: two universal functions.

The compliance of the surface is 2/(E* xi (1 + l xi)) with l = 2 Y/E*.  With a pressure whose transform is
p(xi) = integral of chi(t) cos(xi t) dt from 0 to a, contact with the profile u(r) is one equation on (0, a),

    integral_-a^a chi(t) k(s - t) dt = 2 v(s),   k(x) = integral_0^oo cos(xi x)/(1 + l xi) dxi,

v = E*/2 for u = 1 and E* s^2 for u = r^2.  Its solution for u = 1 gives the stiffness C = 2 E* a c(l/a) of a flat punch
and by reciprocity the load M = (2/3) E* a^3 m(l/a)/R that the profile r^2/(2 R) takes from it: P = C delta - M.  For
small l, c = 1 + (l/(pi a)) (ln(2 a/l) + gamma + 1) and m = 1 + (3 l/(pi a)) (ln(2 a/l) + gamma - 1); for large l the
surface is a membrane, m = 3 c/2.

The table has the Chebyshev coefficients of x/(c - 1) and x/(m - 1) in ln x, x = l/a, for 1e-5 <= x <= 1e5.
`python -m tests.comparisons.models.surface_tension_series` solves the equation and computes it.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike

from comparisons.model import Array

#: File of the coefficients, in `comparisons.data`.
FILE = "surface_tension.csv"

#: Largest l/a of the series; below its inverse are the expansions for small l.
LARGEST = 1e5

#: Relative error of c, m, k and e (measured: worst 4.7e-9 on m where the expansions end, at l/a = 1e-5, and 1.2e-10 on
#: k at l/a = 1e5).
SERIES_ERROR = 1e-8

_START = math.log(2.0) + np.euler_gamma


@dataclass(frozen=True, slots=True)
class Contact:
    """Constants of a contact, as functions of x = l/a; D is x d/dx.

    Attributes
    ----------
    c, m : ndarray
        Stiffness of a flat punch, and the load of a paraboloid.
    k, e : ndarray
        dC/da = 2 E* k and dM/da = 2 E* a^2 e/R: k = c - D c, e = m - D m/3.
    k_rate, e_rate : ndarray
        D k and D e.

    Examples
    --------
    >>> bare = contact(0.0)
    >>> float(bare.c), float(bare.m), float(bare.k), float(bare.e)
    (1.0, 1.0, 1.0, 1.0)
    """

    c: Array
    m: Array
    k: Array
    e: Array
    k_rate: Array
    e_rate: Array


def contact(ratio: ArrayLike) -> Contact:
    """Return the constants of contacts with l/a from 0 to `LARGEST`."""
    x = np.asarray(ratio, float)
    flat, curved = _series()
    c, c_slope, c_rate = _of_series(x, flat, 1.0, _START + 1.0)
    m, m_slope, m_rate = _of_series(x, curved, 3.0, _START - 1.0)
    return Contact(
        1.0 + c, 1.0 + m, 1.0 + c - c_slope, 1.0 + m - m_slope / 3.0, c_slope - c_rate, m_slope - m_rate / 3.0
    )


def _of_series(x: Array, series: Chebyshev, factor: float, start: float) -> tuple[Array, Array, Array]:
    """u = x/f, D u and D^2 u; below the series u = (factor x/pi) (start - ln x)."""
    y = np.log(np.clip(x, 1.0 / LARGEST, LARGEST))
    f, slope, rate = (series.deriv(order)(y) if order else series(y) for order in range(3))
    u, bend = x / f, 1.0 - slope / f
    inside = u, u * bend, u * (bend**2 - rate / f + (slope / f) ** 2)
    unit = factor * x / math.pi
    small = unit * (start - np.log(np.maximum(x, 1e-300)))
    below = small, small - unit, small - 2.0 * unit
    return tuple(np.where(x < 1.0 / LARGEST, low, high) for low, high in zip(below, inside, strict=True))  # type: ignore[return-value]  # three of three


@lru_cache(maxsize=1)
def _series() -> tuple[Chebyshev, Chebyshev]:
    text = files("comparisons.data").joinpath(FILE).read_text("utf-8")
    rows = list(csv.DictReader(text.splitlines()))
    end = math.log(LARGEST)
    flat, curved = (Chebyshev([float(row[name]) for row in rows], domain=(-end, end)) for name in ("flat", "curved"))
    return flat, curved
