"""The Maugis-Dugdale contact of a power-law punch and a graded half-space, without cancellation (Eqs. 66-72).

In the tilde variables of `graded_punch`, with D(x) = 1/2 B(n/2, (1+k)/2) x^n, s = (1-k)/2, L^2 = c^2 - a^2
and T = Lambda L^(2s), the Abel transform q of the pressure is (delta - D(x)) / (4 s) for x < a and
-Lambda (c^2 - x^2)^s / (2 s) for a < x < c.  A finite stress at a makes q continuous, which is Eq. 66,

    delta = D(a) - 2 T,

and the gap outside the contact follows from what q has in excess of its continuation from r < a,

    H(r) = (2/pi) cos(k pi/2) integral_a^r x^k (r^2 - x^2)^(s-1) e(x) dx,
    e(x) = D(x) - D(a) + 2 Lambda (L^(2s) - (c^2 - x^2)^s).

Lambda H(c) = 1 is Griffith's relation (Eq. 69).  Its integrand is positive, so nothing cancels where the
hypergeometric form of Eqs. 69-72 does: at m = c/a -> 1, at large m, and where an argument is near 1.  With
c^2 - x^2 = L^2 z^(1/s) the integral splits into a part ~ c^n and a part ~ Lambda c^(2s) whose coefficients
depend on the shape of the edge alone.  The contact is therefore followed by that shape, w = log(a / L): every
w has one contact, a grows with w from 0 (DMT's end point) without bound, and L / a -> 0 is JKR.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc

from comparisons.model import ComputationFailed
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.quadrature import COARSE, FINE, UnitRule

__all__ = ["CohesiveContact", "ContactState", "EdgeIntegrals", "edge_integrals"]

Array = NDArray[np.float64]

_NEWTON_STEPS = 60
# Newton on a convex increasing function from its right-hand side stops where rounding stops it; the sum of
# the two parts of Griffith's relation is then 1 to a few rounding errors times the size of its logarithms.
_GRIFFITH_TOLERANCE = 1e-14


@dataclass(frozen=True, slots=True)
class EdgeIntegrals:
    """Integrals over the cohesive zone in units of c, functions of n, k and w = log(a/L) only; shape (m,).

    Attributes
    ----------
    log_contact, log_width : ndarray
        log(a / c) and log(L / c).
    shape, stress : ndarray
        The parts of H(c) from the profile and from the stress: coefficients of D(c) and of 2 T.
    shape_slope, stress_slope : ndarray
        Their derivatives with respect to w.
    shape_slope_scale : ndarray
        Sum of the magnitudes of the terms of `shape_slope`, which cancel for n > 2 as a -> 0.
    edge : ndarray
        integral of (x/c)^(k-1) over z, which carries the load of a shift of c.
    load : ndarray
        integral of (x/c)^(k-1) (1-y)^s over y, the load of the cohesive zone.
    """

    log_contact: Array
    log_width: Array
    shape: Array
    stress: Array
    shape_slope: Array
    stress_slope: Array
    shape_slope_scale: Array
    edge: Array
    load: Array


@dataclass(frozen=True, slots=True)
class ContactState:
    """Equilibrium states, tilde variables; every attribute has shape (m,).

    Slopes are derivatives with respect to w = log(a/L).  A ``scale`` is the sum of the magnitudes of the
    terms of the number it belongs to, the yardstick of its rounding error.

    Attributes
    ----------
    contact_radius, cohesive_radius, cohesive_width : ndarray
        a, c and L = sqrt(c^2 - a^2); L stays accurate where a and c agree to rounding.
    displacement, load : ndarray
        delta (Eq. 66) and P (Eq. 67).
    displacement_slope, load_slope : ndarray
        d delta / dw and dP / dw along the curve.
    displacement_scale, load_scale, load_slope_scale, displacement_slope_scale : ndarray
        Magnitudes of the terms of the four numbers above.
    """

    contact_radius: Array
    cohesive_radius: Array
    cohesive_width: Array
    displacement: Array
    load: Array
    displacement_slope: Array
    load_slope: Array
    displacement_scale: Array
    load_scale: Array
    load_slope_scale: Array
    displacement_slope_scale: Array


@dataclass(frozen=True, slots=True)
class CohesiveContact:
    """The contacts of one punch at one generalised Maugis number (Eq. 68).

    Parameters
    ----------
    punch : GradedPunch
        Shape index and gradient exponent.
    maugis_number : float
        Lambda = sigma_0 mu, sigma_0 in dgamma / z0; below 1 if k = 1 (there Lambda >= 1 is JKR itself).

    Examples
    --------
    >>> state = CohesiveContact(GradedPunch(2.0, 0.0), 1e-6).at(np.array([-np.inf]))
    >>> round(float(state.load[0]), 5)  # DMT: 2 pi times the work of adhesion times the radius
    -2.0
    """

    punch: GradedPunch
    maugis_number: float

    def at(self, w: Array, rule: UnitRule = FINE) -> ContactState:
        """Return the states with log(a/L) = `w`, shape (m,); -inf is the point of first contact.

        Raises
        ------
        ComputationFailed
            If Griffith's relation was not solved.
        """
        n, k, s = self.punch.n, self.punch.k, self.punch.s
        edge = self._edge(w, rule)
        log_c = self._griffith(edge)
        log_c_slope, log_c_slope_scale = self._cohesive_growth(edge, log_c)
        log_a, log_L = log_c + edge.log_contact, log_c + edge.log_width
        a, c, a_n = np.exp(log_a), np.exp(log_c), np.exp(n * log_a)
        alpha2, theta2 = np.exp(2.0 * edge.log_contact), np.exp(2.0 * edge.log_width)
        T = self.maugis_number * np.exp(2.0 * s * log_L)
        a_k = a ** (k + 1.0) / (k + 1.0)
        flat = self.punch.flattening * a_n
        cohesive = T * theta2 * c ** (k + 1.0) * edge.load
        stiffness = self.punch.stiffness
        hertz = self.punch.hertz_load * a ** (n + k + 1.0)
        pull = stiffness * (2.0 * T * a_k + cohesive)
        shape_growth = n * flat * (log_c_slope + theta2)
        stress_growth = 4.0 * s * T * (log_c_slope - alpha2)
        displacement_slope = shape_growth - stress_growth
        shift = 2.0 * T * c ** (k + 1.0) * edge.edge
        displacement_slope_scale = n * flat * (log_c_slope_scale + theta2) + 4.0 * s * T * (log_c_slope_scale + alpha2)
        return ContactState(
            contact_radius=a,
            cohesive_radius=c,
            cohesive_width=np.exp(log_L),
            displacement=flat - 2.0 * T,
            load=hertz - pull,
            displacement_slope=displacement_slope,
            load_slope=stiffness * (a_k * displacement_slope - shift * log_c_slope),
            displacement_scale=flat + 2.0 * T,
            load_scale=hertz + pull,
            load_slope_scale=stiffness * (a_k * displacement_slope_scale + shift * log_c_slope_scale),
            displacement_slope_scale=displacement_slope_scale,
        )

    def log_contact_radius(self, w: float) -> float:
        """Return log(a) at log(a/L) = `w`, finite where a itself would overflow."""
        edge = self._edge(np.array([w]), COARSE)
        return float(self._griffith(edge)[0] + edge.log_contact[0])

    def _edge(self, w: Array, rule: UnitRule) -> EdgeIntegrals:
        """Return the integrals over the cohesive zone of this traction."""
        return edge_integrals(self.punch, w, rule)

    def amplitude(self, cohesive_width: float) -> float:
        """Return the displacement by which the traction lifts the surface at the contact, tilde: 2 Lambda L^(2s)."""
        return float(2.0 * self.maugis_number * cohesive_width ** (2.0 * self.punch.s))

    def opening(self, remainder: Array, opened: Array) -> Array:
        """Return the share of the amplitude in e(x): 1 - v^s at v = (c^2-x^2)/L^2 = `remainder` = 1 - `opened`.

        Each of the two numbers is accurate where it is small.
        """
        with np.errstate(divide="ignore"):
            log_v = np.where(remainder < 0.5, np.log(remainder), np.log1p(-np.minimum(opened, 0.75)))
        return np.asarray(-np.expm1(self.punch.s * log_v))

    def zone_share(self, remainder: Array) -> Array:
        """Return the traction of the cohesive zone over its largest value, at (c^2-r^2)/L^2 = `remainder`: 1."""
        return np.ones_like(remainder)

    def contact_share(self, inside: Array) -> Array:
        """Return the traction inside the contact over its largest value, at (a^2-r^2)/L^2 = `inside`."""
        s = self.punch.s
        return np.asarray(betainc(s, 1.0 - s, 1.0 / (1.0 + inside))) if s > 0.0 else np.ones_like(inside)

    def _griffith(self, edge: EdgeIntegrals) -> Array:
        """Solve Griffith's relation, Lambda H(c) = 1, for log(c); shape (m,)."""
        n, s, Lambda = self.punch.n, self.punch.s, self.maugis_number
        # The shape underflows where L / a does; its share is then nothing beside the stress.
        log_shape = np.log(np.maximum(Lambda * self.punch.flattening * edge.shape, np.finfo(float).tiny))
        log_stress = np.log(2.0 * Lambda**2 * edge.stress) + 2.0 * s * edge.log_width
        # The relation is convex and increasing in log(c); where either part alone is 1, c is an upper bound.
        log_c = -log_shape / n
        if s > 0.0:
            log_c = np.minimum(log_c, -log_stress / (2.0 * s))
        for _ in range(_NEWTON_STEPS):
            shape, stress = np.exp(log_shape + n * log_c), np.exp(log_stress + 2.0 * s * log_c)
            total = shape + stress
            step = np.log(total) * total / (n * shape + 2.0 * s * stress)
            log_c = log_c - step
            slope = n * shape + 2.0 * s * stress
            rounding = _GRIFFITH_TOLERANCE * (1.0 + np.abs(log_shape) * shape + np.abs(log_stress) * stress) / slope
            if np.all(np.abs(step) <= rounding + _GRIFFITH_TOLERANCE * np.abs(log_c)):
                return log_c
        raise ComputationFailed(
            f"Griffith's relation was not solved at Lambda = {Lambda}: "
            f"Newton left a step of {np.max(np.abs(step)):.1e} in log(c)"
        )

    def _cohesive_growth(self, edge: EdgeIntegrals, log_c: Array) -> tuple[Array, Array]:
        """Return d log(c) / dw along Griffith's relation, and the magnitude of its terms."""
        n, s, Lambda = self.punch.n, self.punch.s, self.maugis_number
        shape_factor = Lambda * self.punch.flattening * np.exp(n * log_c)
        stress_factor = 2.0 * Lambda**2 * np.exp(2.0 * s * (log_c + edge.log_width))
        stiffening = n * shape_factor * edge.shape + 2.0 * s * stress_factor * edge.stress
        stress_growth = stress_factor * edge.stress_slope
        growth = shape_factor * edge.shape_slope + stress_growth
        scale = shape_factor * edge.shape_slope_scale + np.abs(stress_growth)
        return -growth / stiffening, scale / stiffening


