"""Stable sections of one force curve over the displacement, and loads on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from fscm._typing import Array
from fscm.interpolation.curve.pieces import States

__all__ = ["LoadValue", "Sections"]

#: Points of a section between two points of the curve, from which a place is looked for, Newton steps to it, and the
#: longest of them in parts of the length of the curve.
_BETWEEN, _STEPS, _LONGEST = 4, 4, 1e-3


class LoadValue(NamedTuple):
    """Loads at given displacements, floats or arrays.

    Attributes
    ----------
    value, bound : float or ndarray
        Load, and bound on its error.

    Examples
    --------
    >>> LoadValue(-1.5, 1e-4).value
    -1.5
    """

    value: float | Array
    bound: float | Array


class _Section(NamedTuple):
    """Places along the curve, and their displacements, which rise."""

    place: Array
    displacement: Array


@dataclass(frozen=True)
class Sections:
    """One curve as a spline over its length, and its stable sections under displacement control.

    Attributes
    ----------
    curve : CubicSpline
        Displacement, load, and their bounds, over the place.
    far, contact : _Section
        Up to the jump-in, and from the jump-out on; both are the whole curve if there are no jumps.
    jump_in, jump_out : float, optional
        Displacements of the jumps.
    decay : tuple of float
        Exponent of the load over the gap beyond the far end, and the gap there.
    """

    curve: scipy.interpolate.CubicSpline
    far: _Section
    contact: _Section
    jump_in: float | None
    jump_out: float | None
    decay: tuple[float, float]

    @classmethod
    def of(cls, columns: tuple[Array, ...], unstable: bool, scale: float, n: float, z0: float) -> Sections:
        """The sections of a curve in any units.

        Parameters
        ----------
        columns : tuple of ndarray
            Displacement, load and their bounds.
        unstable : bool
            Whether the curve has jumps.
        scale : float
            Unit in which the displacement is measured for the length.
        n, z0 : float
            Shape index; range of the law in the unit of the displacement.
        """
        displacement, load = columns[:2]
        scaled = np.arcsinh([displacement / scale, load / -load.min()])
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(scaled)))])
        curve = scipy.interpolate.CubicSpline(length, np.column_stack(columns))
        points = np.arange((len(length) - 1) * _BETWEEN + 1) / _BETWEEN
        place = np.interp(points, np.arange(len(length)), length)
        at_place = curve(place)[:, 0]
        decay = 3.0 - 2.0 / n, z0 - float(displacement[0])
        falls = np.flatnonzero(np.diff(at_place) <= 0.0)
        if not unstable or not falls.size:
            whole = _Section(place, np.maximum.accumulate(at_place))
            return cls(curve, whole, whole, None, None, decay)
        first, last = int(falls[0]), int(falls[-1]) + 1
        far = _Section(place[: first + 1], at_place[: first + 1])
        contact = _Section(place[last:], at_place[last:])
        return cls(curve, far, contact, float(at_place[first]), float(at_place[last]), decay)

    def load_at(self, displacement: ArrayLike, branch: str, derivative: States | None) -> LoadValue:
        """Loads with bounds, or their derivatives at fixed displacement, see `ForceCurve.load_at`."""
        if branch not in ("approach", "retreat"):
            raise ValueError(f'branch = {branch!r} is unknown; it is "approach" or "retreat"')
        given = np.asarray(displacement, float)
        x = given.ravel()
        farthest = self.contact.displacement[-1]
        if not (x <= farthest).all():
            raise ValueError(f"displacement = {x.max():g} is outside (-inf, {farthest:g}]: there the curve ends")
        jump = self.jump_in if branch == "approach" else self.jump_out
        in_contact = np.zeros(len(x), np.bool_) if jump is None else x > jump
        value, bound = np.empty(len(x)), np.full(len(x), np.nan)
        for section, mask in ((self.far, ~in_contact), (self.contact, in_contact)):
            if derivative is not None:
                value[mask] = self._moved(section, x[mask], derivative)
            elif mask.any():
                value[mask], bound[mask] = self._loads(section, x[mask])
        if jump is not None and derivative is None:
            bound += self._of_jump(x, jump)
        if given.ndim == 0:
            return LoadValue(float(value[0]), float(bound[0]))
        return LoadValue(value.reshape(given.shape), bound.reshape(given.shape))

    def _loads(self, section: _Section, x: Array) -> tuple[Array, Array]:
        """Loads, and bounds from those of load and displacement."""
        place = self._places(section, x)
        _, value, u_displacement, u_load = self.curve(place).T
        value = value * self._decayed(x)
        bound = np.abs(u_load)
        for side in (-1.0, 1.0):
            beside = np.clip(x + side * np.abs(u_displacement), *section.displacement[[0, -1]])
            loads = self.curve(self._places(section, beside))[:, 1] * self._decayed(x)
            bound = np.maximum(bound, np.abs(u_load) + np.abs(loads - value))
        return value, bound

    def _moved(self, section: _Section, x: Array, derivative: States) -> Array:
        """Derivatives of loads at fixed displacement."""
        place = self._places(section, x)
        moved = scipy.interpolate.CubicSpline(self.curve.x, np.column_stack(derivative[:2]))(place)
        slope = self.curve(place, 1)
        return (moved[:, 1] - slope[:, 1] / slope[:, 0] * moved[:, 0]) * self._decayed(x)

    def _decayed(self, x: Array) -> Array:
        """Share of the load at the far end that is left beyond it, where bodies are as good as rigid."""
        exponent, gap = self.decay
        return (gap / np.maximum(gap + self.far.displacement[0] - x, gap)) ** exponent

    def _places(self, section: _Section, x: Array) -> Array:
        low, high = section.place[0], section.place[-1]
        place = np.interp(x, section.displacement, section.place)
        longest = _LONGEST * self.curve.x[-1]
        for _ in range(_STEPS):
            slope = self.curve(place, 1)[:, 0]
            rising = slope > 0.0
            step = np.where(rising, (x - self.curve(place)[:, 0]) / np.where(rising, slope, 1.0), 0.0)
            place = np.clip(place + np.clip(step, -longest, longest), low, high)
        return place

    def _of_jump(self, x: Array, jump: float) -> Array:
        """What a load may be wrong by because it is unknown on which side of the jump it is."""
        sections = self.far, self.contact
        ends = [np.interp(x, section.displacement, self.curve(section.place)[:, 1]) for section in sections]
        room = abs(float(self.curve(self.far.place[-1] if jump == self.jump_in else self.contact.place[0])[2]))
        return np.where(np.abs(x - jump) <= room, np.abs(ends[0] - ends[1]), 0.0)
