"""Solid of homogeneous layers on a homogeneous substrate, with sharp interfaces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number
from fscm.solids import POSITIVE, checked_tension, elastic_ratio

__all__ = ["Layers"]


@dataclass(frozen=True, slots=True)
class Layers:
    """Any number of sharp layers on a substrate, each with its own constants.

    Parameters
    ----------
    E : sequence of float, shape (N + 1,)
        Moduli of the N layers from the surface downwards, N >= 1, and of the substrate, > 0.
    nu : sequence of float, shape (N + 1,)
        Poisson's ratios in the same order, 0 <= nu <= 1/2.
    thickness : sequence of float, shape (N,)
        Thicknesses of the layers from the surface downwards, > 0.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Raises
    ------
    ValueError
        When the lengths do not fit, or a value is outside its range.

    Examples
    --------
    >>> solid = Layers(E=[1.0, 9.0, 2.0], nu=[0.3, 0.3, 0.5], thickness=[1.0, 0.5])
    >>> solid.modulus(np.array([0.9, 1.1, 1.6])), solid.interfaces
    (array([1., 9., 2.]), (1.0, 1.5))
    """

    E: Sequence[float]
    nu: Sequence[float]
    thickness: Sequence[float]
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "surface_tension", checked_tension(self.surface_tension))
        E = _column("E", self.E, lambda name, x: real_number(name, x, low=0.0, high=math.inf, reason=POSITIVE))
        nu = _column("nu", self.nu, elastic_ratio)
        thickness = _column(
            "thickness", self.thickness, lambda name, x: real_number(name, x, low=0.0, high=math.inf, reason=POSITIVE)
        )
        if not thickness or not len(E) == len(nu) == len(thickness) + 1:
            raise ValueError(
                f"{len(E)} moduli, {len(nu)} ratios and {len(thickness)} thicknesses do not fit layers on a substrate: "
                "E and nu have one entry more than thickness, the last is the substrate"
            )
        for name, value in (("E", E), ("nu", nu), ("thickness", thickness)):
            object.__setattr__(self, name, value)

    @property
    def length(self) -> float:
        """The thickness of the first layer."""
        return self.thickness[0]

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths of the interfaces."""
        return tuple(accumulate(self.thickness))

    def _at(self, values: Sequence[float], z: Array) -> Array:
        return np.array(values)[np.searchsorted(self.interfaces, np.asarray(z, float), side="right")]

    def modulus(self, z: Array) -> Array:
        """E(z); at an interface that of the layer below."""
        return self._at(self.E, z)

    def poisson(self, z: Array) -> Array:
        """nu(z); at an interface that of the layer below."""
        return self._at(self.nu, z)


def _column(name: str, values: object, checked: Callable[[str, object], float]) -> tuple[float, ...]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise ValueError(f"{name} = {values!r} is not a sequence of numbers")
    return tuple(checked(f"{name}[{i}]", value) for i, value in enumerate(values))
