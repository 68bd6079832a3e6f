"""Uncondensed contact model, which keeps every displacement: a check of the condensed path.

On the mesh in units of the edge radius c the equations are K u / factor(c) = F(u, delta, c), with K the
stiffness of E = z^k and the load vector and its tangent assembled by scikit-fem on the surface facets at the
deformed gap H = -delta + f(c s) + u_z.  Newton with the exact tangent is bordered by the edge control; its
linear systems are solved by GMRES with the elastic preconditioner.  The model shares mesh, elements and exterior with
the condensed path, but neither its factorisation nor its quadrature matrices.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator
from skfem import BilinearForm, FacetBasis, LinearForm

from fem_reference._elastic.assembly import HalfSpace, assemble_half_space
from fem_reference._elastic.dof_ordering import line_unknowns
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_bordered, solve_cg
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.errors import NotConverged
from fem_reference.laws import SurfaceLaw
from fem_reference.modulus import PowerLawModulus
from fem_reference.punch import Punch

__all__ = ["FullContact", "FullState"]


NEWTON_TOLERANCE = 1e-10
"""Largest Newton step, in lengths of the law plus the largest displacement."""

NEWTON_STEPS = 25
"""Steps before giving up."""

LINEAR_TOLERANCE = 1e-4
"""Relative residual of a Newton step (inexact Newton): the error falls by as much a step near the
solution."""

SMALLEST_DAMPING = 1e-3
"""Fraction of a step below which none is sought."""

FLOOR_SHARE = 0.6
"""Share of the singular gap below which steps are damped, unless the start lies below it."""

RATE_TOLERANCE = 1e-7
"""Relative residual of the sensitivity solve, whose zero is the pull-off."""

ROOT_TOLERANCE = 1e-4
"""Relative tolerance of the size at pull-off: the secant error
after a step that small is far smaller, and the load is stationary there."""

ROOT_STEPS = 20
"""Secant steps allowed to find the pull-off."""


@LinearForm
def _pressure(v: Any, w: Any) -> Any:
    return w.pressure * w.x[0] * v


@BilinearForm
def _pressure_change(u: Any, v: Any, w: Any) -> Any:
    return w.change * w.x[0] * u * v


@dataclass(frozen=True, slots=True, eq=False)
class FullState:
    """An equilibrium at the size c, with the gap of peak tension at the edge node.

    Attributes
    ----------
    u : ndarray, shape (2 N,)
        Displacement.
    displacement, size, load, load_rate : float
        Approach delta, edge radius c, load P and dP/dc.
    newton_steps, krylov_steps : int
        Work.
    u_rate, displacement_rate : ndarray, float
        Derivatives with respect to c, the predictor of the next size.
    """

    u: Array
    displacement: float
    size: float
    load: float
    load_rate: float
    newton_steps: int
    krylov_steps: int
    u_rate: Array
    displacement_rate: float


class FullContact:
    """Punch, surface law and the whole meshed half-space.

    Parameters
    ----------
    modulus : PowerLawModulus
        E(z); only a power law scales with the size.
    nu : float
        Poisson ratio.
    punch : Punch
        Shape.
    law : SurfaceLaw
        Surface law.
    spec : MeshSpec
        Mesh in units of the edge radius.
    """

    def __init__(self, modulus: PowerLawModulus, nu: float, punch: Punch, law: SurfaceLaw, spec: MeshSpec) -> None:
        self.modulus, self.punch, self.law = modulus, punch, law
        self.half_space: HalfSpace = assemble_half_space(
            spec.grid(), PowerLawModulus(1.0, 1.0, modulus.k), nu, spec.order
        )
        self.preconditioner = ElasticPreconditioner(self.half_space)
        basis = self.half_space.basis
        mesh = basis.mesh
        x, w = np.polynomial.legendre.leggauss(2 * spec.order + 2)
        top = np.flatnonzero((mesh.p[1][mesh.facets] == 0).all(axis=0))
        self.facets = FacetBasis(mesh, basis.elem, facets=top, quadrature=((0.5 * (x + 1.0))[None, :], 0.5 * w))
        self.s: Array = np.asarray(self.facets.global_coordinates())[0]
        line = line_unknowns(basis, 1, 0.0)
        nodes = mesh.p[0][mesh.p[1] == 0]
        self.edge = int(2 * line[int(np.argmin(abs(np.sort(nodes) - 1.0)))] + 1)

    def factor(self, c: float) -> float:
        """c^(1-k) c0^k / E0, the compliance at size c."""
        law = self.modulus
        return c ** (1.0 - law.k) * law.c0**law.k / law.E0

    def gap(self, u: Array, delta: float, c: float) -> Array:
        """H at the facet Gauss points."""
        return -delta + self.punch.height(c * self.s) + np.asarray(self.facets.interpolate(u[1::2]))

    def _loads(self, u: Array, delta: float, c: float) -> tuple[Array, sparse.csr_array, Array, Array]:
        """Load vector, its derivatives with respect to u, delta and c (free rows, scaled)."""
        H = self.gap(u, delta, c)
        change = self.law.slope(H)
        rise = self.s * self.punch.slope(c * self.s)
        vectors = [
            np.asarray(_pressure.assemble(self.facets, pressure=values))
            for values in (self.law.traction(H), -change, change * rise)
        ]
        tangent = _pressure_change.assemble(self.facets, change=change).tocoo()
        size = u.size
        full = sparse.coo_array((tangent.data, (2 * tangent.row + 1, 2 * tangent.col + 1)), shape=(size, size)).tocsr()
        free, D = self.half_space.free, sparse.diags_array(self.preconditioner.scale)
        reduced = []
        for vector in vectors:
            full_vector = np.zeros(size)
            full_vector[1::2] = vector
            reduced.append(self.preconditioner.scale * full_vector[free])
        return reduced[0], (D @ full[free][:, free] @ D).tocsr(), reduced[1], reduced[2]

    def under_pressure(self, pressure: Array, c: float) -> Array:
        """Return the displacement under a pressure at the facet Gauss points, to start Newton from."""
        load = np.zeros(self.half_space.matrix.shape[0])
        load[1::2] = np.asarray(_pressure.assemble(self.facets, pressure=pressure))
        return self.factor(c) * solve_cg(self.half_space, load, self.preconditioner).solution

    def load(self, u: Array, delta: float, c: float) -> float:
        """P on the mesh (compression positive)."""
        p = self.law.traction(self.gap(u, delta, c))
        return 2.0 * math.pi * c**2 * float(np.sum(p * self.s * self.facets.dx))

    def equilibrium(self, u: Array, delta: float, c: float) -> FullState:
        """Solve at the size c from a starting point.

        Raises
        ------
        NotConverged
            If Newton or a linear solve misses its tolerance.
        """
        free, scale = self.half_space.free, self.preconditioner.scale
        u = np.array(u, float)
        A = self.preconditioner.matrix
        edge_row = np.zeros(u.size)
        edge_row[self.edge] = 1.0
        edge_row = scale * edge_row[free]
        krylov = 0
        for step_count in range(NEWTON_STEPS):
            F, T, F_delta, F_c = self._loads(u, delta, c)
            stiff = 1.0 / self.factor(c)
            v = u[free] / scale
            residual = stiff * (A @ v) - F
            control = u[self.edge] - delta + float(self.punch.height(np.array(c))) - self.law.peak_gap
            operator = self._bordered(A * stiff - T, F_delta, edge_row)
            step, count = solve_bordered(
                operator, np.append(residual, control), self.preconditioner, self.factor(c), LINEAR_TOLERANCE
            )
            krylov += count
            change = scale * step[:-1]
            damping = self._damping(u, delta, c, change, float(step[-1]))
            u[free] -= damping * change
            delta -= damping * float(step[-1])
            if np.abs(step[:-1] * scale).max() <= NEWTON_TOLERANCE * (self.law.length + np.abs(u).max()):
                # Exact sensitivity: d/dc of K u / factor - F = 0 and of the control.
                k = self.modulus.k
                right = (1.0 - k) / c * stiff * (A @ (u[free] / scale)) + F_c
                slope = float(self.punch.slope(np.array(c)))
                rate, count = solve_bordered(
                    operator, np.append(right, -slope), self.preconditioner, self.factor(c), RATE_TOLERANCE
                )
                load_rate = self._load_rate(u, delta, c, scale * rate[:-1], float(rate[-1]))
                P = self.load(u, delta, c)
                u_rate = np.zeros(u.size)
                u_rate[free] = scale * rate[:-1]
                work = step_count + 1, krylov + count
                return FullState(u, delta, c, P, load_rate, *work, u_rate, float(rate[-1]))
        raise NotConverged("the uncondensed Newton iteration did not converge; start closer to the solution")

    def pull_off(self, u: Array, delta: float, c: float) -> FullState:
        """Find the minimum of the load over the size, from a starting point near it.

        Raises
        ------
        NotConverged
            If the secant iteration on dP/dc does not converge.
        """
        old = self.equilibrium(u, delta, c)
        # The load falls up to its minimum and rises after it.
        new = self._moved(old, -math.copysign(0.01 * c, old.load_rate))
        krylov, newton = old.krylov_steps + new.krylov_steps, old.newton_steps + new.newton_steps
        for _ in range(ROOT_STEPS):
            shift = -new.load_rate * (new.size - old.size) / (new.load_rate - old.load_rate)
            shift = float(np.clip(shift, -0.05 * new.size, 0.05 * new.size))
            old, new = new, self._moved(new, shift)
            krylov, newton = krylov + new.krylov_steps, newton + new.newton_steps
            if abs(shift) <= ROOT_TOLERANCE * new.size:
                return replace(new, newton_steps=newton, krylov_steps=krylov)
        raise NotConverged("the secant iteration for the pull-off did not converge; start closer to it")

    def _moved(self, state: FullState, shift: float) -> FullState:
        """Solve at a neighbouring size from the tangent prediction."""
        u = state.u + shift * state.u_rate
        return self.equilibrium(u, state.displacement + shift * state.displacement_rate, state.size + shift)

    def _bordered(self, tangent: sparse.csr_array, F_delta: Array, edge_row: Array) -> LinearOperator:
        def apply(x: Array) -> Array:
            x = np.ravel(x)
            return np.append(tangent @ x[:-1] - F_delta * x[-1], edge_row @ x[:-1] - x[-1])

        size = F_delta.size + 1
        return LinearOperator((size, size), apply, dtype=float)

    def _load_rate(self, u: Array, delta: float, c: float, du: Array, ddelta: float) -> float:
        H = self.gap(u, delta, c)
        full = np.zeros(u.size)
        full[self.half_space.free] = du
        dH = np.asarray(self.facets.interpolate(full[1::2])) - ddelta + self.s * self.punch.slope(c * self.s)
        measure = self.s * self.facets.dx
        inside = 2.0 * c * self.law.traction(H) + c**2 * self.law.slope(H) * dH
        return 2.0 * math.pi * float(np.sum(inside * measure))

    def _damping(self, u: Array, delta: float, c: float, du: Array, ddelta: float) -> float:
        full = np.zeros(u.size)
        full[self.half_space.free] = du
        damping = 1.0
        singular = self.law.singular_gap
        lowest = min(FLOOR_SHARE * singular, 0.5 * (float(self.gap(u, delta, c).min()) + singular))
        while damping > SMALLEST_DAMPING and self.gap(u - damping * full, delta - damping * ddelta, c).min() < lowest:
            damping *= 0.5
        return damping
