"""A neo-Hookean half-space: finite strain, and Poisson's ratio up to that of an incompressible solid."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fem_reference._validation import check_tension
from fem_reference.modulus import OffsetPowerLawModulus, PowerLawModulus

__all__ = ["NeoHookean"]


@dataclass(frozen=True, slots=True)
class NeoHookean:
    """A neo-Hookean half-space of the modulus E = E0 ((z + z_s)/c0)^k at small strain.

    Its energy per reference volume is psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2 with G = E/(2 (1 + nu)) and
    lambda = 2 G nu/(1 - 2 nu); an incompressible solid, nu = 0.5, has J = 1.  For `solve_large_strain` only: the
    elements of small strain refuse nu = 0.5.

    Parameters
    ----------
    E0 : float
        Modulus.
    nu : float
        Poisson's ratio in [0, 0.5].
    k, c0, z_s : float
        Exponent of the modulus, 0 <= k < 1, the depth at which it is E0, and the offset of the depth, >= 0.
    surface_tension : float
        Y, a force per length: the energy of the surface is Y times its true area.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> gel = NeoHookean(E0=3.0, nu=0.5)
    >>> float(gel.modulus(1.0)), gel.poisson
    (3.0, 0.5)
    >>> NeoHookean(E0=3.0, nu=0.6)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.6 is outside [0, 0.5]...
    """

    E0: float
    nu: float = 0.5
    k: float = 0.0
    c0: float = 1.0
    z_s: float = 0.0
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.nu) and 0.0 <= self.nu <= 0.5):
            raise ValueError(f"Poisson ratio nu = {self.nu} is outside [0, 0.5]: 0.5 is incompressible")
        if not (math.isfinite(self.z_s) and self.z_s >= 0.0):
            raise ValueError(f"offset z_s = {self.z_s} is outside [0, infinity): it is added to the depth")
        check_tension(self.surface_tension)
        self.modulus  # noqa: B018  # validates the rest

    @property
    def modulus(self) -> PowerLawModulus | OffsetPowerLawModulus:
        """E(z)."""
        if self.k > 0.0 and self.z_s > 0.0:
            return OffsetPowerLawModulus(self.E0, self.c0, self.k, self.z_s)
        return PowerLawModulus(self.E0, self.c0, self.k)

    @property
    def poisson(self) -> float:
        """The ratio."""
        return self.nu
