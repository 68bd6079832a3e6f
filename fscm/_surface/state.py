r"""State of the surface on a mesh.

Radii are r = c s with the mesh in s.  The unknowns are N numbers at the nodes, the displacement delta and log c.

*Gaps.*  Under most punches the numbers are the gaps H.

*Gaps under kinks.*  The height of a punch with kinks is not linear in log c within a step, and is not resolved by the
mesh: it is added to the smooth deformation wherever the scale or the mesh changes.

*Deformations.*  The height of a steep punch is not linear in log c either, and so much larger than the deformation that
their difference loses digits: the numbers are the deformations w, H = f - delta + w.  Under the potential of the whole
punch every shape that grows faster than a paraboloid is steep.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fscm._roots import bracketed_root
from fscm._surface.anchors import Anchor, FixedScale
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.tail import Tail, tail_energy, tail_of
from fscm._typing import Array
from fscm.punch import kinks_of

__all__ = ["Control", "Rates", "State", "SteepState", "rigid_state"]

#: Bound on any change of log c, against overflow of iterates that Newton's method rejects.
_LARGEST_CHANGE = 50.0


@dataclass(frozen=True)
class Control:
    """A linear condition gap * H_0 + displacement * delta + load * P + log_scale * log c = value."""

    value: float
    gap: float = 0.0
    displacement: float = 0.0
    load: float = 0.0
    log_scale: float = 0.0


@dataclass(frozen=True)
class Rates:
    """Derivatives along the equilibrium path; `unknowns` has those of the unknowns of `State`."""

    unknowns: Array
    displacement: float
    log_scale: float
    central_gap: float
    load: float
    energy: float

    def scaled(self, factor: float) -> Rates:
        """The same derivatives in another unit."""
        return Rates(
            factor * self.unknowns,
            factor * self.displacement,
            factor * self.log_scale,
            factor * self.central_gap,
            factor * self.load,
            factor * self.energy,
        )


@dataclass(frozen=True)
class State:
    """One state on its discretisation, whose unknowns are the gaps at the nodes.

    Attributes
    ----------
    disc : Discretisation
    scale : float
        c; radii are c s.
    unknowns : ndarray, shape (N,)
        Numbers at the nodes, in z0.
    displacement : float
        delta / z0.
    anchor : Anchor
        What fixes the scale.
    iterations, residual
        Of the Newton solve that produced it.
    turned : tuple of str and float, optional
        Continuation parameter and its orientation along the path, if they are not those of the anchor.
    """

    disc: Discretisation
    scale: float
    unknowns: Array
    displacement: float
    anchor: Anchor
    iterations: int = 0
    residual: float = 0.0
    turned: tuple[str, float] | None = None

    @property
    def parameter(self) -> str:
        """Name of the continuation parameter: "gap", "log_scale", "displacement" or "load"."""
        return self.turned[0] if self.turned else self.anchor.parameter

    @property
    def orientation(self) -> float:
        """Whether the continuation parameter rises (1) or falls (-1) along the path."""
        return self.turned[1] if self.turned else self.anchor.orientation

    @cached_property
    def rates(self) -> dict[str, Rates]:
        """Stored derivatives along the path by the name of their parameter, see `rates_by`."""
        return {}

    @cached_property
    def gap(self) -> Array:
        """H at the nodes, in z0, shape (N,)."""
        return self.gap_of(self.unknowns, self.radius)

    def gap_of(self, unknowns: Array, radius: Array) -> Array:
        """Gaps from unknowns at any radii."""
        return unknowns

    def with_deformation(self, deformation: Array) -> State:
        """The state with this deformation at the nodes."""
        return replace(self, unknowns=self.disc.height(self.radius) - self.displacement + deformation)

    @property
    def nodal_deformation(self) -> Array:
        """w from the unknowns, shape (N,); equal to `deformation` in equilibrium."""
        return self.gap - self.disc.height(self.radius) + self.displacement

    def mismatch(self, deformation: Array) -> Array:
        """Residual of Eq. 4 at the nodes with this deformation by the pressure, shape (N,)."""
        return self.gap + self.displacement - self.disc.height(self.radius) - deformation

    def change_of_gap(self, unknowns: Array, displacement: float, log_scale: float) -> Array:
        """Change of the gaps by a change of the unknowns, to first order."""
        return unknowns

    def relative_to_punch(self, unknowns: Array, displacement: float) -> Array:
        """Gaps, or their change, as far as they are linear within a step."""
        return unknowns

    def is_linear(self, log_scale: float) -> bool:
        """Whether the gaps are linear in a step with this change of log c."""
        return True

    def shifted(self, unknowns: Array, displacement: float, log_scale: float, factor: float = 1.0) -> State:
        """The state after `factor` times a change of its unknowns, which are linear in log c."""
        return replace(
            self,
            scale=self.scale * math.exp(factor * log_scale),
            unknowns=self.unknowns + factor * unknowns,
            displacement=self.displacement + factor * displacement,
        )

    def unknowns_on(self, mesh: PanelMesh) -> Array:
        """The unknowns interpolated to another mesh at the same scale."""
        return self.disc.mesh.transfer(self.unknowns, mesh)

    def unknowns_at_scale(self, mesh: PanelMesh, scale: float, radii: Array) -> Array:
        """The unknowns at the nodes of a mesh of another scale, which are at these radii of the present mesh."""
        shape = self.disc.problem.punch.height
        return self.disc.mesh.evaluate(self.unknowns, radii) + (shape(scale * mesh.nodes) - shape(self.scale * radii))

    def of_problem(self, disc: Discretisation, scale: float) -> State:
        """The state of another problem with this deformation, at another scale."""
        if scale == self.scale:
            return replace(self, disc=disc)
        change = disc.height(scale * disc.mesh.nodes) - self.disc.height(self.radius)
        return replace(self, disc=disc, scale=scale, unknowns=self.unknowns + change)

    def at_anchor(self, edge_gap: float) -> State:
        """The state with this gap at the edge, which gaps have already."""
        return self

    @cached_property
    def radius(self) -> Array:
        """Node radii r = c s, shape (N,)."""
        return self.scale * self.disc.mesh.nodes

    @property
    def end(self) -> float:
        """Radius where the mesh ends."""
        return float(self.scale * self.disc.mesh.breaks[-1])

    @cached_property
    def pressure(self) -> Array:
        """p at the nodes, shape (N,)."""
        return self.disc.force.traction(self.radius, self.gap)

    @cached_property
    def tail(self) -> Tail:
        """Contribution of radii beyond the mesh."""
        return tail_of(self.disc.problem, self.end, self.displacement)

    @cached_property
    def deformation(self) -> Array:
        """w at the nodes, shape (N,)."""
        d = self.disc
        return d.stiffness_scale(self.scale) * (d.response(self.scale) @ self.pressure) + self.tail.displacement

    @cached_property
    def central_gap(self) -> float:
        """H_0 from Eq. 32."""
        d = self.disc
        w0 = d.stiffness_scale(self.scale) * float(d.axis_response(self.scale) @ self.pressure)
        w0 += self.tail.displacement
        return w0 - self.displacement

    @cached_property
    def load(self) -> float:
        """P of Eq. 31, tension negative."""
        mesh = self.disc.mesh
        area = 2.0 * self.scale**2 * mesh.weights * mesh.nodes
        return float(area @ self.pressure) + self.tail.load

    @cached_property
    def energy(self) -> float:
        """Elastic plus surface energy, unit pi Q^(2/n) dgamma z0^(2/n); its change is P d(delta).

        The elastic part is (1/2) int p w 2 r dr, the surface part int e(H) 2 r dr with e from the law.  When
        the surface part is infinite (a cone under the 9-3 law) its finite part is taken: the divergent
        constant is the same for all states of a problem, so differences are right.
        """
        d = self.disc
        area = 2.0 * self.scale**2 * d.mesh.weights * d.mesh.nodes
        density = 0.5 * self.pressure * self.deformation + d.force.energy(self.radius, self.gap)
        return float(area @ density) + tail_energy(self.disc.problem, self.end, self.displacement)


@dataclass(frozen=True)
class _KinkedState(State):
    """The unknowns are gaps under a punch with kinks."""

    def is_linear(self, log_scale: float) -> bool:
        """As for `State`."""
        return log_scale == 0.0

    def shifted(self, unknowns: Array, displacement: float, log_scale: float, factor: float = 1.0) -> State:
        """As for `State`; the change of the height is exact."""
        moved = State.shifted(self, unknowns, displacement, log_scale, factor)
        if log_scale == 0.0:
            return moved
        disc, r = self.disc, self.radius
        change = disc.height(moved.radius) - disc.height(r) - disc.rise(r) * (factor * log_scale)
        return replace(moved, unknowns=moved.unknowns + change)

    def unknowns_on(self, mesh: PanelMesh) -> Array:
        """As for `State`; the deformation is smooth where the shape is not resolved."""
        shape, old = self.disc.problem.punch.height, self.disc.mesh
        return old.transfer(self.gap - shape(self.radius), mesh) + shape(self.scale * mesh.nodes)

    def unknowns_at_scale(self, mesh: PanelMesh, scale: float, radii: Array) -> Array:
        """As for `State`."""
        shape = self.disc.problem.punch.height
        return self.disc.mesh.evaluate(self.gap - shape(self.radius), radii) + shape(scale * mesh.nodes)


@dataclass(frozen=True)
class SteepState(State):
    """The unknowns are the deformations under a steep punch."""

    def gap_of(self, unknowns: Array, radius: Array) -> Array:
        """As for `State`."""
        return self.disc.height(radius) - self.displacement + unknowns

    def with_deformation(self, deformation: Array) -> State:
        """As for `State`."""
        return replace(self, unknowns=deformation)

    @property
    def nodal_deformation(self) -> Array:
        """As for `State`."""
        return self.unknowns

    def mismatch(self, deformation: Array) -> Array:
        """As for `State`."""
        return self.unknowns - deformation

    def change_of_gap(self, unknowns: Array, displacement: float, log_scale: float) -> Array:
        """As for `State`."""
        return unknowns - displacement + self.disc.rise(self.radius) * log_scale

    def relative_to_punch(self, unknowns: Array, displacement: float) -> Array:
        """As for `State`: without the height."""
        return unknowns - displacement

    def is_linear(self, log_scale: float) -> bool:
        """As for `State`."""
        return False

    def shifted(self, unknowns: Array, displacement: float, log_scale: float, factor: float = 1.0) -> State:
        """As for `State`, but linear in log c + f(c), in which the edge is so."""
        return replace(State.shifted(self, unknowns, displacement, 0.0, factor), scale=self._scale(factor * log_scale))

    def _scale(self, change: float) -> float:
        """The scale after a linear change of log c + f(c)."""
        if change == 0.0:
            return self.scale
        change = min(max(change, -_LARGEST_CHANGE), _LARGEST_CHANGE)

        def beyond(log_c: float) -> float:
            return log_c + float(self.disc.height(np.array([math.exp(log_c)]))[0]) - aim

        start, aim = math.log(self.scale), 0.0
        aim = beyond(start) + change * (1.0 + float(self.disc.rise(np.array([self.scale]))[0]))
        # f is convex in log c: the tangent overshoots upwards, and undershoots downwards.
        high = start + change
        low = start if change > 0.0 else high - beyond(high)
        if beyond(low) >= 0.0 or beyond(high) <= 0.0:  # the same to rounding
            return math.exp(high)
        return math.exp(bracketed_root(beyond, low, high, 1e-15))

    def unknowns_at_scale(self, mesh: PanelMesh, scale: float, radii: Array) -> Array:
        """As for `State`."""
        return self.disc.mesh.evaluate(self.unknowns, radii)

    def of_problem(self, disc: Discretisation, scale: float) -> State:
        """As for `State`."""
        return replace(self, disc=disc, scale=scale)

    def at_anchor(self, edge_gap: float) -> State:
        """As for `State`: restores the gap at the edge, which the height at another scale has changed."""
        edge = float(self.disc.height(np.array([self.scale]))[0] + self.disc.edge @ self.unknowns)
        return replace(self, displacement=edge - edge_gap)


@dataclass(frozen=True)
class _KinkedSteepState(SteepState):
    """The unknowns are the deformations under a steep punch with kinks, which move with log c."""

    def _scale(self, change: float) -> float:
        return self.scale * math.exp(change)


_CLASSES = {
    # steep, with kinks
    (False, False): State,
    (False, True): _KinkedState,
    (True, False): SteepState,
    (True, True): _KinkedSteepState,
}


def rigid_state(disc: Discretisation, central_gap: float) -> State:
    """The state of a rigid solid at a central gap, on a mesh of the scale 1."""
    undeformed = np.zeros(disc.mesh.size)
    kind = _CLASSES[disc.steep, bool(kinks_of(disc.problem.punch))]
    return kind(disc, 1.0, undeformed, -central_gap, FixedScale()).with_deformation(undeformed)
