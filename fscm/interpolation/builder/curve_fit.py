"""Series of the force curves from their nodes, with bounds by the deviations of nodes from the series without them.

As for the atlas, a series has more terms than nodes, and of those that pass the nodes it is the one whose coefficients,
divided by exp(-rate * degree), are smallest.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct

from fscm._typing import Array
from fscm.interpolation.builder.building import tail_bound
from fscm.interpolation.builder.curve_nodes import POINTS, NodePath, chebyshev_positions, values_at_positions
from fscm.interpolation.builder.design import Node
from fscm.interpolation.builder.fitting import largest_degrees
from fscm.interpolation.curve.pieces import PIECES, States, load_scale, states_of
from fscm.interpolation.curve.series import BINS, CurveSeries, basis, cells_of_curve, part_of
from fscm.interpolation.series import degrees_within

__all__ = ["fitted_curves"]

#: Proportions of the largest degrees in n, k and mu; rates at which coefficients may fall, over the degree in mu;
#: squared noise of the nodes relative to the series.
_SHAPE, _RATES, _RIDGE = (0.4, 0.4, 1.0), (0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5), 1e-11
#: Terms for each node.
_TERMS = 1.6
#: A node is left out where one of so many last coefficients over the position of the approach is as large: one of its
#: states belongs to another solution of a coarse mesh.  Measured: 2 of 200 spheres, with 9e-4 and 1.5e-3; at most
#: 1.4e-4 elsewhere.
_LAST, _ROUGH = 4, 3e-4
#: Bounds of the nodes in their units, for k = 0, up to 0.4 and above.  Measured: the largest bounds of `fscm.trace` at
#: the accuracy of the nodes at nine problems, 2.1e-6, 2.4e-5 and 9.5e-4.
_OF_NODES = (5e-6, 5e-5, 1e-3)
#: A cell with fewer nodes has the bound of all nodes.
_FEWEST = 18
#: The bound of a cell is at least this share of those beside it, as in the atlas.
_BESIDE = 0.5


def fitted_curves(solved: Iterable[tuple[Node, NodePath]]) -> tuple[CurveSeries, dict[str, float]]:
    """The series, and the root mean square of the deviations by piece."""
    nodes, rows = [], []
    for node, path in solved:
        row = values_at_positions(node[0], node[2], path)
        if np.abs(_series_of_position(row["approach"])[:, -_LAST:]).max() < _ROUGH:
            nodes.append(node)
            rows.append(row)
    n, k, mu = np.array(nodes).T
    degrees = _degrees(len(nodes))
    terms = basis(degrees, n, k, mu)
    coefficients, deviations, neglected, sizes = {}, {}, {}, {}
    for piece in PIECES:
        values = np.array([row[piece] for row in rows])
        fitted, left_out = _fit(terms, degrees, values.reshape(len(nodes), -1))
        coefficients[piece] = _series_of_position(fitted.reshape(len(degrees), *values.shape[1:]))
        deviations[piece] = _deviations(piece, n[:, None], mu[:, None], values, left_out.reshape(values.shape))
        neglected[piece] = _neglected(piece, values)
        sizes[piece] = float(np.sqrt(np.mean(deviations[piece][:2] ** 2)))
    return CurveSeries(degrees, coefficients, _bounds(n, k, mu, deviations, neglected)), sizes


def _deviations(piece: str, n: Array, mu: Array, values: Array, left_out: Array) -> Array:
    """Deviations of displacement, load and radius in their units, shape (3, nodes, positions)."""
    position = chebyshev_positions(POINTS[piece])
    exact, other = (states_of(piece, n, mu, position, np.moveaxis(x, 1, 0)) for x in (values, values - left_out))
    exact, other = (States(*map(np.real, states)) for states in (exact, other))
    units = 1.0 + mu + np.abs(exact.displacement), load_scale(n, mu, exact.load), 1.0 + exact.contact_radius
    return np.array([np.abs(b - a) / unit for a, b, unit in zip(exact, other, units, strict=True)])


def _neglected(piece: str, values: Array) -> Array:
    """Sums of the last coefficients over the position, by which values between positions are wrong, shape (3, nodes).

    What a series neglects is below the last terms that it has.
    """
    last = np.abs(_series_of_position(values)[..., -_LAST:]).sum(axis=-1).T
    none = np.zeros(len(values))
    return np.array({"approach": [*last, none], "contact": [*last], "compression": [last[0], none, last[1]]}[piece])


def _degrees(count: int) -> NDArray[np.int_]:
    largest = next(size for size in largest_degrees(_SHAPE) if len(degrees_within(size, 1.0)) > _TERMS * count)
    return degrees_within(largest, 1.0)


def _fit(terms: Array, degrees: NDArray[np.int_], values: Array) -> tuple[Array, Array]:
    """Coefficients, and the deviations of nodes from a series without them, for the rate whose ones are smallest."""
    degree = (degrees / np.array(_SHAPE)).sum(axis=1)
    mean = values.mean(axis=0)
    best: tuple[float, Array, Array] = (math.inf, values, values)
    for rate in _RATES:
        expected = np.exp(-rate * degree)
        scaled = terms * expected
        gram = scaled @ scaled.T
        size = float(np.trace(gram)) / len(gram)
        gram = gram / size + _RIDGE * np.eye(len(gram))
        multipliers = np.linalg.solve(gram, values - mean)
        deviations = multipliers / np.diag(np.linalg.inv(gram))[:, None]
        spread = float(np.mean(np.abs(deviations)))
        if spread < best[0]:
            coefficients = expected[:, None] * (scaled.T @ multipliers) / size
            coefficients[0] += mean
            best = spread, coefficients, deviations
    return best[1], best[2]


def _series_of_position(values: Array) -> Array:
    """Chebyshev coefficients over the last axis from values at the Chebyshev points."""
    coefficients = np.asarray(dct(values[..., ::-1], type=2, axis=-1)) / values.shape[-1]
    coefficients[..., 0] *= 0.5
    return coefficients


def _bounds(n: Array, k: Array, mu: Array, deviations: dict[str, Array], neglected: dict[str, Array]) -> Array:
    """Bound of each cell, piece, part of the positions and quantity."""
    of_node = cells_of_curve(n, k, mu)
    shape = (3, 3, 3)
    bounds = np.empty((*shape, len(PIECES), BINS, 3))
    for number, piece in enumerate(PIECES):
        position = chebyshev_positions(POINTS[piece])
        bins = part_of(piece, position) - number * BINS
        for part in range(BINS):
            # Of the shape (quantities, nodes).
            largest = deviations[piece][:, :, bins == part].max(axis=2)
            everywhere = np.array([tail_bound(sample) for sample in largest])
            of_part = np.empty((*shape, 3))
            for cell in np.ndindex(shape):
                inside = np.logical_and.reduce([a == b for a, b in zip(of_node, cell, strict=True)])
                known = np.count_nonzero(inside) >= _FEWEST
                of_part[cell] = [tail_bound(s[inside]) for s in largest] if known else everywhere
                of_part[cell] += neglected[piece][:, inside].max(axis=1, initial=0.0)
            bounds[..., number, part, :] = np.maximum(of_part, _BESIDE * _beside(of_part))
    return bounds + np.array(_OF_NODES)[:, None, None, None, None]


def _beside(values: Array) -> Array:
    """Largest value in the cells that share a face in k or mu."""
    largest = np.zeros_like(values)
    for axis in (1, 2):
        along, moved = np.moveaxis(largest, axis, 0), np.moveaxis(values, axis, 0)
        np.maximum(along[1:], moved[:-1], out=along[1:])
        np.maximum(along[:-1], moved[1:], out=along[:-1])
    return largest
