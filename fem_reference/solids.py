"""Solids: half-spaces with a modulus E(z) and a Poisson ratio nu(z), in any consistent units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Any, Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive, check_tension
from fem_reference.depth_profiles import (
    CustomProfile,
    ExponentialProfile,
    StepProfile,
    TabulatedProfile,
    TransitionProfile,
)
from fem_reference.modulus import Interface, Modulus, OffsetPowerLawModulus, PowerLawModulus
from fem_reference.modulus_checks import check_exponents
from fem_reference.poisson import PoissonRatio, check_poisson

__all__ = [
    "Coating",
    "CustomSolid",
    "Exponential",
    "Homogeneous",
    "Layers",
    "OffsetPowerLaw",
    "PowerLaw",
    "Solid",
    "TabulatedModulus",
]

#: Ratio of neighbouring moduli of a table from which on elements are as short as the distance of the two rows.
STEEP = 1.25


@runtime_checkable
class Solid(Protocol):
    """A half-space; hashable.

    It may have a `surface_tension` too, a force per length; without one there is none.

    Examples
    --------
    >>> isinstance(Homogeneous(E=1.0, nu=0.3), Solid)
    True
    """

    @property
    def modulus(self) -> Modulus:
        """E(z), with its exponents at the surface and at depth."""
        ...

    @property
    def poisson(self) -> float | PoissonRatio:
        """Poisson's ratio in [0, 0.5), or one of depth."""
        ...


def _check_one_ratio(nu: Any) -> None:
    if callable(nu):
        raise ValueError(f"nu = {nu!r} depends on depth; take CustomSolid(E, nu, length) for such a solid")
    check_poisson(nu, 1.0)


class _OneRatio:
    """A solid with one Poisson ratio `nu` at every depth."""

    __slots__ = ()
    nu: float
    surface_tension: float

    def __post_init__(self) -> None:
        _check_one_ratio(self.nu)
        check_tension(self.surface_tension)
        self.modulus  # noqa: B018  # validates the rest

    @property
    def modulus(self) -> Modulus:
        """E(z)."""
        raise NotImplementedError

    @property
    def poisson(self) -> float:
        """The ratio."""
        return self.nu


@dataclass(frozen=True, slots=True)
class PowerLaw(_OneRatio):
    """E = E0 (z / c0)^k (Eq. 3 of the paper).

    Parameters
    ----------
    E0, c0 : float
        Modulus, and the depth at which it is reached, > 0.
    k : float
        Gradient exponent, 0 <= k < 1.
    nu : float
        Poisson's ratio in [0, 0.5).
    surface_tension : float
        Surface tension Y, a force per length, >= 0: the surface bears a pressure less Y times its mean curvature.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> PowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.5)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.5 is outside [0, 0.5): ...
    """

    E0: float
    c0: float
    k: float
    nu: float
    surface_tension: float = 0.0

    @property
    def modulus(self) -> PowerLawModulus:
        """E(z)."""
        return PowerLawModulus(self.E0, self.c0, self.k)


@dataclass(frozen=True, slots=True)
class Homogeneous(_OneRatio):
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
        _check_one_ratio(self.nu)
        check_tension(self.surface_tension)

    @property
    def modulus(self) -> PowerLawModulus:
        """E, as a power law with k = 0, whose c0 has no effect."""
        return PowerLawModulus(self.E, 1.0, 0.0)


@dataclass(frozen=True, slots=True)
class OffsetPowerLaw(_OneRatio):
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

    @property
    def modulus(self) -> OffsetPowerLawModulus:
        """E(z)."""
        return OffsetPowerLawModulus(self.E0, self.c0, self.k, self.z_s)


@dataclass(frozen=True, slots=True)
class Exponential(_OneRatio):
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
        _check_one_ratio(self.nu)
        check_tension(self.surface_tension)

    @property
    def modulus(self) -> ExponentialProfile:
        """E(z)."""
        return ExponentialProfile(self.E_surface, self.E_depth, self.length)


@dataclass(frozen=True, slots=True)
class Coating:
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
        _check_one_ratio(self.nu_coating)
        if self.nu_substrate is not None:
            _check_one_ratio(self.nu_substrate)
        for name in ("E_coating", "E_substrate"):
            check_positive(name, getattr(self, name))
        self.modulus  # noqa: B018  # validates the rest

    @property
    def modulus(self) -> TransitionProfile:
        """E(z)."""
        return TransitionProfile(self.E_coating, self.E_substrate, self.thickness, self.transition)

    @property
    def poisson(self) -> float | TransitionProfile:
        """The one ratio, or that of depth."""
        if self.nu_substrate in (None, self.nu_coating):
            return self.nu_coating
        return TransitionProfile(self.nu_coating, float(self.nu_substrate or 0.0), self.thickness, self.transition)


