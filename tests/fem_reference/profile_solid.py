"""A solid of a modulus and a Poisson ratio that need not belong together."""

from __future__ import annotations

from dataclasses import dataclass

from fem_reference.modulus import Modulus
from fem_reference.modulus_checks import check_exponents
from fem_reference.poisson import PoissonRatio, check_poisson


@dataclass(frozen=True)
class ProfileSolid:
    """Any E(z) and nu(z), as the finite elements take them."""

    modulus: Modulus
    poisson: float | PoissonRatio

    def __post_init__(self) -> None:
        check_poisson(self.poisson, self.modulus.surface_depth)
        check_exponents(self.modulus)
