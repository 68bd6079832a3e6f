r"""States of least load of problems on one common mesh.

The mesh is that of the edge: radii are r = c s, and the gap at s = 1 is that of the largest tension, H_e.  With the
deformations w at the nodes and t = log c as unknowns,

    delta = f(c) + w(1) - H_e,    H = H_e + f(r) - f(c) + w - w(1),
    R = w - M c^(1-k) W p(H) - tail = 0,    P = 2 c^2 sum a p(H) + tail.

The load is least where its Lagrangian P - y.R is stationary: Newton's method on both, whose second derivatives along
the path are closed forms.  Matrices are factorised one by one, almost everything else is done for all problems at once.
"""

from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from fscm._many.meshes import CommonMesh, Nodes
from fscm._many.response import assembled, scales
from fscm._many.tail import tails_of
from fscm._surface.mesh import PanelMesh
from fscm._typing import Array
from fscm.laws import LennardJones

__all__ = ["EDGE_GAP", "LAW", "Batch", "Fields", "Stationary", "stationary_states"]

LAW = LennardJones()
#: H_e.
EDGE_GAP = LAW.peak_gap
#: Newton's method ends no earlier than the load is this close to its extreme, relative to it.
_MISSED = 1e-10
#: Corrections of the derivatives along the path with old factors end when that of the load changes by less than the
#: first number, relative to the load, and those of the deformations by less than the second one, relative to the
#: largest: they only weigh errors.
_SETTLED, _WEIGHING, _REFINEMENTS = 1e-6, 1e-3, 6
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
    nodes : Nodes
        Of the pressure.
    n, k, M : ndarray, shape (b,)
    scale : ndarray, shape (b, panels, panels)
        Of the blocks of the response.
    response : ndarray, shape (b, m fine, m coarse)
        (1 - k) W, from the pressures at the nodes of the second solution to the fine nodes.
    square : ndarray, shape (b, N, N)
        The same from the nodes to them.
    rise, rise_fine : ndarray
        s^n - 1 at the nodes and at the fine ones.
    area : ndarray, shape (N,)
        Weights times radii.
    """

    def __init__(self, mesh: CommonMesh, n: Array, k: Array, M: Array) -> None:
        self.mesh, self.n, self.k, self.M = mesh, n, k, M
        self.scale = scales(mesh.offsets, k)
        self.response = assembled(mesh.table.polynomials(k), mesh.coefficients, self.scale)
        self.rise_fine = self._rise(mesh.fine)
        self._on(mesh.second)

    def on(self, nodes: Nodes) -> Batch:
        """The same problems with the nodes of a first solution."""
        batch = copy(self)
        batch._on(nodes)
        return batch

    def _on(self, nodes: Nodes) -> None:
        self.nodes, size = nodes, nodes.mesh.size
        by_panel = (len(self.n), self.mesh.count, self.mesh.fine.order, -1)
        self.square = np.matmul(nodes.to_coarse, self.response.reshape(by_panel)).reshape(len(self.n), size, -1)
        if nodes is not self.mesh.second:
            lowered = self.square.reshape(len(self.n), -1, self.mesh.second.mesh.order) @ nodes.to_coefficients
            self.square = lowered.reshape(len(self.n), size, size)
        self.rise, self.area = self._rise(nodes.mesh), nodes.mesh.weights * nodes.mesh.nodes

    def _rise(self, mesh: PanelMesh) -> Array:
        return np.asarray(np.expm1(self.n[:, None] * np.log1p(mesh.node_offsets)))

    def adjoint_excess(self, at: Fields, along: Array) -> Array:
        """z / (2 c^2) - 1 at the nodes (see `fscm._many.bounds`), from the derivative of w along the path."""
        shifted = self.nodes.mesh.nodes * self.nodes.slopes(at.w) - along
        return np.asarray(shifted / (at.c_n[:, None] + self.at_edge(along)))

    def at_edge(self, values: Array) -> Array:
        """Values of functions on the nodes, shape (b, N), at the edge; shape (b, 1)."""
        return np.asarray((values[:, self.nodes.edge] @ self.nodes.at_end)[:, None])


class Fields:
    """Fields of a batch at deformations w, shape (b, N), and logarithms t of the scale, shape (b,)."""

    def __init__(self, batch: Batch, w: Array, t: Array) -> None:
        mesh, n = batch.mesh, batch.n
        self.w, self.c = w, np.exp(t)
        self.c_n = self.c**n
        self.edge_w = batch.at_edge(w)
        self.displacement = self.c_n / n + self.edge_w[:, 0] - EDGE_GAP
        self.gap = EDGE_GAP + (self.c_n / n)[:, None] * batch.rise + (w - self.edge_w)
        self.tails = tails_of(n, batch.k, batch.M, self.c * mesh.end, self.displacement)
        self.stiffness = batch.M * self.c ** (1.0 - batch.k)
        self.pressure, self.slope = LAW.traction(self.gap), LAW.slope(self.gap)
        self.ring = 2.0 * self.c[:, None] ** 2 * batch.area
        self.load_in_mesh = _dot(self.ring, self.pressure)
        self.load = self.load_in_mesh + self.tails.load


class Stationary(NamedTuple):
    """States of a batch.

    Attributes
    ----------
    w, t : ndarray
    along : ndarray, shape (b, N)
        dw/dt along the path.
    curvature : ndarray, shape (b,)
        Second derivative of the load along the path.
    missed : ndarray, shape (b,)
        Bound on the distance of the load from its extreme.
    converged : ndarray of bool, shape (b,)
    """

    w: Array
    t: Array
    along: Array
    curvature: Array
    missed: Array
    converged: NDArray[np.bool_]


def _dot(first: Array, second: Array) -> Array:
    """Products of the rows, shape (b,)."""
    return np.asarray(np.einsum("bi,bi->b", first, second))


class _Newton:
    """Newton's method for all problems of a batch.

    Attributes
    ----------
    along : ndarray, shape (b, N)
        As in `Stationary`.
    """

    def __init__(self, batch: Batch, w: Array, t: Array) -> None:
        self.batch, self.w, self.t = batch, w.copy(), t.copy()
        b = len(t)
        self.along = np.zeros(w.shape)
        self.curvature, self.missed, self._last = np.full(b, np.nan), np.full(b, np.inf), np.full(b, np.inf)
        self._factors: dict[int, tuple[Array, NDArray[np.int32]]] = {}
        self.active, self.converged = np.ones(b, bool), np.zeros(b, bool)

    def step(self, remainder: float) -> None:
        """Take one step with all active problems."""
        batch = self.batch
        at = Fields(batch, self.w, self.t)
        residuals = self._residuals(at)
        self.active &= np.isfinite(residuals).all(axis=(1, 2)) & (at.gap > LAW.singular_gap).all(axis=1)
        weighed = at.ring * at.slope
        by_w = weighed.copy()
        by_w[:, batch.nodes.edge] += (at.tails.load_slope - weighed.sum(axis=1))[:, None] * batch.nodes.at_end
        x, along, new = self._solved(at, residuals)
        self.along += along
        left = np.zeros(len(new))
        for i in np.flatnonzero(self.active & ~new).tolist():
            left[i] = self._refine(at, i, by_w[i])
        opened = at.c_n[:, None] * batch.rise + self.along - batch.at_edge(self.along)
        rate, self.curvature = self._derivatives(at, weighed, by_w, opened, x - batch.at_edge(x))
        self.missed = np.where(self.active, 0.5 * (np.abs(rate) + left) ** 2 / np.abs(self.curvature), self.missed)
        growth = -rate / self.curvature
        change, whole = self._move(at, x + growth[:, None] * self.along, growth)
        # With new factors the derivatives along the path are those of the state before the step.
        shrunk = np.where(new, 1.0, change / self._last)
        done = self.active & whole & (change * np.minimum(shrunk, 1.0) < remainder)
        done &= self.missed < _MISSED * np.abs(at.load)
        self.converged |= done
        self.active &= ~done
        slow = (change > _CONTRACTION * self._last) & (change > remainder)
        for i in np.flatnonzero(~self.active | ~whole | (change > _CHORD) | (slow & ~new)).tolist():
            self._factors.pop(i, None)
        self._last = change

    def _residuals(self, at: Fields) -> Array:
        """Minus the residuals of the equilibrium and of `along`, shape (b, N, 2)."""
        batch, tails = self.batch, at.tails
        edge = batch.at_edge(self.along)
        opened = at.c_n[:, None] * batch.rise + self.along - edge
        densities = np.stack([at.pressure, at.slope * opened], axis=2)
        pushed = at.stiffness[:, None, None] * np.matmul(batch.square, densities)
        lift = tails.lift_rate + tails.lift_slope * (at.c_n + edge[:, 0])
        of_along = (1.0 - batch.k)[:, None] * pushed[..., 0] + pushed[..., 1] + lift[:, None] - self.along
        of_w = pushed[..., 0] + tails.lift[:, None] - self.w
        return np.stack([of_w, of_along], axis=2)

    def _refine(self, at: Fields, i: int, by_w: Array) -> float:
        """Correct `along` with old factors until it has settled; the last change of the derivative of the load."""
        batch, tails, left = self.batch, at.tails, np.inf
        nodes, end, Q, rise = batch.nodes.edge, batch.nodes.at_end, batch.square[i], at.c_n[i] * batch.rise[i]
        fixed = (1.0 - batch.k[i]) * at.stiffness[i] * (Q @ at.pressure[i])
        for _ in range(_REFINEMENTS):
            edge = self.along[i, nodes] @ end
            pushed = at.stiffness[i] * (Q @ (at.slope[i] * (rise + self.along[i] - edge)))
            lift = tails.lift_rate[i] + tails.lift_slope[i] * (at.c_n[i] + edge)
            change = self._back_substituted(i, fixed + pushed + lift - self.along[i])
            self.along[i] += change
            left = abs(float(by_w @ change))
            unsettled = np.abs(change).max() > _WEIGHING * np.abs(self.along[i]).max()
            if left < _SETTLED * abs(at.load[i]) and not unsettled:
                break
        return left

    def _back_substituted(self, i: int, right: Array) -> Array:
        return np.asarray(scipy.linalg.lapack.dgetrs(*self._factors[i], right, trans=1)[0])

    def _solved(self, at: Fields, residuals: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Corrections of w and `along`, shape (b, N) each, and which problems have new factors."""
        corrections, new = np.zeros(residuals.shape), np.zeros(len(residuals), bool)
        for i in np.flatnonzero(self.active).tolist():
            if i not in self._factors:
                new[i] = True
                self._factors[i] = self._factorised(at, i)
            corrections[i] = self._back_substituted(i, residuals[i])
        x, along = np.ascontiguousarray(corrections.transpose(2, 0, 1))
        return x, along, new

    def _factorised(self, at: Fields, i: int) -> tuple[Array, NDArray[np.int32]]:
        """Factors of the transpose of the tangent, which is in the order of the packages."""
        nodes, Q = self.batch.nodes, self.batch.square[i]
        weights = at.stiffness[i] * at.slope[i]
        A = Q * -weights
        A.flat[:: len(A) + 1] += 1.0
        by_edge = Q @ weights - at.tails.lift_slope[i]
        A[:, nodes.edge] += by_edge[:, None] * nodes.at_end
        lu, pivots, _ = scipy.linalg.lapack.dgetrf(A.T, overwrite_a=1)
        return lu, pivots

    def _derivatives(
        self, at: Fields, weighed: Array, by_w: Array, opened: Array, corrected: Array
    ) -> tuple[Array, Array]:
        """First derivative of the load along the path, at the corrected state, and the second one.

        `opened` and `corrected` are the changes of the gap along the path and by the residual.
        """
        batch, tails, in_mesh = self.batch, at.tails, at.load_in_mesh
        n, k = batch.n[:, None], batch.k[:, None]
        rise, bend = at.c_n[:, None] * batch.rise, LAW.curvature(at.gap)
        # The adjoint of the load times the response.
        back = at.ring * batch.adjoint_excess(at, self.along)
        curve = bend * opened * opened + at.slope * (n * rise)
        of_back = (1.0 - k) ** 2 * at.pressure + 2.0 * (1.0 - k) * at.slope * opened + curve
        curvature = _dot(at.ring, curve) + 4.0 * (_dot(weighed, opened) + in_mesh) + _dot(back, of_back)
        rate = _dot(by_w, self.along) + 2.0 * in_mesh + _dot(weighed, rise)
        rate += tails.load_rate + tails.load_slope * at.c_n
        mixed = (at.ring + back) * (bend * opened) + 2.0 * weighed + (1.0 - k) * back * at.slope
        return rate + _dot(mixed, corrected), curvature

    def _move(self, at: Fields, step: Array, growth: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Move the active problems; the largest change of a gap, relative to 1 + |H|, and whether the step is whole."""
        batch = self.batch
        opened = (at.c_n * growth)[:, None] * batch.rise + step - batch.at_edge(step)
        falls = np.maximum((-opened / (at.gap - LAW.singular_gap)).max(axis=1), 1e-300)
        rises = np.maximum(np.abs(growth), 1e-300)
        damping = np.minimum(1.0, np.minimum((1.0 - _SHRINK) / falls, _LARGEST_GROWTH / rises))
        change = (np.abs(opened) / (1.0 + np.abs(at.gap))).max(axis=1)
        self.active &= np.isfinite(change)
        moved = np.flatnonzero(self.active)
        self.w[moved] += damping[moved, None] * step[moved]
        self.t[moved] += damping[moved] * growth[moved]
        return change, damping == 1.0


def stationary_states(batch: Batch, w: Array, t: Array, remainder: float) -> Stationary:
    """States with an extreme load.

    Parameters
    ----------
    batch : Batch
    w, t : ndarray
        Guesses.
    remainder : float
        Newton's method ends when about this is left of the changes of gaps, relative to 1 + |H|.
    """
    newton = _Newton(batch, w, t)
    with np.errstate(all="ignore"):
        for _ in range(_ITERATIONS):
            newton.step(remainder)
            if not newton.active.any():
                break
    return Stationary(newton.w, newton.t, newton.along, newton.curvature, newton.missed, newton.converged)
