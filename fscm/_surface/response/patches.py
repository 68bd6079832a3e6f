r"""Table of the images of a ring: polynomials on patches of the logarithms of r + t and abs(r - t).

The sum of the images depends only on the solid, on A = r + t and on B = abs(r - t).  In log A and log B it is analytic
in a strip of half-width pi/4, whatever the depths are, so that a polynomial of fixed degree approximates it on each
patch of fixed size.  Patches are computed on demand.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from fscm._surface.response.images import STEP, Images
from fscm._surface.response.kernel import image_sum
from fscm._surface.response.ring_series import Lattice, below_joined, ring_series
from fscm._typing import Array

__all__ = ["ImageTable", "patches_of"]

#: Steps of the lattice of depths on a patch: an octave. Singularities are at a distance of pi/4 or more, so that
#: coefficients fall like 4.7^-m.
_STEPS = 6
#: Least distance, in the unit of the lattice.
_LEAST = 1e-11
#: Where A is larger than B by _APART patches, all patches of short distances, down to zero, are joined to one with a
#: polynomial in B.  The shallow images depend on B down to the length over which the modulus changes at the surface:
#: the short distances begin where the polynomial is accurate to _ERROR, at the patch _SHORT, or by steps _LOWER lower.
_SHORT, _APART, _LOWER, _LOWEST = -14, 4, 4, -50
#: Error of a table of degree _HIGHEST, relative to the largest D, at least 1, and rounding and truncation for each unit
#: of the strengths of the images.  Measured worst 7e-14 over coatings with contrasts of 1e-4 to 1e4.  The coefficients
#: fall by factors of _FALL, so that the last ones exceed the truncation error.
_HIGHEST, _ERROR, _PER_STRENGTH, _FALL = 15, 2e-13, 2e-15, 5.0
#: On the joined patches images may be shallower than the smallest node, which the coefficients do not show: the
#: polynomial is compared with the sum at _COMPARED distances, from the share _FROM of the longest one on.  The error is
#: _OF_COMPARED times the largest difference: measured at most 1.05 times (offset power laws, k = 0.4 and 0.8).
_COMPARED, _FROM, _OF_COMPARED = 25, 1e-8, 2.0
#: Patches of the same A/B that are computed together: octaves from a multiple of this number on, so that no value
#: depends on what was computed before.
_TOGETHER = 8
#: Range of the index of a patch in each direction: a pair of indices is one integer.
_MOST = 256
#: Index of the joined patches.
_JOINED = 0
#: Points evaluated together: fewer take more calls, more are out of the cache (measured: 71, 64 and 59 ns a point with
#: 2048, 4096 and 8192 points of degree 11).
_AT_A_TIME = 8192


class _Patches:
    """Polynomials of A sum_j a_j f(d_j) on patches, computed on demand; lengths in the unit of the lattice of depths.

    Attributes
    ----------
    size : float
        Of a patch, in log A and log B.
    first_short : int
        Index of the patch from which on short distances are joined.
    least_error : float
        Of the table, without what rounding makes of the strengths.
    """

    def __init__(self, images: Images, degree: int) -> None:
        self._depths, self._strengths, self._degree = images.depths / images.unit, images.strengths, degree
        self._lattice = Lattice(self._depths, self._strengths)
        self._stored: dict[int, tuple[Array, float]] = {}
        self.size, count = _STEPS * STEP, degree + 1
        self.least_error = _ERROR * _FALL ** (_HIGHEST - degree) * images.largest
        self._derivative = np.zeros((count, count))
        slopes = chebyshev.chebder(np.eye(count))
        self._derivative[:-1] = slopes * (2.0 / self.size)
        # B d/dB on [0, 1], x = 2 B - 1
        products = [chebyshev.chebmul(slope, [1.0, 1.0]) for slope in slopes.T]
        self._linear = np.stack([np.pad(c, (0, count - len(c))) for c in products], axis=1)
        for self.first_short in range(_SHORT, _LOWEST, -_LOWER):
            joined = self._joined(self.first_short + _APART + _MOST // 2)
            if _last(joined)[1] < self.least_error:
                break

    @property
    def short(self) -> float:
        """Longest distance on the joined patches."""
        return math.exp(self.first_short * self.size)

    def _joined(self, i: int) -> Array:
        """Coefficients of the values on a joined patch, shape (degree + 1, degree + 1): in log A, then in B."""
        step = _STEPS * self.first_short - below_joined(self._degree)
        apart = _STEPS * (i - _MOST // 2) - step
        return ring_series(self._degree, _STEPS, apart, True).of(self._lattice, np.array([step]))[0]

    def at(self, key: int) -> tuple[Array, float]:
        """Coefficients of value, then of derivative, shape (2 degree + 2, degree + 1), and a bound of their error.

        They are in log B, for each in log A.
        """
        if key not in self._stored:
            i, j = divmod(key, _MOST)
            if j == _JOINED:
                c = self._joined(i)
                self._store([key], c[None], self._linear, [max(_last(c)[0], self._compared(c, i))])
            else:
                octaves = np.arange(_TOGETHER) + j // _TOGETHER * _TOGETHER
                series = ring_series(self._degree, _STEPS, _STEPS * (i - j), False)
                coefficients = series.of(self._lattice, _STEPS * (octaves - _MOST // 2))
                keys = ((octaves + i - j) * _MOST + octaves).tolist()
                self._store(keys, coefficients, self._derivative, [max(_last(c)) for c in coefficients])
        return self._stored[key]

    def _store(self, keys: list[int], c: Array, by_B: Array, errors: list[float]) -> None:
        """Store the coefficients of patches, shape (n, degree + 1, degree + 1): in log A, then in log B or B."""
        rate = self._derivative @ c + c @ by_B.T
        both = np.concatenate([c.swapaxes(1, 2), rate.swapaxes(1, 2)], axis=1)
        self._stored |= dict(zip(keys, zip(both, errors, strict=True), strict=True))

    def _compared(self, c: Array, i: int) -> float:
        """Bound on the error of the polynomials of a joined patch."""
        A = np.array([math.exp((i - _MOST // 2 + 0.5) * self.size)])[:, None]
        share = np.append(0.0, np.geomspace(_FROM, 1.0, _COMPARED))
        B = np.maximum(self.short * share, _LEAST)[None, :]
        polynomial = chebyshev.chebval2d(np.zeros_like(share), 2.0 * B[0] / self.short - 1.0, c)
        exact = image_sum(A[..., None], B[..., None], self._depths, self._strengths)
        return _OF_COMPARED * float(np.max(np.abs(polynomial - (A * exact)[0])))


@lru_cache(maxsize=8)
def patches_of(images: Images, degree: int) -> _Patches:
    """The polynomials of a solid, which serve all units in which it is measured."""
    return _Patches(images, degree)


class ImageTable:
    """A sum_j a_j f(d_j), and its change when all radii grow, by A and B.

    Parameters
    ----------
    images : Images
    degree : int
        Of the polynomials, up to 15; each degree fewer makes the error five times as large.
    """

    def __init__(self, images: Images, degree: int = _HIGHEST) -> None:
        self._patches, self._unit, self._worst = patches_of(images.of_solid, degree), images.unit, 0.0
        self._least_error = self._patches.least_error + _PER_STRENGTH * float(np.sum(np.abs(images.strengths)))

    @property
    def error(self) -> float:
        """Bound of the error of all values computed so far."""
        return self._least_error + self._worst

    def _patch(self, key: int) -> Array:
        coefficients, error = self._patches.at(key)
        self._worst = max(self._worst, error)
        return coefficients

    def of(self, A: Array, B: Array) -> tuple[Array, Array]:
        """A sum_j a_j f(d_j) and its derivative by the logarithm of a common factor of A and B, shape (n,) each."""
        patches = self._patches
        A, B = A / self._unit, np.maximum(B / self._unit, _LEAST)
        x = np.log(A) / patches.size + _MOST // 2
        y = np.log(B) / patches.size + _MOST // 2
        i, j = np.floor(x), np.floor(y)
        shortest = patches.first_short + _MOST // 2
        short = (j < shortest) & (i >= shortest + _APART)
        j[short] = _JOINED
        y[short] = _JOINED + B[short] / patches.short
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
