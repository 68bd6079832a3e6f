"""Equilibria of a core of finite strain under a surface force, closed by the linear exterior: Newton's method.

Lengths are in units of the size c of the mesh, whose node s = 1 is the material point at which the gap is that of the
largest tension, once there is one.  Unknowns are the displacement, the pressure in the mixed form, and the approach.
The tangent is a sparse matrix on the sides of the elements, which is factorised.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from fem_reference._elastic.assembly import square_boundary
from fem_reference._elastic.dof_ordering import line_unknowns
from fem_reference._elastic.elasticity import EXTRA_POINTS
from fem_reference._elastic.exterior import exterior_stiffness
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.trace import Trace, trace_of
from fem_reference._large_strain.core import Core, core_of
from fem_reference._large_strain.surface import Faces, Surface, local_slopes
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged
from fem_reference.modulus import Modulus
from fem_reference.poisson import PoissonRatio, poisson_at

__all__ = ["Block", "Control", "State", "block_of", "extrapolated", "linear_response", "solve_state"]

#: Largest last step in lengths of the law: the next one would be about its square.
NEWTON_TOLERANCE = 1e-6

#: Steps before giving up.
NEWTON_STEPS = 16

#: Largest change of a gap in one step, in lengths of the law, where the faces are within a few of them.
LARGEST_CHANGE = 0.5

#: Share of a step below which none is sought.
SMALLEST_DAMPING = 0.1

#: Largest Poisson ratio of the exterior, whose stiffness needs a finite lambda: it changes by about 1 - 2 nu.
EXTERIOR_RATIO = 0.5 - 2.5e-8

Friction = Literal["frictionless", "bonded"]


@dataclass(frozen=True, eq=False)
class Block:
    """A discretised half-space, in lengths of the radius of its edge.

    Attributes
    ----------
    core : Core
    trace : Trace
        Its surface.
    slopes : ndarray
        Derivatives of the surface functions.
    radial : ndarray of int
        Rows of u_r on it in surface order; those of u_z are the next ones.
    boundary : ndarray of int
        Rows on the side and bottom of the square.
    exterior : ndarray
        Stiffness of the exterior there.
    fixed : ndarray of int
        Rows that are zero.
    """

    core: Core
    trace: Trace
    slopes: Array
    radial: Index
    boundary: Index
    exterior: Array
    fixed: Index

    @cached_property
    def surface_rows(self) -> Index:
        """Rows of the functions of each surface element, both components interleaved, shape (e, 2 (p + 1))."""
        rows = self.radial[self.trace.functions]
        return np.stack([rows, rows + 1], axis=2).reshape(rows.shape[0], -1)

    @cached_property
    def _pattern(self) -> tuple[Index, Array, Index, Index, Index, Index]:
        """Free rows, their numbers, and how entries of all parts go into a matrix of compressed columns."""
        sides = self.core.sides
        free = np.setdiff1d(np.unique(sides), self.fixed)
        number = np.full(self.core.size, -1)
        number[free] = np.arange(free.size)
        parts = [(sides, sides), (self.surface_rows, self.surface_rows), (self.boundary[None], self.boundary[None])]
        rows = np.concatenate([np.repeat(number[r], r.shape[1], axis=1).ravel() for r, _ in parts])
        cols = np.concatenate([np.tile(number[c], (1, c.shape[1])).ravel() for _, c in parts])
        present = np.flatnonzero((rows >= 0) & (cols >= 0))
        key = cols[present] * free.size + rows[present]
        order = np.argsort(key, kind="stable")
        key = key[order]
        starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
        columns = np.searchsorted(key[starts] // free.size, np.arange(free.size + 1))
        return free, number, present[order], starts, key[starts] % free.size, columns

    @property
    def free(self) -> Index:
        """Rows on the sides of elements that are not fixed."""
        return self._pattern[0]

    def matrix(self, elements: Array, surface: Array) -> sparse.csc_array:
        """Tangent on the free rows from those of the elements and of the surface."""
        free, _, order, starts, rows, columns = self._pattern
        entries = np.concatenate([elements.ravel(), surface.ravel(), self.exterior.ravel()])[order]
        data = np.add.reduceat(entries, starts)
        return sparse.csc_array((data, rows, columns), shape=(free.size, free.size))


def block_of(
    grid: Grid,
    modulus: Modulus,
    nu: float | PoissonRatio,
    order: int,
    mixed: bool,
    friction: Friction = "frictionless",
    extra: int = EXTRA_POINTS,
) -> Block:
    """Discretise a half-space.

    Parameters
    ----------
    grid : Grid
        With its edge at s = 1.
    modulus, nu
        E(z), and Poisson's ratio up to 0.5, in lengths of the edge radius.
    order : int
        Degree of the elements.
    mixed : bool
        Whether the pressure is an unknown of its own; an incompressible solid needs it.
    friction : {"frictionless", "bonded"}
        Whether the points of the surface are free to slide, or keep their radii.
    extra : int
        Gauss points a direction beyond the degree.
    """

    def constants(z: Array) -> tuple[Array, Array]:
        E, ratio = modulus(z), poisson_at(nu, z)
        with np.errstate(divide="ignore"):
            softness = np.divide((1.0 + ratio) * (1.0 - 2.0 * ratio), ratio * E)
        return E / (2.0 * (1.0 + ratio)), softness

    core = core_of(grid, constants, order, mixed, extra)
    trace = trace_of(grid, order)
    boundary, signs = square_boundary(grid, core.dofs, order)
    at_end = min(float(poisson_at(nu, np.array(grid.extent))), EXTERIOR_RATIO)
    exterior = exterior_stiffness(grid, modulus, at_end, order, order - 1 if mixed else None)
    surface = 2 * line_unknowns(core.dofs, 1, 0.0)
    fixed = 2 * line_unknowns(core.dofs, 0, 0.0)
    if friction == "bonded":
        fixed = np.union1d(fixed, surface)
    return Block(core, trace, local_slopes(trace), surface, boundary, signs[:, None] * exterior * signs, fixed)


@dataclass(frozen=True, slots=True)
class Control:
    """The gap at a material point of the surface, in units of the input, which picks a state of the path.

    Attributes
    ----------
    vertex : int
        Number of the surface vertex.
    gap : float
    """

    vertex: int
    gap: float


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """An equilibrium.

    Attributes
    ----------
    block : Block
    surface : Surface
    u : ndarray
        Displacement, positive into the solid, in units of the size.
    pressures : ndarray, shape (e, m)
        Those of the elements, in the mixed form.
    delta : float
        Approach in units of the size.
    iterations : int
        Newton steps.
    load_slope : float
        dP/d(delta) along the path at fixed friction, in units of the input.
    residual : float
        Forces that were out of balance before the last step, relative to those of the surface.
    control : Control, optional
        The one that picked the state.
    """

    block: Block
    surface: Surface
    u: Array
    pressures: Array
    delta: float
    iterations: int = 0
    load_slope: float = math.nan
    residual: float = math.nan
    control: Control | None = None

    @property
    def faces(self) -> Faces:
        """The deformed surface."""
        radial = self.block.radial
        return self.surface.faces(self.u[radial], self.u[radial + 1], self.delta)

    @property
    def end(self) -> float:
        """Current radius of the end of the mesh."""
        trace = self.block.trace
        vertices = trace.nodes.size
        return trace.extent + self.surface.finiteness * float(self.u[self.block.radial[vertices - 1]])

    @property
    def load(self) -> float:
        """P in units of the input, compression positive."""
        return self.surface.load(self.faces, self.end, self.delta)

    @property
    def displacement(self) -> float:
        """Approach in units of the input."""
        return self.delta * self.surface.size

    def gap_at(self, vertex: int) -> float:
        """Gap at a surface vertex in units of the input."""
        return _gap(self, vertex)[0]

    @property
    def energy(self) -> float:
        """Elastic energy and that of the faces, in units of the input."""
        c, block = self.surface.size, self.block
        far = self.u[block.boundary]
        elastic = block.core.energy(self.u, self.surface.finiteness) + 0.5 * float(far @ block.exterior @ far)
        elastic *= 2.0 * math.pi * c**3 * self.surface.modulus
        return elastic + self.surface.energy(self.faces, self.end, self.delta)


def _gap(state: State, vertex: int) -> tuple[float, float]:
    """Gap at a vertex in units of the input, and the slope of the punch there."""
    surface, row = state.surface, state.block.radial[vertex]
    rho = state.block.trace.nodes[vertex] + surface.finiteness * state.u[row]
    height = float(surface.punch.height(np.array(surface.size * rho)))
    slope = float(surface.punch.slope(np.array(surface.size * rho)))
    return height + surface.size * (float(state.u[row + 1]) - state.delta), slope


@dataclass(frozen=True, slots=True, eq=False)
class _Step:
    """One Newton step: changes of everything, and the response to a change of the approach."""

    u: Array
    pressures: Array
    delta: float
    load_slope: float
    residual: float


def solve_state(start: State, control: Control) -> State:
    """Solve the equilibrium with a gap given.

    Parameters
    ----------
    start : State
    control : Control

    Raises
    ------
    NotConverged
        If Newton's method does not end.
    """
    state = start
    unit = start.surface.law.z0 / start.surface.size
    for iteration in range(1, NEWTON_STEPS + 1):
        step = _newton_step(state, control)
        factor = _damping(state, step)
        state = _moved(state, step, factor)
        size = float(np.abs(step.u).max())
        if factor == 1.0 and size <= NEWTON_TOLERANCE * unit:
            return replace(
                state,
                iterations=iteration,
                load_slope=step.load_slope,
                residual=step.residual,
                control=control,
            )
        if not math.isfinite(size):
            break
    raise NotConverged(
        f"Newton's method for a solid of finite strain ended at a step of {size / unit:.1e} lengths of the law"
    )


def extrapolated(before: State, state: State, ratio: float) -> State:
    """State beyond another one, `ratio` times as far from it as that is from the one before."""
    return replace(
        state,
        u=state.u + ratio * (state.u - before.u),
        pressures=state.pressures + ratio * (state.pressures - before.pressures),
        delta=state.delta + ratio * (state.delta - before.delta),
    )


def _moved(state: State, step: _Step, factor: float) -> State:
    return replace(
        state,
        u=state.u + factor * step.u,
        pressures=state.pressures + factor * step.pressures,
        delta=state.delta + factor * step.delta,
    )


def _damping(state: State, step: _Step) -> float:
    """Share of a step that changes no gap within a few lengths of the law too much."""
    near = state.faces
    after = _moved(state, step, 1.0).faces
    law, size = state.surface.law, state.surface.size
    reach = np.minimum(near.gap, after.gap) * size < 3.0 * law.z0
    change = float(np.max(np.abs(after.gap - near.gap)[reach], initial=0.0)) * size
    factor = min(1.0, LARGEST_CHANGE * law.z0 / change) if change > 0.0 else 1.0
    while factor > SMALLEST_DAMPING:
        moved = _moved(state, step, factor)
        if moved.faces.stretch.min() > 0.0 and _upright(moved):
            return factor
        factor *= 0.5
    raise NotConverged("a Newton step turns an element inside out: the strains are too large for this mesh")


def _upright(state: State) -> bool:
    """Whether no element is turned inside out."""
    return math.isfinite(state.block.core.energy(state.u, state.surface.finiteness))


def _newton_step(state: State, control: Control) -> _Step:
    """Linearise, and solve for the step and the response to the approach."""
    block, surface = state.block, state.surface
    elements = block.core.condensed(state.u, state.pressures, surface.finiteness)
    if elements is None:
        raise NotConverged("an element is turned inside out: the strains are too large for this mesh")
    faces = state.faces
    by_surface, by_delta = surface.tangent(faces)
    across, down = surface.residual(faces)
    rows = block.surface_rows
    residual = _summed(block.core.sides, elements.residual, block.core.size)
    residual[block.boundary] += block.exterior @ state.u[block.boundary]
    forces = np.stack([across, down], axis=2).reshape(rows.shape)
    residual += _summed(rows, forces, block.core.size)
    approach = _summed(rows, by_delta, block.core.size)
    factors = _factorised(block.matrix(elements.tangent, by_surface))
    solved = factors.solve(np.stack([-residual[block.free], -approach[block.free]], axis=1))
    step, response = np.zeros((2, block.core.size))
    step[block.free], response[block.free] = solved.T
    gap, slope = _gap(state, control.vertex)
    row = block.radial[control.vertex]
    lack = (control.gap - gap) / surface.size

    def gap_change(u: Array) -> float:
        return surface.finiteness * slope * float(u[row]) + float(u[row + 1])

    delta = (lack - gap_change(step)) / (gap_change(response) - 1.0)
    step += delta * response
    pressures = block.core.recover(elements, step)
    imbalance = float(np.linalg.norm(residual[block.free]) / np.linalg.norm(forces))
    return _Step(step, pressures, delta, _load_slope(state, response, approach), imbalance)


def _summed(rows: Index, entries: Array, size: int) -> Array:
    """Sum of entries by their rows."""
    return np.asarray(np.bincount(rows.ravel(), entries.ravel(), size), float)


def _factorised(K: sparse.csc_array) -> SuperLU:
    try:
        return splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:
        raise NotConverged(f"the tangent of the solid of finite strain is singular: {error}") from error


def _load_slope(state: State, response: Array, approach: Array) -> float:
    """Change of the load with the approach along the path: P is the derivative of the energy by delta."""
    surface, block = state.surface, state.block
    faces = state.faces
    change = state.block.trace.weight * np.asarray(surface.law.slope(surface.size * faces.gap)) * surface.size
    direct = -float((change * faces.rho) @ faces.stretch) / surface.modulus
    # The tangent is symmetric but for the end of the surface: the load changes with u as the residual with delta.
    total = direct + float(approach[block.free] @ response[block.free])
    return 2.0 * math.pi * surface.size * surface.modulus * total


def linear_response(block: Block, pressure: Array) -> tuple[Array, Array]:
    """Displacement and pressures of the linear solid under a pressure at the Gauss points of its surface."""
    core, trace = block.core, block.trace
    zero = np.zeros(core.size)
    elements = core.condensed(zero, core.no_pressure(), 1.0)
    if elements is None:
        raise AssertionError("the undeformed solid is not turned inside out")
    e, _, n = trace.local.shape
    factors = _factorised(block.matrix(elements.tangent, np.zeros((e, 2 * n, 2 * n))))
    down = (trace.weight * trace.s * pressure).reshape(e, 1, -1) @ trace.local
    load = _summed(block.surface_rows[:, 1::2], down, core.size)
    u = np.zeros(core.size)
    u[block.free] = factors.solve(load[block.free])
    return u, core.recover(elements, u)
