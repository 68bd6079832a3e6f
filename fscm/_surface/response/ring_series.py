r"""Images of a ring as polynomials in log A and log B, A = r + t and B = abs(r - t), the same for every solid.

The depths of all images are on one lattice, exp(STEP m) times the unit of the solid, on the real axis or on the ray of
45 degrees, and the patches of A and B begin at its steps.  So A f(d) on a patch depends on the numbers of steps between
A, B and d alone: the polynomials are computed once, and a solid sums them with its strengths.

With z = d^2, f is analytic in the disc |z| < B^2.  So the images more than _CLEAR steps above the least B are the sum
of rings on one circle of z, by Cauchy's integral, whose trapezoidal rule is exact but for the power _TERMS of the ratio
of z to B^2.  Those more than _CLEAR steps below the largest B are power series in (B/|d|)^2, with functions of A/|d| as
coefficients, again by Cauchy's integral on a circle.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fscm._surface.response.images import RAY, STEP
from fscm._surface.response.kernel import image_ring, ring_mean
from fscm._typing import Array, ComplexArray

__all__ = ["Lattice", "RingSeries", "below_joined", "ring_series"]

#: Steps from a circle to B, a factor of four, and points of it: 16^-14 is below rounding.
_CLEAR, _TERMS = 12, 14
_RADIUS = math.exp(-2.0 * STEP * _CLEAR)
_CIRCLE = np.exp(2j * math.pi * np.arange(_TERMS) / _TERMS)
#: Points that are computed of a function that is real on the axis; the others are their conjugates.
_HALF = _TERMS // 2 + 1
#: Squares of the directions of the images.
_SQUARES = np.array([1.0, RAY**2])
#: Logarithm of a term that is left out: rounding.
_LEAST = -40.0
#: Neighbouring images that are computed together, near B and far from it, so that no value depends on what was computed
#: before.
_NEAR, _FAR = 6, 60


class Lattice:
    """The strengths of images by the step of their depth, on the axis and on the ray.

    Parameters
    ----------
    depths, strengths : ndarray, complex
        In the unit of the lattice.

    Attributes
    ----------
    first, stop : int
        The first step, and the one after the last.
    """

    def __init__(self, depths: ComplexArray, strengths: ComplexArray) -> None:
        steps = np.rint(np.log(np.abs(depths)) / STEP).astype(int)
        self.first, self.stop = int(np.min(steps)), int(np.max(steps)) + 1
        self._rows = np.zeros((2, self.stop - self.first), complex)
        np.add.at(self._rows, ((depths.imag > 0.0).astype(int), steps - self.first), strengths)
        self._circles: dict[int, ComplexArray] = {}

    def on_circle(self, step: int) -> ComplexArray:
        """Weights of the rings on half of the circle of this step for all images above it."""
        if step not in self._circles:
            self._circles[step] = self._weights(step)
        return self._circles[step]

    def _weights(self, step: int) -> ComplexArray:
        steps = np.arange(self.first, min(step, self.stop))
        z = np.exp(2.0 * STEP * (steps - step)) * _SQUARES[:, None]
        moments = self._rows[:, : len(steps)].ravel() @ np.vander(z.ravel(), _TERMS, increasing=True)
        weights = np.fft.fft(moments) / _TERMS
        weights[1 : _HALF - 1] += np.conj(weights[: _HALF - 1 : -1])
        return np.asarray(weights[:_HALF])

    def beginning_at(self, starts: NDArray[np.intp], count: int) -> ComplexArray:
        """Strengths of so many steps from each of several on, shape (2, len(starts), count)."""
        places = starts[:, None] + np.arange(count) - self.first
        inside = (places >= 0) & (places < self._rows.shape[1])
        return np.where(inside, self._rows[:, np.where(inside, places, 0)], 0.0)


class RingSeries:
    """Coefficients of A f on a patch.

    Parameters
    ----------
    degree : int
    steps : int
        Of the lattice on a patch.
    apart : int
        Steps from the least B to the least A.
    joined : bool
        Whether the patch has all B down to zero, and polynomials in B; the least B is below its smallest node then.
    """

    def __init__(self, degree: int, steps: int, apart: int, joined: bool) -> None:
        self._degree, self._steps, self._apart = degree, steps, apart
        nodes, self._to_modes = _nodes_and_modes(degree)
        share = 0.5 + 0.5 * nodes
        self._largest = below_joined(degree) if joined else steps
        relative = share if joined else np.exp(STEP * steps * (share - 1.0))
        self._B = math.exp(STEP * self._largest) * relative[None, :]
        self._A = (math.exp(STEP * apart) * np.exp(STEP * steps * share))[:, None]
        self._powers = (relative ** (2 * np.arange(_TERMS)[:, None])) @ self._to_modes.T
        self._blocks: dict[tuple[int, int], Array] = {}
        self._shallow = self._series(self._rings(_RADIUS * _CIRCLE[:_HALF]))

    def _rings(self, z: ComplexArray) -> ComplexArray:
        z = z[:, None, None]
        return np.asarray(1.0 / ring_mean(self._A**2 + z, self._B**2 + z))

    def _series(self, rings: Array | ComplexArray) -> Array:
        """Parts of the coefficients of rings, shape (parts, rings, degree + 1, degree + 1)."""
        return _parts(self._to_modes @ (self._A * rings) @ self._to_modes.T)

    def of(self, lattice: Lattice, steps: NDArray[np.intp]) -> Array:
        """Coefficients of patches, shape (len(steps), degree + 1, degree + 1): in log A, then in log B or B.

        The least B of the patches are at these steps.
        """
        first, count = steps - _CLEAR, self._largest + 2 * _CLEAR
        circles = np.stack([lattice.on_circle(step) for step in first.tolist()])
        total = _real_sum(circles, self._shallow)
        strengths = lattice.beginning_at(first, -(-count // _NEAR) * _NEAR)
        strengths[..., count:] = 0.0
        strengths = strengths.reshape(2, len(steps), -1, _NEAR)
        for row, block in np.argwhere(strengths.any(axis=(1, 3))).tolist():
            total += _real_sum(strengths[row, :, block], self._near(row, block))
        return np.asarray(total + self._far(lattice, steps).swapaxes(1, 2) @ self._powers)

    def _near(self, row: int, block: int) -> Array:
        """Parts of the coefficients of neighbouring images, shape (parts, _NEAR, degree + 1, degree + 1)."""
        if (row, block) not in self._blocks:
            depths = np.exp(STEP * (block * _NEAR + np.arange(_NEAR) - _CLEAR))
            on_axis = image_ring(self._A, self._B, depths[:, None, None]) if row == 0 else None
            rings = self._rings(_SQUARES[row] * depths**2) if on_axis is None else on_axis
            self._blocks[row, block] = self._series(rings)
        return self._blocks[row, block]

    def _far(self, lattice: Lattice, steps: NDArray[np.intp]) -> Array:
        """Real parts of the coefficients in log A of the powers of the square of B over the largest one.

        Their shape is (len(steps), _TERMS, degree + 1).
        """
        total = np.zeros((len(steps), _TERMS, self._degree + 1))
        # Steps from the least A to the images that are far.
        clear, A = self._largest + _CLEAR - self._apart, steps + self._apart
        for block in range(clear // _FAR, (lattice.stop - 1 - int(A[0])) // _FAR + 1):
            strengths = lattice.beginning_at(A + block * _FAR, _FAR)
            nearer = clear - block * _FAR
            strengths[..., : max(nearer, 0)] = 0.0
            # A power beyond the circle belongs to an image that is near.
            logs = np.minimum(2.0 * STEP * (nearer - np.arange(_FAR)), 0.0)
            terms = _TERMS if logs[0] > _LEAST / _TERMS else 1 + int(_LEAST / logs[0])
            shares = np.exp(logs[:, None] * np.arange(terms))[..., None]
            for row in np.flatnonzero(strengths.any(axis=(1, 2))).tolist():
                series = _far_series(self._degree, self._steps, row, block)[:, :, :terms]
                total[:, :terms] += _real_sum(strengths[row], shares * series)
        return total


def _parts(series: Array | ComplexArray) -> Array:
    """Real numbers of a series in a new first axis: itself, or the real parts and those of the product with i."""
    return np.stack([series.real, -series.imag] if np.iscomplexobj(series) else [series.real])


def _real_sum(strengths: ComplexArray, parts: Array) -> Array:
    """Real part of the sum over the images of strengths, shape (n, images), times series, given by their parts."""
    factors = np.concatenate([strengths.real, strengths.imag][: len(parts)], axis=1)
    total: Array = factors @ parts.reshape(factors.shape[1], -1)
    return total.reshape(len(strengths), *parts.shape[2:])


def below_joined(degree: int) -> int:
    """Steps from the longest distance of a joined patch down to below its smallest node."""
    return math.ceil(-math.log(0.5 + 0.5 * float(_nodes_and_modes(degree)[0][0])) / STEP)


@lru_cache(maxsize=8)
def _nodes_and_modes(degree: int) -> tuple[Array, Array]:
    nodes = chebyshev.chebpts1(degree + 1)
    return nodes, np.asarray(np.linalg.inv(chebyshev.chebvander(nodes, degree)), float)


@lru_cache(maxsize=256)
def _far_series(degree: int, steps: int, row: int, block: int) -> Array:
    """Parts of the coefficients of A f in log A, for the powers of (B/|d|)^2 over _RADIUS.

    Their shape is (parts, _FAR, _TERMS, degree + 1).

    The images are at _FAR steps below the least A of the patch, from the block's first on.
    """
    nodes, to_modes = _nodes_and_modes(degree)
    depths = np.exp(STEP * (block * _FAR + np.arange(_FAR)))[:, None, None]
    A = np.exp(STEP * steps * (0.5 + 0.5 * nodes)) / depths
    B_squared = (_RADIUS * _CIRCLE)[:, None]
    values = A / ring_mean(_SQUARES[row] + A**2, _SQUARES[row] + B_squared)
    series = np.fft.fft(values, axis=1) / _TERMS @ to_modes.T
    return _parts(series if row else series.real)


@lru_cache(maxsize=1024)
def ring_series(degree: int, steps: int, apart: int, joined: bool) -> RingSeries:
    """The series of a patch, cached.

    Examples
    --------
    >>> ring = Lattice(np.array([1.0 + 0.0j]), np.array([1.0 + 0.0j]))
    >>> value = chebyshev.chebval2d(1.0, 1.0, ring_series(15, 6, 0, joined=False).of(ring, np.array([0]))[0])
    >>> bool(abs(value - 2.0 * image_ring(2.0, 2.0, 1.0)) < 1e-13)
    True
    """
    return RingSeries(degree, steps, apart, joined)
