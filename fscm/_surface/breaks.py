"""Ends of panels: first meshes, and ends at the kinks and joints of the punch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fscm._surface.discretisation import STEEP
from fscm._surface.mesh import PanelMesh
from fscm._surface.state import State
from fscm._typing import Array
from fscm.problem import Problem
from fscm.punch import joints_of, kinks_of

__all__ = [
    "SLIVER",
    "are_halves",
    "at_joints",
    "at_kinks",
    "edge_mesh",
    "end_radius",
    "extended",
    "initial_mesh",
    "joints_in",
    "off_joints",
]

#: Ends of the first panels of all meshes, in units of the radius at s = 1; farther out they grow by factors of four.
_FIRST_ENDS = np.array([0.0, 0.5, 1.0, 2.0])
#: On a steep punch the gap rises by at most this factor over a panel of the first mesh.
_RISE = 64.0
#: A break belongs to a kink that is closer than this share of its panels; a panel is wider than SLIVER.
_NEAR_KINK, SLIVER = 0.3, 1e-7
#: Largest distance of a joint to the nearest end of its panel, relative to its length: where the third derivative jumps
#: the error falls with the fourth power of it, and a node of the panel is farther than this from both ends.
_OFF_JOINT = 5e-3
#: Joints are rounded to this number, 2^40, of steps: ends with more digits are not stored (`_surface.response_store`).
_STORED = 2.0**40


def end_radius(problem: Problem, end_height: float) -> float:
    """A radius with f >= `end_height`, found by doubling."""
    r = 1.0
    while problem.punch.height(np.array([r]))[0] < end_height:
        r *= 2.0
        if r > 1e200:
            raise ValueError(f"the punch does not grow: f is still below {end_height} at r = {r}")
    while problem.punch.height(np.array([r / 2.0]))[0] > end_height:
        r /= 2.0
    return r


def extended(offsets: Array, origin: float, end: float) -> Array:
    """Panel ends relative to the origin, truncated or extended by factors of four to reach the radius `end`."""
    inside = offsets[offsets < end - origin]
    outer = [origin + inside[-1] if len(inside) else 0.0]
    while outer[-1] < end:
        outer.append(4.0 * outer[-1])
    return np.concatenate([inside, np.array(outer[1:]) - origin])


def initial_mesh(problem: Problem, order: int, end_height: float) -> PanelMesh:
    """A coarse mesh for the separated punch, scale 1, with a break at s = 1 and an end where f >= `end_height`."""
    breaks = extended(_FIRST_ENDS, 0.0, end_radius(problem, end_height))
    while problem.punch.growth > STEEP:
        f = problem.punch.height(breaks)
        # Farther out than the end height the pressure need not be resolved.
        bad = np.flatnonzero((f[1:] > _RISE * np.maximum(f[:-1], 1.0)) & (f[:-1] < end_height))
        if not bad.size:
            break
        breaks = np.sort(np.concatenate([breaks, 0.5 * (breaks[bad] + breaks[bad + 1])]))
    return PanelMesh(breaks, order)


def at_kinks(problem: Problem, mesh: PanelMesh, old_scale: float, new_scale: float) -> PanelMesh:
    """Mesh whose ends near kinks of the punch at the old scale are on them at the new one; no ends are added."""
    kinks = np.array(kinks_of(problem.punch))
    if not kinks.size:
        return mesh
    ends, shorter = mesh.offsets[1:-1], np.minimum(mesh.lengths[:-1], mesh.lengths[1:])
    distance = np.abs(kinks / old_scale - mesh.origin - ends[:, None])
    near = (np.min(distance, axis=1) < _NEAR_KINK * shorter) & (ends != 1.0 - mesh.origin)
    kinks = kinks[np.argmin(distance[near], axis=1)]
    return _with_ends(mesh, kinks / old_scale, kinks / new_scale)


def at_joints(problem: Problem, mesh: PanelMesh, scale: float) -> PanelMesh:
    """Mesh with panel ends at the joints of the punch: moved from near them, or inserted.

    A mesh whose scale changes leaves them behind: an end near a joint serves nearly as well as one on it.
    """
    joints = joints_in(problem, scale)
    if not joints.size:
        return mesh
    ends = np.append(np.array(kinks_of(problem.punch)) / scale, joints)
    return _with_ends(mesh, ends, ends)


def joints_in(problem: Problem, scale: float) -> Array:
    """Joints of the punch in the scaled radius, rounded so that the response of panels between them can be stored."""
    mantissa, exponent = np.frexp(np.array(joints_of(problem.punch)) / scale)
    return np.asarray(np.ldexp(np.rint(mantissa * _STORED) / _STORED, exponent))


def off_joints(state: State) -> bool:
    """Whether a joint inside the mesh has left its panel end."""
    mesh = state.disc.mesh
    joints = joints_in(state.disc.problem, state.scale) - mesh.origin
    joints = joints[joints < mesh.offsets[-1]]
    panel = mesh.locate(joints)
    from_end = np.minimum(joints - mesh.offsets[panel], mesh.offsets[panel + 1] - joints)
    return bool(np.any(from_end > _OFF_JOINT * mesh.lengths[panel]))


def _with_ends(mesh: PanelMesh, old: Array, new: Array) -> PanelMesh:
    """Mesh with panel ends at new radii: moved from near the old ones, or inserted."""
    if not new.size:
        return mesh
    ends, edge = mesh.offsets, 1.0 - mesh.origin
    for s in old - mesh.origin:
        i = int(np.argmin(np.abs(ends - s)))
        if not 0 < i < len(ends) - 1 or ends[i] == edge:
            continue
        if abs(ends[i] - s) < _NEAR_KINK * min(ends[i] - ends[i - 1], ends[i + 1] - ends[i]):
            ends = np.delete(ends, i)
    new = new - mesh.origin
    fixed = np.array([ends[0], edge, ends[-1]])
    new = new[(new < ends[-1]) & (np.min(np.abs(new[:, None] - fixed), axis=1) > SLIVER)]
    # A remaining break next to a kink would make an unnecessarily narrow panel.
    distance = np.min(np.abs(ends[:, None] - new), axis=1) if new.size else np.full(len(ends), np.inf)
    keep = (distance > SLIVER) | np.isin(ends, fixed)
    return replace(mesh, offsets=np.union1d(ends[keep], new))


def are_halves(mesh: PanelMesh) -> NDArray[np.bool_]:
    """Whether neighbouring panels are the halves of an earlier one, whose response is stored."""
    initial_ends = extended(_FIRST_ENDS, 0.0, float(mesh.breaks[-1])) - mesh.origin
    starts, lengths = mesh.offsets[:-2], mesh.lengths
    ancestor = initial_ends[np.searchsorted(initial_ends, starts, side="right") - 1]
    number = (starts - ancestor) / lengths[:-1]
    siblings: NDArray[np.bool_] = (lengths[:-1] == lengths[1:]) & (number % 2.0 == 0.0)
    return siblings


def edge_mesh(problem: Problem, order: int, scale: float, end_height: float) -> PanelMesh:
    """A coarse mesh with its origin at the edge, to be split there.

    Its ends are the same for all problems, so that their response is stored (see `_surface.response_store`).
    """
    ends = extended(np.array([-1.0, -0.5, 0.0, 1.0]), 1.0, max(end_radius(problem, end_height) / scale, 4.0))
    return PanelMesh(ends, order, 1.0)
