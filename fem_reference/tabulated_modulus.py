"""A solid through the rows of a table over depth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import scipy

from fem_reference._typing import Array
from fem_reference._validation import check_tension
from fem_reference.solid import Interface, Solid, check_ratio

__all__ = ["TabulatedModulus"]

#: Rows of a table up to which each is a mesh line, where the interpolation has a jump of its second derivative.
MOST_LINES = 64

#: Ratio of neighbouring moduli of a table from which on elements are as short as the distance of the two rows.
STEEP = 1.25


@dataclass(frozen=True, slots=True, repr=False)
class TabulatedModulus(Solid):
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
    _curves: tuple[scipy.interpolate.PchipInterpolator, scipy.interpolate.PchipInterpolator] = field(
        init=False, compare=False
    )

    def __post_init__(self) -> None:
        check_tension(self.surface_tension)
        depths, moduli = _columns(self.depths, self.moduli, "moduli")
        for row, E in enumerate(moduli):
            if not E > 0:
                raise ValueError(f"the modulus {E:g} in row {row} is outside (0, infinity)")
        is_column = isinstance(self.nu, Sequence | np.ndarray)
        ratios: Any = _columns(depths, self.nu, "ratios")[1] if is_column else (self.nu,) * len(depths)
        for ratio in ratios:
            check_ratio(ratio)
        curves = (
            scipy.interpolate.PchipInterpolator(depths, moduli),
            scipy.interpolate.PchipInterpolator(depths, ratios),
        )
        checked = {"depths": depths, "moduli": moduli, "nu": ratios if is_column else self.nu, "_curves": curves}
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"TabulatedModulus({len(self.depths)} rows, depths {self.depths[0]:g} to {self.depths[-1]:g})"

    @property
    def surface_depth(self) -> float:
        """The first depth below the surface."""
        return self.depths[0] if self.depths[0] > 0 else self.depths[1]

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Mesh lines at the rows of a short table, and short elements between two rows of steep moduli."""
        if len(self.depths) > MOST_LINES:
            return ()
        lines = [Interface(depth) for depth in self.depths if depth > 0]
        rows = pairwise(zip(self.depths, self.moduli, strict=True))
        steps = [(a, b) for (a, p), (b, q) in rows if max(p, q) > STEEP * min(p, q)]
        return (*lines, *(Interface(0.5 * (a + b), b - a) for a, b in steps))

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self._interpolated(self._curves[0], z)

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return self._interpolated(self._curves[1], z)

    def _interpolated(self, curve: scipy.interpolate.PchipInterpolator, z: Array) -> Array:
        return np.asarray(curve(np.clip(np.asarray(z, float), self.depths[0], self.depths[-1])))


def _columns(depths: Any, values: Any, name: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Rising depths and a value at each."""
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
    return tuple(z.tolist()), tuple(y.tolist())
