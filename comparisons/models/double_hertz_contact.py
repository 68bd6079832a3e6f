"""The double-Hertz contact of a power-law punch and a graded half-space.

The cohesive traction is the difference of the Hertz pressures of one paraboloid at two radii, the contact radius a
and c > a (Greenwood & Johnson 1998).  In the tilde variables of `graded_punch`, with D(x) = 1/2 B(n/2, (1+k)/2) x^n,
s = (1-k)/2, L^2 = c^2 - a^2 and T = Lambda (1+k) L^(2s) / stiffness,

    sigma(r) = Lambda [ (c^2 - r^2)^((1+k)/2) - (a^2 - r^2)^((1+k)/2) ] / L^(1+k)    (the second term for r < a only).

Inside the contact the two pressures displace the surface by a constant, whatever the punch, so that

    delta = D(a) - T,    P = Hertz(a) - 2 Lambda (c^(k+3) - a^(k+3)) / ((k+3) L^(1+k)),
    e(x)  = D(x) - D(a) + T (min(x, c)^2 - a^2) / L^2,

where e is the excess that gives the gap as in `cohesive_contact`.  The stress is finite at the edge, and Lambda is its
largest value.  The work of adhesion is the integral of sigma over the gap.  Both are Abel transforms: in

    integral_a^c sigma dH = Lambda (1+k) L^(-1-k) integral_a^c x^k e(x) dx = 1

the order of integration was changed, and the inner integral of (x^2-r^2)^(-s) (r^2-y^2)^(s-1) / r over r is
(pi/2) y^(2s-2) x^(-2s) / sin(pi s).  The relation has the form of Griffith's in `cohesive_contact`, a part ~ c^n and a
part ~ c^(2s), and is solved in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.models.cohesive_contact import CohesiveContact, ContactState, EdgeIntegrals
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.quadrature import FINE, UnitRule

__all__ = ["DoubleHertzContact", "double_hertz_integrals"]

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class DoubleHertzContact(CohesiveContact):
    """The contacts of one punch at one generalised Maugis number, that of the largest traction.

    Examples
    --------
    >>> state = DoubleHertzContact(GradedPunch(2.0, 0.4), 1e-6).at(np.array([-np.inf]))
    >>> round(float(state.load[0]), 5)  # DMT: 2 pi times the work of adhesion times the radius
    -2.0
    """

    def at(self, w: Array, rule: UnitRule = FINE) -> ContactState:
        """Return the states with log(a/L) = `w`, shape (m,); -inf is the point of first contact.

        Raises
        ------
        ComputationFailed
            If the relation of the work of adhesion was not solved.
        """
        n, k, s, stiffness = self.punch.n, self.punch.k, self.punch.s, self.punch.stiffness
        edge = self._edge(w, rule)
        log_c = self._griffith(edge)
        growth, growth_scale = self._cohesive_growth(edge, log_c)
        log_a, log_L = log_c + edge.log_contact, log_c + edge.log_width
        a, c = np.exp(log_a), np.exp(log_c)
        alpha2, theta2 = np.exp(2.0 * edge.log_contact), np.exp(2.0 * edge.log_width)
        T = self.maugis_number * (1.0 + k) / stiffness * np.exp(2.0 * s * log_L)  # the amplitude of each state
        a_k, c_k = a ** (k + 1.0) / (k + 1.0), c ** (k + 1.0)
        flat = self.punch.flattening * np.exp(n * log_a)
        hertz = self.punch.hertz_load * a ** (n + k + 1.0)
        pull = stiffness * T * (a_k + 0.5 * theta2 * c_k * edge.load)
        shape_growth, stress_growth = n * flat * (growth + theta2), 2.0 * s * T * (growth - alpha2)
        displacement_slope = shape_growth - stress_growth
        slope_scale = n * flat * (growth_scale + theta2) + 2.0 * s * T * (growth_scale + alpha2)
        # T / L^2 falls as L^(-1-k) while c moves outwards.
        weaker, wider = 0.5 * (1.0 + k) * theta2 * c_k * edge.load, c_k * edge.edge
        zone = T * (weaker * (growth - alpha2) - wider * growth)
        zone_scale = T * (weaker * (growth_scale + alpha2) + wider * growth_scale)
        return ContactState(
            contact_radius=a,
            cohesive_radius=c,
            cohesive_width=np.exp(log_L),
            displacement=flat - T,
            load=hertz - pull,
            displacement_slope=displacement_slope,
            load_slope=stiffness * (a_k * displacement_slope + zone),
            displacement_scale=flat + T,
            load_scale=hertz + pull,
            load_slope_scale=stiffness * (a_k * slope_scale + zone_scale),
            displacement_slope_scale=slope_scale,
        )

    def amplitude(self, cohesive_width: float) -> float:
        """Return T, the displacement by which the traction lifts the surface at the contact, tilde."""
        punch = self.punch
        return float(self.maugis_number * (1.0 + punch.k) / punch.stiffness * cohesive_width ** (2.0 * punch.s))

    def opening(self, remainder: Array, opened: Array) -> Array:
        """Return the share of the amplitude in the excess e(x): (x^2-a^2)/L^2 = `opened`."""
        return opened

    def zone_share(self, remainder: Array) -> Array:
        """Return the traction of the cohesive zone over its largest value, at (c^2-r^2)/L^2 = `remainder`."""
        return np.asarray(remainder ** (1.0 - self.punch.s))

    def contact_share(self, inside: Array) -> Array:
        """Return the traction inside the contact over its largest value, at (a^2-r^2)/L^2 = `inside`."""
        power = 1.0 - self.punch.s
        with np.errstate(divide="ignore", over="ignore"):
            difference = inside**power * np.expm1(power * np.log1p(1.0 / inside))
        return np.where(inside > 0.5, difference, (1.0 + inside) ** power - inside**power)

    def _edge(self, w: Array, rule: UnitRule) -> EdgeIntegrals:
        """Return the integrals over the cohesive zone of this traction."""
        return double_hertz_integrals(self.punch, w, rule)


def double_hertz_integrals(punch: GradedPunch, w: Array, rule: UnitRule = FINE) -> EdgeIntegrals:
    """Return the integrals over the cohesive zone at log(a/L) = `w`, shape (m,).

    x^2 / c^2 = xi^2 = alpha^2 + theta^2 y with alpha = a/c, theta = L/c; d log(theta)/dw = -alpha^2 and
    d log(alpha)/dw = theta^2.  `shape` and `stress` are the two parts of the work of adhesion as in
    `comparisons.models.cohesive_contact.edge_integrals`; `edge` and `load` are the integrals of (x/c)^(k-1) and of
    (x/c)^(k-1) (1-y) over y.

    Examples
    --------
    >>> found = double_hertz_integrals(GradedPunch(2.0, 0.0), np.array([-np.inf]))     # a = 0
    >>> round(float(found.shape[0]), 12), round(float(found.load[0]), 12)              # 1/3 and 4/3
    (0.333333333333, 1.333333333333)
    """
    n, k, s, stiffness = punch.n, punch.k, punch.s, punch.stiffness
    log_alpha = -0.5 * np.logaddexp(0.0, -2.0 * w)
    log_theta = -0.5 * np.logaddexp(0.0, 2.0 * w)
    alpha2, theta2 = np.exp(2.0 * log_alpha), np.exp(2.0 * log_theta)
    # The integrands are singular at y = 0 if a = 0, where the rule has the accurate complement of its nodes.
    y, rest, weight = rule.complement, rule.z, rule.weight
    xi2 = alpha2[:, None] + theta2[:, None] * y
    q = alpha2[:, None] / xi2
    with np.errstate(divide="ignore"):
        log_q = np.where(q < 0.5, np.log(q), np.log1p(-theta2[:, None] * y / xi2))
    xi_k = xi2**-s
    # x^n - a^n in units of c^n.
    rise = (xi_k * -(xi2 ** (0.5 * n)) * np.expm1(0.5 * n * log_q)) @ weight
    plain, lower, upper = xi_k @ weight, (xi_k * y) @ weight, (xi_k * rest) @ weight
    # The derivative of the stress part, integrated by parts so that nothing cancels as k -> 1.
    bend = lower + 0.5 * theta2 * ((xi_k / xi2 * y * rest) @ weight)
    front = np.exp(2.0 * s * log_theta)
    shape_gain = (1.0 + k) * alpha2 * rise
    shape_loss = n * np.exp(n * log_alpha) * theta2 * plain
    return EdgeIntegrals(
        log_contact=log_alpha,
        log_width=log_theta,
        shape=0.5 * (1.0 + k) * front * rise,
        stress=0.25 * (1.0 + k) ** 2 / stiffness * front * lower,
        shape_slope=0.5 * (1.0 + k) * front * (shape_gain - shape_loss),
        stress_slope=-((1.0 + k) ** 2) * s / stiffness * front * alpha2 * bend,
        shape_slope_scale=0.5 * (1.0 + k) * front * (shape_gain + shape_loss),
        edge=plain,
        load=upper,
    )