@dataclass(frozen=True, slots=True)
class Layers:
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
            _check_one_ratio(ratio)

    @property
    def _depths(self) -> tuple[float, ...]:
        return tuple(accumulate(self.thickness))

    @property
    def modulus(self) -> StepProfile:
        """E(z)."""
        return StepProfile(self._depths, tuple(self.E))

    @property
    def poisson(self) -> float | StepProfile:
        """The one ratio, or that of depth."""
        return self.nu[0] if len(set(self.nu)) == 1 else StepProfile(self._depths, tuple(self.nu))


@dataclass(frozen=True, slots=True, repr=False)
class TabulatedModulus:
    """E(z), and nu(z), through the rows of a table: monotone cubic interpolation, constant beyond its ends.

    Parameters
    ----------
    depths : sequence of float, shape (N,), N >= 2
        Rising, the first at least 0.
    moduli : sequence of float, shape (N,)
        Positive.
    nu : float or sequence of float, shape (N,)
        Poisson's ratio in [0, 0.5), one number or one for each depth.
    surface_tension : float
        As for `PowerLaw`.

    Raises
    ------
    ValueError
        If the columns do not form a table, or a value is outside its range.

    Examples
    --------
    >>> solid = TabulatedModulus(depths=(0.0, 1.0, 3.0), moduli=(1.0, 2.0, 4.0), nu=(0.45, 0.3, 0.2))
    >>> solid.modulus(np.array([1.0, 9.0])), solid.poisson(np.array([0.0, 3.0]))
    (array([2., 4.]), array([0.45, 0.2 ]))
    """

    depths: Sequence[float]
    moduli: Sequence[float]
    nu: float | Sequence[float]
    surface_tension: float = 0.0
    modulus: TabulatedProfile = field(init=False, compare=False)
    poisson: float | TabulatedProfile = field(init=False, compare=False)

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        modulus = TabulatedProfile(self.depths, self.moduli, "moduli", STEEP)
        for row, E in enumerate(modulus.values):
            if not E > 0:
                raise ValueError(f"the modulus {E:g} in row {row} is outside (0, infinity)")
        nu: float | tuple[float, ...]
        poisson: float | TabulatedProfile
        if isinstance(self.nu, Sequence | np.ndarray):
            poisson = TabulatedProfile(modulus.depths, self.nu, "ratios")
            nu = tuple(poisson.values)
            for ratio in nu:
                check_poisson(ratio, 1.0)
        else:
            _check_one_ratio(self.nu)
            poisson = nu = self.nu
        columns = (modulus.depths, modulus.values, nu, modulus, poisson)
        for name, value in zip(("depths", "moduli", "nu", "modulus", "poisson"), columns, strict=True):
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"TabulatedModulus({len(self.depths)} rows, depths {self.depths[0]:g} to {self.depths[-1]:g})"


@dataclass(frozen=True, slots=True)
class CustomSolid:
    """Any E(z) and nu(z).

    Parameters
    ----------
    E : callable
        E(z): array of depths -> array of moduli, > 0.
    nu : float or callable
        Poisson's ratio in [0, 0.5), or nu(z) like `E`, constant at great depth.
    length : float
        A depth over which they change, > 0.
    interfaces : sequence of float or Interface
        Depths where E or nu changes at once, or `Interface(depth, transition)` where it does within a short length.
        Those that are not declared are searched for by sampling, which can miss a layer thinner than 1/30 of its depth.
    surface_exponent, depth_exponent : float
        Exponents of E ~ z^m as z -> 0 and z -> infinity, in [0, 1).
    surface_tension : float
        As for `PowerLaw`.

    Raises
    ------
    ValueError
        If a value is outside its range, or E does not have the exponents that are declared.

    Examples
    --------
    >>> stiffening = CustomSolid(lambda z: 1.0 + z**0.5, 0.3, length=1.0, depth_exponent=0.5)
    >>> stiffening.modulus(4.0)
    array(3.)
    """

    E: Callable[[Array], Array]
    nu: float | Callable[[Array], Array]
    length: float
    interfaces: Sequence[float | Interface] = ()
    surface_exponent: float = 0.0
    depth_exponent: float = 0.0
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        ends = (
            interface if isinstance(interface, Interface) else Interface(float(interface))
            for interface in self.interfaces
        )
        object.__setattr__(self, "interfaces", tuple(ends))
        check_exponents(self.modulus)
        check_poisson(self.poisson, self.length)

    @property
    def modulus(self) -> CustomProfile:
        """E(z)."""
        exponents = self.surface_exponent, self.depth_exponent
        return CustomProfile(self.E, *exponents, self.length, tuple(self.interfaces))  # type: ignore[arg-type]  # checked

    @property
    def poisson(self) -> float | CustomProfile:
        """The one ratio, or that of depth."""
        if callable(self.nu):
            return CustomProfile(self.nu, interfaces=tuple(self.interfaces))  # type: ignore[arg-type]  # checked
        return self.nu
