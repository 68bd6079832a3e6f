"""Constants of sharp layers on a substrate, as functions of depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference._typing import Array
from fem_reference.modulus import Interface

__all__ = ["StepProfile"]


@dataclass(frozen=True, slots=True)
class StepProfile:
    """One value in each layer and one below: a modulus, or a Poisson ratio.

    Parameters
    ----------
    depths : tuple of float, shape (N,)
        Rising depths of the interfaces.
    values : tuple of float, shape (N + 1,)
        From the surface downwards; the last is that of the substrate.

    Examples
    --------
    >>> StepProfile((1.0, 1.5), (1.0, 9.0, 2.0))(np.array([0.9, 1.1, 1.6]))
    array([1., 9., 2.])
    """

    depths: tuple[float, ...]
    values: tuple[float, ...]

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
        """The thickness of the first layer."""
        return self.depths[0]

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The interfaces of the layers."""
        return tuple(Interface(depth) for depth in self.depths)

    def __call__(self, z: Array) -> Array:
        """The value at depths, shape of `z`; at an interface that of the layer below."""
        return np.array(self.values)[np.searchsorted(self.depths, np.asarray(z, float), side="right")]
