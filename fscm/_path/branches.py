"""Predictor, change of the edge that the mesh follows, and change of the continuation parameter."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fscm._path.arc_length import ArcLength, Point
from fscm._path.punch_rules import rules_of
from fscm._roots import bracketed_root
from fscm._surface.adaptivity import on_mesh, resolving
from fscm._surface.anchors import AtEdge
from fscm._surface.breaks import at_kinks, edge_mesh
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.state import Rates, State
from fscm._typing import Array

__all__ = ["edge_elsewhere", "follow_edge", "joined", "predicted", "turned"]

#: Times that the panels of a new mesh are split at the edge: it may be 1e-22 of the contact radius.
_HAND_OVER_ROUNDS = 80


def predicted(state: State, rates: Rates, step: float) -> State:
    """The state after a step along the tangent, on a mesh whose ends at kinks are there at the new scale, too."""
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
    offset = bracketed_root(excess, low, mesh.node_offsets[outer + 1])
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
    """The state that follows another edge, with the orientation of the path preserved."""
    point = Point(state, arc.tangent(state), before.segment + 1)
    if rules_of(state.disc.problem).joins(arc, before, point):
        return point
    state = replace(state, turned=("log_scale", -1.0))
    return Point(state, arc.tangent(state), before.segment + 1)
