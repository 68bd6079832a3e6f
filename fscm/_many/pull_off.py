"""Pull-off forces of many problems in the range of the atlas, by groups that share two meshes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fscm._many.bounds import Loads, bounded_loads
from fscm._many.equilibrium import Batch, Stationary, stationary_states
from fscm._many.guess import Guess, guesses
from fscm._many.meshes import CommonMesh, Panels, panels_for
from fscm._many.response import INTERVALS, Interval, ResponseTable
from fscm._typing import Array
from fscm.interpolation.atlas import atlas

__all__ = ["RELATIVE_BOUND", "by_interval", "groups_of", "parts_of", "pull_off_forces", "solved"]

#: Largest bound of a value of a batch, relative to it.
RELATIVE_BOUND = 1e-8
#: Entries of the matrices of a batch: 16 MB, which a cache holds in part.
_ENTRIES = 2_000_000
#: What Newton's method leaves of the changes of gaps in the first solution, and in the second one.
_REMAINDERS = (1e-9, 1e-11)


def pull_off_forces(n: Array, k: Array, mu: Array) -> Loads:
    """Forces and bounds; nan where none was certified.

    Every problem is solved twice, on two meshes and with different orders.  A value is certified if its bound is below
    `RELATIVE_BOUND`, the load has a minimum there, and the atlas agrees within the sum of both bounds: another minimum
    of the load could be taken for it only if it were as deep within them.
    """
    force, bound = np.full(n.shape, np.nan), np.full(n.shape, np.nan)
    known, known_bound = (np.asarray(part) for part in atlas(n, k, mu, "pull_off_force"))
    guess = guesses(n, k, mu)
    for interval, problems in zip(INTERVALS, by_interval(k), strict=True):
        for part, loads in _bounded(interval, n, k, mu, guess, problems):
            certified = np.abs(loads.load + known[part]) <= known_bound[part] + loads.bound
            certified &= loads.bound <= RELATIVE_BOUND * np.abs(loads.load)
            force[part[certified]] = -loads.load[certified]
            bound[part[certified]] = loads.bound[certified]
    return Loads(force, bound)


def _bounded(
    interval: Interval, n: Array, k: Array, mu: Array, guess: Guess, problems: NDArray[np.intp]
) -> Iterator[tuple[NDArray[np.intp], Loads]]:
    """Least loads of the problems of an interval, in batches; their bounds are infinite where there is no minimum."""
    groups = groups_of(n, k, guess, problems)
    table = ResponseTable(interval, [p.offsets for panels in groups for p in (panels, panels.finer)])
    for panels, group in groups.items():
        mesh, finer = CommonMesh(panels, interval.first, table), CommonMesh(panels.finer, interval.second, table)
        for part in parts_of(group, finer):
            yield part, _solved_twice(mesh, finer, n, k, mu, guess, part)
        # The coefficients of the next meshes take the memory of these.
        del mesh, finer


def _solved_twice(
    mesh: CommonMesh, finer: CommonMesh, n: Array, k: Array, mu: Array, guess: Guess, part: NDArray[np.intp]
) -> Loads:
    batch, states = solved(mesh, n, k, mu, guess, part)
    again = Batch(finer, batch.n, batch.k, batch.M)
    guess_again = mesh.transferred(states.w, batch.k, finer)
    states_again = stationary_states(again, guess_again, states.t, _REMAINDERS[1])
    with np.errstate(all="ignore"):
        loads = bounded_loads(batch, states, again, states_again)
    least = states.converged & states_again.converged & (states_again.curvature > 0.0)
    return Loads(loads.load, np.where(least, loads.bound, np.inf))


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
    size = max(1, _ENTRIES // (mesh.coarse.size * mesh.fine.size))
    return [group[start : start + size] for start in range(0, len(group), size)]


def solved(
    mesh: CommonMesh, n: Array, k: Array, mu: Array, guess: Guess, part: NDArray[np.intp]
) -> tuple[Batch, Stationary]:
    """Some of the problems on a mesh, and their states of extreme load."""
    exponent = 2.0 + (k[part] - 1.0) / n[part]
    batch = Batch(mesh, n[part], k[part], 2.0 * mu[part] ** exponent)
    offsets = mesh.coarse.node_offsets
    w = np.stack([guess.deformation(i, float(n[i]), float(k[i]), offsets) for i in part])
    return batch, stationary_states(batch, w, guess.log_scale[part], _REMAINDERS[0])
