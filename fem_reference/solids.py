"""Solids of few constants: homogeneous, a power law with an offset, an exponential, a coating, layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive, check_tension
from fem_reference.solid import Interface, OneRatio, PowerLaw, Solid, check_exponent, check_ratio

__all__ = ["Coating", "Exponential", "Homogeneous", "Layers", "OffsetPowerLaw", "PowerLaw", "Solid"]


@dataclass(frozen=True, slots=True)
class Homogeneous(OneRatio):
    """One modulus E and one Poisson ratio at every depth; `surface_tension` as for `PowerLaw`.

    Examples
    --------
    >>> float(Homogeneous(E=2.0, nu=0.3).modulus(np.array(4.0)))
    2.0
    """

    E: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        check_positive("modulus E", self.E)
        OneRatio.__post_init__(self)

    @property
    def surface_depth(self) -> float:
        """Infinite: one modulus throughout."""
        return math.inf

    @property
    def as_power_law(self) -> PowerLaw:
        """The solid with k = 0, for which c0 has no effect."""
        return PowerLaw(self.E, 1.0, 0.0, self.nu, self.surface_tension)

    def modulus(self, z: Array) -> Array:
        """E, shape of `z`."""
        return np.full(np.shape(z), self.E, float)


@dataclass(frozen=True, slots=True)
class OffsetPowerLaw(OneRatio):
    """E = E0 ((z + z_s) / c0)^k: a graded solid whose surface modulus does not vanish.

    Parameters
    ----------
    E0, c0, k, nu, surface_tension : float
        As for `PowerLaw`.
    z_s : float
        Offset of the depth, > 0.

    Examples
    --------
    >>> float(OffsetPowerLaw(E0=2.0, c0=1.0, k=0.5, z_s=4.0, nu=0.3).modulus(0.0))
    4.0
    """

    E0: float
    c0: float
    k: float
    z_s: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        OneRatio.__post_init__(self)
        check_positive("reference modulus E0", self.E0)
        check_positive("characteristic depth c0", self.c0)
        check_positive("surface offset z_s", self.z_s)
        check_exponent(self.k)

    @property
    def depth_exponent(self) -> float:
        """The gradient exponent."""
        return self.k

    @property
    def surface_depth(self) -> float:
        """The offset z_s."""
        return self.z_s

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E0 * ((np.asarray(z, float) + self.z_s) / self.c0) ** self.k


@dataclass(frozen=True, slots=True)
class Exponential(OneRatio):
    """E = E_depth + (E_surface - E_depth) exp(-z / length).

    Parameters
    ----------
    E_surface, E_depth : float
        Moduli at the surface and at great depth, > 0.
    length : float
        Depth over which the modulus changes, > 0.
    nu : float
        Poisson's ratio in [0, 0.5).
    surface_tension : float
        As for `PowerLaw`.

    Examples
    --------
    >>> Exponential(E_surface=3.0, E_depth=1.0, length=2.0, nu=0.3).modulus(np.array([0.0, 200.0]))
    array([3., 1.])
    """

    E_surface: float
    E_depth: float
    length: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        for name in ("E_surface", "E_depth", "length"):
            check_positive(name, getattr(self, name))
        OneRatio.__post_init__(self)

    @property
    def surface_depth(self) -> float:
        """The length."""
        return self.length

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E_depth + (self.E_surface - self.E_depth) * np.exp(-np.asarray(z, float) / self.length)


@dataclass(frozen=True, slots=True)
class Coating(Solid):
    """A coating on a substrate: E_s + (E_c - E_s) (1 - tanh((z - thickness) / transition)) / 2.

    Parameters
    ----------
    E_coating, E_substrate : float
        Moduli E_c and E_s, > 0.
    thickness : float
        Depth of the interface, > 0.
    transition : float
        Length over which the constants change there, >= 0; 0 for a sharp interface.
    nu_coating : float
        Poisson's ratio of the coating, in [0, 0.5).
    nu_substrate : float, optional
        That of the substrate, joined in the same way; that of the coating by default.
    surface_tension : float
        As for `PowerLaw`.

    Examples
    --------
    >>> solid = Coating(10.0, 1.0, thickness=2.0, transition=0.0, nu_coating=0.2, nu_substrate=0.45)
    >>> solid.modulus(np.array([1.9, 2.1])), solid.poisson(np.array([1.9, 2.1]))
    (array([10.,  1.]), array([0.2 , 0.45]))
    """

    E_coating: float
    E_substrate: float
    thickness: float
    transition: float
    nu_coating: float
    nu_substrate: float | None = None
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        for ratio in (self.nu_coating, self.nu_substrate):
            if ratio is not None:
                check_ratio(ratio)
        for name in ("E_coating", "E_substrate", "thickness"):
            check_positive(name, getattr(self, name))
        if not (math.isfinite(self.transition) and self.transition >= 0):
            raise ValueError(f"transition = {self.transition} is outside [0, infinity): it is a length; 0 is sharp")

    @property
    def surface_depth(self) -> float:
        """The thickness, or the length of the transition where that reaches the surface."""
        return max(self.thickness, self.transition)

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The one interface."""
        return (Interface(self.thickness, self.transition),)

    def modulus(self, z: Array) -> Array:
        """E(z); at a sharp interface that of the substrate."""
        return self._joined(self.E_coating, self.E_substrate, z)

    def poisson(self, z: Array) -> Array:
        """nu(z); at a sharp interface that of the substrate."""
        below = self.nu_coating if self.nu_substrate is None else self.nu_substrate
        return self._joined(self.nu_coating, below, z)

    def _joined(self, above: float, below: float, z: Array) -> Array:
        deeper = np.asarray(z, float) - self.thickness
        if self.transition == 0:
            return np.where(deeper < 0, above, below)
        return below + (above - below) * (0.5 * (1.0 - np.tanh(deeper / self.transition)))


