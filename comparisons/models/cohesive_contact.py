"""The contact of a power-law punch and a graded half-space with a cohesive zone, without cancellation (Eqs. 66-72).

In the tilde variables of `graded_punch`, with D(x) = 1/2 B(n/2, (1+k)/2) x^n, s = (1-k)/2, L^2 = c^2 - a^2 and
v(x) = (c^2 - x^2) / L^2, the traction of the zone a < r < c is Lambda v(r)^d: constant for d = 0 (Maugis-Dugdale), for
d = (1+k)/2 the difference of the Hertz pressures of one paraboloid at the radii c and a (double Hertz: Greenwood &
Johnson 1998).  With p = s + d and the amplitude

    T = Lambda lift L^(2s),    lift = 2 Gamma(1+d) Gamma(1+s) / Gamma(1+p)    (2 for d = 0),

the Abel transform q of the pressure is (delta - D(x)) / (4 s) for x < a and -T v(x)^p / (4 s) for a < x < c.  A finite
stress at a makes q continuous, which is Eq. 66,

    delta = D(a) - T,

the load is the integral of q,

    P = Hertz(a) - stiffness T [ a^(1+k) / (1+k) + integral_a^c x^k v(x)^p dx ],

and the gap outside the contact follows from what q has in excess of its continuation from r < a,

    H(r) = (2/pi) cos(k pi/2) integral_a^r x^k (r^2 - x^2)^(s-1) e(x) dx,    e(x) = D(x) - D(a) + T (1 - v(x)^p).

The traction does the work of adhesion on the gap.  Both are Abel transforms; with their order changed, and z = v^p,
x = c xi, theta = L / c, this is

    integral_a^c sigma dH = Lambda (stiffness lift / 2) theta^(2s) integral_0^1 xi^(k-1) e dz = 1,

for d = 0 Griffith's relation Lambda H(c) = 1 (Eq. 69).  The integrand is positive, so nothing cancels where the
hypergeometric form of Eqs. 69-72 does: at m = c/a -> 1, at large m, and where an argument is near 1.  The integral
splits into a part ~ c^n and a part ~ Lambda c^(2s) whose coefficients depend on the shape of the edge alone.  The
contact is therefore followed by that shape, w = log(a / L): every w has one contact, a grows with w from 0 (DMT's end
point) without bound, and L / a -> 0 is JKR.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import betainc

from comparisons.model import Array, ComputationFailed
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.quadrature import COARSE, FINE, UnitRule

#: Most Newton steps.
_NEWTON_STEPS = 60
#: Newton on a convex increasing function from its right-hand side stops where rounding stops it; the sum of
#: the two parts of Griffith's relation is then 1 to a few rounding errors times the size of its logarithms.
_GRIFFITH_TOLERANCE = 1e-14


@dataclass(frozen=True, slots=True)
class EdgeIntegrals:
    """Integrals over the cohesive zone in units of c, functions of n, k, d and w = log(a/L) only; shape (m,).

    Attributes
    ----------
    log_contact, log_width : ndarray
        log(a / c) and log(L / c).
    shape, stress : ndarray
        The parts of the work of adhesion over Lambda from the profile and from the stress: coefficients of D(c) and T.
    shape_slope, stress_slope : ndarray
        Their derivatives with respect to w.
    shape_slope_scale : ndarray
        Sum of the magnitudes of the terms of `shape_slope`, which cancel for n > 2 as a -> 0.
    edge : ndarray
        integral of xi^(k-1) over z, which carries the load of a shift of c.
    load : ndarray
        integral of xi^(k-1) v^p over 1 - v, the load of the cohesive zone.
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
    """The contacts of one punch with one traction.

    Parameters
    ----------
    punch : GradedPunch
        Shape index and gradient exponent.
    maugis_number : float
        Lambda = sigma_0 mu (Eq. 68) of the largest traction sigma_0 in dgamma / z0; below 1 if k = 1 (there
        Lambda >= 1 is JKR itself).
    decay : float
        d, how fast the traction decays from a to c; 0 or more, dimensionless.

    Examples
    --------
    >>> state = CohesiveContact(GradedPunch(2.0, 0.0), 1e-6).at(np.array([-np.inf]))
    >>> round(float(state.load[0]), 5)  # DMT: 2 pi times the work of adhesion times the radius
    -2.0
    """

    punch: GradedPunch
    maugis_number: float
    decay: float = 0.0

    @property
    def exponent(self) -> float:
        """The exponent p of v in the Abel transform of the traction."""
        return self.punch.s + self.decay

    @property
    def lift(self) -> float:
        """T / (Lambda L^(2s))."""
        ratio = math.gamma(1.0 + self.punch.s) / math.gamma(1.0 + self.exponent)
        return 2.0 * math.gamma(1.0 + self.decay) * ratio

    def at(self, w: Array, rule: UnitRule = FINE) -> ContactState:
        """Return the states with log(a/L) = `w`, shape (m,); -inf is the point of first contact.

        Raises
        ------
        ComputationFailed
            If Griffith's relation was not solved.
        """
        n, k, s, stiffness = self.punch.n, self.punch.k, self.punch.s, self.punch.stiffness
        edge = self.edge_integrals(w, rule)
        log_c = self._griffith(edge)
        growth, growth_scale = self._cohesive_growth(edge, log_c)
        log_a, log_L = log_c + edge.log_contact, log_c + edge.log_width
        a, c = np.exp(log_a), np.exp(log_c)
        alpha2, theta2 = np.exp(2.0 * edge.log_contact), np.exp(2.0 * edge.log_width)
        T = self.lift * self.maugis_number * np.exp(2.0 * s * log_L)
        a_k, c_k = a ** (k + 1.0) / (k + 1.0), c ** (k + 1.0)
        flat = self.punch.flattening * np.exp(n * log_a)
        hertz = self.punch.hertz_load * a ** (n + k + 1.0)
        zone = 0.5 * T * theta2 * c_k * edge.load
        pull = stiffness * (T * a_k + zone)
        displacement_slope = n * flat * (growth + theta2) - 2.0 * s * T * (growth - alpha2)
        displacement_slope_scale = n * flat * (growth_scale + theta2) + 2.0 * s * T * (growth_scale + alpha2)
        # The traction at a radius falls while L grows, and it moves outwards with c.
        weaker, shift = 2.0 * self.decay * zone, T * c_k * edge.edge
        load_slope = a_k * displacement_slope + weaker * (growth - alpha2) - shift * growth
        load_slope_scale = a_k * displacement_slope_scale + weaker * (growth_scale + alpha2) + shift * growth_scale
        return ContactState(
            contact_radius=a,
            cohesive_radius=c,
            cohesive_width=np.exp(log_L),
            displacement=flat - T,
            load=hertz - pull,
            displacement_slope=displacement_slope,
            load_slope=stiffness * load_slope,
            displacement_scale=flat + T,
            load_scale=hertz + pull,
            load_slope_scale=stiffness * load_slope_scale,
            displacement_slope_scale=displacement_slope_scale,
        )

    def log_contact_radius(self, w: float) -> float:
        """Return log(a) at log(a/L) = `w`, finite where a itself would overflow."""
        edge = self.edge_integrals(np.array([w]), COARSE)
        return float(self._griffith(edge)[0] + edge.log_contact[0])

    def amplitude(self, cohesive_width: float) -> float:
        """Return the displacement T by which the traction lifts the surface at the contact, tilde."""
        return float(self.lift * self.maugis_number * cohesive_width ** (2.0 * self.punch.s))

    def opening(self, remainder: Array, opened: Array) -> Array:
        """Return the share of the amplitude in e(x): 1 - v^p at v = `remainder` = 1 - `opened`.

        Each of the two numbers is accurate where it is small.
        """
        with np.errstate(divide="ignore"):
            log_v = np.where(remainder < 0.5, np.log(remainder), np.log1p(-np.minimum(opened, 0.75)))
        return np.asarray(-np.expm1(self.exponent * log_v))

    def contact_share(self, inside: Array) -> Array:
        """Return the traction inside the contact over its largest value, at (a^2-r^2)/L^2 = `inside`."""
        s, p = self.punch.s, self.exponent
        beta = betainc(p, 1.0 - s, 1.0 / (1.0 + inside)) if p > 0.0 else np.ones_like(inside)
        return np.asarray((1.0 + inside) ** self.decay * beta)

    def edge_integrals(self, w: Array, rule: UnitRule = FINE) -> EdgeIntegrals:
        """Return the integrals over the cohesive zone at log(a/L) = `w`, shape (m,).

        xi^2 = alpha^2 + theta^2 y with alpha = a/c, theta = L/c and y = 1 - v = 1 - z^(1/p); the slopes use
        d(xi^2)/dw = 2 alpha^2 theta^2 (1 - y), d log(theta)/dw = -alpha^2 and d log(alpha)/dw = theta^2.

        Examples
        --------
        >>> integrals = CohesiveContact(GradedPunch(2.0, 0.0), 1.0).edge_integrals(np.array([0.0]))   # a = L
        >>> round(float(np.exp(integrals.log_contact[0])), 6), round(float(np.exp(integrals.log_width[0])), 6)
        (0.707107, 0.707107)
        """
        n, s, p = self.punch.n, self.punch.s, self.exponent
        log_alpha = -0.5 * np.logaddexp(0.0, -2.0 * w)
        log_theta = -0.5 * np.logaddexp(0.0, 2.0 * w)
        alpha2, theta2 = np.exp(2.0 * log_alpha), np.exp(2.0 * log_theta)
        weight = rule.weight
        log_remainder = rule.log_z / p if p > 0.0 else np.full_like(rule.log_z, -np.inf)
        remainder, y = np.exp(log_remainder), -np.expm1(log_remainder)
        xi2 = alpha2[:, None] + theta2[:, None] * y
        q = alpha2[:, None] / xi2
        with np.errstate(divide="ignore"):
            log_q = np.where(q < 0.5, np.log(q), np.log1p(-theta2[:, None] * y / xi2))
        xi_k = xi2**-s
        rise = xi2 ** (0.5 * n)
        excess = -rise * np.expm1(0.5 * n * log_q)
        alpha_n = np.exp(n * log_alpha)[:, None]
        half_lift = 0.5 * self.lift
        front = half_lift * self.punch.stiffness * np.exp(2.0 * s * log_theta)
        # The slopes are those of front * integral; d log(front)/dw = -2 s alpha^2 sits in their first term.
        drift = -2.0 * s * (alpha2[:, None] + theta2[:, None] * q * remainder)
        gain, loss = n * theta2[:, None] * (rise * q * remainder), drift * excess - n * theta2[:, None] * alpha_n
        # The stress coefficient multiplies T ~ theta^(2s) once more.
        stress_drift = drift - 2.0 * s * alpha2[:, None]
        xi_load = (alpha2[:, None] + theta2[:, None] * rule.complement) ** -s
        return EdgeIntegrals(
            log_contact=log_alpha,
            log_width=log_theta,
            shape=front * ((xi_k * excess) @ weight),
            stress=half_lift * front * ((xi_k * rule.complement) @ weight),
            shape_slope=front * ((xi_k * (gain + loss)) @ weight),
            stress_slope=half_lift * front * ((xi_k * rule.complement * stress_drift) @ weight),
            shape_slope_scale=front * ((xi_k * (gain - loss)) @ weight),
            edge=xi_k @ weight,
            load=(xi_load * rule.z**p) @ weight,
        )

    def _griffith(self, edge: EdgeIntegrals) -> Array:
        """Solve Griffith's relation for log(c); shape (m,)."""
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
            total, slope = shape + stress, n * shape + 2.0 * s * stress
            step = np.log(total) * total / slope
            log_c = log_c - step
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
