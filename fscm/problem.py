"""Dimensionless problem: punch, graded half-space and surface law (Eqs. 24-31).

Lengths normal to the surface are in z0, radii in (Q z0)^(1/n), tractions in dgamma / z0.  Tension is
negative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from fscm._validation import real_number
from fscm.laws import LennardJones93, SurfaceLaw
from fscm.punch import PowerPunch, PunchShape

__all__ = ["Problem"]

# m * growth has to exceed this for the load integral of p ~ r^(-m growth) times r dr to converge.
_LOAD_INTEGRAL = 2.0

# The surface of a steeper punch rises by the largest double within a few contact radii: 10^300 overflows nearly.
_LARGEST_N = 300.0

# Range of M = 2 mu^((2n+k-1)/n).  Below, the solid is rigid to every digit of a double, with fourteen more to spare;
# above, the cohesive edge, of a relative width 1 / M or less, is as narrow as the rounding of a radius.
_LEAST_M, _LARGEST_M = 1e-30, 1e15


@dataclass(frozen=True, slots=True, init=False)
class Problem:
    """Adhesive contact of a rigid punch with a power-law graded half-space, dimensionless.

    Immutable, hashable, and picklable when its punch and law are.

    Parameters
    ----------
    n : float
        Shape index of the punch, 0 < n <= 300; it also enters the definition of `mu` (Eq. 29), which needs
        2n + k > 1.
    k : float
        Gradient exponent of E = E0 (z/c0)^k, 0 <= k <= 1 (k = 1, the Gibson solid, is `fscm.gibson`).
    mu : float
        Generalised Tabor number (Eq. 29), > 0 and such that 1e-30 <= M <= 1e15 (see `compliance`).
    punch : PunchShape, optional
        Punch shape; the power law r^n / n by default.
    law : SurfaceLaw, optional
        Surface law; Lennard-Jones 9-3 by default.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    >>> Problem(n=2, k=0.4, mu=1.0).compliance
    2.0
    """

    n: float
    k: float
    mu: float
    punch: PunchShape
    law: SurfaceLaw

    def __init__(
        self, n: float, k: float, mu: float, punch: PunchShape | None = None, law: SurfaceLaw | None = None
    ) -> None:
        inf = math.inf
        n = real_number("shape index n", n, low=0.0, high=inf, reason="f = r^n / n must grow with r")
        k = real_number(
            "gradient exponent k",
            k,
            low=0.0,
            high=1.0,
            reason="E = E0 (z/c0)^k has no finite surface response there",
            closed_low=True,
            closed_high=True,
        )
        mu = real_number("Tabor number mu", mu, low=0.0, high=inf, reason="it is a positive ratio of lengths")
        if 2.0 * n + k <= 1.0:
            raise ValueError(
                f"shape index n = {n:g} is outside ({(1.0 - k) / 2.0:g}, inf) for k = {k:g}: "
                "the Tabor number of Eq. 29 is a power 1 / (2n + k - 1)"
            )
        if n > _LARGEST_N:
            raise ValueError(
                f"shape index n = {n:g} is outside (0, {_LARGEST_N:g}]: f = r^n / n overflows near the contact"
            )
        # By logarithms: the power itself may overflow.
        log_M = math.log(2.0) + (2.0 * n + k - 1.0) / n * math.log(mu)
        if not math.log(_LEAST_M) <= log_M <= math.log(_LARGEST_M):
            raise ValueError(
                f"Tabor number mu = {mu:g} gives M = 2 mu^((2n+k-1)/n) = 10^{log_M / math.log(10.0):.0f}, outside "
                f"[{_LEAST_M:g}, {_LARGEST_M:g}]: the solid is rigid, or its cohesive edge a point, to all digits"
            )
        punch = PowerPunch(n) if punch is None else punch
        law = LennardJones93() if law is None else law
        if not isinstance(punch, PunchShape):
            raise ValueError(f"punch = {punch!r} is not a punch shape: it needs growth, height(r) and slope(r)")
        if not isinstance(law, SurfaceLaw):
            raise ValueError(
                f"law = {law!r} is not a surface law: it needs traction, slope, curvature and energy "
                "of the gap and singular_gap, peak_gap and decay"
            )
        if isinstance(punch, PowerPunch) and punch.n != n:
            raise ValueError(
                f"punch = {punch!r} does not fit n = {n:g}: a power-law punch has one shape index, "
                "the one in the scale (Q z0)^(1/n) of its radii"
            )
        C, m = law.decay
        if C != 0.0 and not m * punch.growth > _LOAD_INTEGRAL:
            raise ValueError(
                f"growth f ~ r^{punch.growth:g} of the punch is outside ({_LOAD_INTEGRAL / m:g}, inf): "
                f"with p ~ H^-{m:g} far away, the load integral of p r dr diverges at infinity"
            )
        # The generated __setattr__ of a frozen class refuses; writing through object is its own idiom.
        for name, value in (("n", n), ("k", k), ("mu", mu), ("punch", punch), ("law", law)):
            object.__setattr__(self, name, value)

    @property
    def response(self) -> Any:
        """What distinguishes the solid from a power law (`fscm.graded.GradedProblem`): None."""
        return None

    @property
    def largest_mu(self) -> float:
        """The Tabor number of the softest part of the solid: that of a power law is the only one."""
        return self.mu

    @property
    def compliance(self) -> float:
        """M = 2 mu^((2n+k-1)/n), the factor of the surface deformation in Eq. 28."""
        return 2.0 * self.mu ** ((2.0 * self.n + self.k - 1.0) / self.n)
