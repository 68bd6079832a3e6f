"""Response of one panel to the pressure on another as a function of the gradient exponent, shared by many problems.

(1 - k) G_k is analytic in k, with its nearest singularities at k = 2 and k = -1.  So every block of the matrix of
`fscm._surface.deformation`, times the power k of the distance of its panels, is expanded in Chebyshev polynomials of k:
their coefficients fall by a factor of ten and more, each.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fscm._surface.deformation import response_blocks
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["COARSE", "FINE", "INTERVALS", "ResponseTable", "assembled"]

#: Nodes a panel of the pressure, and of the residual.
COARSE, FINE = 10, 14
#: Intervals of k, each with its own expansion, and the number of its terms.
INTERVALS = ((0.0, 0.4), (0.4, 0.8))
_TERMS = 13


class ResponseTable:
    """Expansions of the blocks between panels, for k in one interval.

    Parameters
    ----------
    low, high : float
        The interval.
    """

    def __init__(self, low: float, high: float) -> None:
        self._low, self._high = low, high
        cosines = np.cos(np.pi * (np.arange(_TERMS) + 0.5) / _TERMS)
        self._nodes = 0.5 * (low + high + (high - low) * cosines)
        self._to_coefficients = np.linalg.inv(chebyshev.chebvander(cosines, _TERMS - 1))
        self._to_fine = gauss_rule(COARSE).interpolation(gauss_rule(FINE).nodes)
        self._panels: dict[tuple[float, float], int] = {}
        self._rows = np.full((0, 0), -1)
        self._blocks = np.empty((0, _TERMS, FINE, COARSE))
        self._count = 0

    def coefficients(self, offsets: Array) -> Array:
        """Coefficients of the scaled blocks between the panels of a mesh, shape (terms, m, m, FINE, COARSE)."""
        panels = [self._panels.setdefault(panel, len(self._panels)) for panel in pairwise(offsets.tolist())]
        most = len(self._panels)
        if most > len(self._rows):
            old, size = len(self._rows), most + most // 2
            self._rows = np.pad(self._rows, (0, size - old), constant_values=-1)
        both = np.ix_(panels, panels)
        lacking = np.nonzero(self._rows[both] < 0)
        if lacking[0].size:
            stop = self._count + lacking[0].size
            if stop > len(self._blocks):
                self._blocks = np.concatenate([self._blocks[: self._count], np.empty((stop, _TERMS, FINE, COARSE))])
            self._blocks[self._count : stop] = self._expanded(offsets, *lacking)
            targets, sources = (np.array(panels)[index] for index in lacking)
            self._rows[targets, sources] = np.arange(self._count, stop)
            self._count = stop
        return np.ascontiguousarray(self._blocks[self._rows[both]].transpose(2, 0, 1, 3, 4))

    def _expanded(self, offsets: Array, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
        mesh = PanelMesh(offsets, FINE, -float(offsets[0]))
        distance = _distances(offsets)[targets, sources]
        values = np.empty((_TERMS, len(targets), FINE * COARSE))
        for i, k in enumerate(self._nodes):
            blocks = response_blocks(kernel_of(float(k)), mesh, targets, sources) @ self._to_fine
            values[i] = ((1.0 - k) * distance**k)[:, None] * blocks.reshape(len(targets), -1)
        expanded = np.tensordot(values, self._to_coefficients, axes=(0, 1))
        return expanded.reshape(len(targets), FINE, COARSE, _TERMS).transpose(0, 3, 1, 2)

    def polynomials(self, k: Array) -> Array:
        """Chebyshev polynomials at exponents, shape (len(k), terms)."""
        return np.asarray(
            chebyshev.chebvander((2.0 * k - self._low - self._high) / (self._high - self._low), _TERMS - 1), float
        )


def assembled(weights: Array, coefficients: Array, offsets: Array, k: Array) -> Array:
    """Sums of weighted coefficients as matrices, shape (b, m FINE, m COARSE), without the scale of the blocks.

    Parameters
    ----------
    weights : ndarray, shape (b, terms)
    coefficients : ndarray, shape (terms, m, m, FINE, COARSE)
    offsets : ndarray, shape (m + 1,)
    k : ndarray, shape (b,)
    """
    terms, m = coefficients.shape[:2]
    blocks = (weights @ coefficients.reshape(terms, -1)).reshape(len(k), m, m, FINE, COARSE)
    blocks *= (_distances(offsets)[None] ** -k[:, None, None])[..., None, None]
    return blocks.transpose(0, 1, 3, 2, 4).reshape(len(k), m * FINE, m * COARSE)


def _distances(offsets: Array) -> Array:
    """Distances of the panels plus their lengths, with which the response scales; shape (m, m)."""
    start, end, length = offsets[:-1], offsets[1:], np.diff(offsets)
    between = np.maximum(start[:, None] - end, start - end[:, None])
    return np.asarray(np.maximum(between, 0.0) + np.maximum(length[:, None], length))
