"""A neo-Hookean half-space: finite strain, and Poisson's ratio up to that of an incompressible solid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive, check_tension
from fem_reference.solid import OneRatio, PowerLaw, check_exponent

__all__ = ["NeoHookean"]


@dataclass(frozen=True, slots=True)
class NeoHookean(OneRatio):
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
    >>> float(gel.modulus(1.0)), float(gel.poisson(1.0))
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
        check_positive("reference modulus E0", self.E0)
        check_positive("characteristic depth c0", self.c0)
        check_exponent(self.k)

    @property
    def surface_exponent(self) -> float:
        """The gradient exponent without an offset."""
        return 0.0 if self.z_s else self.k

    @property
    def depth_exponent(self) -> float:
        """The gradient exponent."""
        return self.k

    @property
    def surface_depth(self) -> float:
        """The offset; infinite for a power law."""
        return self.z_s if self.k and self.z_s else math.inf

    @property
    def as_power_law(self) -> PowerLaw | None:
        """The solid at small strain, if it has no offset or one modulus."""
        if math.isfinite(self.surface_depth):
            return None
        return PowerLaw(self.E0, self.c0, self.k, self.nu, self.surface_tension)

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E0 * ((np.asarray(z, float) + self.z_s) / self.c0) ** self.k
