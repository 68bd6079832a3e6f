"""Series of `comparisons.models.surface_tension`.

`python -m tests.comparisons.models.surface_tension_series` prints it.

The equation is solved with t = 1 - y^2, where chi has the edge 1/y, by collocation on panels that become shorter
towards y = 0; the kernel is integrated with each polynomial of a panel by rules that are graded towards its logarithm.
"""

import itertools
import math

import numpy as np
import scipy
from numpy.polynomial import Chebyshev
from numpy.polynomial.legendre import leggauss

from comparisons.models.surface_tension import LARGEST

#: Coefficients of the table, and of the interpolation that it is cut from.
TERMS, NODES = 48, 80
#: Nodes of a panel, its Gauss rule, and its graded parts.
DEGREE, GAUSS, GRADES = 12, 16, 26
#: Factorials of the asymptotic series of the kernel, and where it begins.
_FACTORIALS, _FAR = [math.factorial(2 * j + 1) for j in range(14)], 60.0


def kernel(z):
    """Integral of cos(u z)/(1 + u) from 0 to infinity, z > 0."""
    sine, cosine = scipy.special.sici(np.minimum(z, _FAR))
    near = (np.pi / 2 - sine) * np.sin(z) - cosine * np.cos(z)
    far = 0.0
    square = 1.0 / np.maximum(z, _FAR) ** 2
    for factorial in reversed(_FACTORIALS):
        far = factorial - square * far
    return np.where(z < _FAR, near, square * far)


def lagrange(points, nodes):
    """Values of the Lagrange polynomials of nodes, (..., len(nodes))."""
    weights = np.array([1.0 / np.prod(node - np.delete(nodes, i)) for i, node in enumerate(nodes)])
    distance = points[..., None] - nodes
    shares = weights / np.where(np.abs(distance) < 1e-15, 1e-15, distance)
    return shares / shares.sum(-1, keepdims=True)


def graded_rule():
    """Nodes and weights on (0, 1), dense towards 0."""
    x, w = leggauss(GAUSS)
    ends = np.append(0.0, 0.25 ** np.arange(GRADES, -1, -1))
    return (ends[:-1, None] + np.diff(ends)[:, None] * (x + 1) / 2).ravel(), (np.diff(ends)[:, None] * w / 2).ravel()


def panel_rows(y, target, low, high, ratio, nodes):
    """Integrals of the kernel at |y^2 - target^2| with the polynomials of a panel, (len(y), DEGREE)."""
    rows = np.zeros((len(y), DEGREE))
    nearest = np.clip(target, low, high)
    offset, (x, w), (graded, weights) = nearest - target, leggauss(GAUSS), graded_rule()
    far = np.flatnonzero(np.abs(offset) > 3.0 * (high - low))
    at = low + (high - low) * (x + 1) / 2
    distance = np.abs((at - target[far, None]) * (at + target[far, None]))
    rows[far] = (kernel(distance / ratio) * (high - low) * w / ratio) @ lagrange(x, nodes)
    for side, length in ((-1.0, nearest - low), (1.0, high - nearest)):
        near = np.setdiff1d(np.flatnonzero(length > 0.0), far)
        step = side * length[near, None] * graded
        at = nearest[near, None] + step
        distance = np.maximum(np.abs((step + offset[near, None]) * (at + target[near, None])), 1e-40)
        values = kernel(distance / ratio) * 2.0 * length[near, None] * weights / ratio
        rows[near] += np.einsum("ij,ijk->ik", values, lagrange(2.0 * (at - low) / (high - low) - 1.0, nodes))
    return rows


def constants(ratio):
    """c and m at l/a, and m by the solution for u = r^2: reciprocity."""
    x, w = leggauss(DEGREE)
    ends = np.concatenate([[0.0], 0.6 * 0.35 ** np.arange(13, -1, -1.0), [0.8, 0.9, 1.0]])
    low, width = ends[:-1], np.diff(ends)
    y, weights = (low[:, None] + width[:, None] * (x + 1) / 2).ravel(), (width[:, None] * w).ravel()
    matrix = np.concatenate(
        [
            sum(panel_rows(y, target, a, b, ratio, x) for target in (y, np.sqrt(2.0 - y * y)))
            for a, b in itertools.pairwise(ends)
        ],
        axis=1,
    )
    square = (1.0 - y * y) ** 2
    flat, curved = np.linalg.solve(matrix, np.stack([np.ones(len(y)), square], 1)).T
    return np.pi * (weights @ flat), 3.0 * np.pi * (weights @ (square * flat)), 3.0 * np.pi * (weights @ curved)


def main():
    end = math.log(LARGEST)
    nodes = Chebyshev.basis(NODES, domain=(-end, end)).roots()
    ratios = np.exp(nodes)
    values = np.array([constants(ratio)[:2] for ratio in ratios])
    fits = [Chebyshev.fit(nodes, ratios / (values[:, i] - 1.0), NODES - 1, domain=(-end, end)).coef for i in (0, 1)]
    print("flat,curved")
    for flat, curved in zip(*(fit[:TERMS] for fit in fits), strict=True):
        print(f"{flat:.17g},{curved:.17g}")


if __name__ == "__main__":
    main()
