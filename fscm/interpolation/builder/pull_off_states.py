"""Series of the states of least load, from which batches of problems start (see `fscm.many`).

The nodes are states of the model that a batch found from the present series.  For the first ones, states of
`fscm.Analysis` were described in the same way.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from fscm._many.equilibrium import Batch, Fields, Stationary
from fscm._many.guess import DATA, basis, guesses, outer_end, point_offsets, terms
from fscm._many.meshes import CommonMesh
from fscm._many.pull_off import by_interval, groups_of, parts_of, solved
from fscm._many.response import INTERVALS, ResponseTable
from fscm._typing import Array
from fscm.interpolation.builder.design import rounded, sobol
from fscm.interpolation.coordinates import BOX

__all__ = ["fit_states", "state_nodes"]

_SEED = 20261128
#: Coefficients of higher degrees are smaller by this rate; what is added to the squares, relative to a node.
_RATE, _RIDGE = 0.6, 1e-6


def state_nodes(count: int) -> tuple[Array, Array, Array]:
    """Nodes n, k and mu with the density of Chebyshev nodes in 1/n, k and ln mu."""
    unit = 0.5 * (1.0 - np.cos(np.pi * sobol(3, count, _SEED)))
    (least_n, most_n), (_, most_k), (least_mu, most_mu) = BOX["n"], BOX["k"], BOX["mu"]
    n = rounded("n", 1.0 / (1.0 / most_n + (1.0 / least_n - 1.0 / most_n) * unit[:, 0]))
    mu = rounded("mu", least_mu * (most_mu / least_mu) ** unit[:, 2])
    return n, rounded("k", most_k * unit[:, 1]), mu


def _described(batch: Batch, at: Fields, i: int, mu: float) -> Array:
    """Numbers that describe a state (`fscm._many.guess.described`)."""
    mesh, n, k, c = batch.nodes.mesh, float(batch.n[i]), float(batch.k[i]), float(at.c[i])

    def gap(offsets: Array) -> Array:
        w = mesh.evaluate_at_offsets(at.w[i], offsets)
        return np.asarray(c**n / n * np.exp(n * np.log1p(offsets)) - at.displacement[i] + w)

    log_width = brentq(lambda x: gap(np.array([np.exp(x)]))[0] - 1.0, np.log(mesh.lengths.min() / 8.0), 2.0)
    inside, outside = point_offsets(n, c, float(np.exp(log_width)))
    numbers = [np.log(c), at.displacement[i] / (1.0 + mu), (1.0 - k) * log_width]
    outside = np.minimum(outside, outer_end(n, c))
    return np.concatenate([numbers, np.log1p(gap(inside)), np.log1p(gap(outside))])


def _rows(batch: Batch, states: Stationary, mu: Array) -> list[tuple[int, Array]]:
    at = Fields(batch, states.w, states.t)
    least = np.flatnonzero(states.converged & (states.curvature > 0.0))
    return [(int(i), _described(batch, at, int(i), float(mu[i]))) for i in least]


def fit_states(count: int, degree: int, path: Path = DATA) -> dict[str, float]:
    """Compute nodes, fit the series to them and write them.

    Returns
    -------
    dict
        Numbers of nodes and terms, and the largest deviations of ln c and of ln(1 + H) at the nodes.
    """
    n, k, mu = state_nodes(count)
    guess, nodes, numbers = guesses(n, k, mu), [], []
    for interval, problems in zip(INTERVALS, by_interval(k), strict=True):
        groups = groups_of(n, k, guess, problems)
        table = ResponseTable(interval, [panels.offsets for panels in groups])
        for panels, group in groups.items():
            mesh = CommonMesh(panels, table)
            for part in parts_of(group, mesh):
                _, _, batch, states = solved(mesh, mesh.first[0], n, k, mu, guess, part)
                for i, row in _rows(batch, states, mu[part]):
                    nodes.append(int(part[i]))
                    numbers.append(row)
    values, degrees = np.array(numbers), terms(degree)
    rows = basis(n[nodes], k[nodes], mu[nodes], degrees)
    weights = np.exp(-_RATE * (degrees @ np.array([1.0, 1.0, 0.75])))
    normal = (rows * weights).T @ (rows * weights) + _RIDGE**2 * np.eye(len(degrees))
    coefficients = weights[:, None] * np.linalg.solve(normal, (rows * weights).T @ values)
    deviation = np.abs(rows @ coefficients - values)
    np.savez_compressed(path, degrees=degrees.astype(np.uint8), coefficients=coefficients.astype(np.float32))
    largest = {"ln_scale": float(deviation[:, 0].max()), "ln_gap": float(deviation[:, 3:].max())}
    return {"nodes": float(len(nodes)), "terms": float(len(degrees)), **largest}
