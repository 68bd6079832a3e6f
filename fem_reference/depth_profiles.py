"""Other moduli and Poisson ratios of depth: exponential, and tables of depths and values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from fem_reference._typing import Array
from fem_reference._validation import check_positive
from fem_reference.modulus import Interface
from fem_reference.poisson import check_poisson

__all__ = ["ExponentialModulus", "TableModulus", "TablePoisson"]

#: Rows of a table up to which each is a mesh line, where the interpolation has a jump of its second derivative.
MOST_LINES = 64

#: Ratio of neighbouring moduli of a table from which on elements are as short as the distance of the two rows.
STEEP = 1.25


@dataclass(frozen=True, slots=True)
class ExponentialModulus:
    """E = E_depth + (E_surface - E_depth) exp(-z / length).

    Parameters
    ----------
    E_surface, E_depth : float
        Young's moduli at the surface and at great depth.
    length : float
        Depth over which the modulus changes.

    Raises
    ------
    ValueError
        If a parameter is not positive and finite.

    Examples
    --------
    >>> ExponentialModulus(E_surface=3.0, E_depth=1.0, length=2.0)(np.array([0.0, 200.0]))
    array([3., 1.])
    """

    E_surface: float
    E_depth: float
    length: float

    def __post_init__(self) -> None:
        for name in ("E_surface", "E_depth", "length"):
            check_positive(name, getattr(self, name))

    @property
    def surface_exponent(self) -> float:
        """Zero: the surface modulus is finite."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """Zero: the solid is homogeneous at great depth."""
        return 0.0

    @property
    def surface_depth(self) -> float:
        """The length."""
        return self.length

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        return self.E_depth + (self.E_surface - self.E_depth) * np.exp(-np.asarray(z, float) / self.length)


class _Column:
    """Monotone interpolation of a column over depth, constant beyond its ends."""

    def __init__(self, name: str, depths: Sequence[float], values: Sequence[float]) -> None:
        try:
            z, y = np.asarray(depths, float), np.asarray(values, float)
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
        self.z, self.y = z, y
        self.curve = PchipInterpolator(z, y)

    def __call__(self, z: Array) -> Array:
        return np.asarray(self.curve(np.clip(np.asarray(z, float), self.z[0], self.z[-1])))

    def interfaces(self, steep: float) -> tuple[Interface, ...]:
        """Mesh lines at the rows, and short elements between two rows whose values have a larger ratio."""
        if self.z.size > MOST_LINES:
            return ()
        lines = [Interface(depth) for depth in self.z.tolist() if depth > 0]
        rows = pairwise(zip(self.z.tolist(), self.y.tolist(), strict=True))
        steps = [(a, b) for (a, p), (b, q) in rows if max(p, q) > steep * min(p, q)]
        return (*lines, *(Interface(0.5 * (a + b), b - a) for a, b in steps))


@dataclass(frozen=True, slots=True, repr=False)
class TableModulus:
    """Young's modulus through the rows of a table: monotone cubic interpolation over depth, constant beyond its ends.

    Parameters
    ----------
    depths : sequence of float, shape (N,), N >= 2
        Rising, the first at least 0.
    moduli : sequence of float, shape (N,)
        Positive.

    Raises
    ------
    ValueError
        If the columns do not form a table, or a modulus is not positive.

    Examples
    --------
    >>> TableModulus(depths=(0.0, 1.0, 3.0), moduli=(1.0, 2.0, 4.0))(np.array([1.0, 9.0]))
    array([2., 4.])
    """

    depths: Sequence[float]
    moduli: Sequence[float]
    _column: _Column = field(init=False, compare=False)

    def __post_init__(self) -> None:
        column = _Column("moduli", self.depths, self.moduli)
        if not np.all(column.y > 0):
            row = int(np.argmin(column.y))
            raise ValueError(f"the modulus {column.y[row]:g} in row {row} is outside (0, infinity)")
        values = (tuple(column.z.tolist()), tuple(column.y.tolist()), column)
        for name, value in zip(("depths", "moduli", "_column"), values, strict=True):
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"TableModulus({len(self.depths)} rows, depths {self.depths[0]:g} to {self.depths[-1]:g})"

    @property
    def surface_exponent(self) -> float:
        """Zero: the surface modulus is finite."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """Zero: the solid is homogeneous below the table."""
        return 0.0

    @property
    def surface_depth(self) -> float:
        """The first depth below the surface."""
        return self.depths[0] if self.depths[0] > 0 else self.depths[1]

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The rows of a short table."""
        return self._column.interfaces(STEEP)

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        return self._column(z)


@dataclass(frozen=True, slots=True, repr=False)
class TablePoisson:
    """Poisson's ratio through the rows of a table, interpolated as `TableModulus`.

    Parameters
    ----------
    depths : sequence of float, shape (N,), N >= 2
        Rising, the first at least 0.
    ratios : sequence of float, shape (N,)
        In [0, 0.5).

    Raises
    ------
    ValueError
        If the columns do not form a table, or a ratio is outside its range.

    Examples
    --------
    >>> TablePoisson(depths=(0.0, 1.0), ratios=(0.45, 0.2))(np.array([0.0, 5.0]))
    array([0.45, 0.2 ])
    """

    depths: Sequence[float]
    ratios: Sequence[float]
    _column: _Column = field(init=False, compare=False)

    def __post_init__(self) -> None:
        column = _Column("ratios", self.depths, self.ratios)
        for ratio in column.y:
            check_poisson(float(ratio), 1.0)
        values = (tuple(column.z.tolist()), tuple(column.y.tolist()), column)
        for name, value in zip(("depths", "ratios", "_column"), values, strict=True):
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"TablePoisson({len(self.depths)} rows, depths {self.depths[0]:g} to {self.depths[-1]:g})"

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The rows of a short table."""
        return self._column.interfaces(math.inf)

    def __call__(self, z: Array) -> Array:
        """nu(z), shape of `z`."""
        return self._column(z)
