"""A solid of a modulus and a Poisson ratio that need not belong together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from fem_reference.depth_profiles import TabulatedProfile
from fem_reference.modulus import Modulus
from fem_reference.modulus_checks import check_exponents
from fem_reference.poisson import PoissonRatio, check_poisson
from fem_reference.solids import STEEP

#: A modulus E(z) through the rows of a table, as that of a `TabulatedModulus`.
table_of_moduli = partial(TabulatedProfile, column="moduli", steep=STEEP)


@dataclass(frozen=True)
class ProfileSolid:
    """Any E(z) and nu(z), as the finite elements take them."""

    modulus: Modulus
    poisson: float | PoissonRatio

    def __post_init__(self) -> None:
        check_poisson(self.poisson, self.modulus.surface_depth)
        check_exponents(self.modulus)
