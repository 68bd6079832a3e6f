r"""Least loads with bounds on their errors: from two solutions, and from the residual of the second one.

At an extreme the error of the load is, to first order, what the adjoint y of the equilibrium weighs the residual with,
whatever fixes the state on its path.  Since r G(r, t) = t G(t, r), the adjoint is p'(H) r z with

    z = 2 c^2 + M c^(1-k) W p'(H) z,

the equation of the derivative of the gap by the displacement along the path, at a fixed radius.  That one is known from
the path on the mesh of the edge, where log c = t goes along it:

    z / (2 c^2) = 1 + (s dw/ds - dw/dt) / (d delta/dt).

The equation itself would not give it: at a fixed radius the narrow edge moves almost freely, so that what the equation
determines of this motion is the error of the response.  The load is corrected by the first-order error that the nodes
of the higher order see.  The bound is the sum of two parts.

*Evidence.*  The difference of the corrected loads of the two solutions, which differ in the orders of the pressure and
of the residual, in the terms of the expansion in k, in the narrowest panels at the edge and at the tip, and in the end
of the mesh.  It exceeds the error of the second solution if that is at most half that of the first one: an estimate,
measured (`docs/sweeps.md`).

*Residual of the second solution.*  Derived are

* the closed tail: its expansion, and what it neglects;
* the effect of the last two coefficients of the expansion in k, by the largest of each block.

Estimates are

* that the coefficients behind those have a smaller effect: each is a fifth of the one before or less (measured);
* rounding, from the sizes of the terms of the residual and of the load, as for `fscm.solve`;
* the distance from the extreme, from what is left of the derivative of the load, to second order in it;
* sums over the Legendre modes of each panel of the products of the adjoint with the error of the pressure, and of those
  of the adjoint with the error of the deformation, at the nodes of the higher order;
* what these nodes miss: the deformation is singular at the ends of panels, where the polynomials of the pressure jump.
  It is a share of the integral of the sizes of the latter products, computed for such singularities (`unseen_share`);
* the square of the error of the pressure: what is of second order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fscm._many.equilibrium import EDGE_GAP, LAW, Batch, Fields, Stationary
from fscm._typing import Array

__all__ = ["Loads", "bounded_loads", "unseen_share"]

#: Factor on the sums over the modes.
_SAFETY = 2.0
#: Share at k = 0, and its rate in k: twice the worst share of singularities of any two sizes at both ends (computed:
#: 0.04 at k = 0, 0.08 at k = 0.4 and 0.17 at k = 0.8 for 12 and 16 nodes; less for the other orders).
_UNSEEN, _UNSEEN_RATE = 0.08, 1.9
#: Relative error of the load per square of the error of the pressure (in units of the largest tension, 1.03): measured
#: worst 12 over 14 problems at k = 0.7 to 0.8 whose edge panels were too long, with errors of the pressure up to 5e-3.
_SECOND_ORDER = 50.0
#: Relative rounding of a few operations; in units of it, those of an entry of the response and of a pressure times an
#: area (as in `fscm._bound.defect`).
_ROUNDOFF, _ENTRY, _WEIGHT = 2.0**-51, 8.0, 4.0


def unseen_share(k: Array) -> Array:
    """Share of the size of a product that its sum over the nodes of the higher order may differ from its integral by.

    The product is that of a polynomial of degree 3 with the error of interpolating the deformation, which is singular
    like u^(1 - k) at the ends of panels (u log u for k = 0).
    """
    return np.asarray(_UNSEEN * np.exp(_UNSEEN_RATE * k))


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
    density : ndarray, shape (b, m coarse)
        The adjoint over the radius, at the nodes of the pressure.
    """

    def __init__(self, batch: Batch, states: Stationary) -> None:
        mesh = batch.mesh
        self.at = at = Fields(batch, states.w, states.t)
        twice, w = 2.0 * at.c[:, None] ** 2, mesh.refined(states.w)
        gap = EDGE_GAP + (at.c_n / batch.n)[:, None] * batch.rise_fine + (w - at.edge_w)
        self.pressure_error = LAW.traction(gap) - mesh.refined(at.pressure)
        shifted = mesh.coarse.nodes * mesh.slopes(states.w) - states.along
        self.density = twice * at.slope * (1.0 + shifted / (at.c_n[:, None] + batch.at_edge(states.along)))
        both = np.matmul(batch.response, np.stack([at.pressure, self.density], axis=2))
        both *= at.stiffness[:, None, None]
        self.deformation_error = w - both[..., 0] - at.tails.lift[:, None]
        self.by_pressure = mesh.fine.nodes * (twice + both[..., 1])
        self.by_deformation = LAW.slope(gap) * self.by_pressure
        seen = self.by_pressure * self.pressure_error - self.by_deformation * self.deformation_error
        self.load = at.load + seen @ mesh.fine.weights


def bounded_loads(first: Batch, first_states: Stationary, second: Batch, second_states: Stationary) -> Loads:
    """Corrected loads of the second solutions of problems, with an extreme load."""
    mesh, defect = second.mesh, _Defect(second, second_states)
    at, y = defect.at, defect.by_deformation
    bound = np.abs(defect.load - _Defect(first, first_states).load)
    by_modes = mesh.by_modes(defect.by_pressure, defect.pressure_error) + mesh.by_modes(y, defect.deformation_error)
    bound += _SAFETY * by_modes + unseen_share(second.k) * (np.abs(y * defect.deformation_error) @ mesh.fine.weights)
    # The area of the innermost panels is small.
    largest = np.max(np.abs(defect.pressure_error) * np.minimum(mesh.fine.nodes, 1.0), axis=1)
    bound += _SECOND_ORDER * np.abs(defect.load) * largest**2 + second_states.missed
    weighed = y * mesh.fine.weights
    bound += _behind(second, at, weighed) + _of_response(second, at, weighed)
    return Loads(defect.load, bound + _rounding(second, at, defect.density))


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
    pushed = np.matmul(batch.scale * mesh.uncertain, np.abs(at.pressure).reshape(by_panel).sum(axis=2)[..., None])[
        ..., 0
    ]
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
