"""Equilibria of a discretised half-space under a surface force, with a gap given: Newton's method.

Lengths are in units of the size c of the mesh, whose node s = 1 is the material point at which the gap is that of the
largest tension, once there is one.  Unknowns are the displacement, the pressure in the mixed form, and the approach.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem_reference._large_strain.block import Block, factorised, summed
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.surface import Surface
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["ROUGH_TOLERANCE", "Control", "State", "extrapolated", "solve_state"]

#: Largest last step in lengths of the law: the next one would be about its square.
NEWTON_TOLERANCE = 1e-6

#: As that, of a state on the way to another one.
ROUGH_TOLERANCE, ROUGH_STEPS = 1e-2, 6

#: Steps before giving up.
NEWTON_STEPS = 16

#: Largest change of a gap in one step, in lengths of the law, where the faces are within a few of them.
LARGEST_CHANGE = 0.5

#: Share of a step below which none is sought.
SMALLEST_DAMPING = 0.1


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


def solve_state(start: State, control: Control, tolerance: float = NEWTON_TOLERANCE) -> State:
    """Solve the equilibrium with a gap given.

    Parameters
    ----------
    start : State
    control : Control
    tolerance : float
        Largest last step in lengths of the law; fewer steps are tried for a larger one.

    Raises
    ------
    NotConverged
        If Newton's method does not end.
    """
    state = start
    unit = start.surface.law.z0 / start.surface.size
    steps = NEWTON_STEPS if tolerance <= NEWTON_TOLERANCE else ROUGH_STEPS
    for iteration in range(1, steps + 1):
        step = _newton_step(state, control)
        factor = _damping(state, step)
        state = _moved(state, step, factor)
        size = float(np.abs(step.u).max())
        if factor == 1.0 and size <= tolerance * unit:
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
        if _upright(moved):
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
    residual = summed(block.core.sides, elements.residual, block.core.size)
    residual[block.boundary] += block.exterior @ state.u[block.boundary]
    forces = np.stack([across, down], axis=2).reshape(rows.shape)
    residual += summed(rows, forces, block.core.size)
    approach = summed(rows, by_delta, block.core.size)
    factors = factorised(block.matrix(elements.tangent, by_surface))
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


def _load_slope(state: State, response: Array, approach: Array) -> float:
    """Change of the load with the approach along the path: P is the derivative of the energy by delta."""
    surface, block = state.surface, state.block
    faces = state.faces
    _, by_height = surface.pressure_slopes(faces)
    direct = -float((block.trace.weight * by_height * faces.rho) @ faces.stretch)
    # The tangent is symmetric but for the end of the surface: the load changes with u as the residual with delta.
    total = direct + float(approach[block.free] @ response[block.free])
    return 2.0 * math.pi * surface.size * surface.modulus * total
