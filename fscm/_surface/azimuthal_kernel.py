r"""Ring response to a pressure that varies like cos(m theta) around the ring.

A ring of pressure cos(m theta) at the radius t lifts the surface at the radius r by cos(m theta) times

    G_m(r, t) = (t / 2 pi) int_0^{2 pi} cos(m phi) (r^2 + t^2 - 2 r t cos phi)^{-a} dphi,      a = (1 + k)/2,

in the unit of G_k = G_0 of `_surface.kernel`.  Expansion in powers of x = min(r, t) / max(r, t) and integration term
by term give

    G_m = t max(r, t)^{-(1+k)} (a)_m / m! x^m F(a, a+m; m+1; x^2),

and the quadratic transformation x^2 -> 4 x / (1 + x)^2 = 1 - y, with y = ((r - t) / (r + t))^2,

    G_m = t (r + t)^{-(1+k)} (a)_m / m! ((1 - y) / 4)^m F(a+m, m+1/2; 2m+1; 1 - y).

Here c - a - b is -k/2 for every m, so that G_m has the singularity of G_0 and the same product integration.
"""

from __future__ import annotations

from functools import lru_cache

import mpmath
import numpy as np

from fscm._surface.kernel import (
    _NEAR_LIMIT,
    _SERIES_TERMS,
    _SMALLEST_K,
    _ZERO_K,
    Kernel,
    _digits,
    _gauss_series,
    _polynomial,
    _scaled,
)
from fscm._typing import Array

__all__ = ["AzimuthalKernel", "azimuthal_kernel"]

#: Terms of the expansion in x^2 < 0.03, far from the ring; the last is below 1e-20 for every m in use.
_FAR_TERMS = 14


class AzimuthalKernel(Kernel):
    """The ring response G_m for one gradient exponent; it has the interface of `Kernel` without the primitives.

    Parameters
    ----------
    k : float
        Gradient exponent, 0 <= k < 1.
    m : int
        Number of waves around the ring, >= 0.

    Examples
    --------
    >>> radius, ring = np.array([0.5]), np.array([2.0])
    >>> same = AzimuthalKernel(0.4, 0).response(radius, ring, ring - radius)
    >>> bool(np.isclose(same, Kernel(0.4).response(radius, ring, ring - radius)))
    True
    """

    def __init__(self, k: float, m: int) -> None:
        self.k = 0.0 if k < _SMALLEST_K else float(k)
        self.m = m
        with mpmath.workdps(_digits(self.k)):
            q = mpmath.mpf(self.k) if self.k > 0 else mpmath.mpf(_ZERO_K)
            a = (1 + q) / 2
            half = mpmath.mpf(1) / 2
            front = mpmath.rf(a, m) / mpmath.factorial(m)
            # F(A, B; C; 1 - y) = regular + y^{-k/2} singular
            A, B, C = a + m, m + half, mpmath.mpf(2 * m + 1)
            regular = _scaled(
                _gauss_series(A, B, 1 + q / 2, _SERIES_TERMS),
                front * mpmath.gamma(C) * mpmath.gamma(-q / 2) / (mpmath.gamma(C - A) * mpmath.gamma(C - B)),
            )
            singular = _scaled(
                _gauss_series(C - A, C - B, 1 - q / 2, _SERIES_TERMS),
                front * mpmath.gamma(C) * mpmath.gamma(q / 2) / (mpmath.gamma(A) * mpmath.gamma(B)),
            )
            for _ in range(m):
                regular, singular = (_times_quarter_of_rest(series) for series in (regular, singular))
            pairs = list(zip(regular, singular, strict=True))
            self._near_D = _polynomial([x + y for x, y in pairs], _NEAR_LIMIT)
            self._near_C = _polynomial([y * q / 2 for _, y in pairs], _NEAR_LIMIT)
            series = _scaled(_gauss_series(a, a + m, mpmath.mpf(m + 1), _FAR_TERMS), front)
            self._far = np.array([float(c) for c in series])

    def response(self, r: Array, t: Array, distance: Array) -> Array:
        """G_m(r, t), as `Kernel.response`."""
        out = super().response(r, t, distance)
        far = distance > np.sqrt(_NEAR_LIMIT) * (r + t)
        out[far] *= (np.minimum(r[far], t[far]) / np.maximum(r[far], t[far])) ** self.m
        return out


def _times_quarter_of_rest(series: list[mpmath.mpf]) -> list[mpmath.mpf]:
    """Taylor coefficients of (1 - y)/4 times a series in y."""
    return [(x - y) / 4 for x, y in zip(series, [mpmath.mpf(0), *series[:-1]], strict=True)]


@lru_cache(maxsize=64)
def azimuthal_kernel(k: float, m: int) -> AzimuthalKernel:
    """The kernel of an exponent and a number of waves, cached."""
    return AzimuthalKernel(k, m)
