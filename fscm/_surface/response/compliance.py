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
from fscm._surface.response.depths import depth_intervals
from fscm._typing import Array
from fscm.solids import GradedHalfSpace

__all__ = ["START", "compliance"]

#: Depth of the initial state, in 1/xi: the solid below changes C by exp(-2 START) = 1e-20.
START = 24.0
#: Longest step, and stages of the collocation: the error of a step is below 1e-15 (order 12).
_STEP, _STAGES = 0.75, 6


@lru_cache(maxsize=4)
def _collocation(stages: int) -> tuple[Array, Array, Array]:
    """Nodes, weights and matrix of the Gauss collocation on [0, 1]."""
    rule = gauss_rule(stages)
    c = rule.nodes
    powers = np.arange(stages)
    # For so few stages a Vandermonde matrix is accurate enough: condition 1e4.
    integrals = c[:, None] ** (powers + 1) / (powers + 1)
    return c, rule.weights, integrals @ np.linalg.inv(c[:, None] ** powers)


def _stages(
    E: Array, nu: Array, h: Array, displacement: Array, stress: Array
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Both states at the end of a step, from those at its start and the constants at its stages.

    The rates of (U, S) follow from (W, T), and those of (W, T) from (U, S): one of the two is eliminated.

    Parameters
    ----------
    E, nu : ndarray, shape (n, stages)
    h : ndarray, shape (n,)
        Lengths of the steps, negative upwards.
    displacement, stress : ndarray, shape (n, 2, 2)
        (U, W) and (T, S) of two solutions.
    """
    _, b, a = _collocation(_STAGES)
    s, h = _STAGES, h[:, None]
    shear, coupling, stiff = 2.0 * (1.0 + nu) / E, nu / (1.0 - nu), E / (1.0 - nu**2)
    normal = (1.0 + nu) * (1.0 - 2.0 * nu) / (E * (1.0 - nu))
    U, W, T, S = displacement[:, 0], displacement[:, 1], stress[:, 0], stress[:, 1]
    # W and T at the stages by constant U and S, and by each rate of U and S.
    fixed = h[..., None] * a
    on_W = fixed @ (normal[..., None] * S[:, None] - coupling[..., None] * U[:, None])
    on_T = fixed @ (stiff[..., None] * U[:, None] + coupling[..., None] * S[:, None])
    twice = [fixed @ (x[..., None] * fixed) for x in (coupling, normal, stiff)]
    matrix = np.empty((len(E), 2 * s, 2 * s))
    matrix[:, :s, :s] = twice[0] - shear[..., None] * twice[2]
    matrix[:, :s, s:] = -twice[1] - shear[..., None] * twice[0]
    matrix[:, s:, :s] = twice[2]
    matrix[:, s:, s:] = twice[0]
    matrix[:, np.arange(2 * s), np.arange(2 * s)] += 1.0
    on_W += W[:, None]
    on_T += T[:, None]
    rates = np.linalg.solve(matrix, np.concatenate([on_W + shear[..., None] * on_T, -on_T], axis=1))
    dU, dS = rates[:, :s], rates[:, s:]
    U_stage, S_stage = U[:, None] + fixed @ dU, S[:, None] + fixed @ dS
    dW = normal[..., None] * S_stage - coupling[..., None] * U_stage
    dT = stiff[..., None] * U_stage + coupling[..., None] * S_stage
    U, W, T, S = (x + h * (b @ rate) for x, rate in ((U, dU), (W, dW), (T, dT), (S, dS)))
    return (U, W), (T, S)


def _homogeneous(E: Array, nu: Array) -> Array:
    """Q of a homogeneous solid, shape (..., 2, 2)."""
    Q = np.empty((*E.shape, 2, 2))
    Q[..., 0, 0] = Q[..., 1, 1] = -2.0 * (1.0 - nu**2) / E
    Q[..., 0, 1] = Q[..., 1, 0] = (1.0 + nu) * (1.0 - 2.0 * nu) / E
    return Q


def _steps(solid: GradedHalfSpace, xi: Array, longest: float) -> Array:
    """Ends of the steps of each xi from the depth upwards, shape (most steps + 1, len(xi)), padded with zeros."""
    depths = depth_intervals(solid, START / float(np.min(xi)))
    columns = []
    for x in xi:
        inside = x * depths[x * depths < START]
        ends = np.append(inside, START)
        counts = np.maximum(1, np.ceil(np.diff(ends) / longest).astype(int))
        parts = [a + (b - a) * np.arange(n) / n for a, b, n in zip(ends[:-1], ends[1:], counts.tolist(), strict=True)]
        columns.append(np.append(np.concatenate(parts), START)[::-1])
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
    z = steps[0] / xi
    Q = _homogeneous(solid.modulus(z), solid.poisson(z))
    for start, stop in pairwise(steps):
        active = np.flatnonzero(start > stop)
        for substep in range(refinement):
            h = (stop - start)[active] / refinement
            x = start[active] + substep * h
            z = ((x[:, None] + h[:, None] * c) / xi[active, None]).ravel()
            E, nu = (values.reshape(len(active), _STAGES) for values in (solid.modulus(z), solid.poisson(z)))
            identity = np.broadcast_to(np.eye(2), (len(active), 2, 2))
            (U, W), (T, S) = _stages(E, nu, h, Q[active], identity)
            # (U, W) by the inverse of (T, S)
            det = (T[:, 0] * S[:, 1] - T[:, 1] * S[:, 0])[:, None]
            for row, Y in enumerate((U, W)):
                Q[active, row, 0] = ((Y[:, :1] * S[:, 1:] - Y[:, 1:] * S[:, :1]) / det)[:, 0]
                Q[active, row, 1] = ((Y[:, 1:] * T[:, :1] - Y[:, :1] * T[:, 1:]) / det)[:, 0]
    return -Q[:, 1, 1]
