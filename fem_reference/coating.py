"""Modulus of a homogeneous coating on a homogeneous substrate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive
from fem_reference.modulus import Interface

__all__ = ["CoatingModulus"]


@dataclass(frozen=True, slots=True)
class CoatingModulus:
    """E = E_s + (E_c - E_s) (1 - tanh((z - thickness) / transition)) / 2: a coating on a substrate.

    Parameters
    ----------
    E_coating, E_substrate : float
        Young's moduli E_c and E_s.
    thickness : float
        Depth of the interface.
    transition : float
        Length over which the modulus changes there; 0 for a sharp interface.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> CoatingModulus(E_coating=10.0, E_substrate=1.0, thickness=2.0)(np.array([1.9, 2.1]))
    array([10.,  1.])
    """

    E_coating: float
    E_substrate: float
    thickness: float
    transition: float = 0.0

    def __post_init__(self) -> None:
        for name in ("E_coating", "E_substrate", "thickness"):
            check_positive(name, getattr(self, name))
        if not (math.isfinite(self.transition) and self.transition >= 0):
            raise ValueError(f"transition = {self.transition} is outside [0, infinity): it is a length; 0 is sharp")

    @property
    def surface_exponent(self) -> float:
        """Zero: the surface modulus is finite."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """Zero: the substrate is homogeneous."""
        return 0.0

    @property
    def surface_depth(self) -> float:
        """The thickness, or the length of the transition where that reaches the surface."""
        return max(self.thickness, self.transition)

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The one interface."""
        return (Interface(self.thickness, self.transition),)

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`; at a sharp interface that of the substrate."""
        below = np.asarray(z, float) - self.thickness
        sharp = self.transition == 0
        share = np.where(below < 0, 1.0, 0.0) if sharp else 0.5 * (1.0 - np.tanh(below / self.transition))
        return self.E_substrate + (self.E_coating - self.E_substrate) * share