def edge_integrals(punch: GradedPunch, w: Array, rule: UnitRule = FINE) -> EdgeIntegrals:
    """Return the integrals over the cohesive zone at log(a/L) = `w`, shape (m,).

    x^2 / c^2 = xi^2 = alpha^2 + theta^2 y with alpha = a/c, theta = L/c and y = 1 - z^(1/s); the slopes use
    d(xi^2)/dw = 2 alpha^2 theta^2 (1 - y), d log(theta)/dw = -alpha^2 and d log(alpha)/dw = theta^2.

    Examples
    --------
    >>> found = edge_integrals(GradedPunch(2.0, 0.0), np.array([0.0]))          # a = L = c / sqrt(2)
    >>> round(float(np.exp(found.log_contact[0])), 6), round(float(np.exp(found.log_width[0])), 6)
    (0.707107, 0.707107)
    """
    n, s = punch.n, punch.s
    log_alpha = -0.5 * np.logaddexp(0.0, -2.0 * w)
    log_theta = -0.5 * np.logaddexp(0.0, 2.0 * w)
    alpha2, theta2 = np.exp(2.0 * log_alpha), np.exp(2.0 * log_theta)
    weight = rule.weight
    log_rest = rule.log_z / s if s > 0.0 else np.full_like(rule.log_z, -np.inf)
    rest, y = np.exp(log_rest), -np.expm1(log_rest)
    xi2 = alpha2[:, None] + theta2[:, None] * y
    q = alpha2[:, None] / xi2
    with np.errstate(divide="ignore"):
        log_q = np.where(q < 0.5, np.log(q), np.log1p(-theta2[:, None] * y / xi2))
    xi_k = xi2**-s
    rise = xi2 ** (0.5 * n)
    excess = -rise * np.expm1(0.5 * n * log_q)
    alpha_n = np.exp(n * log_alpha)[:, None]
    front = punch.stiffness * np.exp(2.0 * s * log_theta)
    shape = front * ((xi_k * excess) @ weight)
    stress = front * ((xi_k * rule.complement) @ weight)
    # The slopes below are those of front * integral; d log(front)/dw = -2 s alpha^2 sits in their first term.
    drift = -2.0 * s * (alpha2[:, None] + theta2[:, None] * q * rest)
    gain, loss = n * theta2[:, None] * (rise * q * rest), drift * excess - n * theta2[:, None] * alpha_n
    shape_slope = front * ((xi_k * (gain + loss)) @ weight)
    shape_slope_scale = front * ((xi_k * (gain - loss)) @ weight)
    # The stress coefficient multiplies T ~ theta^(2s) once more.
    stress_slope = front * ((xi_k * rule.complement * (drift - 2.0 * s * alpha2[:, None])) @ weight)
    xi_load = (alpha2[:, None] + theta2[:, None] * rule.complement) ** -s
    return EdgeIntegrals(
        log_contact=log_alpha,
        log_width=log_theta,
        shape=shape,
        stress=stress,
        shape_slope=shape_slope,
        stress_slope=stress_slope,
        shape_slope_scale=shape_slope_scale,
        edge=xi_k @ weight,
        load=(xi_load * rule.z**s) @ weight,
    )
