r"""Table of the images of a ring: polynomials on patches of the logarithms of r + t and abs(r - t).

The sum of the images depends only on the solid, on A = r + t and on B = abs(r - t).  In log A and log B it is analytic
in a strip of half-width pi/4, whatever the depths are, so that a polynomial of fixed degree approximates it on each
patch of fixed size.  Patches are computed on demand.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from fscm._surface.response.images import Images
from fscm._surface.response.kernel import image_ring, image_sum
from fscm._typing import Array

__all__ = ["ImageTable"]

#: Size of a patch: singularities are at a distance of pi/4 or more, so that coefficients fall like 4.7^-m.
_SIZE = math.log(2.0)
#: Least distance, in units of the length of the solid.
_LEAST = 1e-11
#: Where A is larger than B by _APART patches, all patches of short distances, down to zero, are joined to one with a
#: polynomial in B.  The shallow images depend on B down to the length over which the modulus changes at the surface:
#: the short distances begin where the polynomial is accurate to _ERROR, at the patch _SHORT, or by steps _LOWER lower.
_SHORT, _APART, _LOWER, _LOWEST = -14, 4, 4, -50
#: Images shallower than this share of B, or deeper than A over this share, are lumped: the error of their expansion in
#: the square of the ratio is its fourth power.
_FAR = 7e-4
#: Error of a table of degree _HIGHEST, relative to the largest D, at least 1, and rounding and truncation for each unit
#: of the strengths of the images.  Measured worst 7e-14 over coatings with contrasts of 1e-4 to 1e4.  The coefficients
#: fall by factors of _FALL, so that the last ones exceed the truncation error.
_HIGHEST, _ERROR, _PER_STRENGTH, _FALL = 15, 2e-13, 2e-15, 5.0
#: On the joined patches images may be shallower than the smallest node, which the coefficients do not show: the
#: polynomial is compared with the sum at _COMPARED distances, from the share _FROM of the longest one on.  The error is
#: _OF_COMPARED times the largest difference: measured at most 1.05 times (offset power laws, k = 0.4 and 0.8).
_COMPARED, _FROM, _OF_COMPARED = 25, 1e-8, 2.0
#: Range of the index of a patch in each direction: a pair of indices is one integer.
_MOST = 256
#: Index of the joined patches.
_JOINED = 0
#: Points evaluated together: fewer take more calls, more are out of the cache (measured: 71, 64 and 59 ns a point with
#: 2048, 4096 and 8192 points of degree 11).
_AT_A_TIME = 8192


class ImageTable:
    """A sum_j a_j f(d_j), and its change when all radii grow, by A and B.

    Parameters
    ----------
    images : Images
    length : float
        Depth near which the solid changes.
    degree : int
        Of the polynomials, up to 15; each degree fewer makes the error five times as large.
    """

    def __init__(self, images: Images, length: float, degree: int = _HIGHEST) -> None:
        self._images, self._length = images, length
        self._worst = 0.0
        self._patches: dict[int, Array] = {}
        self._count = count = degree + 1
        self._least_error = _ERROR * _FALL ** (_HIGHEST - degree) * images.largest
        self._nodes = chebyshev.chebpts1(count)
        self._to_modes = np.linalg.inv(chebyshev.chebvander(self._nodes, degree))
        self._derivative = np.zeros((count, count))
        slopes = chebyshev.chebder(np.eye(count))
        self._derivative[:-1] = slopes * (2.0 / _SIZE)
        # B d/dB on [0, 1], x = 2 B - 1
        products = [chebyshev.chebmul(slope, [1.0, 1.0]) for slope in slopes.T]
        self._linear = np.stack([np.pad(c, (0, count - len(c))) for c in products], axis=1)
        for self._first_short in range(_SHORT, _LOWEST, -_LOWER):
            joined = self._coefficients(self._first_short + _APART + _MOST // 2, _JOINED)
            if _last(joined)[1] < self._least_error:
                break

    @property
    def error(self) -> float:
        """Bound of the error of all values computed so far."""
        return self._least_error + _PER_STRENGTH * float(np.sum(np.abs(self._images.strengths))) + self._worst

    @property
    def _short(self) -> float:
        return self._length * math.exp(self._first_short * _SIZE)

    def _coefficients(self, i: int, j: int) -> Array:
        """Coefficients of the values on a patch, shape (degree + 1, degree + 1): in log A, then in log B or B."""
        half = 0.5 * _SIZE
        A = self._length * np.exp((i - _MOST // 2 + 0.5) * _SIZE + half * self._nodes)[:, None]
        if j == _JOINED:
            B = self._short * (0.5 + 0.5 * self._nodes)[None, :]
        else:
            B = self._length * np.exp((j - _MOST // 2 + 0.5) * _SIZE + half * self._nodes)[None, :]
        c: Array = self._to_modes @ (A * self._sum(A, B)) @ self._to_modes.T
        return c

    def _patch(self, key: int) -> Array:
        """Coefficients of value, then of derivative, shape (2 degree + 2, degree + 1): in log B, for each in log A."""
        if key not in self._patches:
            i, j = divmod(key, _MOST)
            c = self._coefficients(i, j)
            in_A, in_B = _last(c)
            self._worst = max(self._worst, in_A, self._compared(c, i) if j == _JOINED else in_B)
            rate = self._derivative @ c + c @ (self._linear if j == _JOINED else self._derivative).T
            self._patches[key] = np.concatenate([c.T, rate.T])
        return self._patches[key]

    def _compared(self, c: Array, i: int) -> float:
        """Bound on the error of the polynomials of a joined patch."""
        A = np.array([self._length * math.exp((i - _MOST // 2 + 0.5) * _SIZE)])[:, None]
        share = np.append(0.0, np.geomspace(_FROM, 1.0, _COMPARED))
        B = np.maximum(self._short * share, _LEAST * self._length)[None, :]
        polynomial = chebyshev.chebval2d(np.zeros_like(share), 2.0 * B[0] / self._short - 1.0, c)
        return _OF_COMPARED * float(np.max(np.abs(polynomial - (A * self._sum(A, B))[0])))

    def _sum(self, A: Array, B: Array) -> Array:
        """Sum of a_j f(d_j), with images much shallower or deeper than the patch lumped."""
        d, a = self._images.depths, self._images.strengths
        size = np.abs(d)
        shallow = size < _FAR * float(np.min(np.minimum(A, B)))
        deep = size > float(np.max(np.maximum(A, B))) / _FAR
        separate = ~(shallow | deep)
        total = image_sum(A[..., None], B[..., None], d[separate], a[separate])
        if shallow.any():
            zero, scale = np.zeros(()), size[shallow][-1]
            at_zero = image_ring(A, B, zero)
            slope = (image_ring(A, B, scale) - at_zero) / scale**2
            total += a[shallow].sum().real * at_zero + (a[shallow] @ d[shallow] ** 2).real * slope
        if deep.any():
            scale = size[deep][0]
            slope = (scale * image_ring(A, B, scale) - 1.0) * scale**2
            total += (a[deep] / d[deep]).sum().real + (a[deep] / d[deep] ** 3).sum().real * slope
        return total

    def of(self, A: Array, B: Array) -> tuple[Array, Array]:
        """A sum_j a_j f(d_j) and its derivative by the logarithm of a common factor of A and B, shape (n,) each."""
        B = np.maximum(B, _LEAST * self._length)
        x = np.log(A / self._length) / _SIZE + _MOST // 2
        y = np.log(B / self._length) / _SIZE + _MOST // 2
        i, j = np.floor(x), np.floor(y)
        shortest = self._first_short + _MOST // 2
        short = (j < shortest) & (i >= shortest + _APART)
        j[short] = _JOINED
        y[short] = _JOINED + B[short] / self._short
        keys = (i * _MOST + j).astype(np.uint16)
        order = np.argsort(keys, kind="stable")
        x, y = (2.0 * (x - i) - 1.0)[order], (2.0 * (y - j) - 1.0)[order]
        keys = keys[order]
        starts = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])) if len(keys) else np.empty(0, int)
        sums = _sums([self._patch(key) for key in keys[starts].tolist()], [*starts.tolist(), len(x)], x, y)
        results = np.empty((2, len(x)))
        results[:, order] = sums
        return results[0], results[1]


def _sums(patches: list[Array], bounds: list[int], x: Array, y: Array) -> Array:
    """Value and derivative, shape (2, n), at points; those from one of the bounds to the next are in one patch."""
    sums, size = np.empty((2, len(x))), min(len(x), _AT_A_TIME)
    degrees = patches[0].shape[1] if patches else 0
    in_A, in_B, rows = (np.empty((count, size)) for count in (degrees, degrees, 2 * degrees))
    patch = 0
    for begin in range(0, len(x), _AT_A_TIME):
        points = slice(begin, min(begin + _AT_A_TIME, len(x)))
        count = points.stop - begin
        _polynomials(x[points], in_A[:, :count])
        _polynomials(y[points], in_B[:, :count])
        while True:
            columns = slice(max(bounds[patch], begin) - begin, min(bounds[patch + 1], points.stop) - begin)
            np.matmul(patches[patch], in_A[:, columns], out=rows[:, columns])
            if bounds[patch + 1] >= points.stop:
                break
            patch += 1
        of_both = rows.reshape(2, degrees, size)[..., :count]
        np.einsum("dmi,mi->di", of_both, in_B[:, :count], out=sums[:, points])
    return sums


def _last(coefficients: Array) -> tuple[float, float]:
    """Largest of the last two coefficients in log A, and in log B or B."""
    size = np.abs(coefficients)
    return float(np.max(size[-2:])), float(np.max(size[:-2, -2:]))


def _polynomials(x: Array, out: Array) -> None:
    """Chebyshev polynomials, in `out`, shape (degree + 1, n)."""
    out[0], out[1] = 1.0, x
    twice = 2.0 * x
    for m in range(1, len(out) - 1):
        np.multiply(twice, out[m], out=out[m + 1])
        out[m + 1] -= out[m - 1]
