"""Largest contact radius at which a solid can be under tension: the load in the limit of a short range of the law.

In that limit (Johnson, Kendall, Roberts) the energy U of the solid under a punch that touches it up to the radius a
obeys dU/da = 2 pi a w at a given approach delta.  U is quadratic in delta, and its coefficients for all radii at the
lines of one mesh come from one factorisation of the compliance, whose leading blocks are those of smaller contacts.
The radii are right to the length of an element, a third of the radius: enough to tell whether load or displacement turn
back beyond a radius, because a stiff layer carries the contact, or a soft one begins to.
"""

from __future__ import annotations

import math

import numpy as np
from scipy import linalg

from fem_reference._contact.contact import Contact
from fem_reference._elastic.trace import Trace
from fem_reference._typing import Array
from fem_reference._wells import work_of_tension

__all__ = ["jkr_curve", "last_turn"]


def jkr_curve(contact: Contact, size: float) -> tuple[Array, Array, Array]:
    """Return contact radii beyond `size`, rising, with load and displacement in the limit of a short range.

    Parameters
    ----------
    contact : Contact
        On a mesh of that size whose elements grow with their distance from the edge.
    size : float
    """
    trace, factor = contact.compliance.trace, contact.compliance.factor(size)
    order, ends = _outwards(trace)
    shapes = np.stack([np.zeros(order.size), _coefficients(trace, contact.punch.height(size * trace.s))], axis=1)
    shapes[: trace.nodes.size, 0] = 1.0
    L = linalg.cholesky(contact.compliance.matrix[np.ix_(order, order)], lower=True)
    y = linalg.solve_triangular(L, shapes[order], lower=True)
    products = np.stack([y[:, 0] ** 2, y[:, 0] * y[:, 1]])
    K = 2.0 * math.pi * size**2 / factor * np.cumsum(products, axis=1)[:, ends]
    a = size * trace.nodes[1:]
    change = np.diff(K, axis=1) / np.diff(a)
    middle, K = 0.5 * (a[1:] + a[:-1]), 0.5 * (K[:, 1:] + K[:, :-1])
    # A barrier is passed before: the repulsion that it returns on separation is left out.
    work = work_of_tension(contact.law)
    delta = change[1] / change[0] - np.sqrt(4.0 * math.pi * middle * work / change[0])
    beyond = middle > size
    return middle[beyond], (K[0] * delta - K[1])[beyond], delta[beyond]


def last_turn(contact: Contact, size: float) -> float:
    """Return the radius beyond which load and displacement only rise, and the load is compressive, in that limit."""
    a, load, delta = jkr_curve(contact, size)
    turning = np.flatnonzero((load[1:] <= 0.0) | (np.diff(load) <= 0.0) | (np.diff(delta) <= 0.0))
    return float(a[turning[-1] + 1]) if turning.size else size


def _outwards(trace: Trace) -> tuple[Array, Array]:
    """Order of the functions from the axis outwards, and the index of the last one of each element in it."""
    rows = [trace.functions[0, :1]]
    rows += [np.concatenate([element[2:], element[1:2]]) for element in trace.functions]
    return np.concatenate(rows), np.cumsum([row.size for row in rows])[1:] - 1


def _coefficients(trace: Trace, values: Array) -> Array:
    """Coefficients of a function given at the Gauss points, element by element: it may grow by many decades."""
    e = trace.functions.shape[0]
    inverse = np.linalg.pinv(trace.local[0])
    w = np.zeros(trace.phi.shape[1])
    w[trace.functions] = values.reshape(e, -1) @ inverse.T
    return w
