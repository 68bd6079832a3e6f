"""Common equations of JKR, DMT and Maugis-Dugdale: a power-law punch in contact with a power-law graded half-space.

The kernel of Eq. 6 is a product of two Abel kernels,

    G_k(r, t) = t (2/pi) cos(k pi/2) integral_0^min(r,t) x^k (r^2 - x^2)^(-(1+k)/2) (t^2 - x^2)^(-(1+k)/2) dx,

so that q(x) = integral_x^inf t p(t) (t^2 - x^2)^(-(1+k)/2) dt determines everything.  Lengths and loads are
the tilde variables of Eqs. 63-65, in which the surface deformation is 2 (1 - k) integral p G_k dt: they are
the barred variables (Eqs. 25-31) of a problem with mu = 1, and

    delta_bar = mu delta~,    a_bar = mu^(1/n) a~,    P_bar = mu^(2/n - 1) P~,    p_bar = p~ / mu.

In close contact up to the radius a, q = (delta - 1/2 B(n/2, (1+k)/2) x^n) / (2 (1 - k)) for x < a.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import beta

from comparisons.model import Array, Curve
from comparisons.problem import Problem


@dataclass(frozen=True, slots=True)
class Scales:
    """Factors from tilde to barred variables.

    Examples
    --------
    >>> GradedPunch(2.0, 0.0).scales(mu=4.0)
    Scales(displacement=4.0, radius=2.0, load=1.0, pressure=0.25)
    """

    displacement: float
    radius: float
    load: float
    pressure: float

    def curve(self, displacement: Array, load: Array, **radii: Array) -> Curve:
        """Return the curve of tilde variables, with columns of radii by their names."""
        columns = {name: self.radius * values for name, values in radii.items()}
        return Curve(self.displacement * displacement, self.load * load, columns)


@dataclass(frozen=True, slots=True)
class GradedPunch:
    """The constants of Eqs. 50-51 and 66-67 at shape index `n` and gradient exponent `k`.

    Every constant has its limit at k = 1: cos(k pi/2) / (1 - k) is written through sin(pi s) / (pi s).

    Examples
    --------
    >>> punch = GradedPunch(2.0, 0.0)
    >>> round(punch.flattening, 6), round(punch.stiffness, 6), round(punch.adhesion, 6)
    (1.0, 0.63662, 2.506628)
    """

    n: float
    k: float

    @classmethod
    def of(cls, problem: Problem) -> GradedPunch:
        """Return the constants of a problem."""
        return cls(float(problem.n), float(problem.k))

    @property
    def s(self) -> float:
        """(1 - k) / 2, the exponent of the edge field."""
        return 0.5 * (1.0 - self.k)

    @property
    def stiffness(self) -> float:
        """2 cos(k pi/2) / (pi (1 - k)); P = stiffness (1 + k)^-1 a^(1+k) delta for a flat punch."""
        return _sinc(self.s)

    @property
    def flattening(self) -> float:
        """1/2 B(n/2, (1+k)/2): the displacement is flattening a^n without adhesion."""
        return 0.5 * float(beta(0.5 * self.n, 0.5 * (1.0 + self.k)))

    @property
    def adhesion(self) -> float:
        """sqrt(2 pi (1 - k) / cos(k pi/2)): JKR subtracts adhesion a^s from the displacement (Eq. 50)."""
        return 2.0 / math.sqrt(self.stiffness)

    @property
    def hertz_load(self) -> float:
        """P without adhesion over a^(n+k+1) (first term of Eqs. 51 and 67)."""
        n, k = self.n, self.k
        return self.stiffness * self.flattening * n / ((1.0 + k) * (n + k + 1.0))

    def scales(self, mu: float) -> Scales:
        """Return the factors from tilde to barred variables at Tabor number `mu`."""
        return Scales(mu, mu ** (1.0 / self.n), mu ** (2.0 / self.n - 1.0), 1.0 / mu)


@lru_cache(maxsize=64)
def _sinc(s: float) -> float:
    """sin(pi s) / (pi s): a solution of the width of a cohesive zone asks for it thousands of times."""
    return float(np.sinc(s))
