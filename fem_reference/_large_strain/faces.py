"""Values on the deformed surface."""

from __future__ import annotations

from dataclasses import dataclass

from fem_reference._typing import Array

__all__ = ["Faces"]


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Values at the Gauss points of the surface.

    Attributes
    ----------
    rho, stretch, tilt, gap : ndarray, shape (q,)
        Current radius, its derivative, derivative of u_z, and vertical gap H.
    """

    rho: Array
    stretch: Array
    tilt: Array
    gap: Array
