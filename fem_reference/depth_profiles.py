"""Functions of depth that are constant far below: steps, a transition, an exponential, a table, any function.

Each is a modulus E(z) or a Poisson ratio nu(z); the solids (`fem_reference.solids`) check their values.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import scipy

from fem_reference._typing import Array
from fem_reference._validation import check_positive
from fem_reference.modulus import Interface, check_exponent

__all__ = ["CustomProfile", "ExponentialProfile", "StepProfile", "TabulatedProfile", "TransitionProfile"]

#: Rows of a table up to which each is a mesh line, where the interpolation has a jump of its second derivative.
MOST_LINES = 64


class _Settling:
    """A function with a finite value at the surface and one at great depth."""

    __slots__ = ()

    @property
    def surface_exponent(self) -> float:
        """Zero: the value at the surface is finite."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """Zero: the solid is homogeneous at great depth."""
        return 0.0


@dataclass(frozen=True, slots=True)
class StepProfile(_Settling):
    """One value in each layer and one below.

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


@dataclass(frozen=True, slots=True)
class TransitionProfile(_Settling):
    """below + (above - below) (1 - tanh((z - thickness) / transition)) / 2: a constant of a coating on a substrate.

    Parameters
    ----------
    above, below : float
        Values of the coating and of the substrate.
    thickness : float
        Depth of the interface, > 0.
    transition : float
        Length over which the value changes there, >= 0; 0 for a sharp interface.

    Raises
    ------
    ValueError
        If a length is outside its range.

    Examples
    --------
    >>> TransitionProfile(above=10.0, below=1.0, thickness=2.0)(np.array([1.9, 2.1]))
    array([10.,  1.])
    """

    above: float
    below: float
    thickness: float
    transition: float = 0.0

    def __post_init__(self) -> None:
        check_positive("thickness", self.thickness)
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

    def __call__(self, z: Array) -> Array:
        """The value at depths, shape of `z`; at a sharp interface that of the substrate."""
        deeper = np.asarray(z, float) - self.thickness
        if self.transition == 0:
            return np.where(deeper < 0, self.above, self.below)
        share = 0.5 * (1.0 - np.tanh(deeper / self.transition))
        return self.below + (self.above - self.below) * share


@dataclass(frozen=True, slots=True)
class ExponentialProfile(_Settling):
    """at_depth + (at_surface - at_depth) exp(-z / length).

    Parameters
    ----------
    at_surface, at_depth : float
        Values at the surface and at great depth.
    length : float
        Depth over which the value changes, > 0.

    Examples
    --------
    >>> ExponentialProfile(at_surface=3.0, at_depth=1.0, length=2.0)(np.array([0.0, 200.0]))
    array([3., 1.])
    """

    at_surface: float
    at_depth: float
    length: float

    @property
    def surface_depth(self) -> float:
        """The length."""
        return self.length

    def __call__(self, z: Array) -> Array:
        """The value at depths, shape of `z`."""
        return self.at_depth + (self.at_surface - self.at_depth) * np.exp(-np.asarray(z, float) / self.length)


