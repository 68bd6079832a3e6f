"""Solid through data points of the modulus against the depth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy

from fscm._typing import Array
from fscm._validation import real_number
from fscm.solids import checked_tension, elastic_ratio

__all__ = ["TabulatedModulus"]


def _numbers(name: str, values: Sequence[float], low: float, reason: str, closed: bool) -> tuple[float, ...]:
    numbers = []
    for i, value in enumerate(values):
        numbers.append(real_number(f"{name}[{i}]", value, low=low, high=math.inf, reason=reason, closed_low=closed))
    return tuple(numbers)


@dataclass(frozen=True, slots=True)
class TabulatedModulus:
    """E(z), and nu(z), through data points: monotone between neighbours (PCHIP), constant beyond the first and last.

    Parameters
    ----------
    depths : sequence of float
        Depths of the data, >= 0, ascending strictly; at least two.
    moduli : sequence of float
        Moduli there, > 0.
    nu : float or sequence of float
        Poisson's ratio, one number or one for each depth.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> solid = TabulatedModulus([0.0, 1.0, 3.0], [1.0, 2.0, 4.0], nu=0.3)
    >>> solid.modulus(np.array([0.0, 1.0, 7.0]))
    array([1., 2., 4.])
    """

    depths: Sequence[float]
    moduli: Sequence[float]
    nu: float | Sequence[float]
    surface_tension: float = 0.0
    _young: scipy.interpolate.PchipInterpolator = field(init=False, repr=False, compare=False)
    _nu: scipy.interpolate.PchipInterpolator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "surface_tension", checked_tension(self.surface_tension))
        depths = _numbers("depths", self.depths, 0.0, "the solid is below z = 0", True)
        moduli = _numbers("moduli", self.moduli, 0.0, "a modulus is positive", False)
        if len(depths) != len(moduli) or len(depths) < 2:
            raise ValueError(
                f"{len(depths)} depths and {len(moduli)} moduli do not form a table: as many of both, at least two"
            )
        for i in range(1, len(depths)):
            if not depths[i] > depths[i - 1]:
                raise ValueError(
                    f"depths[{i}] = {depths[i]:g} is not above depths[{i - 1}] = {depths[i - 1]:g}: they ascend"
                )
        if not isinstance(self.nu, float | int):
            ratios = tuple(elastic_ratio(f"nu[{i}]", value) for i, value in enumerate(self.nu))
            if len(ratios) != len(depths):
                raise ValueError(
                    f"{len(ratios)} values of nu do not fit {len(depths)} depths: one for each, or one number"
                )
            nu: float | tuple[float, ...] = ratios
        else:
            nu = elastic_ratio("nu", self.nu)
        for name, value in (("depths", depths), ("moduli", moduli), ("nu", nu)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "_young", scipy.interpolate.PchipInterpolator(depths, moduli))
        object.__setattr__(self, "_nu", scipy.interpolate.PchipInterpolator(depths, np.broadcast_to(nu, len(depths))))

    @property
    def length(self) -> float:
        """The least distance of two depths."""
        return float(np.min(np.diff(self.depths)))

    @property
    def interfaces(self) -> tuple[float, ...]:
        """The depths: the second derivative jumps there."""
        return tuple(z for z in self.depths if z > 0.0)

    def _inside(self, z: Array) -> Array:
        return np.clip(np.asarray(z, float), self.depths[0], self.depths[-1])

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return np.asarray(self._young(self._inside(z)))

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return np.asarray(self._nu(self._inside(z)))
