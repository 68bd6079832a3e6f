"""Displacement at the center by the pressure far away from it, from the closed compliance of a layer on a substrate.

Nothing of `fscm` is used.  With c(xi) of `tests.solvers.layered_jkr`, a ring of unit pressure at t lifts the center by
1 + t int (c - 1) J0(xi t) d(xi), in units of that of a homogeneous solid.  The attraction A (H + 1)^-n of the law of
Mie on a sphere r^2/2 at the displacement delta is A 2^n (t^2 + a^2)^-n, a^2 = 2 (1 - delta), whose Hankel transform is

    int_0^oo t (t^2 + a^2)^-n J0(xi t) dt = (xi/a)^(n-1) K_(n-1)(a xi) / (2^(n-1) Gamma(n)),

so that what all of it lifts is one integral over xi, and what lies beyond T is the rest of that by t < T.
"""

import numpy as np
from scipy.special import gamma, j0, kv

from tests.solvers.layered_jkr import FAR_DECAY, Stack

_X, _W = np.polynomial.legendre.leggauss(24)


class Stiff:
    """A stiff layer, 1000 times as stiff as its substrate and about as thick as the mesh is long."""

    thickness = 2e3
    solid = ([1.0, 1e-3], [0.3, 0.3], [thickness])
    stack = Stack(((1.0, 0.3, thickness),), (1e-3, 0.3))


def _rule(ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    half = 0.5 * np.diff(ends)
    return ((ends[:-1] + half)[:, None] + half[:, None] * _X).ravel(), (half[:, None] * _W).ravel()


def response_at_center(t: float) -> float:
    """G(0, t) of the stiff layer."""
    top = FAR_DECAY / Stiff.thickness
    first = min(1.0 / t, top)
    ends = np.concatenate([first * 0.5 ** np.arange(60.0, 0.0, -1.0), np.arange(first, top, np.pi / t), [top]])
    xi, weight = _rule(np.append(0.0, ends))
    return 1.0 + t * float(weight @ ((Stiff.stack.relative_compliance(xi) - 1.0) * j0(xi * t)))


def lifted_from_beyond(T: float, displacement: float, m: float, n: float, compliance: float) -> float:
    """Displacement of the center by the attraction of Mie's law beyond T, in z0; the repulsion is nothing there."""
    A, a = (m - 1.0) * (n - 1.0) / (m - n), np.sqrt(2.0 * (1.0 - displacement))
    xi, weight = _rule(np.append(0.0, 2.0 ** np.arange(-60.0, 6.0)))
    transform = (xi / a) ** (n - 1.0) * kv(n - 1.0, a * xi) / (2.0 ** (n - 1.0) * gamma(n))
    everything = float(weight @ (Stiff.stack.relative_compliance(xi) * transform))
    t, dt = _rule(np.append(0.0, T * 2.0 ** np.arange(-14.0, 1.0)))
    rings = np.array([response_at_center(float(radius)) for radius in t])
    return -compliance * A * 2.0**n * (everything - float(dt @ ((t * t + a * a) ** -n * rings)))