@dataclass(frozen=True, slots=True)
class TabulatedProfile(_Settling):
    """Monotone cubic interpolation through the rows of a table over depth, constant beyond its ends.

    Parameters
    ----------
    depths : sequence of float, shape (N,), N >= 2
        Rising, the first at least 0.
    values : sequence of float, shape (N,)
    column : str
        What the values are, for messages.
    steep : float
        Ratio of neighbouring values from which on elements are as short as the distance of the two rows.

    Raises
    ------
    ValueError
        If the columns do not form a table.

    Examples
    --------
    >>> TabulatedProfile(depths=(0.0, 1.0, 3.0), values=(1.0, 2.0, 4.0))(np.array([1.0, 9.0]))
    array([2., 4.])
    """

    depths: Sequence[float]
    values: Sequence[float]
    column: str = "values"
    steep: float = math.inf
    _curve: scipy.interpolate.PchipInterpolator = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        name = self.column
        try:
            z, y = np.asarray(self.depths, float), np.asarray(self.values, float)
        except (TypeError, ValueError) as error:
            raise ValueError(f"the depths and {name} of a table are not two columns of numbers: {error}") from error
        if z.ndim != 1 or z.shape != y.shape or z.size < 2:
            raise ValueError(
                f"depths of the shape {z.shape} and {name} of the shape {y.shape} do not form a table: it has a value "
                "at each of 2 depths or more"
            )
        if not (np.all(np.isfinite(z)) and np.all(np.isfinite(y))):
            row = int(np.argmin(np.isfinite(z) & np.isfinite(y)))
            raise ValueError(f"row {row} of the table, ({z[row]}, {y[row]}), is not finite")
        if z[0] < 0:
            raise ValueError(f"the first depth {z[0]:g} is outside [0, infinity): depths count from the surface")
        falls = np.flatnonzero(np.diff(z) <= 0)
        if falls.size:
            row = int(falls[0]) + 1
            raise ValueError(
                f"the depth {z[row]:g} in row {row} is not above {z[row - 1]:g}, the one before it: they must rise"
            )
        checked = (tuple(z.tolist()), tuple(y.tolist()), scipy.interpolate.PchipInterpolator(z, y))
        for attribute, value in zip(("depths", "values", "_curve"), checked, strict=True):
            object.__setattr__(self, attribute, value)

    @property
    def surface_depth(self) -> float:
        """The first depth below the surface."""
        return self.depths[0] if self.depths[0] > 0 else self.depths[1]

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Mesh lines at the rows of a short table, and short elements between two rows of steep values."""
        if len(self.depths) > MOST_LINES:
            return ()
        lines = [Interface(depth) for depth in self.depths if depth > 0]
        rows = pairwise(zip(self.depths, self.values, strict=True))
        steps = [(a, b) for (a, p), (b, q) in rows if max(p, q) > self.steep * min(p, q)]
        return (*lines, *(Interface(0.5 * (a + b), b - a) for a, b in steps))

    def __call__(self, z: Array) -> Array:
        """The value at depths, shape of `z`."""
        return np.asarray(self._curve(np.clip(np.asarray(z, float), self.depths[0], self.depths[-1])))


@dataclass(frozen=True, slots=True)
class CustomProfile:
    """Any function of depth, with the exponents of its powers at the surface and at depth.

    Parameters
    ----------
    function : callable
        Of an array of depths.
    surface_exponent, depth_exponent : float
        Exponents m of z^m as z -> 0 and z -> infinity, in [0, 1).
    surface_depth : float
        Depth over which the function leaves its power at the surface.
    interfaces : tuple of Interface
        Depths where it changes at once or within a short length.  Those that are not declared are searched for by
        sampling, which can miss a layer thinner than 1/30 of its depth.

    Examples
    --------
    >>> stiffening = CustomProfile(lambda z: 1.0 + z**0.5, depth_exponent=0.5, surface_depth=0.1)
    >>> float(stiffening(np.array(4.0)))
    3.0
    """

    function: Callable[[Array], Array]
    surface_exponent: float = 0.0
    depth_exponent: float = 0.0
    surface_depth: float = 1.0
    interfaces: tuple[Interface, ...] = ()

    def __post_init__(self) -> None:
        check_exponent(self.surface_exponent)
        check_exponent(self.depth_exponent)
        check_positive("surface depth", self.surface_depth)
        if not (isinstance(self.interfaces, tuple) and all(isinstance(i, Interface) for i in self.interfaces)):
            raise ValueError(f"interfaces = {self.interfaces!r} is not a tuple of Interface(depth, transition)")

    def __call__(self, z: Array) -> Array:
        """The value at depths, shape of `z`."""
        return np.asarray(self.function(np.asarray(z, float)), float)
