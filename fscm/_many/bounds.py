r"""Least loads with bounds on their errors, from the residual at the nodes of a higher order.

At an extreme the error of the load is, to first order, what the adjoint y of the equilibrium weighs the residual with,
whatever fixes the state on its path.  Since r G(r, t) = t G(t, r), the adjoint is p'(H) r z with

    z = 2 c^2 + M c^(1-k) W p'(H) z,

the equation of the derivative of the gap by the displacement at a fixed scale: it has the accuracy of the state, at the
nodes of the higher order as well.  The value is corrected by the first-order error.  What bounds the error that is left
is made of sizes that cannot cancel:

* sums over the Legendre modes of each panel of the products of the adjoint with the error of the pressure, and of those
  of the adjoint with the error of the deformation;
* a share of the integral of the sizes of the latter: the deformation is not smooth at the ends of panels, so that sums
  over the nodes of the higher order miss a part of its error;
* the square of the error of the pressure: what is of second order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fscm._many.equilibrium import EDGE_GAP, LAW, Batch, Fields, Stationary
from fscm._many.response import assembled
from fscm._typing import Array

__all__ = ["Loads", "bounded_loads"]

#: Factor on the sums over the modes.
_SAFETY = 2.0
#: Share of the integral of the size that sums over the nodes may miss: measured at most 0.05 over 362 random problems.
_MISSED = 0.25
#: Relative error of the load per square of the error of the pressure (in units of the largest tension, 1.03): measured
#: worst 12 over 14 problems at k = 0.7 to 0.8 whose edge panels were too long, with errors of the pressure up to 5e-3.
_SECOND_ORDER = 50.0
#: Relative rounding of a few operations; in units of it, those of an entry of the response and of a pressure times an
#: area (as in `fscm._bound.defect`).
_ROUNDOFF, _ENTRY, _WEIGHT = 2.0**-51, 8.0, 4.0
#: What the expansion of the response in k neglects: the last term, and this share of the one before it.
_SHARE = 0.1


class Loads(NamedTuple):
    """Least loads, shape (b,), and bounds on their errors."""

    load: Array
    bound: Array


def bounded_loads(batch: Batch, states: Stationary) -> Loads:
    """Corrected loads of states with an extreme load."""
    mesh = batch.mesh
    at = Fields(batch, states.w, states.t)
    fine, twice = mesh.fine, 2.0 * at.c[:, None] ** 2
    w = mesh.refined(states.w)
    gap = EDGE_GAP + (at.c_n / batch.n)[:, None] * batch.rise_fine + (w - at.edge_w[:, None])
    pressure_error = LAW.traction(gap) - mesh.refined(at.pressure)
    coarse_density = twice * at.slope * states.free
    both = np.matmul(batch.response, np.stack([at.pressure, coarse_density], axis=2))
    both *= at.stiffness[:, None, None]
    deformation_error = w - both[..., 0] - at.tails.lift[:, None]
    # The adjoint of the response, and the adjoint, as densities.
    v = fine.nodes * (twice + both[..., 1])
    y = LAW.slope(gap) * v
    load = at.load + (v * pressure_error - y * deformation_error) @ fine.weights
    bound = _SAFETY * (mesh.by_modes(v, pressure_error) + mesh.by_modes(y, deformation_error))
    bound += _MISSED * (np.abs(y * deformation_error) @ fine.weights)
    # The area of the innermost panels is small.
    largest = np.max(np.abs(pressure_error) * np.minimum(fine.nodes, 1.0), axis=1)
    bound += _SECOND_ORDER * np.abs(load) * largest**2
    weighed = y * fine.weights
    bound += states.missed
    bound += _behind(batch, at, weighed) + _of_response(batch, at, weighed) + _rounding(batch, at, coarse_density)
    return Loads(load, bound)


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
    """Effect of what the expansion of the response in k neglects."""
    effects = []
    for term in (-1, -2):
        left = assembled(batch.polynomials[:, [term]], batch.coefficients[[term]], batch.mesh.offsets, batch.k)
        pushed = np.matmul(left, at.pressure[..., None])[..., 0]
        effects.append(np.abs(at.stiffness * np.einsum("bi,bi->b", y, pushed)))
    return effects[0] + _SHARE * effects[1]


def _rounding(batch: Batch, at: Fields, density: Array) -> Array:
    """Rounding of the residual, weighed by the adjoint, and of the load."""
    size = 8.0 / 3.0 * ((at.gap - LAW.singular_gap) ** -9 + (at.gap - LAW.singular_gap) ** -3)
    height = (at.c_n / batch.n)[:, None] * np.abs(batch.rise)
    change = np.abs(at.slope) * (np.abs(at.w) + np.abs(at.edge_w)[:, None] + height + np.abs(at.gap))
    y = np.abs(density) * batch.area
    back = at.stiffness[:, None] * np.abs(np.matmul(y[:, None], batch.square)[:, 0])
    terms = y * np.abs(at.w) + back * (_ENTRY * size + change) + at.ring * (_WEIGHT * size + change)
    return np.asarray(_ROUNDOFF * terms.sum(axis=1))
