"""Punch given as a table of radii and heights, joined by straight segments."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["MeasuredPunch"]

#: Segments whose slopes differ by less than this, relative to their size, make no kink.
_STRAIGHT = 1e-12


@dataclass(frozen=True, slots=True)
class MeasuredPunch:
    """A measured profile: straight segments between points, and a power of the radius beyond the last one.

    The slope jumps at the points, and the meshes have breaks there where the pressure needs them, so that no smoothing
    is needed.  Hashable, picklable.

    Parameters
    ----------
    radii : sequence of float, shape (N,), N >= 2
        Radii, increasing from 0.
    heights : sequence of float, shape (N,)
        Heights; the first is 0, the last is positive.
    growth : float
        Exponent g > 0 of the continuation f = f_N (r / r_N)^g beyond the last point; 2, a paraboloid, by default.

    Raises
    ------
    ValueError
        When the columns do not form a profile, with the reason in one sentence.

    Examples
    --------
    >>> punch = MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.25, 2.0])
    >>> punch.height(np.array([0.5, 1.5, 4.0])), punch.slope(np.array([1.5]))
    (array([0.125, 1.125, 8.   ]), array([1.75]))
    >>> punch.kinks
    (1.0, 2.0)
    """

    radii: Sequence[float]
    heights: Sequence[float]
    growth: float = 2.0
    kinks: tuple[float, ...] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        growth = real_number("growth", self.growth, low=0.0, high=math.inf, reason="the punch must grow at infinity")
        r, f = _column("radii", self.radii), _column("heights", self.heights)
        if len(r) != len(f) or len(r) < 2:
            raise ValueError(
                f"{len(r)} radii and {len(f)} heights do not form a profile: it has one height for each of 2 radii"
            )
        if r[0] != 0.0 or f[0] != 0.0:
            raise ValueError(f"the first point ({r[0]:g}, {f[0]:g}) is not (0, 0): heights are measured from the tip")
        if np.any(np.diff(r) <= 0.0):
            i = int(np.argmax(np.diff(r) <= 0.0)) + 1
            raise ValueError(f"radius {r[i]:g} in row {i} is outside ({r[i - 1]:g}, inf): radii have to increase")
        if f[-1] <= 0.0:
            raise ValueError(f"the last height {f[-1]:g} is outside (0, inf): the punch must grow beyond it")
        slopes = np.append(np.diff(f) / np.diff(r), growth * f[-1] / r[-1])
        bent = np.abs(np.diff(slopes)) > _STRAIGHT * np.abs(slopes[1:])
        values = (tuple(r.tolist()), tuple(f.tolist()), growth, tuple(r[1:][bent].tolist()))
        for name, value in zip(("radii", "heights", "growth", "kinks"), values, strict=True):
            object.__setattr__(self, name, value)

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """n and Q of the power beyond the last point."""
        return self.growth, self.radii[-1] ** self.growth / (self.growth * self.heights[-1])

    def height(self, r: Array) -> Array:
        """f(r)."""
        r = np.asarray(r, float)
        beyond = self.heights[-1] * (np.maximum(r, self.radii[-1]) / self.radii[-1]) ** self.growth
        return np.where(r > self.radii[-1], beyond, np.interp(r, self.radii, self.heights))

    def slope(self, r: Array) -> Array:
        """df/dr; at a kink that of the segment outside."""
        r = np.asarray(r, float)
        end = self.radii[-1]
        slopes = np.diff(self.heights) / np.diff(self.radii)
        inside = slopes[np.clip(np.searchsorted(self.radii, r, side="right") - 1, 0, len(slopes) - 1)]
        beyond = self.growth * self.heights[-1] / end * (np.maximum(r, end) / end) ** (self.growth - 1.0)
        return np.where(r >= end, beyond, inside)


def _column(name: str, values: Sequence[float]) -> Array:
    try:
        column = np.array(values)
    except ValueError as error:
        raise ValueError(f"{name} have to be a column of real numbers: {error}") from error
    if column.ndim != 1 or column.dtype.kind not in "iuf" or not np.all(np.isfinite(column.astype(float))):
        raise ValueError(f"{name} of shape {column.shape} and type {column.dtype} are not a column of finite numbers")
    return column.astype(float)
