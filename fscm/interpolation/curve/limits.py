r"""Limits of the model: JKR-n-k for large Tabor numbers, a rigid punch on a rigid solid for small ones.

With D = B(n/2, (1+k)/2) / 2, S = 2 cos(k pi/2) / (pi (1-k)), s = (1-k)/2, K = 2 / S^(1/2), radii in mu^(1/n) and loads
in mu^(2/n-1), the contact of JKR has (Eqs. 50-51)

    delta = mu (D a^n - K a^s),    P = S / (1+k) (n / (n+k+1) D a^(n+k+1) - K a^(s+k+1)).

An event is one value of theta in n D a^(n-s) = theta K: s at jump-out, s + k + 1 at pull-off, n + k + 1 at zero load.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fscm._typing import Array
from fscm.interpolation.curve.pieces import CONTACT_GAP, LARGEST_LOAD, Numbers, States, load_unit, rigid_load

__all__ = ["JKR_QUANTITIES", "jkr_approach", "jkr_contact", "jkr_value", "rigid_curve"]

#: Share of the pull-off force up to which surfaces before contact are as good as rigid.
_WEAK = 0.1
#: Quantities that JKR has.
JKR_QUANTITIES = ("pull_off_force", "pull_off_displacement", "zero_load_displacement", "jump_out_displacement")


class _Constants(NamedTuple):
    flattening: Numbers
    stiffness: Numbers
    adhesion: Numbers
    s: Numbers

    @classmethod
    def of(cls, n: Numbers, k: Numbers) -> _Constants:
        # A tenth of a second to import.
        from scipy.special import gamma

        s = 0.5 * (1.0 - k)
        beta = gamma(0.5 * n) * gamma(0.5 * (1.0 + k)) / gamma(0.5 * (n + 1.0 + k))
        stiffness = np.sinc(s)
        return cls(0.5 * beta, stiffness, 2.0 / stiffness**0.5, s)

    def radius(self, n: Numbers, theta: Numbers) -> Numbers:
        """Radius of an event in mu^(1/n)."""
        return (theta * self.adhesion / (n * self.flattening)) ** (1.0 / (n - self.s))


def _load(c: _Constants, n: Numbers, k: Numbers, a: Numbers) -> Numbers:
    hertz = n / (n + k + 1.0) * c.flattening * a ** (n + k + 1.0)
    return c.stiffness / (1.0 + k) * (hertz - c.adhesion * a ** (c.s + k + 1.0))


def jkr_value(n: Numbers, k: Numbers, mu: Numbers, quantity: str) -> Numbers:
    """A quantity of JKR, one of `JKR_QUANTITIES`.

    Examples
    --------
    >>> float(jkr_value(np.array(2.0), np.array(0.0), np.array(20.0), "pull_off_force").round(12))
    1.5
    """
    c = _Constants.of(n, k)
    if quantity == "pull_off_force":
        return -(mu ** (2.0 / n - 1.0)) * _load(c, n, k, c.radius(n, c.s + k + 1.0))
    theta = {
        "pull_off_displacement": c.s + k + 1.0,
        "zero_load_displacement": n + k + 1.0,
        "jump_out_displacement": c.s,
    }[quantity]
    return mu * c.adhesion * c.radius(n, theta) ** c.s * (theta / n - 1.0)


def jkr_approach(n: Numbers, k: Numbers, mu: Numbers, position: Array) -> States:
    """States before contact, which is at zero displacement: they attract each other as rigid ones, up to a share.

    Parameters
    ----------
    n, k, mu : ndarray, shape (m, 1)
    position : ndarray, shape (p,)
        From -1 to 1.
    """
    weak = _WEAK * np.real(jkr_value(n, k, mu, "pull_off_force"))
    nearest, farthest = np.zeros_like(weak), 10.0 + 5.0 * np.real(mu)
    high = farthest.copy()
    for _ in range(60):
        middle = 0.5 * (nearest + high)
        strong = np.real(rigid_load(np.real(n), middle)) < -weak
        nearest, high = np.where(strong, middle, nearest), np.where(strong, high, middle)
    share = 0.5 * (position + 1.0)
    gap = (1.0 + farthest) * ((1.0 + high) / (1.0 + farthest)) ** share - 1.0
    gap = gap + np.zeros_like(mu)
    return States(-gap, rigid_load(n, gap), np.zeros_like(gap))


def jkr_contact(n: Numbers, k: Numbers, mu: Numbers, position: Array, compression: bool) -> States:
    """States in contact, from the radius zero to the load L, or from there to `LARGEST_LOAD`; shapes as before."""
    c, unit = _Constants.of(n, k), mu ** (2.0 / n - 1.0)
    real = [np.real(x) for x in (n, k, mu)]
    scale = np.real(load_unit(n, mu))
    ends = [_radius_of(load, *real) for load in (scale, np.full_like(scale, LARGEST_LOAD))]
    share = 0.5 * (position + 1.0)
    a = ends[0] * (ends[1] / ends[0]) ** share if compression else ends[0] * share**2
    a = a + np.zeros_like(mu)
    displacement = mu * (c.flattening * a**n - c.adhesion * a**c.s)
    return States(displacement, unit * _load(c, n, k, a), mu ** (1.0 / n) * a)


def _radius_of(load: Array, n: Array, k: Array, mu: Array) -> Array:
    """Radius at which JKR has a compressive load, in mu^(1/n)."""
    c, unit = _Constants.of(n, k), mu ** (2.0 / n - 1.0)
    low = c.radius(n, n + k + 1.0)
    high = low + ((1.0 + k) * (n + k + 1.0) * load / unit / (c.stiffness * n * c.flattening)) ** (1.0 / (n + k + 1.0))
    high = high * 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = unit * _load(c, n, k, middle) < load
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return low


def rigid_curve(n: float, count: int) -> States:
    """States of rigid bodies from the central gap 10 to `LARGEST_LOAD`."""
    shape, low, high = np.array(n), -1.0, 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if float(rigid_load(shape, np.array(middle))) < LARGEST_LOAD else (middle, high)
    gap = np.geomspace(11.0, 1.0 + high, count) - 1.0
    radius = (n * np.maximum(CONTACT_GAP - gap, 0.0)) ** (1.0 / n)
    return States(-gap, np.real(rigid_load(shape, gap)), radius)
