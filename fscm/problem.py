"""The problem as pure data: what is pressed on what, dimensionless (Eqs. 24-31).

Lengths normal to the surface are in z0, radii in (Q z0)^(1/n), tractions in dgamma / z0.  Tension is negative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fscm.profile import PowerLaw, Profile
from fscm.surface_law import LennardJones93, SurfaceLaw

__all__ = ["Problem"]


@dataclass(frozen=True, slots=True)
class Problem:
    """Adhesive contact of a rigid punch with a power-law graded half-space, dimensionless.

    Parameters
    ----------
    n : float
        Shape index of the punch, > 0; it also enters the definition of `mu` (Eq. 29).
    k : float
        Gradient exponent of E = E0 (z/c0)^k, 0 <= k < 1 (k = 1, the Gibson solid, is `fscm.gibson`).
    mu : float
        Generalised Tabor number (Eq. 29), > 0.
    profile : Profile, optional
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
    profile: Profile = None  # type: ignore[assignment]
    law: SurfaceLaw = field(default_factory=LennardJones93)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.n) and self.n > 0):
            raise ValueError(f"shape index n = {self.n} is outside (0, infinity): f = r^n / n must grow with r")
        if not 0 <= self.k <= 1:
            raise ValueError(f"gradient exponent k = {self.k} is outside [0, 1]: E = E0 (z/c0)^k has no finite surface response there")
        if not (math.isfinite(self.mu) and self.mu > 0):
            raise ValueError(f"Tabor number mu = {self.mu} is outside (0, infinity)")
        if self.profile is None:
            object.__setattr__(self, "profile", PowerLaw(float(self.n)))

    @property
    def compliance(self) -> float:
        """M = 2 mu^((2n+k-1)/n), the factor of the surface deformation in Eq. 28."""
        return 2.0 * self.mu ** ((2.0 * self.n + self.k - 1.0) / self.n)
