"""Stiffness of the elements of a tensor-product mesh, as sums of products of matrices along r and along z.

The modulus depends on the depth only and the weight r on the radius only, so that every integral over an element is a
product of two integrals along its sides.  Functions, numbering and degree are those of scikit-fem's `ElementQuadP`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from skfem import Dofs, MeshQuad

from fem_reference._elastic.dof_ordering import both_components
from fem_reference._elastic.elasticity import (
    EXTRA_POINTS,
    FIRST_LAYER_POINTS,
    Body,
    contracted,
    element_places,
    gauss_product,
    lame_parameters,
)
from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_functions, line_slopes
from fem_reference._elastic.mapping import first_layer_depth
from fem_reference._elastic.mesh import Grid
from fem_reference._typing import Array, Index
from fem_reference.solid import Solid

__all__ = [
    "BLOCKS",
    "along_from_start",
    "charted_stiffness",
    "depth_integrals",
    "factors",
    "pressure_functions",
    "radial_integrals",
    "tensor_stiffness",
    "unit_functions",
]

#: Functions along a side and their slopes, from points of the unit interval and their degree.
Along = Callable[[Array, int], tuple[Array, Array]]


def factors(mesh: MeshQuad, order: int) -> tuple[Index, Index]:
    """Degrees of both factors of each function of an element, along both coordinates of the mesh."""
    edge = range(2, order + 1)
    pairs = [(0, 0), (1, 0), (1, 1), (0, 1)]
    pairs += [(i, 0) for i in edge] + [(1, i) for i in edge] + [(i, 1) for i in edge] + [(0, i) for i in edge]
    pairs += [(i, j) for i in edge for j in edge]
    x, y = np.array(pairs, np.intp).T
    # The first reference axis goes from the first corner to the second.
    return (y, x) if mesh.p[0, mesh.t[0, 0]] == mesh.p[0, mesh.t[1, 0]] else (x, y)


def _along(points: Array, order: int) -> tuple[Array, Array]:
    """Functions and slopes on the unit interval, shape (q, order + 1)."""
    ends = np.array([0.0, 1.0])
    return line_functions(ends, order, points), line_slopes(ends, order, points)


def along_from_start(points: Array, order: int) -> tuple[Array, Array]:
    """As `_along`, with 1 and x in place of the functions of both ends: an end counts from the start of the side.

    Examples
    --------
    >>> along_from_start(np.array([0.25]), 1)
    (array([[1.  , 0.25]]), array([[0., 1.]]))
    """
    N, slope = _along(points, order)
    N[:, 0], N[:, 1] = 1.0, points
    slope[:, 0], slope[:, 1] = 0.0, 1.0
    return N, slope


def unit_functions(mesh: MeshQuad, order: int, X: Array) -> tuple[Array, Array, Array]:
    """Functions of an element at points X of the unit square of (r, z), and their slopes along both; shape (q, n)."""
    along = factors(mesh, order)
    N, dN = (f[:, along[0]] for f in _along(X[0], order))
    M, dM = (f[:, along[1]] for f in _along(X[1], order))
    return N * M, dN * M, N * dM


def pressure_functions(X: Array, degree: int) -> Array:
    """Products of Legendre polynomials up to a total degree at points X of the unit square, shape (q, m).

    Examples
    --------
    >>> pressure_functions(np.array([[0.5], [1.0]]), 1)
    array([[1., 1., 0.]])
    """
    along = [np.polynomial.legendre.legvander(2.0 * x - 1.0, degree) for x in X]
    return np.stack([along[0][:, i] * along[1][:, j] for i in range(degree + 1) for j in range(degree + 1 - i)], axis=1)


def _integrals(left: Array, weight: Array, right: Array) -> Array:
    """Integrals of the products of functions on each element, shape (e, n, n); `weight` has the shape (e, q)."""
    return np.asarray(np.swapaxes(left, -1, -2) @ (weight[:, :, None] * right))


def radial_integrals(nodes: Array, order: int, along: Along = _along) -> dict[str, Array]:
    """Matrices along r of every column; d marks a derivative."""
    x, w = unit_gauss(order + EXTRA_POINTS)
    N, slope = along(x, order)
    h = np.diff(nodes)[:, None]
    r, weight = nodes[:-1, None] + h * x, h * w
    dN = slope / h[:, :, None]
    return {
        "N r N": _integrals(N, weight * r, N),
        "dN r dN + N/r N": _integrals(dN, weight * r, dN) + _integrals(N, weight / r, N),
        "dN r dN": _integrals(dN, weight * r, dN),
        "dN N + N dN": _integrals(dN, weight, N) + _integrals(N, weight, dN),
        "(dN r + N) N": _integrals(dN, weight * r, N) + _integrals(N, weight, N),
        "N r dN": _integrals(N, weight * r, dN),
    }


def depth_integrals(nodes: Array, solid: Solid, order: int, along: Along = _along) -> dict[str, Array]:
    """Matrices along z of every row, weighted with lambda, mu or stiff = lambda + 2 mu; d marks a derivative."""
    rows: list[dict[str, Array]] = []
    x, w = unit_gauss(order + EXTRA_POINTS)
    u, wu = unit_gauss(FIRST_LAYER_POINTS)
    for ends, points, weights in ((nodes[:2], u**3, 3.0 * u**2 * wu), (nodes[1:], x, w)):
        Z, slope = along(points, order)
        h = np.diff(ends)[:, None]
        z, stretch = first_layer_depth(ends[:-1, None] + h * points, float(nodes[1]), solid.surface_exponent)
        measure, dZ = h * weights * stretch, slope / (h * stretch)[:, :, None]
        lame, shear = lame_parameters(solid, z)
        lame, shear = lame * measure, shear * measure
        stiff = lame + 2.0 * shear
        rows.append(
            {
                "Z stiff Z": _integrals(Z, stiff, Z),
                "Z lambda Z": _integrals(Z, lame, Z),
                "Z mu Z": _integrals(Z, shear, Z),
                "dZ mu dZ": _integrals(dZ, shear, dZ),
                "dZ stiff dZ": _integrals(dZ, stiff, dZ),
                "Z lambda dZ": _integrals(Z, lame, dZ),
                "dZ mu Z": _integrals(dZ, shear, Z),
            }
        )
    in_first_layer, below = rows
    return {name: np.concatenate([in_first_layer[name], below[name]]) for name in below}


#: Blocks of an element, radial or axial rows and columns, as pairs of a matrix along r and one along z.
BLOCKS = {
    (0, 0): (("dN r dN + N/r N", "Z stiff Z"), ("dN N + N dN", "Z lambda Z"), ("N r N", "dZ mu dZ")),
    (0, 1): (("(dN r + N) N", "Z lambda dZ"), ("N r dN", "dZ mu Z")),
    (1, 1): (("N r N", "dZ stiff dZ"), ("dN r dN", "Z mu Z")),
}


def tensor_stiffness(grid: Grid, dofs: Dofs, solid: Solid) -> Iterator[tuple[Index, Index, Array]]:
    """Numbers, rows and stiffness of some elements at a time: shapes (e,), (e, 2 n) and (e, 2 n, 2 n).

    The next ones take the memory of the stiffness.

    Parameters
    ----------
    grid : Grid
        The mesh; its first layer has a chart.
    dofs : skfem.Dofs
        Numbering of its functions of `ElementQuadP`.
    solid : Solid
        In units of the grid.

    Raises
    ------
    ValueError
        If the modulus is not positive, or Poisson's ratio outside its range.
    """
    mesh, order = dofs.topo, int(dofs.element.p)
    columns, layers = element_places(mesh)
    rows = both_components(np.asarray(dofs.element_dofs)).T
    order_of_layers = np.lexsort((layers, columns)).reshape(grid.r.size - 1, -1)
    radial, depth = radial_integrals(grid.r, order), depth_integrals(grid.z, solid, order)
    count = order_of_layers.shape[1]
    along_z = [np.stack([depth[name].ravel() for _, name in pairs]) for pairs in BLOCKS.values()]
    # New memory costs as much as what is written into it.
    products = np.empty((len(BLOCKS), (order + 1) ** 2, count * (order + 1) ** 2))
    K = np.empty((count, rows.shape[1], rows.shape[1]))
    places = _places(*factors(mesh, order), count, order + 1)
    for column, elements in enumerate(order_of_layers):
        for product, pairs, of_depth in zip(products, BLOCKS.values(), along_z, strict=True):
            of_radius = np.stack([radial[name][column].ravel() for name, _ in pairs], axis=1)
            np.matmul(of_radius, of_depth, out=product)
        np.take(products.ravel(), places, out=K, mode="clip")
        yield elements, rows[elements], K


def _places(along_r: Index, along_z: Index, layers: int, n: int) -> Index:
    """Places of the entries of the elements of a column among the products along r and z of each block.

    A product has the pairs of functions along r as its rows, and layers and then pairs along z as its columns.
    """
    size = 2 * along_r.size
    places = np.empty((layers, size, size), np.intp)
    layer = np.arange(layers)[:, None, None]
    for block, (i, j) in enumerate(BLOCKS):
        first, second = (pair[:, None] * n + pair for pair in (along_r, along_z))
        of_block = (block * n**2 + first) * layers * n**2 + layer * n**2 + second
        places[:, i::2, j::2] = of_block
        if i != j:
            places[:, j::2, i::2] = np.swapaxes(of_block, 1, 2)
    return places


def charted_stiffness(
    body: Body, dofs: Dofs, first_layer: Index, pressure_degree: int | None = None
) -> Iterator[tuple[Index, Index, Array]]:
    """Numbers, rows and stiffness of elements as of `tensor_stiffness`, under any chart of a tensor-product mesh.

    Parameters
    ----------
    body : Body
        Its first coordinate points into the solid in the first layer.
    dofs : skfem.Dofs
        Numbering of the functions on its mesh.
    first_layer : ndarray of int
        Elements touching the surface.
    pressure_degree : int, optional
        Of the polynomials to which the dilatation is projected: the mixed form, which keeps the volume of nearly
        incompressible solids without locking.
    """
    mesh, order = body.mesh, body.order
    rows = both_components(np.asarray(dofs.element_dofs)).T
    corner, sides = mesh.p[:, mesh.t].min(axis=1), np.ptp(mesh.p[:, mesh.t], axis=1)
    deeper = np.setdiff1d(np.arange(mesh.nelements), first_layer)
    count = order + EXTRA_POINTS
    rules = (deeper, gauss_product(count, count)), (first_layer, gauss_product(count, FIRST_LAYER_POINTS, 3))
    for elements, (X, W) in rules:
        if not elements.size:
            continue
        # Transposed in the first layer, where the rule of the chart goes along the first coordinate.
        X = X[::-1] if elements is first_layer else X
        (r, z), J = body.chart(corner[:, elements, None] + sides[:, elements, None] * X[:, None, :])
        det = J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
        N, *slopes = unit_functions(mesh, order, X)
        along_r, along_z = (slope / sides[i, elements, None, None] for i, slope in enumerate(slopes))
        radial = (J[1, 1] / det)[..., None] * along_r - (J[1, 0] / det)[..., None] * along_z
        axial = (J[0, 0] / det)[..., None] * along_z - (J[0, 1] / det)[..., None] * along_r
        measure = r * np.abs(det) * W * (sides[0] * sides[1])[elements, None]
        lame, shear = lame_parameters(body.solid, z)
        hoop = N / r[..., None]
        if pressure_degree is None:
            yield elements, rows[elements], contracted(radial, axial, hoop, lame * measure, shear * measure)
            continue
        K = contracted(radial, axial, hoop, 0.0 * measure, shear * measure)
        tests = pressure_functions(X, pressure_degree)
        B = np.empty((elements.size, tests.shape[1], K.shape[1]))
        for component, dilatation in enumerate((radial + hoop, axial)):
            B[:, :, component::2] = tests.T @ (measure[..., None] * dilatation)
        C = tests.T @ ((measure / lame)[..., None] * tests)
        yield elements, rows[elements], K + B.swapaxes(1, 2) @ np.linalg.solve(C, B)
