"""Smooth functions of two variables as Chebyshev polynomials on cells that are halved until they resolve the functions.

A cell is fitted when a point in it is first asked for, so that only the visited part of the plane costs anything.
Cells depend on their place alone: the values do not depend on the order of the questions.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from fscm._typing import Array
from fscm.errors import Failure, NotConverged

__all__ = ["ChebyshevTree"]

#: Nodes of a cell in each variable, and last coefficients in each that have to be within the tolerance.
_NODES, _LAST = 14, 2
#: Length of the first cells, and number of halvings.
_FIRST, _HALVINGS = 2.0, 30
#: Points, as shares of a cell, at which its polynomial is compared with a finer evaluation of the functions.
_FRESH = np.array([[0.93, 0.31], [0.41, 0.97], [0.04, 0.62], [0.55, 0.03], [0.77, 0.81]])
#: Cells that are fitted together.
_TOGETHER = 16

_POINTS = np.polynomial.chebyshev.chebpts1(_NODES)
#: Coefficients from values at the nodes.
_FIT = np.linalg.inv(np.polynomial.chebyshev.chebvander(_POINTS, _NODES - 1))


class ChebyshevTree:
    """Some functions of (X, Y) with their derivatives.

    Parameters
    ----------
    functions : callable
        (X, Y, finer) -> values of shape (functions, N), nan where there is none; `finer` asks for a finer evaluation.
    tolerance : callable
        (X, Y) -> admissible error of the values, shape (N,).
    breaks : sequence of float
        Values of X at which the functions are not smooth.

    Attributes
    ----------
    cells : int
        Fitted cells.

    Examples
    --------
    >>> tree = ChebyshevTree(lambda X, Y, finer: np.array([np.exp(X - Y)]), lambda X, Y: np.full(X.shape, 1e-13))
    >>> X, Y = np.array([0.3]), np.array([5.0])
    >>> value, by_X, by_Y = tree(X, Y)
    >>> bool(abs(value[0, 0] - np.exp(-4.7)) < 1e-14), bool(abs(by_Y[0, 0] + np.exp(-4.7)) < 1e-12)
    (True, True)
    >>> bool(tree.error(X, Y)[0] < 1e-14)
    True
    """

    def __init__(
        self,
        functions: Callable[[Array, Array, bool], Array],
        tolerance: Callable[[Array, Array], Array],
        breaks: tuple[float, ...] = (),
    ) -> None:
        self._functions, self._tolerance = functions, tolerance
        self._breaks = np.array(sorted(breaks))
        self._roots: dict[tuple[int, int, int], int] = {}
        #: Of each cell: its ends (X, X, Y, Y); the variable that is cut, or -1 for a fitted and -2 for a new one; its
        #: first half, which the second one follows; its number among the fitted ones; its halvings.
        self._ends, self._cut, self._half, self._fitted, self._depth = (
            np.empty((0, 4)),
            *(np.empty(0, int) for _ in range(4)),
        )
        self._coefficients = np.empty((0, 0, _NODES, _NODES))
        #: Of each fitted cell: largest difference of its polynomial and the finer evaluation at fresh points.
        self._errors = np.empty(0)
        self.cells = 0

    def __call__(self, X: Array, Y: Array) -> tuple[Array, Array, Array]:
        """Values and derivatives by X and Y, each of shape (functions, N)."""
        cell = self._located(X, Y)
        ends = self._ends[cell]
        a, b = ends[:, 1] - ends[:, 0], ends[:, 3] - ends[:, 2]
        T_X, rate_X = _basis((2.0 * X - ends[:, 0] - ends[:, 1]) / a)
        T_Y, rate_Y = _basis((2.0 * Y - ends[:, 2] - ends[:, 3]) / b)
        of_cells = self._coefficients[self._fitted[cell]]
        along_Y = np.matmul(of_cells, np.stack([T_Y, rate_Y], axis=-1)[:, None])
        value, by_Y = np.einsum("nfij,ni->jfn", along_Y, T_X)
        by_X = np.einsum("nfi,ni->fn", along_Y[..., 0], rate_X)
        return value, by_X * (2.0 / a), by_Y * (2.0 / b)

    def error(self, X: Array, Y: Array) -> Array:
        """Error of the values, measured in the cells of the points; shape (N,)."""
        return np.asarray(self._errors[self._fitted[self._located(X, Y)]])

    def _located(self, X: Array, Y: Array) -> Array:
        """Fitted cell of each point."""
        strip = np.searchsorted(self._breaks, X, side="right")
        keys = np.stack([strip, np.floor(X / _FIRST).astype(int), np.floor(Y / _FIRST).astype(int)], axis=1)
        distinct, inverse = np.unique(keys, axis=0, return_inverse=True)
        cell = np.array([self._root(*key) for key in distinct.tolist()], int)[inverse.ravel()]
        while True:
            cut = self._cut[cell]
            new = cut == -2
            if np.any(new):
                self._fit(np.unique(cell[new]))
                continue
            halved = np.flatnonzero(cut >= 0)
            if not halved.size:
                return cell
            at = cell[halved]
            first = self._half[at]
            position = np.where(cut[halved] == 0, X[halved], Y[halved])
            cell[halved] = first + (position >= self._ends[first, 2 * cut[halved] + 1])

    def _root(self, strip: int, i: int, j: int) -> int:
        key = strip, i, j
        if key not in self._roots:
            walls = np.concatenate([[-math.inf], self._breaks, [math.inf]])
            left, right = max(_FIRST * i, walls[strip]), min(_FIRST * (i + 1), walls[strip + 1])
            self._roots[key] = self._added(np.array([[left, right, _FIRST * j, _FIRST * (j + 1)]]), 0)
        return self._roots[key]

    def _added(self, ends: Array, depth: int) -> int:
        """Number of the first of new cells."""
        first, count = len(self._cut), len(ends)
        self._ends = np.concatenate([self._ends, ends])
        self._cut = np.append(self._cut, np.full(count, -2))
        self._half = np.append(self._half, np.zeros(count, int))
        self._fitted = np.append(self._fitted, np.zeros(count, int))
        self._depth = np.append(self._depth, np.full(count, depth))
        return first

    def _fit(self, cells: Array) -> None:
        """Fit the polynomials of some cells, or halve these."""
        for start in range(0, len(cells), _TOGETHER):
            some = cells[start : start + _TOGETHER]
            X, Y = self._at(some, 0.5 * (1.0 + _POINTS)[:, None], 0.5 * (1.0 + _POINTS))
            values = self._functions(X.ravel(), Y.ravel(), False)
            values = values.reshape(len(values), len(some), _NODES, _NODES).swapaxes(0, 1)
            with np.errstate(invalid="ignore"):
                coefficients = _FIT @ values @ _FIT.T
            # The largest tolerance of a cell is that of the noise in it.
            admissible = np.max(self._tolerance(X.ravel(), Y.ravel()).reshape(len(some), -1), axis=1)
            size = np.max(np.abs(coefficients), axis=1)
            last_X, last_Y = np.max(size[:, -_LAST:], axis=(1, 2)), np.max(size[:, :, -_LAST:], axis=(1, 2))
            finite = np.all(np.isfinite(coefficients), axis=(1, 2, 3))
            resolved = finite & (np.maximum(last_X, last_Y) <= admissible)
            # A cell with points at which there is no value is halved where it is longest.
            ends = self._ends[some]
            longer = ends[:, 3] - ends[:, 2] > ends[:, 1] - ends[:, 0]
            second = np.where(finite, last_Y > last_X, longer)
            for cell, done, along_Y in zip(some.tolist(), resolved, second, strict=True):
                if not done:
                    self._halve(cell, int(along_Y))
            if np.any(resolved):
                self._store(some[resolved], coefficients[resolved])

    def _at(self, cells: Array, share_X: Array, share_Y: Array) -> tuple[Array, Array]:
        """Points at shares of cells, of shapes (cells, *shape of both shares)."""
        share_X, share_Y = np.broadcast_arrays(share_X, share_Y)
        ends = self._ends[cells].reshape(-1, 4, *(1,) * share_X.ndim)
        return ends[:, 0] + share_X * (ends[:, 1] - ends[:, 0]), ends[:, 2] + share_Y * (ends[:, 3] - ends[:, 2])

    def _halve(self, cell: int, variable: int) -> None:
        ends, depth = self._ends[cell], int(self._depth[cell]) + 1
        if depth > _HALVINGS:
            place = f"ln r = {ends[0]:.6g}, ln v = {ends[2]:.6g}"
            raise NotConverged(f"the potential of the punch is not smooth near {place}", Failure.PUNCH)
        middle = 0.5 * (ends[2 * variable] + ends[2 * variable + 1])
        halves = np.array([ends, ends])
        halves[0, 2 * variable + 1] = halves[1, 2 * variable] = middle
        self._half[cell] = self._added(halves, depth)
        self._cut[cell] = variable

    def _store(self, cells: Array, coefficients: Array) -> None:
        """Keep the polynomials of cells, and compare them with the functions at fresh points."""
        if not self.cells:
            self._coefficients = np.empty((0, *coefficients.shape[1:]))
        self._coefficients = np.concatenate([self._coefficients, coefficients])
        self._fitted[cells] = self.cells + np.arange(len(cells))
        self._cut[cells] = -1
        self.cells += len(cells)
        self._errors = np.append(self._errors, np.zeros(len(cells)))
        X, Y = (at.ravel() for at in self._at(cells, _FRESH[:, 0], _FRESH[:, 1]))
        differences = np.abs(self(X, Y)[0] - self._functions(X, Y, True))
        self._errors[-len(cells) :] = np.max(differences.reshape(-1, len(cells), len(_FRESH)), axis=(0, 2))


def _basis(t: Array) -> tuple[Array, Array]:
    """Chebyshev polynomials and their derivatives, each of shape (N, nodes)."""
    T, rate = np.empty((len(t), _NODES)), np.empty((len(t), _NODES))
    T[:, 0], T[:, 1], rate[:, 0], rate[:, 1] = 1.0, t, 0.0, 1.0
    for i in range(2, _NODES):
        T[:, i] = 2.0 * t * T[:, i - 1] - T[:, i - 2]
        rate[:, i] = 2.0 * (T[:, i - 1] + t * rate[:, i - 1]) - rate[:, i - 2]
    return T, rate
