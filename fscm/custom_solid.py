"""Solid with any function of the depth for its modulus."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number
from fscm.solids import ELASTIC, POSITIVE, checked_tension, elastic_ratio

__all__ = ["CustomSolid"]

#: Depths below the surface, in units of the length, at which the functions are checked.
_CHECKED = np.geomspace(1e-6, 1e6, 25)


@dataclass(frozen=True, slots=True)
class CustomSolid:
    """Any E(z) and nu(z).

    Parameters
    ----------
    E : callable
        E(z): array of depths -> array of moduli, > 0 everywhere, the surface included.
    nu : float or callable
        Poisson's ratio, or nu(z) like `E`.
    length : float
        A depth over which they change, > 0.
    interfaces : sequence of float, optional
        Depths > 0 at which E or nu or a derivative of them jumps.  Layers thinner than a twentieth of their depth may
        be missed unless their interfaces are given here.
    surface_exponent, depth_exponent : float
        Exponents of E ~ z^m as z -> 0, which is 0 (a modulus that vanishes at the surface is a `PowerLaw`), and as
        z -> infinity, in [0, 1), which the response does not need.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> solid = CustomSolid(lambda z: 2.0 + np.sin(z) ** 2, 0.3, length=1.0)
    >>> solid.modulus(np.array([0.0])), solid.poisson(np.array([5.0]))
    (array([2.]), array([0.3]))
    """

    E: Callable[[Array], Array]
    nu: float | Callable[[Array], Array]
    length: float
    interfaces: Sequence[float] = ()
    surface_exponent: float = 0.0
    depth_exponent: float = 0.0
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "surface_tension", checked_tension(self.surface_tension))
        for name, high, reason in (
            ("surface_exponent", 0.0, "its modulus is positive at the surface; one that vanishes there is a PowerLaw"),
            ("depth_exponent", 1.0, "it has no finite surface response far away"),
        ):
            exponent = real_number(
                name, getattr(self, name), low=0.0, high=high, reason=reason, closed_low=True, closed_high=high == 0.0
            )
            object.__setattr__(self, name, exponent)
        length = real_number("length", self.length, low=0.0, high=math.inf, reason=POSITIVE)
        object.__setattr__(self, "length", length)
        ends = [real_number("interface", z, low=0.0, high=math.inf, reason=POSITIVE) for z in self.interfaces]
        object.__setattr__(self, "interfaces", tuple(sorted(ends)))
        if not callable(self.nu):
            object.__setattr__(self, "nu", elastic_ratio("nu", self.nu))
        z = np.append(0.0, self.length * _CHECKED)
        moduli, ratios = self.modulus(z), self.poisson(z)
        for values, name, good, reason in (
            (
                moduli,
                "modulus",
                np.isfinite(moduli) & (moduli > 0.0),
                "(0, inf): it is positive at every depth, also at the surface",
            ),
            (ratios, "Poisson's ratio", (ratios >= 0.0) & (ratios <= 0.5), f"[0, 0.5]: {ELASTIC}"),
        ):
            if values.shape != z.shape:
                raise ValueError(
                    f"the {name} has the shape {values.shape} for depths of the shape {z.shape}: it is "
                    "a function of an array"
                )
            if not good.all():
                i = int(np.argmin(good))
                raise ValueError(f"{name} = {values[i]:g} at the depth {z[i]:g} is outside {reason}")

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return np.asarray(self.E(np.asarray(z, float)), float)

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        z = np.asarray(z, float)
        return np.asarray(self.nu(z), float) if callable(self.nu) else np.full(z.shape, self.nu)
