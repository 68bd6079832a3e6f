r"""Residual and exact bordered tangent of the equations at a state.

    R_i = H_i + delta - f(c s_i) - w_i = 0          (Eq. 4)
    an anchor that fixes the scale:  c = given,  or  H(s = 1) = edge gap  (the mesh then follows the edge)
    a control:  linear in  (H_0, delta, P, log c)   (central gap, displacement, load, arc length: all alike)

The bordered matrix is regular at the folds, where the tangent of R alone is singular.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from fscm._surface.anchors import AtEdge
from fscm._surface.bordered import Bordered
from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.state import Control, Rates, State, SteepState
from fscm._typing import Array

__all__ = ["Linearisation", "linearised", "rates_by"]

#: Largest row sum of the difference of two tangents for which the factors of one serve the other.
_NEAR = 0.05
#: Rounding of a few operations, and that of an entry of the response in units of it (see `fscm._bound.defect`).
_ROUNDOFF, _ENTRY = 2.0**-51, 8.0
#: A tangent from the factors of a neighbouring state is corrected as long as each correction is smaller than the one
#: before by _CONVERGING: more than about seven of them take longer than new factors.  It is exact to rounding after one
#: below _ROUNDED, relative to its largest component (of gaps relative to 1 + |H|).
_CONVERGING, _ROUNDED = 0.01, 1e-14


class Linearisation:
    """Residual, tangent and functionals at a state, which need not be in equilibrium."""

    def __init__(self, state: State) -> None:
        self.state = s = state
        d, problem = s.disc, s.disc.problem
        K = d.stiffness_scale(s.scale)
        slope = d.force.slope(s.radius, s.gap)
        k = problem.k
        rise = d.rise(s.radius)
        self.residual = s.mismatch(s.deformation)
        elastic = s.deformation - s.tail.displacement
        self._stiffness_slope = K * slope
        growth, axis_growth = (K * rate for rate in d.growth(s.scale, s.pressure))
        #: r dp/dr at a fixed gap, by which the pressure at a node changes with log c; None if it does not.
        self.drift = d.force.drift(s.radius, s.gap)
        if self.drift is not None:
            growth = growth + K * (d.response(s.scale) @ self.drift)
            axis_growth = axis_growth + K * float(d.axis_response(s.scale) @ self.drift)
        self._growth_on_axis = float(axis_growth)
        self._slope, self._rise = slope, rise
        #: dR / d delta and dR / d log c.
        self._displacement_column, self.scale_column = self._columns((1.0 - k) * elastic, growth)
        #: Residual of the anchor, and its derivatives by the unknowns at the nodes, by delta and by log c.
        self.anchor, self._anchor_row, self._anchor_ends = 0.0, np.zeros(d.mesh.size), (0.0, 1.0)
        if isinstance(s.anchor, AtEdge):
            gap, by_displacement, by_scale = self._gap_at_edge()
            self.anchor, self._anchor_row = gap - s.anchor.gap_at(problem, s.scale), d.edge
            self._anchor_ends = by_displacement, by_scale - s.anchor.drift(problem, s.scale)

    def _columns(self, elastic: Array, growth: Array | float) -> tuple[float | Array, Array]:
        """Derivatives of the residual by delta and log c."""
        tail = self.state.tail
        return 1.0 - tail.displacement_slope, -(self._rise + elastic + growth + tail.displacement_rate)

    def _gap_at_edge(self) -> tuple[float, float, float]:
        """Gap at s = 1, and its derivatives by delta and log c."""
        return float(self.state.disc.edge @ self.state.gap), 0.0, 0.0

    def by_unknowns(self, by_gap: Array, by_displacement: float, by_scale: float) -> Array:
        """Derivatives by the unknowns, shape (N + 2,), from those by the gaps, delta and log c."""
        return np.concatenate([by_gap, [by_displacement, by_scale]])

    def sizes(self) -> tuple[Array, Array | float]:
        """Sizes of the terms of the residual that are rounded, and of those of the gaps if they are no unknowns."""
        return self._sizes_of_gap() + np.abs(self.state.gap), 0.0

    def _sizes_of_gap(self) -> Array:
        s = self.state
        return abs(s.displacement) + np.abs(s.disc.height(s.radius)) + np.abs(self._rise)

    @cached_property
    def load_gradient(self) -> Array:
        """Derivatives of the load by the unknowns, shape (N + 2,)."""
        s, mesh = self.state, self.state.disc.mesh
        area = 2.0 * s.scale**2 * mesh.weights * mesh.nodes
        by_scale = 2.0 * (s.load - s.tail.load) + s.tail.load_rate
        if self.drift is not None:
            by_scale += float(area @ self.drift)
        return self.by_unknowns(area * self._slope, s.tail.load_slope, by_scale)

    @cached_property
    def axis_gap_gradient(self) -> Array:
        """Derivatives of the central gap by the unknowns, shape (N + 2,)."""
        s, d = self.state, self.state.disc
        row = d.stiffness_scale(s.scale) * d.axis_response(s.scale) * self._slope
        elastic = s.central_gap + s.displacement - s.tail.displacement
        by_scale = (1.0 - d.problem.k) * elastic + s.tail.displacement_rate + self._growth_on_axis
        return self.by_unknowns(row, -(1.0 - s.tail.displacement_slope), by_scale)

    def bordered(self, row: Array) -> Bordered:
        """The bordered tangent with a last row."""
        N = len(self.residual)
        columns = np.empty((N, 2))
        columns[:, 0], columns[:, 1] = self._displacement_column, self.scale_column
        rows = np.array([np.append(self._anchor_row, self._anchor_ends), row])
        return Bordered(self.state.disc.response(self.state.scale), self._stiffness_slope, columns, rows)

    def rounding(self) -> Array:
        """Bound of the rounding of the residual, shape (N,)."""
        s, d = self.state, self.state.disc
        product = d.stiffness_scale(s.scale) * (d.response(s.scale) @ d.force.size(s.radius, s.gap))
        return np.asarray(_ROUNDOFF * (self.sizes()[0] + _ENTRY * product))

    def near(self, factor: BorderedFactor) -> bool:
        """Whether the factors of another state's tangent serve this one."""
        change = np.abs(self._stiffness_slope - factor.stiffness_slope)
        return bool((self.state.disc.response(self.state.scale) @ change).max() < _NEAR)

    def times(self, x: Array) -> Array:
        """The bordered matrix times a vector, with zero in place of its last row; shape (N + 2,)."""
        d, dH = self.state.disc, x[:-2]
        product = np.zeros(len(x))
        product[:-2] = dH - d.response(self.state.scale) @ (self._stiffness_slope * dH)
        product[:-2] += self._displacement_column * x[-2] + self.scale_column * x[-1]
        product[-2] = self._anchor_ends[0] * x[-2] + self._anchor_ends[1] * x[-1]
        product[-2] += self._anchor_row @ dH
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
        self.state.disc.factor = None  # frees its memory first
        self.state.disc.factor = BorderedFactor(self.bordered(row))
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
        # The energy changes by P d(delta) along a path of equilibria.
        return Rates(dH, dd, dc, central_gap, load, self.state.load * dd)

    def _tangent(self, row: Array) -> Array:
        """Tangent with unit product with a row, by the factors of a neighbouring state and corrections, or new ones."""
        factor = self.state.disc.factor
        if factor is not None and self.near(factor):
            x, last_change = factor.tangent, np.inf
            # Gaps and their rates are many decades larger far out than near the edge.
            size = np.append(1.0 + np.abs(self.state.gap), [1.0, 1.0])
            change = 1.0
            while change < _CONVERGING * last_change:
                last_change, x = change, x / float(row @ x)
                correction = factor.solve(self.times(x), row)
                change = float((np.abs(correction) / size).max() / (np.abs(x) / size).max())
                x = x - correction
                if change < _ROUNDED:
                    return x
        return self._factored(row).tangent


