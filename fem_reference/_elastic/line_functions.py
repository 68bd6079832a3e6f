"""Functions of scikit-fem's hierarchical elements along a line of a mesh: its surface, or its outer boundary."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._typing import Array, Index

__all__ = ["line_functions", "line_projection", "line_slopes"]


def line_functions(nodes: Array, order: int, s: Array) -> Array:
    """Functions of scikit-fem's `ElementLinePp` in surface order, at radii `s`.

    Written out, because that class makes its polynomials again in every call, and the path evaluates one radius
    at a time.
    """
    element = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, nodes.size - 2)
    x = (s - nodes[element]) / np.diff(nodes)[element]
    legendre = np.polynomial.legendre.legvander(2.0 * x - 1.0, order)
    values = np.zeros((s.size, nodes.size + (nodes.size - 1) * (order - 1)))
    rows = np.arange(s.size)
    values[rows, element] = 1.0 - x
    values[rows, element + 1] = x
    for degree in range(2, order + 1):
        # The integral of the Legendre polynomial of one degree less, normalised.
        rise = legendre[:, degree] - legendre[:, degree - 2]
        values[rows, nodes.size + element * (order - 1) + degree - 2] = rise / np.sqrt(4.0 * degree - 2.0)
    return values


def line_slopes(nodes: Array, order: int, s: Array) -> Array:
    """Derivatives of `line_functions`."""
    element = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, nodes.size - 2)
    h = np.diff(nodes)[element]
    legendre = np.polynomial.legendre.legvander(2.0 * (s - nodes[element]) / h - 1.0, order - 1)
    slopes = np.zeros((s.size, nodes.size + (nodes.size - 1) * (order - 1)))
    rows = np.arange(s.size)
    slopes[rows, element] = -1.0 / h
    slopes[rows, element + 1] = 1.0 / h
    for degree in range(2, order + 1):
        column = nodes.size + element * (order - 1) + degree - 2
        slopes[rows, column] = np.sqrt(4.0 * degree - 2.0) * legendre[:, degree - 1] / h
    return slopes


def line_projection(
    nodes: Array, retained: Index, order: int, coordinate: Callable[[Array], Array] | None = None
) -> Array:
    """Projection of the functions on a line to those of longer elements: equal at the nodes, nearest in slope between.

    What it loses of a function is orthogonal to polynomials of degree p - 2 on each longer element.

    Parameters
    ----------
    nodes : ndarray, shape (n,)
        Ascending.
    retained : ndarray of int
        Indices of the nodes that the longer elements have, the first and the last among them.
    order : int
        Degree p of the functions, at least 2.
    coordinate : callable, optional
        From the coordinate of the shorter elements to that of the longer ones; both are equal at the nodes that stay.

    Returns
    -------
    ndarray
        Coefficients of the longer elements, in surface order, for each function of the shorter ones.

    Examples
    --------
    >>> square = np.array([0.0, 1.0, 9.0, 1.0 / 6**0.5, 4.0 / 6**0.5])  # r^2 on [0, 1] and [1, 3]
    >>> projection = line_projection(np.array([0.0, 1.0, 3.0]), np.array([0, 2]), order=2)
    >>> (projection @ square).round(12) == np.array([0.0, 9.0, 9.0 / 6**0.5]).round(12)  # r^2 on [0, 3]
    array([ True,  True,  True])
    """
    x, w = unit_gauss(2 * order)
    h = np.diff(nodes)[:, None]
    s = (nodes[:-1, None] + h * x).ravel()
    weight = (h * w).ravel()
    longer = nodes[retained]
    short, long = line_slopes(nodes, order, s), line_slopes(longer, order, s if coordinate is None else coordinate(s))
    # The slopes of the functions inside an element of length h are orthogonal, of the norm 2/h.
    scale = np.concatenate([np.zeros(retained.size), np.repeat(0.5 * np.diff(longer), order - 1)])
    projection = scale[:, None] * (long.T @ (weight[:, None] * short))
    projection[np.arange(retained.size), retained] = 1.0
    return np.asarray(projection)
