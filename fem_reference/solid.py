"""Solids as data: a half-space with a modulus E(z) and one Poisson ratio."""

from __future__ import annotations

from dataclasses import dataclass

from fem_reference.modulus import Modulus, OffsetPowerLawModulus, PowerLawModulus
from fem_reference.modulus_checks import check_exponents

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
        _check_poisson(self.nu)
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
    """Half-space with any modulus E(z) and a constant Poisson ratio.

    Parameters
    ----------
    modulus : Modulus
        E(z), with its exponents at the surface and at depth.
    nu : float
        Poisson ratio in [0, 0.5).

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
    """

    modulus: Modulus
    nu: float

    def __post_init__(self) -> None:
        _check_poisson(self.nu)
        check_exponents(self.modulus)


def _check_poisson(nu: float) -> None:
    if not 0 <= nu < 0.5:
        raise ValueError(
            f"Poisson ratio nu = {nu} is outside [0, 0.5): displacement elements cannot keep the volume; "
            "take nu = 0.499 or less"
        )
