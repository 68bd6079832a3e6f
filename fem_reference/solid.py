"""Solids as data: a half-space with a modulus E(z) and a Poisson ratio nu(z)."""

from __future__ import annotations

from dataclasses import dataclass

from fem_reference.modulus import Modulus, OffsetPowerLawModulus, PowerLawModulus
from fem_reference.modulus_checks import check_exponents
from fem_reference.poisson import PoissonRatio, check_poisson

__all__ = ["CustomSolid", "Solid"]


@dataclass(frozen=True, slots=True)
class Solid:
    """Half-space with E = E0 ((z + z_s) / c0)^k and a constant Poisson ratio.

    Examples
    --------
    >>> Solid(E0=1.0, c0=1.0, k=0.4, nu=0.5)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.5 is outside [0, 0.5): ...
    """

    E0: float
    c0: float
    k: float
    nu: float
    z_s: float = 0.0

    def __post_init__(self) -> None:
        if isinstance(self.nu, PoissonRatio):
            raise ValueError(f"nu = {self.nu!r} depends on depth; take CustomSolid(modulus, nu) for such a solid")
        check_poisson(self.nu, 1.0)
        if self.z_s < 0:
            raise ValueError(f"surface offset z_s = {self.z_s} is negative: the modulus would vanish inside the solid")
        self.modulus  # noqa: B018  (validates the rest)

    @property
    def modulus(self) -> Modulus:
        """E(z).

        Examples
        --------
        >>> float(Solid(E0=2.0, c0=1.0, k=0.5, nu=0.3, z_s=4.0).modulus(0.0))
        4.0
        """
        if self.z_s > 0:
            return OffsetPowerLawModulus(self.E0, self.c0, self.k, self.z_s)
        return PowerLawModulus(self.E0, self.c0, self.k)


@dataclass(frozen=True, slots=True)
class CustomSolid:
    """Half-space with any modulus E(z) and any Poisson ratio nu(z).

    Parameters
    ----------
    modulus : Modulus
        E(z), with its exponents at the surface and at depth.
    nu : float or PoissonRatio
        Poisson ratio in [0, 0.5), or one of depth.

    Raises
    ------
    ValueError
        If the Poisson ratio is outside its range, or the modulus does not have the exponents that it declares.

    Examples
    --------
    >>> from fem_reference.modulus import CustomModulus
    >>> stiffening = CustomModulus(lambda z: 1.0 + z**0.5, 0.0, 0.5, surface_depth=1.0)
    >>> CustomSolid(stiffening, nu=0.3).modulus(4.0)
    array(3.)

    A coating with both constants of its own:

    >>> from fem_reference import CoatingModulus, CoatingPoisson
    >>> coated = CustomSolid(CoatingModulus(10.0, 1.0, thickness=2.0), CoatingPoisson(0.2, 0.45, thickness=2.0))
    """

    modulus: Modulus
    nu: float | PoissonRatio

    def __post_init__(self) -> None:
        check_poisson(self.nu, self.modulus.surface_depth)
        check_exponents(self.modulus)
