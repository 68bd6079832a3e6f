"""Predicted states, change of the edge that the mesh follows, and change of the continuation parameter."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import scipy

from fscm._adaptivity import at_kinks, rescaled_mesh
from fscm._arc_length import ArcLength, Point
from fscm._equilibrium import Discretisation, Rates, State
from fscm._newton import moved_gap, moves_exactly
from fscm._panels import PanelMesh
from fscm.errors import NotConverged
from fscm.punch import kinks_of

__all__ = ["checked_sense", "edge_elsewhere", "follow_edge", "joined", "predicted", "turned"]

# Largest deviation from the trapezoidal rule, relative to the distance of a gap to the singular gap.
_SURPRISE = 0.5
# The gaps within this multiple of the edge radius tell the sense of the path.
_NEAR_EDGE = 2.0


def predicted(state: State, rates: Rates, step: float) -> State:
    problem = state.disc.problem
    if step * rates.log_scale != 0.0 and kinks_of(problem.punch):
        return _predicted_with_kinks(state, rates, step)
    return replace(
        state,
        scale=state.scale * math.exp(step * rates.log_scale),
        gap=moved_gap(state, step * rates.gap, step * rates.log_scale),
        displacement=state.displacement + step * rates.displacement,
    )


def _predicted_with_kinks(state: State, rates: Rates, step: float) -> State:
    """The same, on a mesh with its breaks where the kinks are at the new scale."""
    problem, old, log_scale = state.disc.problem, state.disc.mesh, step * rates.log_scale
    scale, shape = state.scale * math.exp(log_scale), problem.punch.height
    smooth = moved_gap(state, step * rates.gap, log_scale) - shape(state.radius * math.exp(log_scale))
    mesh = PanelMesh(at_kinks(problem, old.breaks, state.scale, scale), old.order)
    return replace(
        state,
        disc=Discretisation(problem, mesh, state.disc),
        scale=scale,
        gap=old.transfer(smooth, mesh) + shape(scale * mesh.nodes),
        displacement=state.displacement + step * rates.displacement,
    )


def follow_edge(state: State, end_height: float) -> State:
    """Guess on a mesh scaled so that the outermost gap of largest tension sits at s = 1."""
    problem, mesh = state.disc.problem, state.disc.mesh
    target = problem.law.peak_gap
    outer = int(np.flatnonzero(state.gap < target)[-1]) if np.any(state.gap < target) else -1
    low = 0.0 if outer < 0 else float(mesh.nodes[outer])
    ratio = scipy.optimize.brentq(
        lambda s: mesh.evaluate(state.gap, np.array([s]))[0] - target, low, mesh.nodes[outer + 1]
    )
    new = rescaled_mesh(problem, mesh, state.scale, state.scale * ratio, end_height)
    known = np.minimum(new.nodes * ratio, mesh.breaks[-1])
    shape = problem.punch.height
    if not moves_exactly(problem.punch):
        gap = mesh.evaluate(state.gap, known)
        gap += shape(state.scale * ratio * new.nodes) - shape(state.scale * known)
    else:
        gap = mesh.evaluate(state.gap - shape(state.radius), known) + shape(state.scale * ratio * new.nodes)
    return State(Discretisation(problem, new), state.scale * ratio, gap, state.displacement, True)


def edge_elsewhere(state: State, hand_over: float) -> bool:
    """Whether the outermost contact edge is not the one that the mesh follows."""
    if not state.follows_edge:
        return min(state.central_gap, float(np.min(state.gap))) < hand_over
    return float(np.min(state.gap[state.disc.mesh.nodes > 1.0])) < hand_over


def turned(arc: ArcLength, point: Point, name: str | None = None) -> Point:
    """The same state, from which the path goes on in the named parameter, or in the other one that changes most."""
    shares = {name: share for name, share in arc.shares(point).items() if name != point.state.parameter}
    name = name or max(shares, key=lambda other: abs(shares[other]))
    state = replace(point.state, turned=(name, math.copysign(1.0, shares[name])))
    return Point(state, arc.tangent(state), point.stretch + 1)


def joined(arc: ArcLength, before: Point, state: State) -> Point:
    """The state that follows another edge, with load and displacement changing in the same sense as before."""
    point = Point(state, arc.tangent(state), before.stretch + 1)
    old, new = arc.shares(before), arc.shares(point)
    if sum(old[name] * new[name] for name in ("displacement", "load")) >= 0.0:
        return point
    state = replace(state, turned=("log_scale", -1.0))
    return Point(state, arc.tangent(state), before.stretch + 1)


def checked_sense(a: Point, b: Point, step: float, same: bool | None) -> bool:
    """Whether the gaps go on changing in the same sense; NotConverged when b is on another branch.

    Near a sharp turn of the path, the gaps inside the contact tell its sense when load and displacement do not.
    """
    mesh, other = a.state.disc.mesh, b.state.disc.mesh
    known = np.minimum(other.nodes, mesh.breaks[-1])
    before, rate = mesh.evaluate(a.state.gap, known), mesh.evaluate(a.rates.gap, known)
    clearance = b.state.gap - a.state.disc.problem.law.singular_gap
    near = other.nodes < _NEAR_EDGE
    product = other.weights * other.nodes * rate * b.rates.gap / clearance**2
    if same is None:
        same = bool(np.sum(product[near]) >= 0.0)
    surprise = b.state.gap - before - 0.5 * step * (rate + (1.0 if same else -1.0) * b.rates.gap)
    if np.max(np.abs(surprise) / clearance) > _SURPRISE:
        raise NotConverged("Newton converged to a state that the tangent does not lead to")
    return same
