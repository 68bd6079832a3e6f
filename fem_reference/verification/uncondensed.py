"""Uncondensed contact model of which nothing is condensed, the tangent neither: a check of the path and of its events.

Newton with the exact tangent is bordered by the edge control; its linear systems are solved by GMRES with the elastic
preconditioner.  The model shares mesh, elements and exterior with the condensed path, but neither its factorisation
nor its quadrature matrices; from the events of the whole system it differs by its tangent and its linear solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem_reference._contact.full_system import FullSystem
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.dof_ordering import line_unknowns
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_bordered
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


class FullContact(FullSystem):
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
        self.modulus = modulus
        unit = PowerLawModulus(1.0, 1.0, modulus.k)
        super().__init__(assemble_half_space(spec.grid(), unit, nu, spec.order), punch, law)
        basis = self.half_space.basis
        nodes = basis.mesh.p[0][basis.mesh.p[1] == 0]
        line = line_unknowns(basis, 1, 0.0)
        self.edge = int(2 * line[int(np.argmin(abs(np.sort(nodes) - 1.0)))] + 1)

    def factor(self, c: float) -> float:
        """c^(1-k) c0^k / E0, the compliance at size c."""
        law = self.modulus
        return c ** (1.0 - law.k) * law.c0**law.k / law.E0

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
            F, T, F_delta, F_c = self.loads(u, delta, c)
            stiff = 1.0 / self.factor(c)
            v = u[free] / scale
            residual = stiff * (A @ v) - F
            control = u[self.edge] - delta + float(self.punch.height(np.array(c))) - self.law.peak_gap
            operator = self.bordered(A * stiff - T, F_delta, edge_row)
            step, count = solve_bordered(
                operator, np.append(residual, control), self.preconditioner, self.factor(c), LINEAR_TOLERANCE
            )
            krylov += count
            change = scale * step[:-1]
            damping = self._damping(u, delta, c, change, float(step[-1]))
            u[free] -= damping * change
            delta -= damping * float(step[-1])
            if np.abs(step[:-1] * scale).max() <= NEWTON_TOLERANCE * (self.law.z0 + np.abs(u).max()):
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
