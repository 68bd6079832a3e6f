"""Quadrature over the radii beyond a mesh, where the traction is a power of the radius."""

from __future__ import annotations

import math

import numpy as np

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._typing import Array
from fem_reference.interaction import Interaction

__all__ = ["far_rule"]

#: With r = R/t^s the integral of p(r) r dr is one of t^(s q - 1), p r ~ r^(-1 - q): s q is this number, so that q
#: points or more integrate it exactly, whatever q is.  With r = R/t alone, 24 points lost 2 % of the load for q = 0.2.
SMOOTH = 4.0

#: Farthest radius in units of R, to stay within the range of numbers: the integrand is a power of t beyond.
FARTHEST = 1e30


def far_rule(count: int, force: Interaction, R: float, unit: float = 1.0, least: float = 0.0) -> tuple[Array, Array]:
    """Radii r > R and weights of dr for integrals of p(r) r, shapes (count,).

    Parameters
    ----------
    count : int
    force : Interaction
        p(r) ~ r^-q, with the q at R.  (Where that is slow, it may be another one far away.)
    R : float
        Where the mesh ends, in units of `unit`.
    unit : float
        Of R, in that of the force.
    least : float
        Smallest s.

    Examples
    --------
    >>> from fem_reference import Mie, PowerPunch
    >>> from fem_reference.interaction import Derjaguin
    >>> punch, law = PowerPunch(2.0, 1.0), Mie(1.0, 1.0, m=9.0, n=1.1)
    >>> r, w = far_rule(24, Derjaguin(punch, law), 1e6)
    >>> load = float((w * r) @ law.traction(punch.height(r)))
    >>> load / (5.0 * 1e12 * float(law.traction(punch.height(1e6))))      # R^2 p(R)/(m g - 2)
    1.0000...
    """
    t, w = unit_gauss(count)
    q = force.fall(unit * R) - 2.0
    if q < 1.0:
        q = force.fall(unit * R * FARTHEST) - 2.0
    s = max(least, SMOOTH / q) if math.isfinite(q) else max(least, 1.0)
    rise = -s * np.log(t)
    near = np.minimum(rise, math.log(FARTHEST))
    r = R * np.exp(near)
    return r, w * s / t * r * np.exp(-q * (rise - near) if math.isfinite(q) else 0.0 * t)
