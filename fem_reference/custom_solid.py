"""A solid of any E(z) and nu(z): values that a solid can have, and exponents that are those of the values."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive, check_tension
from fem_reference.solid import REMEDY, Interface, Solid, check_exponent, check_ratio, positive_modulus

__all__ = ["CustomSolid"]

#: Depths, relative to the length of the solid, between which a Poisson ratio is examined, and how many of them.
DEPTHS = 1e-12, 1e12, 2000

#: Depths, relative to the length of the solid, between which its exponents are measured.
SHALLOW, DEEP = (1e-14, 1e-12), (1e6, 1e8)

#: Largest difference of the surface exponent from the one measured. The chart of the first layer has z^(1-k) for the
#: declared k (measured with an exponent that is 1e-3 too small: the pull-off force moves by 1e-8).
SURFACE_TOLERANCE = 1e-3

#: Largest difference of the exponent at depth, which many moduli approach slowly. The mesh is extended until the
#: exterior matters little, whatever its exponent.
DEPTH_TOLERANCE = 0.02


@dataclass(frozen=True, slots=True)
class CustomSolid(Solid):
    """Any E(z) and nu(z).

    Parameters
    ----------
    E : callable
        E(z): array of depths -> array of moduli, > 0.
    nu : float or callable
        Poisson's ratio in [0, 0.5), or nu(z) like `E`, constant at great depth.
    length : float
        A depth over which they change, > 0.
    interfaces : sequence of float or Interface
        Depths where E or nu changes at once, or `Interface(depth, transition)` where it does within a short length.
        Those that are not declared are searched for by sampling, which can miss a layer thinner than 1/30 of its depth.
    surface_exponent, depth_exponent : float
        Exponents of E ~ z^m as z -> 0 and z -> infinity, in [0, 1).
    surface_tension : float
        As for `PowerLaw`.

    Raises
    ------
    ValueError
        If a value is outside its range, or E does not have the exponents that are declared.

    Examples
    --------
    >>> stiffening = CustomSolid(lambda z: 1.0 + z**0.5, 0.3, length=1.0, depth_exponent=0.5)
    >>> stiffening.modulus(4.0)
    array(3.)
    """

    E: Callable[[Array], Array]
    nu: float | Callable[[Array], Array]
    length: float
    interfaces: Sequence[float | Interface] = ()  # type: ignore[assignment]  # interfaces after __post_init__
    surface_exponent: float = 0.0
    depth_exponent: float = 0.0
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        ends = (end if isinstance(end, Interface) else Interface(float(end)) for end in self.interfaces)
        object.__setattr__(self, "interfaces", tuple(ends))
        check_exponent(self.surface_exponent)
        check_exponent(self.depth_exponent)
        check_positive("length", self.length)
        self._check_exponents()
        self._check_ratios()

    @property
    def surface_depth(self) -> float:
        """The length."""
        return self.length

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return np.asarray(self.E(np.asarray(z, float)), float)

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return np.asarray(self.nu(np.asarray(z, float)) if callable(self.nu) else np.full(np.shape(z), self.nu), float)

    def _check_exponents(self) -> None:
        """Refuse declared exponents that are not those of the modulus."""
        for name, declared, range_, tolerance, remedy in (
            ("surface exponent", self.surface_exponent, SHALLOW, SURFACE_TOLERANCE, "the mesh at the surface"),
            ("depth exponent", self.depth_exponent, DEEP, DEPTH_TOLERANCE, "the exterior of the mesh"),
        ):
            z = self.length * np.array(range_)
            E = positive_modulus(self, z)
            measured = math.log(E[1] / E[0]) / math.log(z[1] / z[0])
            if abs(measured - declared) > tolerance:
                raise ValueError(
                    f"{name} {declared:g} is declared, but E(z) rises as z^{measured:.3g} between the depths "
                    f"{z[0]:.3g} and {z[1]:.3g}: {remedy} would be that of another solid; declare the exponent of E, "
                    "and the depth over which it leaves its surface law"
                )

    def _check_ratios(self) -> None:
        """Refuse a Poisson ratio outside [0, 0.5)."""
        if not callable(self.nu):
            check_ratio(self.nu)
            return
        low, high, count = DEPTHS
        z = self.length * np.geomspace(low, high, count)
        values = self.poisson(z)
        if values.shape != z.shape:
            raise ValueError(
                f"Poisson's ratio of {z.size} depths has the shape {values.shape}: nu(z) must have that of z"
            )
        bad = np.flatnonzero(~((values >= 0) & (values < 0.5)))
        if bad.size:
            raise ValueError(
                f"Poisson ratio nu = {values[bad[0]]:.6g} at the depth {z[bad[0]]:.6g} is outside [0, 0.5): {REMEDY}"
            )
