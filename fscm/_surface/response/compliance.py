r"""Surface compliance C(xi) of a solid whose elastic constants depend on the depth.

A pressure J0(xi r) displaces the surface by C(xi) J0(xi r).  With the displacements U J1(xi r), W J0(xi r) and the
stresses xi T J1(xi r), xi S J0(xi r) on the plane z, all of them functions of x = xi z,

    U' = W + T/G,      W' = -a U + S/L,      T' = a S + E* U,      S' = -T,

a = nu/(1-nu), E* = E/(1-nu^2), 1/L = (1+nu)(1-2nu)/(E(1-nu)), 1/G = 2(1+nu)/E: finite also at nu = 1/2.  The solution
that decays downwards has (U, W) = Q (T, S), a Riccati equation for the 2x2 matrix Q, and xi C = -Q_22 at x = 0.

Each step integrates the linear equations from (U, W, T, S) = (Q, 1) by Gauss collocation, for all xi at once, and
recomputes Q.  Upwards the decaying solution grows, so that errors are damped.  Steps end where the constants change.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np

from fscm._surface.mesh import gauss_rule
from fscm._surface.response.depths import changes_below, depth_intervals, interval_ranges
from fscm._typing import Array
from fscm.solids import GradedHalfSpace

__all__ = ["START", "compliance"]

#: Depth, in 1/xi, from which on the solid changes C by exp(-2 START) = 1e-20.
START = 24.0
#: Longest step, and stages of the collocation: the error of a step is below 1e-15 (order 12).
_STEP, _STAGES = 0.75, 6


@lru_cache(maxsize=4)
def _collocation(stages: int) -> tuple[Array, Array, Array, Array]:
    """Nodes, weights and matrix a of the Gauss collocation on [0, 1], and the products a_ij a_jl, shape (i l, j)."""
    rule = gauss_rule(stages)
    c = rule.nodes
    powers = np.arange(stages)
    # For so few stages a Vandermonde matrix is accurate enough: condition 1e4.
    integrals = c[:, None] ** (powers + 1) / (powers + 1)
    a = integrals @ np.linalg.inv(c[:, None] ** powers)
    return c, rule.weights, a, (a[:, None, :] * a.T).reshape(-1, stages)


def _stages(E: Array, nu: Array, h: Array, displacement: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Displacement and stress at the end of a step, from unit stresses at its start and the constants at its stages.

    The rates of (U, S) follow from (W, T), and those of (W, T) from (U, S): one of the two is eliminated.

    Parameters
    ----------
    E, nu : ndarray, shape (stages, n)
    h : ndarray, shape (n,)
        Lengths of the steps, negative upwards.
    displacement : ndarray, shape (2, 2, n)
        U and W by T, and by S.

    Returns
    -------
    (U, W), (T, S) : ndarray, shape (2, n) each
        Of the two solutions.
    """
    _, b, a, products = _collocation(_STAGES)
    s, (U, W), (T, S) = _STAGES, displacement, np.eye(2)[..., None]
    shear, coupling, stiff = 2.0 * (1.0 + nu) / E, nu / (1.0 - nu), E / (1.0 - nu**2)
    normal = (1.0 + nu) * (1.0 - 2.0 * nu) / (E * (1.0 - nu))

    def integrated(rates: Array) -> Array:
        return h * (a @ rates.reshape(s, -1)).reshape(rates.shape)

    # W and T at the stages by constant U and S, and by each rate of U and S.
    on_W = W + integrated(normal[:, None] * S - coupling[:, None] * U)
    on_T = T + integrated(stiff[:, None] * U + coupling[:, None] * S)
    twice = [h * h * (products @ x).reshape(s, s, -1) for x in (coupling, normal, stiff)]
    matrix = np.empty((2 * s, 2 * s, len(h)))
    matrix[:s, :s] = twice[0] - shear[:, None] * twice[2]
    matrix[:s, s:] = -twice[1] - shear[:, None] * twice[0]
    matrix[s:, :s] = twice[2]
    matrix[s:, s:] = twice[0]
    matrix[np.arange(2 * s), np.arange(2 * s)] += 1.0
    right = np.concatenate([on_W + shear[:, None] * on_T, -on_T])
    rates = np.linalg.solve(np.moveaxis(matrix, 2, 0), np.moveaxis(right, 2, 0))
    dU, dS = np.moveaxis(rates, 0, 2).reshape(2, s, 2, -1)
    U_stage, S_stage = U + integrated(dU), S + integrated(dS)
    dW = normal[:, None] * S_stage - coupling[:, None] * U_stage
    dT = stiff[:, None] * U_stage + coupling[:, None] * S_stage
    U, W, T, S = (x + h * np.tensordot(b, rate, 1) for x, rate in ((U, dU), (W, dW), (T, dT), (S, dS)))
    return (U, W), (T, S)


