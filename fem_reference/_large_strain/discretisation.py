"""A problem on the meshes of its small-strain equilibria: blocks and states of finite strain at any size."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.friction import FrictionName
from fem_reference._contact.path import EDGE_RISE
from fem_reference._contact.states import Point
from fem_reference._elastic.elasticity import EXTRA_POINTS
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import variant
from fem_reference._large_strain.block import Block, block_of
from fem_reference._large_strain.equilibrium import ROUGH_TOLERANCE, Control, State, extrapolated, solve_state
from fem_reference._large_strain.start import small_strain_state
from fem_reference._large_strain.surface import Surface
from fem_reference._large_strain.surface_stability import largest_tension
from fem_reference._large_strain.transfer import carried_over
from fem_reference.errors import NotConverged
from fem_reference.interaction import Interaction
from fem_reference.neo_hookean import NeoHookean
from fem_reference.problem import Problem
from fem_reference.solid import PowerLaw, ScaledSolid, Solid
from fem_reference.solids import Homogeneous, OffsetPowerLaw

__all__ = ["Discretisation", "LinearEvent", "linear_event", "linear_problem"]

#: Poisson's ratio up to which the small-strain solver goes; its solid only serves to begin with.
LARGEST_RATIO = 0.49

#: Share of the tension at which a flat surface is unstable from which on it is named as the reason.
NEAR_LIMIT = 0.75

#: Degrees of the elements on which an event is sought first: fewer ones by so many, and the least.
FEWER_DEGREES, LEAST_DEGREE = 2, 4

#: Factor of the strains to begin with where the linear state is too far away; its first and its smallest step.
FIRST_FINITENESS, FIRST_STEP, SMALLEST_STEP = 0.05, 0.2, 0.005

#: Factor of the next step of the strains after a state that was found in a few Newton steps.
LONGER, FEW = 1.5, 3


@dataclass(frozen=True, slots=True)
class LinearEvent:
    """An event of the path of small strain.

    Attributes
    ----------
    point : Point
    spec : MeshSpec
        Mesh on which it was computed.
    size : float
        Radius of the edge of that mesh.
    """

    point: Point
    spec: MeshSpec
    size: float

    @property
    def radius(self) -> float:
        """Radius of the contact edge, or that of the lowest part of the gap, on which contact begins."""
        point = self.point
        if point.branch.touching:
            return point.edge_radius
        contact, state = point.branch.contact, point.state
        above = contact.gap(state.y) > state.central_gap + EDGE_RISE * contact.law.z0
        return float(state.size * contact.compliance.trace.s[np.argmax(above)])


def linear_problem(problem: Problem, friction: FrictionName = "none") -> Problem:
    """Return a problem with a path of small strain near that of an incompressible or a bonded solid.

    The response of the surface of a homogeneous solid depends on E/(1 - nu^2) only; where its points keep their radii
    it is (3 - 4 nu)/(4 (1 - nu)^2) times as large (that of a force in the infinite solid, twice).  The first states of
    finite strain begin from vertical gaps.
    """
    problem, solid = problem.under("derjaguin"), problem.solid
    if not isinstance(solid, PowerLaw | Homogeneous | OffsetPowerLaw | NeoHookean):
        return problem
    nu = solid.nu
    stiffer = 4.0 * (1.0 - nu) ** 2 / (3.0 - 4.0 * nu) if friction == "bonded" else 1.0
    if nu <= LARGEST_RATIO and stiffer == 1.0:
        return problem
    ratio = min(nu, LARGEST_RATIO)
    name = "E" if isinstance(solid, Homogeneous) else "E0"
    modulus = getattr(solid, name) * stiffer * (1.0 - ratio**2) / (1.0 - nu**2)
    return replace(problem, solid=replace(solid, nu=ratio, **{name: modulus}))


def linear_event(
    problem: Problem, event: str, accuracy: float | str = "quick", friction: FrictionName = "none"
) -> LinearEvent:
    """Return an event of the path of small strain, and its mesh.

    Raises
    ------
    ValueError, NoSuchEvent, NotConverged
        As `fem_reference.event_state`.
    """
    mesh = chosen(linear_problem(problem, friction), (event,), accuracy, lambda mesh: mesh.events)
    return LinearEvent(mesh.events.at(event), mesh.spec, mesh.size)


@dataclass(frozen=True, slots=True)
class Discretisation:
    """Elements of finite strain for a problem.

    Attributes
    ----------
    problem : Problem
    spec : MeshSpec
        In units of the edge radius, at the radius `size`.
    size : float
        Edge radius for which the lines of the mesh have their places.
    extent : float
        Side of the core in edge radii.
    mixed : bool
        Whether the pressure is an unknown of its own.
    friction : {"none", "bonded"}
    interaction : Interaction
    extra : int
        Gauss points a direction beyond the degree.
    feature : str
        Of `fem_reference._elastic.variants.FEATURES`, made coarser; none by default.
    """

    problem: Problem
    spec: MeshSpec
    size: float
    extent: float
    mixed: bool
    friction: FrictionName
    interaction: Interaction
    extra: int = EXTRA_POINTS
    feature: str = ""

    def at(self, radius: float) -> Discretisation:
        """Return the discretisation whose lines have their places for an edge at a radius."""
        return replace(self, spec=self.spec.moved(radius / self.size), size=radius)

    @property
    def _without_length(self) -> bool:
        """Whether the solid has no length of its own, so that its elements serve every size."""
        return math.isinf(self.problem.solid.surface_depth)

    @property
    def unit_of_traction(self) -> float:
        """The modulus of a solid without a length, which has that of its elements as 1."""
        return float(self.problem.solid.modulus(np.array(self.size))) if self._without_length else 1.0

    def block(self, radius: float) -> Block:
        """Return the elements with their edge at a radius."""
        solid = self.problem.solid
        spec = replace(self.spec, extent=self.extent)
        bonded = self.friction == "bonded"
        if self._without_length:
            unit = NeoHookean(1.0, float(solid.poisson(np.array(radius))))
            return _block(self, spec, ScaledSolid(unit, bonded=bonded))
        return _block(self, spec.moved(radius / self.size), ScaledSolid(solid, radius, bonded))

    def surface(self, block: Block, radius: float) -> Surface:
        """Return punch and law at a radius of the edge."""
        punch, law = self.problem.punch, self.problem.law
        unit = self.unit_of_traction
        tension = self.problem.solid.surface_tension / (unit * radius)
        return Surface(block.trace, block.slopes, punch, law, self.interaction, radius, unit, tension=tension)

    @property
    def coarser(self) -> Discretisation:
        """The discretisation on which an event is sought first."""
        return replace(self, spec=replace(self.spec, order=max(LEAST_DEGREE, self.spec.order - FEWER_DEGREES)))

    def carried(self, state: State, radius: float, control: Callable[[Block], Control]) -> State:
        """Solve a state from one on other elements.

        Raises
        ------
        NotConverged
            If it is not found.
        """
        block = self.block(radius)
        return solve_state(carried_over(state, block, self.surface(block, radius)), control(block))

    def first_state(self, event: LinearEvent, radius: float, control: Callable[[Block], Control]) -> State:
        """Solve a state from one of small strain, in one step or by raising the factor of the strains to 1.

        Raises
        ------
        NotConverged
            If the strains cannot be raised to their full size.
        """
        block = self.block(radius)
        surface = self.surface(block, radius)
        linear = small_strain_state(event.point, block, surface)
        with suppress(NotConverged):
            return solve_state(linear, control(block))
        before: State | None = None
        state = replace(linear, surface=replace(surface, finiteness=FIRST_FINITENESS))
        state, step = solve_state(state, control(block), ROUGH_TOLERANCE), FIRST_STEP
        while state.surface.finiteness < 1.0:
            step = min(step, 1.0 - state.surface.finiteness)
            finiteness = 1.0 if step > 0.999 - state.surface.finiteness else state.surface.finiteness + step
            try:
                start = replace(state, surface=replace(surface, finiteness=finiteness))
                if before is not None:
                    ratio = step / (state.surface.finiteness - before.surface.finiteness)
                    start = extrapolated(before, start, ratio)
                following = solve_state(start, control(block), ROUGH_TOLERANCE)
            except NotConverged as error:
                step *= 0.5
                if step < SMALLEST_STEP:
                    raise NotConverged(
                        f"the equilibrium of small strain can be continued to {state.surface.finiteness:.2f} of the "
                        f"strains only ({error}): {_reason(self.problem)}"
                    ) from error
                continue
            before, state = state, following
            if state.iterations <= FEW:
                step *= LONGER
        return solve_state(state, control(block))


@lru_cache(maxsize=4)
def _block(choice: Discretisation, spec: MeshSpec, solid: Solid) -> Block:
    grid = variant(spec, choice.feature).grid() if choice.feature else spec.grid()
    law = choice.problem.law
    tension = -float(law.traction(np.array(law.peak_gap))) / choice.unit_of_traction
    return block_of(grid, solid, spec.order, choice.mixed, tension, choice.extra)


def _reason(problem: Problem) -> str:
    """What to do, and what the tension of the law does to a compressible surface."""
    law, solid, remedy = problem.law, problem.solid, "take a stiffer solid or less adhesion"
    if math.isfinite(solid.surface_depth):
        return remedy
    E, nu = float(solid.modulus(np.array(1.0))), float(solid.poisson(np.array(1.0)))
    tension = -float(law.traction(np.array(law.peak_gap))) * (1.0 - nu**2) / E
    limit = largest_tension(nu)
    if tension < NEAR_LIMIT * limit:
        return remedy
    return (
        f"the largest tension of the law is {tension:.3g} of E/(1 - nu^2), and the flat surface of such a solid is "
        f"unstable from {limit:.3g} on; {remedy}"
    )