@dataclass(frozen=True, slots=True)
class Layers(Solid):
    """Any number of sharp layers on a substrate, each with its own constants.

    Parameters
    ----------
    E : sequence of float, shape (N + 1,)
        Moduli of the N layers from the surface downwards, N >= 1, and of the substrate, > 0.
    nu : sequence of float, shape (N + 1,)
        Poisson's ratios in the same order, in [0, 0.5).
    thickness : sequence of float, shape (N,)
        Thicknesses of the layers from the surface downwards, > 0.
    surface_tension : float
        As for `PowerLaw`.

    Raises
    ------
    ValueError
        If the lengths do not fit, or a value is outside its range.

    Examples
    --------
    >>> solid = Layers(E=(1.0, 9.0, 2.0), nu=(0.3, 0.3, 0.45), thickness=(1.0, 0.5))
    >>> solid.modulus(np.array([0.9, 1.1, 1.6])), solid.poisson(np.array([1.1, 1.6]))
    (array([1., 9., 2.]), array([0.3 , 0.45]))
    """

    E: Sequence[float]
    nu: Sequence[float]
    thickness: Sequence[float]
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        for name in ("E", "nu", "thickness"):
            values = getattr(self, name)
            if isinstance(values, str) or not np.iterable(values):
                raise ValueError(f"{name} = {values!r} is not a sequence of numbers")
            object.__setattr__(self, name, tuple(values))
        if not self.thickness or not len(self.E) == len(self.nu) == len(self.thickness) + 1:
            raise ValueError(
                f"{len(self.E)} moduli, {len(self.nu)} ratios and {len(self.thickness)} thicknesses are no layers on a "
                "substrate: E and nu have one entry more than thickness, the last is the substrate"
            )
        for name in ("E", "thickness"):
            for i, value in enumerate(getattr(self, name)):
                check_positive(f"{name}[{i}]", value)
        for ratio in self.nu:
            check_ratio(ratio)

    @property
    def surface_depth(self) -> float:
        """The thickness of the first layer."""
        return self.thickness[0]

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The interfaces of the layers."""
        return tuple(Interface(depth) for depth in accumulate(self.thickness))

    def modulus(self, z: Array) -> Array:
        """E(z); at an interface that of the layer below."""
        return self._of_layers(self.E, z)

    def poisson(self, z: Array) -> Array:
        """nu(z); at an interface that of the layer below."""
        return self._of_layers(self.nu, z)

    def _of_layers(self, values: Sequence[float], z: Array) -> Array:
        depths = tuple(accumulate(self.thickness))
        return np.array(values, float)[np.searchsorted(depths, np.asarray(z, float), side="right")]
