"""Pull-off forces of many problems in the range of the atlas, by groups that share a mesh."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from fscm._many.bounds import Loads, bounded_loads, corrected_loads
from fscm._many.equilibrium import Batch, Stationary, stationary_states
from fscm._many.guess import Guess, guesses
from fscm._many.meshes import CommonMesh, Nodes, Panels, panels_for
from fscm._many.response import INTERVALS, ResponseTable
from fscm._typing import Array
from fscm.interpolation.atlas import atlas

__all__ = ["RELATIVE_BOUND", "by_interval", "groups_of", "parts_of", "pull_off_forces", "solved"]

#: Largest bound of a value of a batch, relative to it.
RELATIVE_BOUND = 1e-8
#: Entries of the matrices of a batch: 16 MB, which a cache holds in part.
_ENTRIES = 2_000_000
#: What Newton's method leaves of the changes of gaps.
_REMAINDER = 1e-10


def pull_off_forces(n: Array, k: Array, mu: Array) -> Loads:
    """Forces and bounds; nan where none was certified.

    Every problem is solved twice on a mesh, with different orders.  A value is certified if its bound is below
    `RELATIVE_BOUND`, the load has a minimum there, and the atlas agrees within the sum of both bounds: another minimum
    of the load could be taken for it only if it were as deep within them.
    """
    force, bound = np.full(n.shape, np.nan), np.full(n.shape, np.nan)
    known, known_bound = (np.asarray(part) for part in atlas(n, k, mu, "pull_off_force"))
    guess = guesses(n, k, mu)
    for interval, problems in zip(INTERVALS, by_interval(k), strict=True):
        groups = groups_of(n, k, guess, problems)
        table = ResponseTable(interval, [panels.offsets for panels in groups])
        for panels, group in groups.items():
            mesh = CommonMesh(panels, table)
            for part in parts_of(group, mesh):
                loads = _bounded(mesh, n, k, mu, guess, part)
                good = loads.bound <= RELATIVE_BOUND * np.abs(loads.load)
                good &= np.abs(loads.load + known[part]) <= known_bound[part] + loads.bound
                force[part[good]], bound[part[good]] = -loads.load[good], loads.bound[good]
            # The coefficients of the next mesh take the memory of these.
            del mesh
    return Loads(force, bound)


def _bounded(mesh: CommonMesh, n: Array, k: Array, mu: Array, guess: Guess, part: NDArray[np.intp]) -> Loads:
    """Least loads of some of the problems; their bounds are infinite where there is no minimum.

    Where the bound is too large, a first solution with more nodes replaces the first one.
    """
    loads = Loads(np.full(len(part), np.nan), np.full(len(part), np.inf))
    for nodes in mesh.first:
        left = np.flatnonzero(~(loads.bound <= RELATIVE_BOUND * np.abs(loads.load)))
        if left.size:
            first, states, again, states_again = solved(mesh, nodes, n, k, mu, guess, part[left])
            with np.errstate(all="ignore"):
                found = bounded_loads(again, states_again, corrected_loads(first, states))
            least = states.converged & states_again.converged & (states_again.curvature > 0.0)
            loads.load[left], loads.bound[left] = found.load, np.where(least, found.bound, np.inf)
    return loads


def by_interval(k: Array) -> list[NDArray[np.intp]]:
    """Indices of the problems of each interval."""
    index = np.searchsorted([interval.high for interval in INTERVALS[:-1]], k, side="right")
    return [np.flatnonzero(index == i) for i in range(len(INTERVALS))]


def groups_of(n: Array, k: Array, guess: Guess, problems: NDArray[np.intp]) -> dict[Panels, NDArray[np.intp]]:
    """Problems by the mesh that they share."""
    wanted = panels_for(n[problems], k[problems], guess.log_scale[problems], guess.width[problems])
    groups: dict[Panels, list[int]] = defaultdict(list)
    for problem, panels in zip(problems.tolist(), wanted, strict=True):
        groups[panels].append(problem)
    return {panels: np.array(groups[panels]) for panels in sorted(groups)}


def parts_of(group: NDArray[np.intp], mesh: CommonMesh) -> list[NDArray[np.intp]]:
    """Batches of a group."""
    size = max(1, _ENTRIES // (mesh.second.mesh.size * mesh.fine.size))
    return [group[start : start + size] for start in range(0, len(group), size)]


def solved(
    mesh: CommonMesh, nodes: Nodes, n: Array, k: Array, mu: Array, guess: Guess, part: NDArray[np.intp]
) -> tuple[Batch, Stationary, Batch, Stationary]:
    """Some of the problems with the nodes of a first and of the second solution, and their states of extreme load."""
    exponent = 2.0 + (k[part] - 1.0) / n[part]
    again = Batch(mesh, n[part], k[part], 2.0 * mu[part] ** exponent)
    first, offsets = again.on(nodes), nodes.mesh.node_offsets
    w = np.stack([guess.deformation(i, float(n[i]), float(k[i]), offsets) for i in part])
    states = stationary_states(first, w, guess.log_scale[part], _REMAINDER)
    w = nodes.interpolated(states.w, nodes.to_coefficients)
    return first, states, again, stationary_states(again, w, states.t, _REMAINDER)
