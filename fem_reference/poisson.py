"""Poisson's ratio: one number, or a function of depth."""

from __future__ import annotations

import math
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array

__all__ = ["PoissonRatio", "check_poisson", "poisson_at"]

#: What a refused ratio is told.
REMEDY = "displacement elements cannot keep the volume; take nu = 0.499 or less"

#: Depths, relative to a length of the solid, between which a ratio is examined, and how many of them.
DEPTHS = 1e-12, 1e12, 2000


@runtime_checkable
class PoissonRatio(Protocol):
    """Poisson's ratio nu(z), constant at great depth, and optionally `interfaces` as those of a modulus.

    Examples
    --------
    >>> isinstance(lambda z: 0.3 + 0.1 * np.exp(-z), PoissonRatio)
    True
    """

    def __call__(self, z: Array) -> Array:
        """nu(z), shape of `z`."""
        ...


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
    >>> check_poisson(lambda z: 0.3 + 0.3 * np.exp(-z), 1.0)
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
