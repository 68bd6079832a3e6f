"""The surface law of two bodies in a liquid: wall and van der Waals attraction, and the repulsion of a double layer."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from fem_reference._roots import root_between
from fem_reference._typing import Array
from fem_reference._validation import check_positive
from fem_reference._wells import stable_gaps

__all__ = ["Dlvo"]

#: Distances at which the signs of traction and slope are looked at, in lengths of wall or double layer: from the wall,
#: twice as strong as any attraction, to where the double layer is 1e-26 of itself.  Neighbours differ by 0.2 %.
NEAREST, FARTHEST, SAMPLES = 0.1, 60.0, 8000


@dataclass(frozen=True, slots=True)
class Dlvo:
    """The law of Derjaguin, Landau, Verwey and Overbeek, p = A/(6 pi) (z0^6 D^-9 - D^-3) + P exp(-D/L).

    D is the distance of the faces; the gap H is zero at the deepest well, D = `distance`.  P is 64 k T rho tanh^2(e
    psi/(4 k T)) for weakly overlapping double layers of the potential psi in a solution of the number density rho
    (Israelachvili, Intermolecular and Surface Forces, chapter 14).

    Parameters
    ----------
    hamaker_constant : float
        A, an energy.
    z0 : float
        Distance at which wall and attraction alone are in balance: the range of the law.
    double_layer : float
        Pressure P, zero or more.
    debye_length : float
        L.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> law = Dlvo(hamaker_constant=16.0 * np.pi, z0=1.0, double_layer=0.0, debye_length=1.0)
    >>> round(law.work_of_adhesion, 12), round(law.peak_gap, 12) == round(3.0 ** (1.0 / 6.0) - 1.0, 12)
    (1.0, True)
    """

    hamaker_constant: float
    z0: float
    double_layer: float
    debye_length: float
    distance: float = field(init=False, compare=False)
    work_of_adhesion: float = field(init=False, compare=False)
    peak_gap: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("hamaker_constant", "z0", "debye_length"):
            check_positive(name, getattr(self, name))
        if not (math.isfinite(self.double_layer) and self.double_layer >= 0):
            raise ValueError(
                f"double_layer = {self.double_layer} is outside [0, infinity): like bodies repel each other; state an "
                "attraction as a table of a law"
            )
        longest = max(self.z0, self.debye_length)
        D = np.geomspace(NEAREST * self.z0, FARTHEST * longest, SAMPLES)
        wells = stable_gaps(partial(self._pressure, order=0), D)
        deepest = min(wells, key=self._stored)
        slope = partial(self._pressure, order=1)
        rising = np.flatnonzero((slope(D[:-1]) < 0) & (slope(D[1:]) >= 0))
        peaks = [root_between(lambda d: float(slope(np.array(d))), D[i], D[i + 1], 1e-15 * D[i]) for i in rising]
        peak = min(peaks, key=lambda at: float(self._pressure(np.array(at), 0)))
        object.__setattr__(self, "distance", deepest)
        object.__setattr__(self, "work_of_adhesion", -self._stored(deepest))
        object.__setattr__(self, "peak_gap", peak - deepest)

    def _pressure(self, D: Array, order: int) -> Array:
        """Traction at a distance, or its slope."""
        strength, near = self.hamaker_constant / (6.0 * math.pi), (self.z0 / D) ** 6
        layer = self.double_layer * np.exp(-D / self.debye_length)
        if order == 0:
            return np.asarray(strength * (near - 1.0) / D**3 + layer)
        return np.asarray(strength * (3.0 - 9.0 * near) / D**4 - layer / self.debye_length)

    def _stored(self, D: float) -> float:
        """Energy per area at a distance: the integral of the traction beyond."""
        strength = self.hamaker_constant / (12.0 * math.pi)
        layer = self.double_layer * self.debye_length * math.exp(-D / self.debye_length)
        return strength * (0.25 * (self.z0 / D) ** 6 - 1.0) / D**2 + layer

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at D = 0."""
        return -self.distance

    @property
    def decay(self) -> tuple[float, float]:
        """Tension A/(6 pi) H^-3 at large gaps."""
        return self.hamaker_constant / (6.0 * math.pi), 3.0

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        return self._pressure(np.asarray(H, float) + self.distance, 0)

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        return self._pressure(np.asarray(H, float) + self.distance, 1)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H."""
        return np.asarray(np.vectorize(self._stored, otypes=[float])(np.asarray(H, float) + self.distance))
