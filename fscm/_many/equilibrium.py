r"""States of least load of problems on one common mesh.

The mesh is that of the edge: radii are r = c s, and the gap at s = 1 is that of the largest tension, H_e.  With the
deformations w at the nodes and t = log c as unknowns,

    delta = f(c) + w(1) - H_e,    H = H_e + f(r) - f(c) + w - w(1),
    R = w - M c^(1-k) W p(H) - tail = 0,    P = 2 c^2 sum a p(H) + tail.

The load is least where its Lagrangian P - y.R is stationary: Newton's method on both, whose second derivatives along
the path are closed forms.  Matrices are factorised one by one, everything else is done for all problems at once.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from fscm._many.meshes import CommonMesh
from fscm._many.response import ResponseTable, assembled
from fscm._many.tail import tails_of
from fscm._typing import Array
from fscm.laws import LennardJones

__all__ = ["EDGE_GAP", "LAW", "Batch", "Fields", "Stationary", "stationary_states"]

LAW = LennardJones()
#: H_e.
EDGE_GAP = LAW.peak_gap
#: Newton's method ends when about this is left of the changes of gaps, relative to 1 + |H|.
_REMAINDER = 1e-12
#: It also ends no earlier than the load is this close to its extreme, relative to it.
_MISSED = 1e-10
#: Largest change of the adjoint by a correction with old factors, relative to it: it only weighs errors.
_FREE = 1e-3
#: Corrections of the derivatives along the path with old factors end when that of the load changes by less than this,
#: relative to the load.
_SETTLED, _REFINEMENTS = 1e-7, 6
_ITERATIONS = 30
#: After a step below _CHORD the factors are reused, as long as each step is smaller than the one before by
#: _CONTRACTION.
_CHORD, _CONTRACTION = 0.05, 0.3
#: A gap falls in one step to this share of its distance from the singular gap at the least; log c changes by at most so
#: much.
_SHRINK, _LARGEST_GROWTH = 0.4, 0.3


class Batch:
    """Problems on one mesh, with their matrices.

    Attributes
    ----------
    mesh : CommonMesh
    n, k, M : ndarray, shape (b,)
    polynomials : ndarray, shape (b, terms)
        Of k, see `ResponseTable`.
    response : ndarray, shape (b, m fine, m coarse)
        (1 - k) W, from the pressures at the coarse nodes to the fine ones.
    square : ndarray, shape (b, m coarse, m coarse)
        The same to the coarse nodes.
    rise, rise_fine : ndarray
        s^n - 1 at the coarse and at the fine nodes.
    area : ndarray, shape (m coarse,)
        Weights times radii.
    """

    def __init__(self, mesh: CommonMesh, table: ResponseTable, coefficients: Array, n: Array, k: Array, M: Array):
        self.mesh, self.n, self.k, self.M = mesh, n, k, M
        self.coefficients, self.polynomials = coefficients, table.polynomials(k)
        self.response = assembled(self.polynomials, coefficients, mesh.offsets, k)
        size = mesh.coarse.size
        by_panel = (len(n), mesh.count, mesh.orders.fine, size)
        self.square = np.matmul(mesh.to_coarse, self.response.reshape(by_panel)).reshape(len(n), size, size)
        self.rise, self.rise_fine = (
            np.expm1(n[:, None] * np.log1p(of_order.node_offsets)) for of_order in (mesh.coarse, mesh.fine)
        )
        self.area = mesh.coarse.weights * mesh.coarse.nodes


class Fields:
    """Fields of a batch at deformations w, shape (b, m coarse), and logarithms t of the scale, shape (b,)."""

    def __init__(self, batch: Batch, w: Array, t: Array) -> None:
        mesh, n = batch.mesh, batch.n
        self.w, self.c = w, np.exp(t)
        self.c_n = self.c**n
        self.edge_w = w[:, mesh.edge_nodes] @ mesh.at_end
        self.displacement = self.c_n / n + self.edge_w - EDGE_GAP
        self.gap = EDGE_GAP + (self.c_n / n)[:, None] * batch.rise + (w - self.edge_w[:, None])
        self.tails = tails_of(n, batch.k, batch.M, self.c * mesh.end, self.displacement)
        self.stiffness = batch.M * self.c ** (1.0 - batch.k)
        self.pressure, self.slope = LAW.traction(self.gap), LAW.slope(self.gap)
        self.elastic = self.stiffness[:, None] * np.matmul(batch.square, self.pressure[..., None])[..., 0]
        self.residual = w - self.elastic - self.tails.lift[:, None]
        self.ring = 2.0 * self.c[:, None] ** 2 * batch.area
        self.load = np.einsum("bi,bi->b", self.ring, self.pressure) + self.tails.load

    def by_w(self, batch: Batch, i: int) -> Array:
        """Derivatives of the load of one problem by the deformations."""
        row = self.ring[i] * self.slope[i]
        row[batch.mesh.edge_nodes] += (self.tails.load_slope[i] - row.sum()) * batch.mesh.at_end
        return np.asarray(row)


class Stationary(NamedTuple):
    """States of a batch.

    Attributes
    ----------
    w, t : ndarray
    free : ndarray, shape (b, m coarse)
        Minus the derivative of the gap by the displacement at a fixed scale.
    curvature : ndarray, shape (b,)
        Second derivative of the load along the path.
    missed : ndarray, shape (b,)
        Bound on the distance of the load from its extreme.
    converged : ndarray of bool, shape (b,)
    """

    w: Array
    t: Array
    free: Array
    curvature: Array
    missed: Array
    converged: NDArray[np.bool_]


class _Factor:
    """Factors of the tangent A of one problem, and solutions that corrections start from.

    Attributes
    ----------
    along, free : ndarray
        dw/dt along the path, and as in `Stationary`.
    left : float
        Last change of the derivative of the load by a correction of `along`.
    """

    def __init__(self, batch: Batch, at: Fields, i: int, along: Array, free: Array) -> None:
        mesh, Q, slope = batch.mesh, batch.square[i], at.slope[i]
        self._nodes, self._end = mesh.edge_nodes, mesh.at_end
        A = Q * (-at.stiffness[i] * slope)
        by_edge = -A.sum(axis=1) - at.tails.lift_slope[i]
        A[np.arange(len(slope)), np.arange(len(slope))] += 1.0
        A[:, self._nodes] += by_edge[:, None] * self._end
        # Of the transpose, which is in the order of the packages.
        self._lu, self._pivots, _ = scipy.linalg.lapack.dgetrf(A.T, overwrite_a=1)
        self._held = self._solved(by_edge[:, None])[:, 0]
        self.along, self.free = along, free
        by_w = at.by_w(batch, i)
        self.back = at.stiffness[i] * (scipy.linalg.lapack.dgetrs(self._lu, self._pivots, by_w, trans=0)[0] @ Q)
        self.left, self.curvature = 0.0, np.nan

    def _solved(self, right: Array) -> Array:
        return np.asarray(scipy.linalg.lapack.dgetrs(self._lu, self._pivots, right, trans=1)[0])

    def correct(self, residuals: Array) -> tuple[Array, float]:
        """Correct `along` and `free`.

        Parameters
        ----------
        residuals : ndarray, shape (N, 3)
            Of the equilibrium, of `along` and of `free`.

        Returns
        -------
        step : ndarray
            Of w.
        change : float
            Largest change of `free`, relative to it.
        """
        x, along, free = self._solved(residuals).T
        # Without the anchor, which A contains.
        free = free + self._held * (free[self._nodes] @ self._end) / (1.0 - self._held[self._nodes] @ self._end)
        self.along, self.free = self.along + along, self.free + free
        return np.asarray(x), float(np.max(np.abs(free)) / np.max(np.abs(self.free)))

    def refine(self, batch: Batch, at: Fields, i: int) -> None:
        """Correct `along` until the derivative of the load does not change."""
        by_w, rise, tails = at.by_w(batch, i), at.c_n[i] * batch.rise[i], at.tails
        for _ in range(_REFINEMENTS):
            edge = self.along[self._nodes] @ self._end
            pushed = at.stiffness[i] * (batch.square[i] @ (at.slope[i] * (rise + self.along - edge)))
            lift = tails.lift_rate[i] + tails.lift_slope[i] * (at.c_n[i] + edge)
            along = self._solved(((1.0 - batch.k[i]) * at.elastic[i] + pushed + lift - self.along)[:, None])[:, 0]
            self.along = self.along + along
            self.left = abs(float(by_w @ along))
            if self.left < _SETTLED * abs(at.load[i]):
                break


def _residuals(batch: Batch, at: Fields, along: Array, free: Array) -> Array:
    """Minus the residuals of the equilibrium, of `along` and of `free`, shape (b, N, 3)."""
    mesh, tails = batch.mesh, at.tails
    rise = at.c_n[:, None] * batch.rise
    edge = along[:, mesh.edge_nodes] @ mesh.at_end
    moved = at.slope * (rise + along - edge[:, None])
    pushed = at.stiffness[:, None, None] * np.matmul(batch.square, np.stack([moved, at.slope * free], axis=2))
    lift = tails.lift_rate + tails.lift_slope * (at.c_n + edge)
    of_along = (1.0 - batch.k)[:, None] * at.elastic + pushed[..., 0] + lift[:, None] - along
    return np.stack([-at.residual, of_along, 1.0 + pushed[..., 1] - free], axis=2)


def _growth(batch: Batch, at: Fields, i: int, factor: _Factor, x: Array, new: bool) -> float:
    """Step of log c towards the extreme of the load; a new factor gets the curvature."""
    mesh, n, k = batch.mesh, batch.n[i], batch.k[i]
    p, slope, ring, tails, back = at.pressure[i], at.slope[i], at.ring[i], at.tails, factor.back
    nodes, end, along, rise = mesh.edge_nodes, mesh.at_end, factor.along, at.c_n[i] * batch.rise[i]
    weighed, in_mesh = ring * slope, at.load[i] - tails.load[i]
    rate = at.by_w(batch, i) @ along + 2.0 * in_mesh + weighed @ rise
    rate += tails.load_rate[i] + tails.load_slope[i] * at.c_n[i]
    # Changes of the gap along the path, and by the residual.
    opened, corrected = rise + along - along[nodes] @ end, x - x[nodes] @ end
    bend = LAW.curvature(at.gap[i])
    if new:
        curve = bend * opened * opened + slope * (n * rise)
        curvature = ring @ curve + 4.0 * (weighed @ opened) + 4.0 * in_mesh
        curvature += back @ ((1.0 - k) ** 2 * p + 2.0 * (1.0 - k) * slope * opened + curve)
        factor.curvature = float(curvature)
    mixed = (ring + back) @ (bend * corrected * opened) + (2.0 * weighed + (1.0 - k) * back * slope) @ corrected
    return float(-(rate + mixed) / factor.curvature)


def stationary_states(batch: Batch, w: Array, t: Array) -> Stationary:
    """States with an extreme load, from guesses."""
    b, N = w.shape
    w, t = w.copy(), t.copy()
    factors: list[_Factor | None] = [None] * b
    along, free = np.zeros((b, N)), np.zeros((b, N))
    last, missed = np.full(b, np.inf), np.full(b, np.inf)
    active, converged, reused = np.ones(b, bool), np.zeros(b, bool), np.zeros(b, bool)
    for _ in range(_ITERATIONS):
        with np.errstate(all="ignore"):
            at = Fields(batch, w, t)
            residuals = _residuals(batch, at, along, free)
        active &= np.isfinite(at.residual).all(axis=1) & (at.gap > LAW.singular_gap).all(axis=1)
        for i in np.flatnonzero(active):
            factor = factors[i]
            new = factor is None
            if factor is None:
                factor = factors[i] = _Factor(batch, at, int(i), along[i], free[i])
            x, unsettled = factor.correct(residuals[i])
            if not new:
                factor.refine(batch, at, int(i))
            growth = _growth(batch, at, int(i), factor, x, new)
            along[i], free[i] = factor.along, factor.free
            step = x + growth * factor.along
            change, damping = _size(batch, at, int(i), step, growth)
            if not np.isfinite(change):
                active[i] = False
                continue
            w[i] += damping * step
            t[i] += damping * growth
            rate = abs(growth * factor.curvature) + factor.left
            missed[i] = 0.5 * rate * rate / abs(factor.curvature)
            # The first step with old factors follows one of Newton's method, and says nothing about those after it.
            ahead = change * (change if new else min(1.0, change / last[i]) if reused[i] else _CONTRACTION)
            settled = new or unsettled < _FREE
            if damping == 1.0 and ahead < _REMAINDER and missed[i] < _MISSED * abs(at.load[i]) and settled:
                active[i], converged[i] = False, True
            elif damping < 1.0 or change > _CHORD or (not new and (change > _CONTRACTION * last[i] or not settled)):
                factors[i] = None
            last[i], reused[i] = change, not new
        if not active.any():
            break
    curvature = np.array([np.nan if factor is None else factor.curvature for factor in factors])
    return Stationary(w, t, free, curvature, missed, converged)


def _size(batch: Batch, at: Fields, i: int, step: Array, growth: float) -> tuple[float, float]:
    """Largest change of a gap by a step, relative to 1 + |H|, and the share of the step that is taken."""
    mesh = batch.mesh
    dH = at.c_n[i] * batch.rise[i] * growth + step - step[mesh.edge_nodes] @ mesh.at_end
    falls = float(np.max(-dH / (at.gap[i] - LAW.singular_gap)))
    damping = min(1.0, (1.0 - _SHRINK) / max(falls, 1e-300), _LARGEST_GROWTH / max(abs(growth), 1e-300))
    return float(np.max(np.abs(dH) / (1.0 + np.abs(at.gap[i])))), damping