def _homogeneous(E: Array, nu: Array) -> Array:
    """Q of homogeneous solids, shape (2, 2, n)."""
    own, other = -2.0 * (1.0 - nu**2) / E, (1.0 + nu) * (1.0 - 2.0 * nu) / E
    return np.stack([own, other, other, own]).reshape(2, 2, -1)


def _starts(solid: GradedHalfSpace, xi: Array, depths: Array) -> Array:
    """Least depths, in 1/xi, from which on the changes of the solid down to START change C by exp(-2 START) or less.

    A change by a small share at a depth x changes C by that share of exp(-2 x).
    """
    ranges, deepest, starts = interval_ranges(solid, depths), START / xi, np.empty_like(xi)
    last = np.clip(np.searchsorted(depths, deepest), 1, len(depths) - 1)
    for count in np.unique(last).tolist():
        alike = last == count
        shares = changes_below(ranges[..., :count], depths[: count + 1], deepest[alike])
        below = START + 0.5 * np.log(np.minimum(shares, 1.0))
        starts[alike] = np.min(np.maximum(xi[alike, None] * depths[:count], below), axis=1)
    return starts


def _steps(solid: GradedHalfSpace, xi: Array, longest: float) -> Array:
    """Ends of the steps of each xi from the depth upwards, shape (most steps + 1, len(xi)), padded with zeros."""
    depths = depth_intervals(solid, START / float(np.min(xi)))
    columns = []
    for x, start in zip(xi.tolist(), _starts(solid, xi, depths).tolist(), strict=True):
        inside = x * depths[x * depths < start]
        ends = np.append(inside, start)
        counts = np.maximum(1, np.ceil(np.diff(ends) / longest).astype(int))
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        columns.append(
            np.append(np.repeat(ends[:-1], counts) + within * np.repeat(np.diff(ends) / counts, counts), start)[::-1]
        )
    steps = np.zeros((max(len(column) for column in columns), len(xi)))
    for i, column in enumerate(columns):
        steps[: len(column), i] = column
    return steps


def compliance(solid: GradedHalfSpace, xi: Array, refinement: int = 1) -> Array:
    """xi C(xi), an inverse modulus; 2 (1 - nu^2)/E for a homogeneous solid.

    Parameters
    ----------
    solid : GradedHalfSpace
    xi : ndarray, shape (n,)
        Wave numbers, > 0, of the inverse unit of the depths.
    refinement : int
        Number by which every step is divided: the change is the error of the undivided steps.

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    NotConverged
        When the constants jump at a depth that is no interface of the solid.

    Examples
    --------
    >>> from fscm import Exponential
    >>> solid = Exponential(E_surface=1.0, E_depth=2.0, length=1.0, nu=0.0)
    >>> compliance(solid, np.array([1e-6, 1e6])).round(5)
    array([1., 2.])
    """
    c = _collocation(_STAGES)[0]
    steps = _steps(solid, xi, _STEP)
    z = START / xi
    Q = _homogeneous(solid.modulus(z), solid.poisson(z))
    for start, stop in pairwise(steps):
        active = np.flatnonzero(start > stop)
        for substep in range(refinement):
            h = (stop - start)[active] / refinement
            x = start[active] + substep * h
            z = ((x + h * c[:, None]) / xi[active]).ravel()
            E, nu = (values.reshape(_STAGES, -1) for values in (solid.modulus(z), solid.poisson(z)))
            displacement, (T, S) = _stages(E, nu, h, Q[..., active])
            # (U, W) by the inverse of (T, S)
            det = T[0] * S[1] - T[1] * S[0]
            for row, Y in zip(Q, displacement, strict=True):
                row[0, active] = (Y[0] * S[1] - Y[1] * S[0]) / det
                row[1, active] = (Y[1] * T[0] - Y[0] * T[1]) / det
    return -Q[1, 1]
