"""Poisson's ratio: one number, or a function of depth."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array
from fem_reference.modulus import Interface

__all__ = ["CoatingPoisson", "CustomPoisson", "PoissonRatio", "check_poisson", "poisson_at"]

#: What a refused ratio is told.
REMEDY = "displacement elements cannot keep the volume; take nu = 0.499 or less"

#: Depths, relative to a length of the solid, between which a ratio is examined, and how many of them.
DEPTHS = 1e-12, 1e12, 2000


@runtime_checkable
class PoissonRatio(Protocol):
    """Poisson's ratio nu(z), constant at great depth, and optionally `interfaces` as those of a modulus.

    Examples
    --------
    >>> isinstance(CoatingPoisson(0.3, 0.45, thickness=1.0), PoissonRatio)
    True
    """

    def __call__(self, z: Array) -> Array:
        """nu(z), shape of `z`."""
        ...


@dataclass(frozen=True, slots=True)
class CoatingPoisson:
    """nu = nu_s + (nu_c - nu_s) (1 - tanh((z - thickness) / transition)) / 2: that of a coating on a substrate.

    Parameters
    ----------
    nu_coating, nu_substrate : float
        nu_c and nu_s, in [0, 0.5).
    thickness, transition : float
        As those of `CoatingModulus`.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> CoatingPoisson(nu_coating=0.45, nu_substrate=0.2, thickness=2.0)(np.array([1.9, 2.1]))
    array([0.45, 0.2 ])
    """

    nu_coating: float
    nu_substrate: float
    thickness: float
    transition: float = 0.0

    def __post_init__(self) -> None:
        check_poisson(self.nu_coating, 1.0)
        check_poisson(self.nu_substrate, 1.0)
        Interface(self.thickness, self.transition)

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The one interface."""
        return (Interface(self.thickness, self.transition),)

    def __call__(self, z: Array) -> Array:
        """nu(z), shape of `z`; at a sharp interface that of the substrate."""
        below = np.asarray(z, float) - self.thickness
        if self.transition == 0:
            return np.where(below < 0, self.nu_coating, self.nu_substrate)
        share = 0.5 * (1.0 - np.tanh(below / self.transition))
        return self.nu_substrate + (self.nu_coating - self.nu_substrate) * share


@dataclass(frozen=True, slots=True)
class CustomPoisson:
    """Any nu(z), constant at great depth.

    Parameters
    ----------
    function : callable
        nu(z) of an array of depths.
    interfaces : tuple of Interface
        As those of `CustomModulus`.

    Examples
    --------
    >>> float(CustomPoisson(lambda z: 0.4 - 0.1 * np.exp(-z))(np.array(0.0))) - 0.3 < 1e-15
    True
    """

    function: Callable[[Array], Array]
    interfaces: tuple[Interface, ...] = ()

    def __call__(self, z: Array) -> Array:
        """nu(z), shape of `z`."""
        return np.asarray(self.function(np.asarray(z, float)), float)


def poisson_at(nu: float | PoissonRatio, z: Array) -> Array:
    """Poisson's ratio at depths, shape of `z`.

    Examples
    --------
    >>> poisson_at(0.3, np.array([0.0, 1.0]))
    array([0.3, 0.3])
    """
    if callable(nu):
        return np.asarray(nu(z), float)
    return np.full(np.shape(z), nu, float)


def check_poisson(nu: float | PoissonRatio, length: float) -> None:
    """Refuse a Poisson ratio outside [0, 0.5).

    Parameters
    ----------
    nu : float or PoissonRatio
    length : float
        A depth of the solid, around which a function is examined.

    Raises
    ------
    ValueError
        With the value, and where it is.

    Examples
    --------
    >>> check_poisson(CustomPoisson(lambda z: 0.3 + 0.3 * np.exp(-z)), 1.0)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.6 at the depth 1e-12 is outside [0, 0.5): ...
    """
    if not isinstance(nu, PoissonRatio):
        if isinstance(nu, bool) or not isinstance(nu, (int, float, np.number)) or not 0 <= nu < 0.5:
            raise ValueError(f"Poisson ratio nu = {nu} is outside [0, 0.5): {REMEDY}")
        return
    low, high, count = DEPTHS
    scale = length if math.isfinite(length) else 1.0
    z = scale * np.geomspace(low, high, count)
    values = poisson_at(nu, z)
    if values.shape != z.shape:
        raise ValueError(f"Poisson's ratio of {z.size} depths has the shape {values.shape}: nu(z) must have that of z")
    bad = np.flatnonzero(~((values >= 0) & (values < 0.5)))
    if bad.size:
        raise ValueError(
            f"Poisson ratio nu = {values[bad[0]]:.6g} at the depth {z[bad[0]]:.6g} is outside [0, 0.5): {REMEDY}"
        )
