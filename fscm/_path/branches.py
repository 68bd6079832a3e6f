"""Predictor, change of the edge that the mesh follows, and change of the continuation parameter."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import scipy

from fscm._path.arc_length import ArcLength, Point
from fscm._surface.adaptivity import at_kinks, edge_mesh, on_mesh, resolving
from fscm._surface.anchors import AtEdge
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.state import Rates, State
from fscm._typing import Array
from fscm.errors import NotConverged
from fscm.punch import PowerPunch

__all__ = ["LARGEST_DEVIATION", "checked_orientation", "edge_elsewhere", "follow_edge", "joined", "predicted", "turned"]

#: Largest deviation from the trapezoidal rule, relative to the distance of a gap to the singular gap.
LARGEST_DEVIATION = 0.5
#: The gaps within this multiple of the edge radius determine the orientation of the path.
_NEAR_EDGE = 2.0
#: Times that the panels of a new mesh are split at the edge: it may be 1e-22 of the contact radius.
_HAND_OVER_ROUNDS = 80


def predicted(state: State, rates: Rates, step: float) -> State:
    """The state after a step along the tangent, on a mesh with its breaks where the kinks are at the new scale."""
    problem, old = state.disc.problem, state.disc.mesh
    moved = state.shifted(rates.unknowns, rates.displacement, rates.log_scale, step)
    if moved.scale == state.scale:
        return moved
    mesh = at_kinks(problem, old, state.scale, moved.scale)
    return moved if mesh is old else on_mesh(moved, mesh)


def follow_edge(state: State, end_height: float, tolerance: float, edge_gap: float | None = None) -> State:
    """Guess on a mesh scaled so that the outermost edge gap, by default that of largest tension, is at s = 1."""
    problem, mesh = state.disc.problem, state.disc.mesh

    def target(radius: Array) -> Array | float:
        return problem.force.peak_gap(radius) if edge_gap is None else edge_gap

    def excess(offset: float) -> float:
        at = np.array([offset])
        gap = mesh.evaluate_at_offsets(state.gap, at)
        return float((gap - target(state.scale * (mesh.origin + at)))[0])

    inside = state.gap < target(state.radius)
    outer = int(np.flatnonzero(inside)[-1]) if np.any(inside) else -1
    low = -mesh.origin if outer < 0 else float(mesh.node_offsets[outer])
    offset = scipy.optimize.brentq(excess, low, mesh.node_offsets[outer + 1])
    ratio = mesh.origin + offset
    scale = state.scale * ratio

    def unknowns_on(new: PanelMesh) -> Array:
        return state.unknowns_at_scale(new, scale, np.minimum(new.nodes * ratio, mesh.breaks[-1]))

    def gap_on(new: PanelMesh) -> Array:
        return state.gap_of(unknowns_on(new), scale * new.nodes)

    new = edge_mesh(problem, mesh.order, scale, end_height)
    new = resolving(state, new, tolerance, gap_on, _HAND_OVER_ROUNDS, scale)
    disc = Discretisation(problem, new)
    guess = replace(state, disc=disc, scale=scale, unknowns=unknowns_on(new), anchor=AtEdge(edge_gap), turned=None)
    return replace(guess, iterations=0, residual=0.0)


def edge_elsewhere(state: State, hand_over: float) -> bool:
    """Whether the outermost contact edge is not the one that the mesh follows."""
    if not state.anchor.in_contact:
        return min(state.central_gap, float(np.min(state.gap))) < hand_over
    return float(np.min(state.gap[state.disc.mesh.nodes > 1.0])) < hand_over


def turned(arc: ArcLength, point: Point, name: str | None = None) -> Point:
    """The same state with another continuation parameter: the named one, or the one that changes most."""
    shares = {name: share for name, share in arc.shares(point).items() if name != point.state.parameter}
    name = name or max(shares, key=lambda candidate: abs(shares[candidate]))
    state = replace(point.state, turned=(name, math.copysign(1.0, shares[name])))
    return Point(state, arc.tangent(state), point.segment + 1)


def joined(arc: ArcLength, before: Point, state: State) -> Point:
    """The state that follows another edge, with the orientation of the path preserved.

    It is that of load and displacement.  Where contact begins it is that of the central gap, too, and under a power-law
    punch of that alone: the first contact may be so small that the others do not change within the error of the mesh.
    """
    point = Point(state, arc.tangent(state), before.segment + 1)
    if isinstance(state.disc.problem.punch, PowerPunch):
        same = before.rates.central_gap * point.rates.central_gap >= 0.0
    else:
        old, new = arc.shares(before), arc.shares(point)
        product = sum(old[name] * new[name] for name in ("displacement", "load"))
        if not before.state.anchor.in_contact:
            clearance = state.central_gap - state.disc.problem.law.singular_gap
            product += before.rates.central_gap * point.rates.central_gap / clearance**2
        same = product >= 0.0
    if same:
        return point
    state = replace(state, turned=("log_scale", -1.0))
    return Point(state, arc.tangent(state), before.segment + 1)


def _relative(state: State) -> Array:
    """Gaps; of a steep punch without its height, which is not linear in log c within a step."""
    return state.relative_to_punch(state.unknowns, state.displacement)


def _relative_rates(point: Point) -> Array:
    return point.state.relative_to_punch(point.rates.unknowns, point.rates.displacement)


def checked_orientation(a: Point, b: Point, step: float, same: bool | None, largest: float = LARGEST_DEVIATION) -> bool:
    """Whether b has the orientation of a.  Raises NotConverged if b lies on another branch.

    Near a sharp turn of the path, where load and displacement are undecided (`same` is None), it is that of the gaps
    inside the contact.
    """
    old_mesh, new_mesh = a.state.disc.mesh, b.state.disc.mesh
    offsets = np.minimum(new_mesh.seen_from(old_mesh.origin), old_mesh.offsets[-1])
    before, rate = (
        old_mesh.evaluate_at_offsets(_relative(a.state), offsets),
        old_mesh.evaluate_at_offsets(_relative_rates(a), offsets),
    )
    after, new_rate = _relative(b.state), _relative_rates(b)
    clearance = b.state.gap - a.state.disc.problem.law.singular_gap
    near_edge = new_mesh.nodes < _NEAR_EDGE
    product = new_mesh.weights * new_mesh.nodes * rate * new_rate / clearance**2
    if same is None:
        same = bool(np.sum(product[near_edge]) >= 0.0)
    deviation = after - before - 0.5 * step * (rate + (1.0 if same else -1.0) * new_rate)
    if np.max(np.abs(deviation) / clearance) > largest:
        raise NotConverged("Newton converged to a state on another branch of the path")
    return same
