r"""Table of the images of a ring: polynomials on patches of the logarithms of r + t and abs(r - t).

The sum of the images depends on the solid, on A = r + t and on B = abs(r - t) alone.  In log A and log B it is analytic
in a strip of half-width pi/4, whatever the depths are, so that a polynomial of fixed degree on each patch of fixed size
follows it.  The patches are made when they are first needed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from fscm._typing import Array
from fscm.graded.images import Images
from fscm.graded.kernel import image_ring, image_sum

__all__ = ["ImageTable"]

# Degree and size of a patch: the singularities are at a distance of pi/4 or more, so that they fall like 4.7^-m.
_DEGREE, _SIZE = 15, math.log(2.0)
# Distances below this share of the length of the solid count as this one.
_LEAST = 1e-11
# Patches of shorter distances, down to zero, are one where A is larger by so many patches: the polynomial is in B
# there.  The shallow images follow B down to the length over which the modulus changes at the surface, so that these
# distances begin where the polynomial follows them to _ERROR: at the first of these numbers, or by steps lower.
_SHORT, _APART, _LOWER, _LOWEST = -14, 4, 4, -50
# Images shallower than this share of B, or deeper than A over this share, are joined: what their expansion in the
# square of the ratio leaves is the fourth power of it.
_FAR = 7e-4
# Error of the table: its own, relative to the largest D, at least 1, and rounding and what is left out for each unit
# of the strengths of the images.  Measured worst 7e-14 over coatings with contrasts of 1e-4 to 1e4.  The coefficients
# fall by factors of 5, so that the last ones are above what is left out.
_ERROR, _PER_STRENGTH = 2e-13, 2e-15
# On the joined patches the shallowest images are shallower than the first node, and the coefficients do not show it:
# the polynomial is compared with the sum at so many distances, from this share of the longest one on.  The largest
# difference counts so many times: measured at most 1.05 times it between them (offset power laws, k = 0.4 and 0.8).
_COMPARED, _FROM, _OF_COMPARED = 25, 1e-8, 2.0
# Numbers of the patches in each direction: a pair of them is one integer.
_MOST = 256
# Number of those that are joined.
_JOINED = 0
# Points whose polynomials are evaluated together: they take 1 MB.
_AT_A_TIME = 2048


class ImageTable:
    """A sum_j a_j f(d_j), and its change when all radii grow, by A and B.

    Parameters
    ----------
    images : Images
    length : float
        Depth near which the solid changes.
    """

    def __init__(self, images: Images, length: float) -> None:
        self._images, self._length = images, length
        self._worst = 0.0
        self._patches: dict[int, Array] = {}
        self._nodes = chebyshev.chebpts1(_DEGREE + 1)
        self._to_modes = np.linalg.inv(chebyshev.chebvander(self._nodes, _DEGREE))
        self._derivative = np.zeros((_DEGREE + 1, _DEGREE + 1))
        slopes = chebyshev.chebder(np.eye(_DEGREE + 1))
        self._derivative[:-1] = slopes * (2.0 / _SIZE)
        # B d/dB on [0, 1], x = 2 B - 1
        products = [chebyshev.chebmul(slope, [1.0, 1.0]) for slope in slopes.T]
        self._linear = np.stack([np.pad(c, (0, _DEGREE + 1 - len(c))) for c in products], axis=1)
        for self._first_short in range(_SHORT, _LOWEST, -_LOWER):
            joined = self._coefficients(self._first_short + _APART + _MOST // 2, _JOINED)
            if _last(joined)[1] < _ERROR * images.largest:
                break

    @property
    def error(self) -> float:
        """Bound of the error of all values so far."""
        own = _ERROR * self._images.largest + _PER_STRENGTH * float(np.sum(np.abs(self._images.strengths)))
        return own + self._worst

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
        """Coefficients of value and derivative, shape (degree + 1, 2, degree + 1): in log A, then in log B."""
        if key not in self._patches:
            i, j = divmod(key, _MOST)
            c = self._coefficients(i, j)
            in_A, in_B = _last(c)
            self._worst = max(self._worst, in_A, self._compared(c, i) if j == _JOINED else in_B)
            rate = self._derivative @ c + c @ (self._linear if j == _JOINED else self._derivative).T
            self._patches[key] = np.ascontiguousarray(np.stack([c, rate], axis=1))
        return self._patches[key]

    def _compared(self, c: Array, i: int) -> float:
        """Bound on what the polynomials of a joined patch leave out."""
        A = np.array([self._length * math.exp((i - _MOST // 2 + 0.5) * _SIZE)])[:, None]
        share = np.append(0.0, np.geomspace(_FROM, 1.0, _COMPARED))
        B = np.maximum(self._short * share, _LEAST * self._length)[None, :]
        found = chebyshev.chebval2d(np.zeros_like(share), 2.0 * B[0] / self._short - 1.0, c)
        return _OF_COMPARED * float(np.max(np.abs(found - (A * self._sum(A, B))[0])))

    def _sum(self, A: Array, B: Array) -> Array:
        """Sum of a_j f(d_j); images that are shallow or deep beside the patch are joined."""
        d, a = self._images.depths, self._images.strengths
        size = np.abs(d)
        shallow = size < _FAR * float(np.min(np.minimum(A, B)))
        deep = size > float(np.max(np.maximum(A, B))) / _FAR
        near = ~(shallow | deep)
        total = image_sum(A[..., None], B[..., None], d[near], a[near])
        if shallow.any():
            zero, first = np.zeros(()), size[shallow][-1]
            at_zero = image_ring(A, B, zero)
            slope = (image_ring(A, B, first) - at_zero) / first**2
            total += a[shallow].sum().real * at_zero + (a[shallow] @ d[shallow] ** 2).real * slope
        if deep.any():
            last = size[deep][0]
            slope = (last * image_ring(A, B, last) - 1.0) * last**2
            total += (a[deep] / d[deep]).sum().real + (a[deep] / d[deep] ** 3).sum().real * slope
        return total

    def of(self, A: Array, B: Array) -> tuple[Array, Array]:
        """A sum_j a_j f(d_j) and its derivative by the logarithm of a common factor of A and B, shape (n,) each."""
        B = np.maximum(B, _LEAST * self._length)
        x = np.log(A / self._length) / _SIZE + _MOST // 2
        y = np.log(B / self._length) / _SIZE + _MOST // 2
        i, j = np.floor(x), np.floor(y)
        first = self._first_short + _MOST // 2
        short = (j < first) & (i >= first + _APART)
        j[short] = _JOINED
        y[short] = _JOINED + B[short] / self._short
        keys = (i * _MOST + j).astype(np.uint16)
        order = np.argsort(keys, kind="stable")
        x, y = (2.0 * (x - i) - 1.0)[order], (2.0 * (y - j) - 1.0)[order]
        keys = keys[order]
        starts = np.flatnonzero(np.append(True, keys[1:] != keys[:-1])) if len(keys) else np.empty(0, int)
        ends = np.append(starts[1:], len(keys))
        sums, count = np.empty((2, len(x))), _DEGREE + 1
        work = np.empty((4, count, _AT_A_TIME))
        for first in range(0, len(x), _AT_A_TIME):
            last = min(first + _AT_A_TIME, len(x))
            X, Y, rows = work[0, :, : last - first], work[1, :, : last - first], work[2:, :, : last - first]
            _polynomials(x[first:last], X)
            _polynomials(y[first:last], Y)
            patches = np.searchsorted(ends, first, side="right"), np.searchsorted(starts, last)
            for one in range(int(patches[0]), int(patches[1])):
                part = slice(max(int(starts[one]), first) - first, min(int(ends[one]), last) - first)
                c = self._patch(int(keys[starts[one]]))
                rows[..., part] = (c.reshape(count, -1).T @ X[:, part]).reshape(2, count, -1)
            rows *= Y
            rows.sum(axis=1, out=sums[:, first:last])
        found = np.empty((2, len(x)))
        found[:, order] = sums
        return found[0], found[1]


def _last(coefficients: Array) -> tuple[float, float]:
    """Largest of the last two coefficients of each polynomial in log A, and of each in B."""
    size = np.abs(coefficients)
    return float(np.max(size[-2:])), float(np.max(size[:-2, -2:]))


def _polynomials(x: Array, out: Array) -> None:
    """Chebyshev polynomials up to _DEGREE, in `out`, shape (_DEGREE + 1, n)."""
    out[0], out[1] = 1.0, x
    twice = 2.0 * x
    for m in range(1, _DEGREE):
        np.multiply(twice, out[m], out=out[m + 1])
        out[m + 1] -= out[m - 1]
