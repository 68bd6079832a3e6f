"""Pull-off forces of many problems in the range of the atlas, by groups that share a mesh."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fscm._many.bounds import Loads, bounded_loads
from fscm._many.equilibrium import Batch, Stationary, stationary_states
from fscm._many.guess import Guess, guesses
from fscm._many.meshes import CommonMesh, Panels, panels_for
from fscm._many.response import FIRST, INTERVALS, SECOND, ResponseTable
from fscm._typing import Array
from fscm.interpolation.atlas import atlas

__all__ = ["RELATIVE_BOUND", "pull_off_forces", "solved"]

#: Largest bound of a value of a batch, relative to it.
RELATIVE_BOUND = 1e-8
#: Entries of the matrices of a batch: 16 MB, which a cache holds in part.
_ENTRIES = 2_000_000


def pull_off_forces(n: Array, k: Array, mu: Array) -> Loads:
    """Forces and bounds; nan where none was certified.

    Every problem is solved twice, on two meshes and with different orders.  A value is certified if its bound is below
    `RELATIVE_BOUND`, the load has a minimum there, and the atlas agrees within the sum of both bounds: another minimum
    of the load could be taken for it only if it were as deep within them.
    """
    force, bound = np.full(n.shape, np.nan), np.full(n.shape, np.nan)
    known, known_bound = (np.asarray(part) for part in atlas(n, k, mu, "pull_off_force"))
    guess = guesses(n, k, mu)
    for low, high in INTERVALS:
        table, finer = ResponseTable(low, high, FIRST), ResponseTable(low, high, SECOND)
        of_interval = (k >= low) & ((k < high) | (high == INTERVALS[-1][1]))
        for part, batch, states in solved(table, n, k, mu, guess, np.flatnonzero(of_interval)):
            again, states_again = _second(batch, states, finer)
            with np.errstate(all="ignore"):
                loads = bounded_loads(batch, states, again, states_again)
            certified = states.converged & states_again.converged & (states_again.curvature > 0.0)
            certified &= np.abs(loads.load + known[part]) <= known_bound[part] + loads.bound
            certified &= loads.bound <= RELATIVE_BOUND * np.abs(loads.load)
            force[part[certified]] = -loads.load[certified]
            bound[part[certified]] = loads.bound[certified]
    return Loads(force, bound)


def _second(batch: Batch, states: Stationary, finer: ResponseTable) -> tuple[Batch, Stationary]:
    """The problems of a batch on the mesh of the second solution, and their states there."""
    mesh = CommonMesh(batch.mesh.panels.finer, finer.orders)
    again = Batch(mesh, finer, finer.coefficients(mesh.offsets), batch.n, batch.k, batch.M)
    return again, stationary_states(again, batch.mesh.transferred(states.w, batch.k, mesh), states.t)


def _groups(n: Array, k: Array, guess: Guess, problems: NDArray[np.intp]) -> list[tuple[Panels, NDArray[np.intp]]]:
    """Problems by the mesh that they share."""
    wanted = panels_for(n[problems], k[problems], guess.log_scale[problems], guess.width[problems])
    groups: dict[Panels, list[int]] = defaultdict(list)
    for problem, panels in zip(problems.tolist(), wanted, strict=True):
        groups[panels].append(problem)
    return [(panels, np.array(groups[panels])) for panels in sorted(groups)]


def solved(
    table: ResponseTable, n: Array, k: Array, mu: Array, guess: Guess, problems: NDArray[np.intp]
) -> Iterator[tuple[NDArray[np.intp], Batch, Stationary]]:
    """Some of the problems, in batches on one mesh each, with their states of extreme load."""
    for panels, group in _groups(n, k, guess, problems):
        mesh = CommonMesh(panels, table.orders)
        coefficients, offsets = table.coefficients(mesh.offsets), mesh.coarse.node_offsets
        size = max(1, _ENTRIES // (mesh.coarse.size * mesh.fine.size))
        for start in range(0, len(group), size):
            part = group[start : start + size]
            exponent = 2.0 + (k[part] - 1.0) / n[part]
            batch = Batch(mesh, table, coefficients, n[part], k[part], 2.0 * mu[part] ** exponent)
            w = np.stack([guess.deformation(i, float(n[i]), float(k[i]), offsets) for i in part])
            yield part, batch, stationary_states(batch, w, guess.log_scale[part])
