"""Pressure and gap of a contact with a cohesive zone along the radius.

Inverting the Abel transform of `cohesive_contact`, the pressure inside the contact (r < a) is Hertz's for the
radius a minus a share of the cohesive stress that rises from the inside to 1 at the edge,

    p(r) = (stiffness / 2) n D(1) integral_r^a x^(n-1) (x^2 - r^2)^(-s) dx - Lambda share(r),
    share(r) = u^(-d) I_u(p, 1-s),    u = (c^2 - a^2) / (c^2 - r^2),

with the regularised incomplete beta function I (Maugis-Dugdale at k = 0: (2/pi) arcsin sqrt(u)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.model import FARTHEST_GAP, Array, NotApplicable, RadialField
from comparisons.models.cohesive_contact import CohesiveContact, ContactState
from comparisons.models.graded_punch import Scales
from comparisons.models.quadrature import FINE

#: Bound on the error of pressure and gap as a fraction of their ranges: measured worst 1.2e-13 against 25 digits.
PROFILE_ROUNDING = 1e-12

#: The profiles end beyond this many cohesive radii and beyond this gap, in z0.
_FARTHEST = 3.0
#: The radius nearest to the axis, over c: a cone on a homogeneous half-space has infinite pressure at r = 0.
_NEAREST = 1e-6
#: Still two different numbers after the change of units.
_BELOW_EDGE = 1e-15
#: The square of L / c must not underflow.
_NARROWEST = 1e-150


@dataclass(frozen=True, slots=True, kw_only=True)
class CohesiveProfiles(RadialField):
    """The surface beyond three times c and a gap of 10; its radii are denser towards a and c on both sides.

    The pressure jumps at c, where two radii are 1e-15 apart; the gap is 0 inside a.

    Attributes
    ----------
    contact_radius, cohesive_radius : float
        a and c, in (Q z0)^(1/n).
    displacement : float
        delta in z0.
    """

    contact_radius: float
    cohesive_radius: float
    displacement: float


def pressure(contact: CohesiveContact, state: ContactState, r: Array) -> Array:
    """p(r) in tilde variables, shape of `r` (1-D, > 0), for a state of one element.

    Examples
    --------
    >>> from comparisons.models.graded_punch import GradedPunch
    >>> contact = CohesiveContact(GradedPunch(2.0, 0.0), 1.0)
    >>> state = contact.at(np.array([0.0]))
    >>> edge = 0.5 * (state.contact_radius + state.cohesive_radius)
    >>> pressure(contact, state, edge).tolist()                     # the cohesive stress
    [-1.0]
    """
    punch = contact.punch
    n, s = punch.n, punch.s
    a, c, L = _radii(state)
    zone = np.maximum((c - r) * (c + r), 0.0) / L**2
    p = np.where(r < c, -contact.maugis_number * np.minimum(zone, 1.0) ** contact.decay, 0.0)
    inside = r < a
    if not np.any(inside):
        return p
    ri = r[inside]
    rise = (a - ri) * (a + ri)
    x2 = ri[:, None] ** 2 + rise[:, None] * FINE.complement
    hertz = 0.5 * rise ** (1.0 - s) * ((x2 ** (0.5 * n - 1.0) * FINE.complement**-s) @ FINE.weight)
    share = contact.contact_share(rise / L**2)
    p[inside] = 0.5 * punch.stiffness * n * punch.flattening * hertz - contact.maugis_number * share
    return p


def gap(contact: CohesiveContact, state: ContactState, r: Array) -> Array:
    """H(r) in tilde variables, shape of `r` (1-D, > 0), for a state of one element.

    The integral of `cohesive_contact` is taken over (a, min(r, c)) and (c, r), each in y with x^2 linear in y
    and 1 - y = z^(1/s), which makes the kernel (r^2 - x^2)^(s-1) regular where it is singular.

    Examples
    --------
    >>> from comparisons.models.graded_punch import GradedPunch
    >>> contact = CohesiveContact(GradedPunch(2.0, 0.0), 1.0)
    >>> state = contact.at(np.array([0.0]))
    >>> gap(contact, state, state.cohesive_radius).round(12).tolist()       # Griffith: H(c) = 1 / Lambda
    [1.0]
    """
    a, c, L = _radii(state)
    n = contact.punch.n
    H = np.zeros_like(r)
    for i in np.nonzero(r > a)[0]:
        ri = float(r[i])
        if contact.punch.s == 0.0:
            # Independent springs: the deformation is 2 p(r).
            opened = np.minimum(np.array([(ri - a) * (ri + a) / L**2]), 1.0)
            share = 1.0 if ri >= c else float(contact.opening(1.0 - opened, opened)[0])
            H[i] = (ri**n - a**n) / n + contact.amplitude(L) * share
        else:
            H[i] = _gap_part(contact, state, a, min(ri, c), ri)
            if ri > c:
                H[i] += _gap_part(contact, state, c, ri, ri)
    return H


def cohesive_profiles(contact: CohesiveContact, state: ContactState, scale: Scales, points: int) -> CohesiveProfiles:
    """Return the profiles of a state of one element, in barred variables.

    There are `points` radii each inside the contact, in the cohesive zone and beyond it.

    Raises
    ------
    NotApplicable
        If the cohesive zone is so narrow that its width underflows.

    Examples
    --------
    >>> from comparisons.models.graded_punch import GradedPunch
    >>> contact = CohesiveContact(GradedPunch(2.0, 0.0), 1.0)
    >>> state = contact.at(np.array([0.0]))
    >>> surface = cohesive_profiles(contact, state, contact.punch.scales(mu=1.0), points=20)
    >>> float(surface.pressure.min()), bool(surface.gap[surface.radius < surface.contact_radius].max() == 0.0)
    (-1.0, True)
    """
    a, c, L = _radii(state)
    if L / c < _NARROWEST:
        raise NotApplicable(
            f"the cohesive zone of radius {c:.6g} has a width below {_NARROWEST} of it: the edge is JKR's"
        )
    dense = np.sin(np.linspace(0.0, 0.5 * np.pi, points))
    both = np.sin(np.linspace(0.0, 0.5 * np.pi, points)) ** 2
    inside = _NEAREST * c + (a - _NEAREST * c) * dense if a > _NEAREST * c else np.array([_NEAREST * c])
    # H = r^n/n - delta + w, and the traction lifts the surface by less than the amplitude.
    n, height = contact.punch.n, FARTHEST_GAP / scale.displacement + abs(float(state.displacement[0]))
    end = max(_FARTHEST * c, float((n * (height + contact.amplitude(L))) ** (1.0 / n)))
    beyond = c + (end - c) * (1.0 - dense[::-1])
    r = np.unique(np.concatenate((inside, a + (c - a) * both, [c * (1.0 - _BELOW_EDGE)], beyond)))
    r = r[r > 0.0]
    return CohesiveProfiles(
        contact_radius=scale.radius * a,
        cohesive_radius=scale.radius * c,
        displacement=scale.displacement * float(state.displacement[0]),
        radius=scale.radius * r,
        pressure=scale.pressure * pressure(contact, state, r),
        gap=scale.displacement * gap(contact, state, r),
        u_distance=PROFILE_ROUNDING,
        u_gap_distance=PROFILE_ROUNDING,
    )


def _radii(state: ContactState) -> tuple[float, float, float]:
    """Return a, c and L of a state of one element."""
    return float(state.contact_radius[0]), float(state.cohesive_radius[0]), float(state.cohesive_width[0])


def _gap_part(contact: CohesiveContact, state: ContactState, start: float, end: float, r: float) -> float:
    """Return the part of H(r) from start < x < end (a or c, r or c)."""
    punch = contact.punch
    n, s = punch.n, punch.s
    a, c, L = _radii(state)
    width = L if (start, end) == (a, c) else float(np.sqrt((end - start) * (end + start)))
    log_remainder = FINE.log_z / s
    remainder, y = np.exp(log_remainder), -np.expm1(log_remainder)
    x2 = start**2 + width**2 * y
    lift = np.full_like(y, contact.amplitude(L))
    if start < c:
        share = (width / L) ** 2
        lift *= contact.opening((c - end) * (c + end) / L**2 + share * remainder, share * y)
    excess = punch.flattening * (x2 ** (0.5 * n) - a**n) + lift
    beyond = (r - end) * (r + end) / width**2
    kernel = (remainder / (beyond + remainder)) ** (1.0 - s) if beyond > 0.0 else 1.0
    return float(punch.stiffness * width ** (2.0 * s) * ((kernel * x2**-s * excess) @ FINE.weight))
