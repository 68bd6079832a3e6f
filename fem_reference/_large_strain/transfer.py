"""A state carried over to other elements, as the beginning of Newton's method there.

The displacement is projected with equal weights for all elements, as the energy in the plane has no length; the
pressures are projected on each element.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem_reference._elastic.elasticity import element_places, gauss_product
from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_functions
from fem_reference._elastic.tensor_elements import factors, pressure_functions, unit_functions
from fem_reference._large_strain.block import Block
from fem_reference._large_strain.core import Core
from fem_reference._large_strain.equilibrium import State
from fem_reference._large_strain.surface import Surface
from fem_reference._typing import Array, Index

__all__ = ["carried_over"]


def carried_over(state: State, block: Block, surface: Surface) -> State:
    """Return the state on other elements, not in balance there.

    Parameters
    ----------
    state : State
    block : Block
        The other elements.  Beyond those of the state, its displacement stays as at their end.
    surface : Surface
        Of the other elements.
    """
    core = block.core
    order = core.order
    X, W = gauss_product(order + 1, order + 1)
    values, pressures = _fields(state, core, X)
    u = _projected(core, X, W, values)
    u[block.fixed] = 0.0
    if core.mixed:
        T = pressure_functions(X, order - 1)
        pressures = np.asarray(np.linalg.solve(T.T @ (W[:, None] * T), T.T @ (W[:, None] * pressures.T)).T, float)
    else:
        pressures = core.no_pressure()
    return replace(state, block=block, surface=surface, u=u, pressures=pressures)


def _fields(state: State, core: Core, X: Array) -> tuple[Array, Array]:
    """Displacement, shape (e, q, 2), and pressure, shape (e, q), of a state at points of other elements."""
    own, order = state.block.core, state.block.core.order
    columns, layers = element_places(core.grid.quads())
    r = core.grid.r[columns, None] + np.diff(core.grid.r)[columns, None] * X[0]
    z = core.grid.z[layers, None] + np.diff(core.grid.z)[layers, None] * X[1]
    column, along_r = _local(own.grid.r, r)
    layer, along_z = _local(own.grid.z, z)
    mesh = own.grid.quads()
    places = np.empty((own.grid.r.size - 1, own.grid.z.size - 1), int)
    places[tuple(element_places(mesh))] = np.arange(mesh.t.shape[1])
    element = places[column, layer]
    points = np.stack([along_r, along_z])
    functions = unit_functions(mesh, order, points)[0]
    coefficients = state.u[own.rows[element]].reshape(element.size, -1, 2)
    values = np.einsum("qn,qnc->qc", functions, coefficients).reshape(*r.shape, 2)
    if not own.mixed:
        return values, np.zeros(r.shape)
    tests = pressure_functions(points, order - 1)
    return values, np.einsum("qm,qm->q", tests, state.pressures[element]).reshape(r.shape)


def _local(nodes: Array, places: Array) -> tuple[Index, Array]:
    """Interval of each place, and the place in it as a share of its length."""
    x = np.clip(places.ravel(), nodes[0], nodes[-1])
    interval = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
    return interval, (x - nodes[interval]) / np.diff(nodes)[interval]


def _projected(core: Core, X: Array, W: Array, values: Array) -> Array:
    """Coefficients of the displacement nearest to values at points of each element.

    All elements have the mass of the unit square, so that the mass of all is the product of one along r and one along
    z.
    """
    mesh, order = core.grid.quads(), core.order
    N = unit_functions(mesh, order, X)[0]
    numbers = core.rows[:, 0::2] // 2
    places = [
        _line_places(element, degrees, order)
        for element, degrees in zip(element_places(mesh), factors(mesh, order), strict=True)
    ]
    along_r, along_z = (np.zeros(core.size // 2, np.intp) for _ in places)
    along_r[numbers], along_z[numbers] = places
    right = N.T @ (W[:, None] * values)
    sums = [np.bincount(numbers.ravel(), right[..., c].ravel(), core.size // 2) for c in (0, 1)]
    mass_r, mass_z = (_line_mass(nodes.size - 1, order) for nodes in (core.grid.r, core.grid.z))
    b = np.empty((2, mass_r.shape[0], mass_z.shape[0]))
    b[:, along_r, along_z] = sums
    along_both = np.linalg.solve(mass_z, np.linalg.solve(mass_r, b).swapaxes(1, 2))
    return np.asarray(along_both[:, along_z, along_r].T.ravel())


def _line_places(element: Index, degrees: Index, order: int) -> Index:
    """Number along a side, in surface order, of the factor of each function of some elements, shape (e, n)."""
    inside = int(element.max()) + 2 + element[:, None] * (order - 1) + degrees - 2
    return np.where(degrees < 2, element[:, None] + degrees, inside)


def _line_mass(count: int, order: int) -> Array:
    """Mass of the functions of elements in a row, in surface order, each element of the mass 1."""
    x, w = unit_gauss(order + 1)
    nodes = np.arange(count + 1.0)
    N = line_functions(nodes, order, (nodes[:-1, None] + x).ravel())
    return np.asarray(N.T @ (np.tile(w, count)[:, None] * N))
