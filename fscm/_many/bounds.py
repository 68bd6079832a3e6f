r"""Least loads with bounds on their errors: from two solutions on one mesh, and from the residual of the second one.

At an extreme the error of the load is, to first order, what the adjoint y of the equilibrium weighs the residual with,
whatever fixes the state on its path.  Since r G(r, t) = t G(t, r), the adjoint is p'(H) r z with

    z = 2 c^2 + M c^(1-k) W p'(H) z,

the equation of the derivative of the gap by the displacement along the path, at a fixed radius.  That one is known from
the path on the mesh of the edge, where log c = t goes along it:

    z / (2 c^2) = 1 + (s dw/ds - dw/dt) / (d delta/dt).

The equation itself would not give it: at a fixed radius the narrow edge moves almost freely, so that what the equation
determines of this motion is the error of the response.  The load is corrected by the first-order error that the nodes
of the higher order see.  The bound is the sum of two parts.

*Evidence.*  The difference of the corrected loads of the two solutions, which differ in the order of the pressure.  It
exceeds the error of the second solution if that is at most half that of the first one: an estimate, measured
(`docs/sweeps.md`).  Errors that both have are in the other part.

*Residual of the second solution.*  Derived are

* the closed tail: its expansion, and what it neglects;
* the effect of the last two coefficients of the expansion in k, by the largest of each block;
* what the nodes of the higher order miss.  The deformation is singular at the ends of panels, where the polynomials of
  the pressure jump.  Only the error of the pressure makes it so, and near its panel the kernel is that of a line,
  proportional to |u - v|^-k, to first order in the length of the panel over its radius.  So what is missed is the sum
  over the Legendre modes of that error, times what is missed of the response to a mode, computed (`missed_share`).

Estimates are

* that the coefficients behind those have a smaller effect: each is a fifth of the one before or less (measured);
* rounding, from the sizes of the terms of the residual and of the load, as for `fscm.solve`;
* the distance from the extreme, from what is left of the derivative of the load, to second order in it;
* sums over the Legendre modes of each panel of the products of the adjoint with the error of the pressure, and of those
  of the adjoint with the error of the deformation, at the nodes of the higher order;
* the square of the error of the pressure: what is of second order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import gamma

from fscm._many.equilibrium import EDGE_GAP, LAW, Batch, Fields, Stationary
from fscm._typing import Array

__all__ = ["Loads", "bounded_loads", "corrected_loads", "missed_share"]

#: Factor on the sums over the modes.
_SAFETY = 2.0
#: Share at k = 0 by the number of nodes of the residual, and its rate in k: twice the worst of the modes from 6 on
#: (computed, for 12 nodes: 4.7e-5 at k = 0, 4.6e-4 at k = 0.4 and 4.2e-3 at k = 0.8; for 14: 1.35e-3 at k = 0.67 and
#: 2.88e-3 at k = 0.8).  Share of this on the panel beside it, per ratio of the lengths: twice the worst of ratios 1/4
#: to 4 (computed).
_MISSED, _MISSED_RATE, _BESIDE = {12: 1e-4, 14: 5.6e-5}, 5.8, 0.5
#: Relative error of the load per square of the error of the pressure (in units of the largest tension, 1.03): measured
#: worst 12 over 14 problems at k = 0.7 to 0.8 whose edge panels were too long, with errors of the pressure up to 5e-3.
_SECOND_ORDER = 50.0
#: Relative rounding of a few operations; in units of it, those of an entry of the response and of a pressure times an
#: area (as in `fscm._bound.defect`).
_ROUNDOFF, _ENTRY, _WEIGHT = 2.0**-51, 8.0, 4.0


def missed_share(k: Array, fine: int) -> Array:
    """What so many fine nodes miss of the integral of a unit mode's response over a panel of unit length.

    The kernel is |u - v|^-k / k (-log |u - v| for k = 0), the weight a polynomial of degree 3 of the size of 1.
    """
    return np.asarray(_MISSED[fine] * np.exp(_MISSED_RATE * k))


class Loads(NamedTuple):
    """Least loads, shape (b,), and bounds on their errors."""

    load: Array
    bound: Array


class _Defect:
    """Errors of the states of a batch at the nodes of the higher order, and the adjoint that weighs them.

    Attributes
    ----------
    at : Fields
    pressure_error, deformation_error : ndarray, shape (b, m fine)
    by_pressure, by_deformation : ndarray, shape (b, m fine)
        Densities of the derivatives of the load by these errors, the second one times -1.
    density : ndarray, shape (b, N)
        The adjoint over the radius, at the nodes of the pressure.
    load : ndarray, shape (b,)
        Corrected by the errors.
    """

    def __init__(self, batch: Batch, states: Stationary) -> None:
        mesh, nodes = batch.mesh, batch.nodes
        self.at = at = Fields(batch, states.w, states.t)
        twice, w = 2.0 * at.c[:, None] ** 2, nodes.interpolated(states.w, nodes.to_fine)
        gap = EDGE_GAP + (at.c_n / batch.n)[:, None] * batch.rise_fine + (w - at.edge_w)
        self.pressure_error = LAW.traction(gap) - nodes.interpolated(at.pressure, nodes.to_fine)
        self.density = twice * at.slope * (1.0 + batch.adjoint_excess(at, states.along))
        densities = [nodes.interpolated(values, nodes.to_coefficients) for values in (at.pressure, self.density)]
        both = np.matmul(batch.response, np.stack(densities, axis=2))
        both *= at.stiffness[:, None, None]
        self.deformation_error = w - both[..., 0] - at.tails.lift[:, None]
        self.by_pressure = mesh.fine.nodes * (twice + both[..., 1])
        self.by_deformation = LAW.slope(gap) * self.by_pressure
        seen = self.by_pressure * self.pressure_error - self.by_deformation * self.deformation_error
        self.load = at.load + seen @ mesh.fine.weights


def corrected_loads(batch: Batch, states: Stationary) -> Array:
    """Loads of solutions, corrected to first order by their errors at the fine nodes."""
    return _Defect(batch, states).load


def bounded_loads(batch: Batch, states: Stationary, before: Array) -> Loads:
    """Corrected loads of solutions with an extreme load; `before` are those of the first solutions."""
    mesh, defect = batch.mesh, _Defect(batch, states)
    at, y = defect.at, defect.by_deformation
    errors = mesh.modes(defect.pressure_error)
    products = np.abs(mesh.modes(defect.by_pressure) * errors) + np.abs(
        mesh.modes(y) * mesh.modes(defect.deformation_error)
    )
    squares = 1.0 / (2.0 * np.arange(mesh.fine.order) + 1.0)
    bound = np.abs(defect.load - before) + _SAFETY * (products @ squares) @ mesh.fine.lengths
    bound += _missed(batch, at, np.abs(errors).sum(axis=2), np.abs(mesh.by_panel(y)).max(axis=2))
    # The area of the innermost panels is small.
    largest = np.max(np.abs(defect.pressure_error) * np.minimum(mesh.fine.nodes, 1.0), axis=1)
    bound += _SECOND_ORDER * np.abs(defect.load) * largest**2 + states.missed
    weighed = y * mesh.fine.weights
    bound += _behind(batch, at, weighed) + _of_response(batch, at, weighed)
    return Loads(defect.load, bound + _rounding(batch, at, defect.density))


def _missed(batch: Batch, at: Fields, errors: Array, y: Array) -> Array:
    """What the fine nodes miss of the response to the error of the pressure, on its panel and on those beside it."""
    k, lengths = batch.k[:, None], batch.mesh.fine.lengths
    # Of the kernel: near the ring it is this number over k, times the distance to the power -k.
    strength = gamma(1.0 + 0.5 * k) / (np.sqrt(np.pi) * gamma(0.5 + 0.5 * k))
    weighed = y * lengths
    beside = np.zeros_like(weighed)
    beside[:, 1:] += weighed[:, :-1]
    beside[:, :-1] += weighed[:, 1:]
    shares = missed_share(k, batch.mesh.fine.order) * (1.0 - k) * strength * lengths ** (1.0 - k) * errors
    return np.asarray(at.stiffness * (shares * (weighed + _BESIDE * beside)).sum(axis=1))


def _behind(batch: Batch, at: Fields, y: Array) -> Array:
    """Error of the tail: its expansion, the deformation behind the mesh, and the variation of the lift over it."""
    tails, w = at.tails, np.abs(at.w[:, -1])
    total = np.abs(y.sum(axis=1))
    expansion = tails.load_error + total * tails.lift_error
    neglected = w * (np.abs(tails.load_slope) + total * np.abs(tails.lift_slope))
    # A ring at t lifts r by t^-k F(a, a; 1; x^2) with x = r / t, and F is at most 1 / (1 - x^2).
    x = batch.mesh.fine.nodes / batch.mesh.end
    return expansion + neglected + np.abs(tails.lift) * (np.abs(y) @ (x * x / ((1.0 - x) * (1.0 + x))))


def _of_response(batch: Batch, at: Fields, y: Array) -> Array:
    """Effect of the last two coefficients of the response in k, each at most the largest of its block."""
    mesh = batch.mesh
    by_panel = (len(y), mesh.count, -1)
    pressure = np.abs(at.pressure).reshape(by_panel).sum(axis=2)
    pushed = np.matmul(batch.scale * mesh.uncertain, pressure[..., None])[..., 0]
    return np.asarray(at.stiffness * np.einsum("bi,bi->b", np.abs(y).reshape(by_panel).sum(axis=2), pushed))


def _rounding(batch: Batch, at: Fields, density: Array) -> Array:
    """Rounding of the residual, weighed by the adjoint, and of the load."""
    size = 8.0 / 3.0 * ((at.gap - LAW.singular_gap) ** -9 + (at.gap - LAW.singular_gap) ** -3)
    height = (at.c_n / batch.n)[:, None] * np.abs(batch.rise)
    change = np.abs(at.slope) * (np.abs(at.w) + np.abs(at.edge_w) + height + np.abs(at.gap))
    y = np.abs(density) * batch.area
    back = at.stiffness[:, None] * np.abs(np.matmul(y[:, None], batch.square)[:, 0])
    terms = y * np.abs(at.w) + back * (_ENTRY * size + change) + at.ring * (_WEIGHT * size + change)
    return np.asarray(_ROUNDOFF * terms.sum(axis=1))
