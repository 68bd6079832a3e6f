r"""Table of the images of a ring: polynomials on patches of the logarithms of r + t and abs(r - t).

The sum of the images depends on the solid, on A = r + t and on B = abs(r - t) alone.  In log A and log B it is analytic
in a strip of half-width pi/2, whatever the depths are, so that a polynomial of fixed degree on each patch of fixed size
follows it.  The patches are made when they are first needed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from fscm._typing import Array
from fscm.graded.images import Images
from fscm.graded.kernel import image_ring

__all__ = ["ImageTable"]

# Degree and size of a patch: the singularities are at a distance of pi/2, so that they fall like 4.75^-m.
_DEGREE, _SIZE = 17, math.log(4.0)
# Distances below this share of the length of the solid count as this one.
_LEAST = 1e-11
# Patches of shorter distances, down to zero, are one where A is larger by so many patches: the polynomial is in B
# there, and leaves 5e-12 at most (measured; an offset power law): the shallow images follow B in steps of a decade.
_SHORT, _APART = -7, 2
# Images shallower than this share of B, or deeper than A over this share, are joined: what their expansion in the
# square of the ratio leaves is the fourth power of it.
_FAR = 7e-4
# Error of the table: its own, and rounding and what is left out for each unit of the strengths of the images; measured
# worst 2e-10 on a sharp layer, whose strengths are 3e5 together.
_ERROR, _PER_STRENGTH = 1e-11, 2e-15
# Numbers of the patches in each direction: a pair of them is one integer.
_MOST = 200
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
        self._short = length * math.exp(_SHORT * _SIZE)
        #: Bound of the error of the value.
        self.error = _ERROR + _PER_STRENGTH * float(np.sum(np.abs(images.strengths)))
        self._patches: dict[int, Array] = {}
        self._nodes = chebyshev.chebpts1(_DEGREE + 1)
        self._to_modes = np.linalg.inv(chebyshev.chebvander(self._nodes, _DEGREE))
        self._derivative = np.zeros((_DEGREE + 1, _DEGREE + 1))
        slopes = chebyshev.chebder(np.eye(_DEGREE + 1))
        self._derivative[:-1] = slopes * (2.0 / _SIZE)
        # B d/dB on [0, 1], x = 2 B - 1
        products = [chebyshev.chebmul(slope, [1.0, 1.0]) for slope in slopes.T]
        self._linear = np.stack([np.pad(c, (0, _DEGREE + 1 - len(c))) for c in products], axis=1)

    def _patch(self, key: int) -> Array:
        """Coefficients of value and derivative, shape (degree + 1, 2, degree + 1): in log A, then in log B."""
        if key not in self._patches:
            i, j = divmod(key, _MOST)
            half = 0.5 * _SIZE
            A = self._length * np.exp((i - _MOST // 2 + 0.5) * _SIZE + half * self._nodes)[:, None]
            if j == _JOINED:
                B = self._short * (0.5 + 0.5 * self._nodes)[None, :]
            else:
                B = self._length * np.exp((j - _MOST // 2 + 0.5) * _SIZE + half * self._nodes)[None, :]
            values = A * self._sum(A, B)
            c = self._to_modes @ values @ self._to_modes.T
            rate = self._derivative @ c + c @ (self._linear if j == _JOINED else self._derivative).T
            self._patches[key] = np.ascontiguousarray(np.stack([c, rate], axis=1))
        return self._patches[key]

    def _sum(self, A: Array, B: Array) -> Array:
        """Sum of a_j f(d_j); images that are shallow or deep beside the patch are joined."""
        d, a = self._images.depths, self._images.strengths
        shallow, deep = d < _FAR * float(np.min(np.minimum(A, B))), d > float(np.max(np.maximum(A, B))) / _FAR
        near = ~(shallow | deep)
        total = np.einsum("ijk,k->ij", image_ring(A[..., None], B[..., None], d[near]), a[near])
        if shallow.any():
            zero, first = np.zeros(()), d[shallow][-1]
            at_zero = image_ring(A, B, zero)
            slope = (image_ring(A, B, first) - at_zero) / first**2
            total += a[shallow].sum() * at_zero + (a[shallow] @ d[shallow] ** 2) * slope
        if deep.any():
            last = d[deep][0]
            slope = (last * image_ring(A, B, last) - 1.0) * last**2
            total += (a[deep] / d[deep]).sum() + (a[deep] / d[deep] ** 3).sum() * slope
        return total

    def of(self, A: Array, B: Array) -> tuple[Array, Array]:
        """A sum_j a_j f(d_j) and its derivative by the logarithm of a common factor of A and B, shape (n,) each."""
        B = np.maximum(B, _LEAST * self._length)
        x = np.log(A / self._length) / _SIZE + _MOST // 2
        y = np.log(B / self._length) / _SIZE + _MOST // 2
        i, j = np.floor(x), np.floor(y)
        short = (j < _SHORT + _MOST // 2) & (i >= _SHORT + _APART + _MOST // 2)
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


def _polynomials(x: Array, out: Array) -> None:
    """Chebyshev polynomials up to _DEGREE, in `out`, shape (_DEGREE + 1, n)."""
    out[0], out[1] = 1.0, x
    twice = 2.0 * x
    for m in range(1, _DEGREE):
        np.multiply(twice, out[m], out=out[m + 1])
        out[m + 1] -= out[m - 1]
