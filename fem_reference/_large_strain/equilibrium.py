"""Equilibria of a discretised half-space under a surface force, with a gap given: Newton's method.

Lengths are in units of the size c of the mesh, whose node s = 1 is the material point at which the gap is that of the
largest tension, once there is one.  Unknowns are the displacement, the pressure in the mixed form, and the approach.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem_reference._large_strain.block import Block
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.linearisation import Gap, Linearisation, Step, linearised
from fem_reference._large_strain.surface import Surface
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["ROUGH_TOLERANCE", "Control", "State", "extrapolated", "settled", "solve_state"]

#: Largest last step in lengths of the law: the next one would be about its square.
NEWTON_TOLERANCE = 1e-6

#: As that, of a state on the way to another one.
ROUGH_TOLERANCE, ROUGH_STEPS = 1e-2, 6

#: Steps before giving up.
NEWTON_STEPS = 16

#: Share of its size to which a step of a chord shrinks at least: one costs a tenth of a step of Newton's method.
SHRINKING = 0.2

#: What a chord may leave, in tolerances of the last step of Newton's method: that leaves as much, its square.
CHORD_REST = 1e-6

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
    residual : float
        Forces that were out of balance before the last step, relative to those of the surface.
    control : Control, optional
        The one that picked the state.
    linearisation : Linearisation, optional
        The one whose step was the last, at this state or near it.
    """

    block: Block
    surface: Surface
    u: Array
    pressures: Array
    delta: float
    iterations: int = 0
    residual: float = math.nan
    control: Control | None = None
    linearisation: Linearisation | None = None

    @property
    def light(self) -> State:
        """The state without its linearisation, which takes most of the memory."""
        return replace(self, linearisation=None)

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
    def load_slope(self) -> float:
        """dP/d(delta) along the path at fixed friction, in units of the input; it costs a factorisation."""
        surface, block, faces = self.surface, self.block, self.faces
        at_state = _linearised(self)
        _, by_height = surface.pressure_slopes(faces)
        direct = -float((block.trace.weight * by_height * faces.rho) @ faces.stretch)
        # The tangent is symmetric but for the end of the surface: the load changes with u as the residual with delta.
        total = direct + float(at_state.approach[block.free] @ at_state.response[block.free])
        return 2.0 * math.pi * surface.size * surface.modulus * total

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


def solve_state(start: State, control: Control, tolerance: float = NEWTON_TOLERANCE) -> State:
    """Solve the equilibrium with a gap given.

    Steps are those of a chord, with the linearisation of the start if it has one, or of the last step of Newton's
    method, as long as they shrink well.

    Parameters
    ----------
    start : State
    control : Control
    tolerance : float
        Largest last step of Newton's method in lengths of the law; fewer steps are tried for a larger one.

    Raises
    ------
    NotConverged
        If Newton's method does not end.
    """
    unit = start.surface.law.z0 / start.surface.size
    steps = NEWTON_STEPS if tolerance <= NEWTON_TOLERANCE else ROUGH_STEPS
    state, size = start, math.inf
    for iteration in range(steps + 1):
        kept = state.linearisation
        if kept is not None and kept.serves(state.block):
            state, done = _chord(state, control, size, tolerance * unit)
            if done:
                return replace(state, iterations=iteration)
        if iteration == steps:
            break
        state = replace(state, linearisation=_linearised(state))
        step = _step(state, control)
        factor = _damping(state, step)
        state = replace(_moved(state, step, factor), residual=step.imbalance, control=control)
        size = float(np.abs(step.u).max())
        if factor == 1.0 and size <= tolerance * unit:
            return replace(state, iterations=iteration + 1)
        if not math.isfinite(size):
            break
        if factor < 1.0:
            state = state.light
    raise NotConverged(
        f"Newton's method for a solid of finite strain ended at a step of {size / unit:.1e} lengths of the law"
    )


def _chord(state: State, control: Control, before: float, tolerance: float) -> tuple[State, bool]:
    """Go on with the linearisation of a state as long as the steps shrink well.

    Parameters
    ----------
    state : State
    control : Control
    before : float
        Size of the step to the state; infinite if its linearisation is that of another state.
    tolerance : float
        Largest last step, in units of the size.

    Returns
    -------
    state : State
        The last one to which the steps shrank.
    done : bool
        Whether it is the equilibrium.
    """
    good = tried = state
    while True:
        try:
            step = _step(tried, control)
        except NotConverged:
            return good, False
        size = float(np.abs(step.u).max())
        if not (size <= SHRINKING * before and _share(tried, step) == 1.0):
            return good, False
        tried = replace(_moved(tried, step, 1.0), residual=step.imbalance, control=control)
        # What is left is the sum of the next steps.
        shrinking = size / before if math.isfinite(before) else SHRINKING
        if math.isfinite(before):
            good = tried
        if size <= tolerance and size * shrinking <= CHORD_REST * tolerance:
            return tried, True
        before = size


def settled(state: State) -> State:
    """Return the state after a further step of the chord, if it is an equilibrium."""
    if state.control is None or state.linearisation is None:
        return state
    return _moved(state, _step(state, state.control), 1.0)


def extrapolated(before: State, state: State, ratio: float) -> State:
    """State beyond another one, `ratio` times as far from it as that is from the one before."""
    return replace(
        state,
        u=state.u + ratio * (state.u - before.u),
        pressures=state.pressures + ratio * (state.pressures - before.pressures),
        delta=state.delta + ratio * (state.delta - before.delta),
    )


def _moved(state: State, step: Step, factor: float) -> State:
    return replace(
        state,
        u=state.u + factor * step.u,
        pressures=state.pressures + factor * step.pressures,
        delta=state.delta + factor * step.delta,
    )


def _damping(state: State, step: Step) -> float:
    """Share of a step that changes no gap within a few lengths of the law too much, and turns no element inside out."""
    factor = _share(state, step)
    while factor > SMALLEST_DAMPING:
        moved = _moved(state, step, factor)
        if _upright(moved):
            return factor
        factor *= 0.5
    raise NotConverged("a Newton step turns an element inside out: the strains are too large for this mesh")


def _share(state: State, step: Step) -> float:
    """Share of a step that changes no gap within a few lengths of the law too much."""
    near = state.faces
    after = _moved(state, step, 1.0).faces
    law, size = state.surface.law, state.surface.size
    reach = np.minimum(near.gap, after.gap) * size < 3.0 * law.z0
    change = float(np.max(np.abs(after.gap - near.gap)[reach], initial=0.0)) * size
    return min(1.0, LARGEST_CHANGE * law.z0 / change) if change > 0.0 else 1.0


def _upright(state: State) -> bool:
    """Whether no element is turned inside out."""
    return math.isfinite(state.block.core.energy(state.u, state.surface.finiteness))


def _linearised(state: State) -> Linearisation:
    return linearised(state.block, state.surface, state.u, state.pressures, state.faces)


def _step(state: State, control: Control) -> Step:
    """Step into balance by the linearisation of a state."""
    if state.linearisation is None:
        raise AssertionError("a step needs a linearisation")
    surface = state.surface
    gap, slope = _gap(state, control.vertex)
    row = int(state.block.radial[control.vertex])
    to_gap = Gap(row, surface.finiteness * slope, (control.gap - gap) / surface.size)
    return state.linearisation.step(state.block, surface, state.u, state.pressures, state.faces, to_gap)