class _OfDeformations(Linearisation):
    """The same for the unknowns (w, delta, log c) of a steep punch, H = f(c s) - delta + w."""

    def _columns(self, elastic: Array, growth: Array | float) -> tuple[float | Array, Array]:
        tail, W = self.state.tail, self.state.disc.response(self.state.scale)
        by_scale = -(W @ (self._stiffness_slope * self._rise) + (elastic + growth) + tail.displacement_rate)
        return W @ self._stiffness_slope - tail.displacement_slope, by_scale

    def _gap_at_edge(self) -> tuple[float, float, float]:
        s, d = self.state, self.state.disc
        edge = np.array([s.scale])
        gap = float(d.height(edge)[0] - s.displacement + d.edge @ s.unknowns)
        return gap, -1.0, float(d.rise(edge)[0])

    def by_unknowns(self, by_gap: Array, by_displacement: float, by_scale: float) -> Array:
        by_displacement -= float(by_gap.sum())
        by_scale += float(by_gap @ self._rise)
        return super().by_unknowns(by_gap, by_displacement, by_scale)

    def sizes(self) -> tuple[Array, Array | float]:
        # The height is rounded in the gap, not in the equation.
        return np.abs(self.state.unknowns), self._sizes_of_gap()


def linearised(state: State) -> Linearisation:
    """Residual and tangent at a state."""
    return (_OfDeformations if isinstance(state, SteepState) else Linearisation)(state)


def rates_by(state: State, parameter: str) -> Rates:
    """Exact derivatives along the path, per unit of a continuation parameter."""
    if parameter not in state.rates:  # stored instead of the tangent, which is as large as the response
        state.rates[parameter] = linearised(state).rates(Control(0.0, **{parameter: 1.0}))
    return state.rates[parameter]
