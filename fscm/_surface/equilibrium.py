r"""Equilibrium of the surface: the state on a mesh, its residual and its exact bordered tangent.

Radii are r = c s with the mesh in s.  The half-space has no length of its own, so one response matrix W
serves every scale c:  w(c s) = M (1-k) c^{1-k} (W p)(s).  Unknowns are the gaps H at the nodes, the
displacement delta and log c; the equations are

    R_i = H_i + delta - f(c s_i) - w_i = 0          (Eq. 4)
    an anchor that fixes the scale:  c = given,  or  H(s = 1) = edge gap  (the mesh then follows the edge)
    a control:  linear in  (H_0, delta, P, log c)   (central gap, displacement, load, arc length: all alike)

The bordered matrix is regular at the folds, where the tangent of R alone is singular.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.deformation import axis_row, response_matrix
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh
from fscm._surface.response import response_of
from fscm._surface.tail import Tail, tail_energy, tail_of
from fscm._typing import Array
from fscm.problem import Problem

__all__ = ["STEEP", "Control", "Discretisation", "Linearisation", "Rates", "State"]

#: Growth of a punch above which its height is not linear in log c within a step, and so much larger than the
#: deformation that their difference loses digits: the unknowns are then the deformations w instead of the gaps.
STEEP = 10.0
#: Bound on the heights of a steep punch: the tension there is negligible, 1e-180 for the 9-3 law.
_HIGHEST = 1e60
#: Largest row sum of the difference of two tangents for which the factors of one serve the other.
_NEAR = 0.1
#: Rounding of a few operations, and that of an entry of the response in units of it (see `_defect`).
_ROUNDOFF, _ENTRY = 2.0**-51, 8.0
#: A tangent from the factors of a neighbouring state is corrected as long as each correction is smaller than the one
#: before by _CONVERGING; it is exact to rounding when the last one is below _ROUNDED, relative to its largest component
#: (of gaps relative to 1 + |H|).
_CONVERGING, _ROUNDED, _CORRECTIONS = 0.1, 1e-14, 12


@dataclass(frozen=True)
class Control:
    """A linear condition gap * H_0 + displacement * delta + load * P + log_scale * log c = value."""

    value: float
    gap: float = 0.0
    displacement: float = 0.0
    load: float = 0.0
    log_scale: float = 0.0


class Discretisation:
    """A problem on a mesh: everything that does not depend on the state.

    Parameters
    ----------
    problem : Problem
    mesh : PanelMesh
        In the scaled radius s; must have a break at s = 1.
    previous : Discretisation, optional
        Blocks of its response matrix are reused.
    """

    def __init__(self, problem: Problem, mesh: PanelMesh, previous: Discretisation | None = None) -> None:
        self.problem, self.mesh = problem, mesh
        self._previous = previous
        self._at: tuple[float, Any, Array] | None = None
        # Matrices, and rows for the axis, of the other exponents of several bodies.
        self._others: dict[float, tuple[Array, Array]] = {}
        # On the previous mesh, at the same scale: reused for common panels.
        self._before: tuple[PanelMesh, float, Any] | None = None
        if previous is not None and previous._at is not None and previous.problem.graded == problem.graded:
            if previous.mesh is mesh:
                self._at = previous._at
            else:
                self._before = previous.mesh, *previous._at[:2]
        #: The latest factors of a tangent on this mesh, which serve neighbouring states.
        self.factor: BorderedFactor | None = None
        edge = int(np.searchsorted(mesh.offsets, 1.0 - mesh.origin))
        self.edge = mesh.row_at_end(max(edge - 1, 0), 1.0)

    @cached_property
    def matrix(self) -> Array:
        """The matrix W of a power law; on demand, because on some meshes nothing is solved."""
        previous, self._previous = self._previous, None
        while previous is not None and previous._previous is not None:
            previous = previous._previous  # on a mesh on which nothing was solved
        reusable = None
        if previous is not None and previous.problem.k == self.problem.k and "matrix" in previous.__dict__:
            reusable = previous.mesh, previous.matrix
        return response_matrix(kernel_of(self.problem.k), self.mesh, reusable)

    @cached_property
    def axis(self) -> Array:
        """The row of W for the axis."""
        return axis_row(kernel_of(self.problem.k), self.mesh)

    def _power_law(self, k: float) -> tuple[Array, Array]:
        """The matrix W of an exponent, and its row for the axis."""
        if k == self.problem.k:
            return self.matrix, self.axis
        if k not in self._others:
            self._others[k] = response_matrix(kernel_of(k), self.mesh), axis_row(kernel_of(k), self.mesh)
        return self._others[k]

    @property
    def steep(self) -> bool:
        """Whether the unknowns are the deformations instead of the gaps."""
        return self.problem.punch.growth > STEEP

    def height(self, radius: Array) -> Array:
        """Height of the punch, bounded for a steep one."""
        f = self.problem.punch.height(radius)
        return np.minimum(f, _HIGHEST) if self.steep else f

    def rise(self, radius: Array) -> Array:
        """r df/dr, the change of the height with log c."""
        if self.steep:
            # Where the height is bounded it does not change.
            below_bound = self.problem.punch.height(radius) < _HIGHEST
            return np.where(below_bound, radius * self.problem.punch.slope(np.where(below_bound, radius, 0.0)), 0.0)
        return radius * self.problem.punch.slope(radius)

    def _at_scale(self, c: float) -> tuple[Any, Array]:
        """Response of the images at a scale, and the whole response, of bodies that are not one power law."""
        if self._at is None or self._at[0] != c:
            self._at = None  # frees its memory first
            response = response_of(self.problem.graded)
            remainder = response.remainder(self.mesh, c, self._before)
            self._before = None
            terms = [(factor, self._power_law(k)[0]) for k, factor in self._factors(c).items()]
            if remainder is not None:
                terms.append((-response.weight * c**self.problem.k, remainder.matrix))
            matrices = [matrix if factor == 1.0 else factor * matrix for factor, matrix in terms]
            self._at = c, remainder, sum(matrices[1:], matrices[0])
        return self._at[1:]

    def _factors(self, c: float) -> dict[float, float]:
        """Factors of the matrices of all exponents at a scale."""
        k = self.problem.k
        return {k_i: weight * c ** (k - k_i) for k_i, weight in response_of(self.problem.graded).singular_parts.items()}

    def response(self, c: float) -> Array:
        """The matrix W at a scale; it does not depend on it for a power law."""
        return self.matrix if self.problem.graded is None else self._at_scale(c)[1]

    def axis_response(self, c: float) -> Array:
        """The row of W for the axis at a scale."""
        if self.problem.graded is None:
            return self.axis
        response = response_of(self.problem.graded)
        rows = [factor * self._power_law(k)[1] for k, factor in self._factors(c).items()]
        remainder = self._at_scale(c)[0]
        if remainder is not None:
            rows.append(-response.weight * c**self.problem.k * remainder.axis)
        return np.asarray(np.sum(rows, axis=0))

    def growth(self, c: float, pressure: Array) -> tuple[Array | float, float]:
        """Derivative of W p by log c at the nodes and on the axis, without that of the factor of W."""
        if self.problem.graded is None:
            return 0.0, 0.0
        response, k = response_of(self.problem.graded), self.problem.k
        nodes, axis = np.zeros(self.mesh.size), 0.0
        for k_i, factor in self._factors(c).items():
            if k_i != k:
                matrix, row = self._power_law(k_i)
                nodes = nodes + (k - k_i) * factor * (matrix @ pressure)
                axis += (k - k_i) * factor * float(row @ pressure)
        remainder = self._at_scale(c)[0]
        if remainder is not None:
            factor = response.weight * c**k
            nodes = nodes - factor * (remainder.rate @ pressure + k * (remainder.matrix @ pressure))
            axis -= factor * float(remainder.axis_rate @ pressure + k * (remainder.axis @ pressure))
        return nodes, axis

    def stiffness_scale(self, c: float) -> float:
        """M (1-k) c^{1-k}, the factor of W."""
        p = self.problem
        return p.compliance * (1.0 - p.k) * c ** (1.0 - p.k)


@dataclass(frozen=True)
class State:
    """One equilibrium state on its discretisation.

    Attributes
    ----------
    disc : Discretisation
    scale : float
        c; radii are c s.
    gap : ndarray, shape (N,)
        H at the nodes, in z0.
    displacement : float
        delta / z0.
    follows_edge : bool
        The anchor: H(s=1) is the edge gap (True) or the scale is fixed (False).
    iterations, residual
        Of the Newton solve that produced it.
    lift : ndarray, shape (N,), optional
        Deformation w from which the gaps of a steep punch follow.
    edge_gap : float, optional
        Gap at s = 1 when the mesh follows the edge; by default the one of largest tension.
    turned : tuple of str and float, optional
        Continuation parameter and its orientation along the path, if they are not the usual ones: log c, rising, when
        the mesh follows the edge, else the central gap, falling.
    """

    disc: Discretisation
    scale: float
    gap: Array
    displacement: float
    follows_edge: bool
    iterations: int = 0
    residual: float = 0.0
    lift: Array | None = None
    edge_gap: float | None = None
    turned: tuple[str, float] | None = None

    @classmethod
    def lifted(
        cls,
        disc: Discretisation,
        scale: float,
        lift: Array,
        displacement: float,
        follows_edge: bool,
        edge_gap: float | None = None,
        turned: tuple[str, float] | None = None,
    ) -> State:
        """The state of a steep punch from its deformation."""
        gap = disc.height(scale * disc.mesh.nodes) - displacement + lift
        return cls(disc, scale, gap, displacement, follows_edge, lift=lift, edge_gap=edge_gap, turned=turned)

    @property
    def parameter(self) -> str:
        """Name of the continuation parameter: "gap", "log_scale", "displacement" or "load"."""
        return self.turned[0] if self.turned else "log_scale" if self.follows_edge else "gap"

    @property
    def orientation(self) -> float:
        """Whether the continuation parameter rises (1) or falls (-1) along the path."""
        return self.turned[1] if self.turned else 1.0 if self.follows_edge else -1.0

    @property
    def gap_at_edge(self) -> float:
        """Gap at s = 1 when the mesh follows the edge."""
        return float(self.disc.problem.force.peak_gap(np.array(self.scale))) if self.edge_gap is None else self.edge_gap

    @property
    def drift_at_edge(self) -> float:
        """Derivative of that gap by log c."""
        return self.disc.problem.force.peak_drift(self.scale) if self.edge_gap is None else 0.0

    @cached_property
    def radius(self) -> Array:
        """Node radii r = c s, shape (N,)."""
        return self.scale * self.disc.mesh.nodes

    @property
    def end(self) -> float:
        """Radius where the mesh ends."""
        return float(self.scale * self.disc.mesh.breaks[-1])

    @cached_property
    def pressure(self) -> Array:
        """p at the nodes, shape (N,)."""
        return self.disc.problem.force.traction(self.radius, self.gap)

    @cached_property
    def tail(self) -> Tail:
        """Contribution of radii beyond the mesh."""
        return tail_of(self.disc.problem, self.end, self.displacement)

    @cached_property
    def deformation(self) -> Array:
        """w at the nodes, shape (N,)."""
        d = self.disc
        return d.stiffness_scale(self.scale) * (d.response(self.scale) @ self.pressure) + self.tail.displacement

    @cached_property
    def central_gap(self) -> float:
        """H_0 from Eq. 32."""
        d = self.disc
        w0 = d.stiffness_scale(self.scale) * float(d.axis_response(self.scale) @ self.pressure)
        w0 += self.tail.displacement
        return w0 - self.displacement

    @cached_property
    def load(self) -> float:
        """P of Eq. 31, tension negative."""
        mesh = self.disc.mesh
        area = 2.0 * self.scale**2 * mesh.weights * mesh.nodes
        return float(area @ self.pressure) + self.tail.load

    @cached_property
    def energy(self) -> float:
        """Elastic plus surface energy, unit pi Q^(2/n) dgamma z0^(2/n); its change is P d(delta).

        The elastic part is (1/2) int p w 2 r dr, the surface part int e(H) 2 r dr with e from the law.  When
        the surface part is infinite (a cone under the 9-3 law) its finite part is taken: the divergent
        constant is the same for all states of a problem, so differences are right.
        """
        d = self.disc
        area = 2.0 * self.scale**2 * d.mesh.weights * d.mesh.nodes
        density = 0.5 * self.pressure * self.deformation + d.problem.force.energy(self.radius, self.gap)
        return float(area @ density) + tail_energy(self.disc.problem, self.end, self.displacement)

    @cached_property
    def _rates(self) -> dict[str, Rates]:
        return {}

    def rates(self, follow: str = "log_scale") -> Rates:
        """Exact derivatives along the path, per unit of `follow` ("log_scale" or "gap")."""
        if follow not in self._rates:  # stored instead of the tangent, which is as large as the response
            self._rates[follow] = Linearisation(self).rates(Control(0.0, **{follow: 1.0}))
        return self._rates[follow]


@dataclass(frozen=True)
class Rates:
    """Derivatives along the equilibrium path; `gap` has those of the deformation if the punch is steep."""

    gap: Array
    displacement: float
    log_scale: float
    central_gap: float
    load: float

    def scaled(self, factor: float) -> Rates:
        """The same derivatives in another unit."""
        return Rates(
            factor * self.gap,
            factor * self.displacement,
            factor * self.log_scale,
            factor * self.central_gap,
            factor * self.load,
        )


class Linearisation:
    """Residual, tangent and functionals at a state, which need not be in equilibrium."""

    def __init__(self, state: State) -> None:
        self.state = s = state
        d, problem = s.disc, s.disc.problem
        K = d.stiffness_scale(s.scale)
        slope = problem.force.slope(s.radius, s.gap)
        k = problem.k
        rise = d.rise(s.radius)
        if s.lift is None:
            self.residual = s.gap + s.displacement - d.height(s.radius) - s.deformation
        else:
            self.residual = s.lift - s.deformation
        # dR / d delta and dR / d log c
        elastic = s.deformation - s.tail.displacement
        self._stiffness_slope = K * slope
        self._displacement_column: float | Array = 1.0 - s.tail.displacement_slope
        growth, axis_growth = (K * rate for rate in d.growth(s.scale, s.pressure))
        #: r dp/dr at a fixed gap, by which the pressure at a node changes with log c; None if it does not.
        self.drift = problem.force.drift(s.radius, s.gap)
        if self.drift is not None:
            growth = growth + K * (d.response(s.scale) @ self.drift)
            axis_growth = axis_growth + K * float(d.axis_response(s.scale) @ self.drift)
        self.scale_column = -(rise + (1.0 - k) * elastic + growth + s.tail.displacement_rate)
        # Derivatives of the anchor by delta and log c.
        self._anchor_ends = 0.0, -s.drift_at_edge if s.follows_edge else 1.0
        self.anchor = float(d.edge @ s.gap) - s.gap_at_edge if s.follows_edge else 0.0
        self._growth_on_axis = float(axis_growth)
        self._slope, self._rise = slope, rise
        if s.lift is not None:
            self._unknown_is_lift(s.lift, K * slope, rise, (1.0 - k) * elastic + growth)

    def _unknown_is_lift(self, lift: Array, stiffness: Array, rise: Array, elastic: Array) -> None:
        """Columns for the unknowns (w, delta, log c), H = f(c s) - delta + w."""
        s, d = self.state, self.state.disc
        W = d.response(s.scale)
        self._displacement_column = W @ stiffness - s.tail.displacement_slope
        self.scale_column = -(W @ (stiffness * rise) + elastic + s.tail.displacement_rate)
        if s.follows_edge:
            edge = np.array([s.scale])
            self.anchor = float(d.height(edge)[0] - s.displacement + d.edge @ lift) - s.gap_at_edge
            self._anchor_ends = -1.0, float(d.rise(edge)[0]) - s.drift_at_edge

    @cached_property
    def load_gradient(self) -> Array:
        """Derivatives of the load by the unknowns, shape (N + 2,)."""
        s, mesh = self.state, self.state.disc.mesh
        area = 2.0 * s.scale**2 * mesh.weights * mesh.nodes
        by_scale = 2.0 * (s.load - s.tail.load) + s.tail.load_rate
        if self.drift is not None:
            by_scale += float(area @ self.drift)
        return self._by_unknowns(area * self._slope, s.tail.load_slope, by_scale)

    @cached_property
    def axis_gap_gradient(self) -> Array:
        """Derivatives of the central gap by the unknowns, shape (N + 2,)."""
        s, d = self.state, self.state.disc
        row = d.stiffness_scale(s.scale) * d.axis_response(s.scale) * self._slope
        elastic = s.central_gap + s.displacement - s.tail.displacement
        by_scale = (1.0 - d.problem.k) * elastic + s.tail.displacement_rate + self._growth_on_axis
        return self._by_unknowns(row, -(1.0 - s.tail.displacement_slope), by_scale)

    def _by_unknowns(self, by_gap: Array, by_displacement: float, by_scale: float) -> Array:
        """Derivatives by the gaps, delta and log c as those by the unknowns, which are w for a steep punch."""
        if self.state.lift is not None:
            by_displacement -= float(by_gap.sum())
            by_scale += float(by_gap @ self._rise)
        return np.concatenate([by_gap, [by_displacement, by_scale]])

    def bordered(self) -> Array:
        """The bordered matrix in Fortran order, shape (N + 2, N + 2); its last row is not set."""
        d = self.state.disc
        N = d.mesh.size
        matrix = np.empty((N + 2, N + 2), order="F")
        J = matrix[:N, :N]
        np.multiply(d.response(self.state.scale), -self._stiffness_slope, out=J)
        J[np.arange(N), np.arange(N)] += 1.0
        matrix[:N, N] = self._displacement_column
        matrix[:N, N + 1] = self.scale_column
        matrix[N, :N] = d.edge if self.state.follows_edge else 0.0
        matrix[N, N:] = self._anchor_ends
        return matrix

    def rounding(self) -> Array:
        """Bound of the rounding of the residual, shape (N,)."""
        s, d = self.state, self.state.disc
        product = d.stiffness_scale(s.scale) * (d.response(s.scale) @ d.problem.force.size(s.radius, s.gap))
        if s.lift is not None:
            size = np.abs(s.lift)
        else:
            size = np.abs(s.gap) + abs(s.displacement) + np.abs(d.height(s.radius)) + np.abs(d.rise(s.radius))
        return np.asarray(_ROUNDOFF * (size + _ENTRY * product))

    def near(self, factor: BorderedFactor) -> bool:
        """Whether the factors of another state's tangent serve this one."""
        change = np.abs(self._stiffness_slope - factor.stiffness_slope)
        return bool(np.max(self.state.disc.response(self.state.scale) @ change) < _NEAR)

    def times(self, x: Array) -> Array:
        """All rows of the bordered matrix but the last, times a vector; shape (N + 1,)."""
        d, dH = self.state.disc, x[:-2]
        product = np.empty(len(x) - 1)
        product[:-1] = dH - d.response(self.state.scale) @ (self._stiffness_slope * dH)
        product[:-1] += self._displacement_column * x[-2] + self.scale_column * x[-1]
        product[-1] = self._anchor_ends[0] * x[-2] + self._anchor_ends[1] * x[-1]
        if self.state.follows_edge:
            product[-1] += d.edge @ dH
        return product

    def row(self, control: Control) -> Array:
        """Derivatives of the left side of a control by the unknowns, shape (N + 2,)."""
        row = np.zeros(len(self.residual) + 2)
        row[-2:] = control.displacement, control.log_scale
        if control.gap:
            row += control.gap * self.axis_gap_gradient
        if control.load:
            row += control.load * self.load_gradient
        return row

    def factor(self, control: Control) -> BorderedFactor:
        """Factors of the bordered matrix with a control, stored for neighbouring states on the same mesh."""
        return self._factored(self.row(control))

    def _factored(self, row: Array) -> BorderedFactor:
        matrix = self.bordered()
        matrix[-1] = row
        self.state.disc.factor = None  # frees its memory first
        self.state.disc.factor = BorderedFactor(matrix, self._stiffness_slope)
        return self.state.disc.factor

    def violation(self, control: Control) -> float:
        """Left side of the control minus its value."""
        s = self.state
        terms = (control.gap, "central_gap"), (control.displacement, "displacement"), (control.load, "load")
        left = sum(float(weight * getattr(s, name)) for weight, name in terms if weight)
        return left + control.log_scale * math.log(s.scale) - control.value

    def rates(self, control: Control) -> Rates:
        """Derivatives along the path by the left side of the control."""
        N = len(self.residual)
        x = self._tangent(self.row(control))
        dH, dd, dc = x[:N], float(x[N]), float(x[N + 1])
        central_gap, load = (
            float(gradient[:N] @ dH) + float(gradient[N]) * dd + float(gradient[N + 1]) * dc
            for gradient in (self.axis_gap_gradient, self.load_gradient)
        )
        return Rates(dH, dd, dc, central_gap, load)

    def _tangent(self, row: Array) -> Array:
        """Tangent with unit product with a row, by the factors of a neighbouring state and corrections, or new ones."""
        factor = self.state.disc.factor
        if factor is not None and self.near(factor):
            x, last_change = factor.tangent, np.inf
            # Gaps and their rates are many decades larger far out than near the edge.
            size = np.append(1.0 + np.abs(self.state.gap), [1.0, 1.0])
            for _ in range(_CORRECTIONS):
                x = x / float(row @ x)
                correction = factor.solve(np.append(self.times(x), 0.0), row)
                change = float(np.max(np.abs(correction) / size) / np.max(np.abs(x) / size))
                if not change < _CONVERGING * last_change:
                    if last_change < _ROUNDED:
                        return x
                    break
                x, last_change = x - correction, change
        return self._factored(row).tangent
