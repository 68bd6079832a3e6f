"""Panels of the face of a punch, on which a function of the distance to a point is integrated.

Panels are halves of halves of an interval [0, T]; where a kink is inside, they end there.  A point takes the largest
panels that are farther away than they are long and on which a polynomial follows the profile.  So it has small panels
where the face is near, wherever that is, and where the profile is rough, and large ones elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from typing import cast

import numpy as np

from fem_reference._typing import Array, Index
from fem_reference.punch import Punch, kinks_of

__all__ = ["Face", "Fineness", "face_of"]

#: Shortest panel relative to its outer radius: below, radii are not resolved.
_SHORTEST = 1e-13

#: Most octaves of the radius at which a search begins, and panels for which there is room at first.
_MOST_OCTAVES, _FIRST = 120, 256

#: Rounding of the heights in the coefficients of a polynomial through them.
_ROUNDING = 4.0 * np.finfo(float).eps


@dataclass(frozen=True, slots=True)
class Fineness:
    """How fine the integral over a face is.

    Attributes
    ----------
    nodes : int
        Gauss points of a panel.
    ratio : float
        Least distance of a point from the middle of a panel, over the length of the panel.
    roughness : float
        Largest of the last two Legendre coefficients of the profile on a panel, over the distance.
    beyond : float
        Share of a plane's traction that the face out of reach may have.
    """

    nodes: int
    ratio: float
    roughness: float
    beyond: float


class Face:
    """Panels of a profile, made when they are asked for.

    A point begins with the octaves [2^i, 2^(i+1)] of the radius from its own on, and with [0, 2^i] inside of them.

    Parameters
    ----------
    punch : Punch
    fineness : Fineness
    """

    def __init__(self, punch: Punch, fineness: Fineness) -> None:
        self._punch, self._fineness = punch, fineness
        self._kinks = np.array(kinks_of(punch), float)
        self._x, self._w = np.polynomial.legendre.leggauss(fineness.nodes)
        degrees = np.arange(fineness.nodes - 2, fineness.nodes)
        self._last = np.polynomial.legendre.legvander(self._x, fineness.nodes - 1)[:, degrees]
        self._last *= self._w[:, None] * (degrees + 0.5)
        self._count = 0
        # Radius, height, slope and weight of the radius at the Gauss points of each panel.
        self._nodes = np.empty((_FIRST, 4, fineness.nodes))
        # Start, stop, height of the start; radius and height of the middle; length and roughness.
        self._shape = np.empty((_FIRST, 7))
        self._halves = np.full((_FIRST, 2), -1)
        # The octaves from 2^lowest on, and what is inside of each.
        self._lowest = 0
        self._octaves, self._insides = np.empty(0, np.intp), np.empty(0, np.intp)

    def nodes(self, panels: Index) -> tuple[Array, ...]:
        """Radius, height, slope and weight of the radius at the Gauss points, shapes (panels, nodes)."""
        return tuple(np.moveaxis(self._nodes[panels], 1, 0))

    def _height(self, radius: Array) -> Array:
        """A shape may overflow far out, where nothing is left of its force."""
        with np.errstate(over="ignore"):
            return self._punch.height(radius)

    def _add(self, start: Array, stop: Array) -> Index:
        """Numbers of new panels."""
        half = 0.5 * (stop - start)
        middle, weight = start + half, half[:, None] * self._w
        radius = middle[:, None] + half[:, None] * self._x
        with np.errstate(over="ignore", invalid="ignore"):
            height, slope = self._punch.height(radius), self._punch.slope(radius)
            level = self._height(middle)
            rough = np.abs((height - level[:, None]) @ self._last).max(axis=1)
            rough -= _ROUNDING * np.abs(height).max(axis=1)
            length = np.sum(weight * np.hypot(1.0, slope), axis=1)
        first, self._count = self._count, self._count + start.size
        while self._count > len(self._nodes):
            self._nodes, self._shape = (np.concatenate([old, old]) for old in (self._nodes, self._shape))
            self._halves = np.concatenate([self._halves, np.full_like(self._halves, -1)])
        self._nodes[first : self._count] = np.stack([radius, height, slope, weight], axis=1)
        shape = [start, stop, self._height(start), middle, level, length, rough]
        self._shape[first : self._count] = np.stack(shape, axis=1)
        return np.arange(first, self._count)

    def _halves_of(self, panels: Index) -> Index:
        """Both halves of each panel, one behind the other."""
        halves = self._halves[panels]
        if halves.size and halves.min() < 0:
            missing = np.unique(panels[halves[:, 0] < 0])
            start, stop = self._shape[missing, 0], self._shape[missing, 1]
            cut = 0.5 * (start + stop)
            for i in np.flatnonzero(np.searchsorted(self._kinks, start, "right") < np.searchsorted(self._kinks, stop)):
                inside = self._kinks[(self._kinks > start[i]) & (self._kinks < stop[i])]
                cut[i] = inside[np.argmin(np.abs(inside - cut[i]))]
            self._halves[missing] = np.stack([self._add(start, cut), self._add(cut, stop)], axis=1)
            halves = self._halves[panels]
        return halves.ravel()

    def _with_octaves(self, lowest: int, highest: int) -> None:
        """Have the octaves from `lowest` to `highest`, both included."""
        if not self._octaves.size:
            self._lowest = lowest
        known = range(self._lowest, self._lowest + self._octaves.size)
        for below, new in ((True, range(lowest, self._lowest)), (False, range(known.stop, highest + 1))):
            if len(new):
                start = 2.0 ** np.array(new)
                octaves, insides = self._add(start, 2.0 * start), self._add(0.0 * start, start)
                order = slice(None, None, 1 if below else -1)
                self._octaves = np.concatenate([octaves, self._octaves][order])
                self._insides = np.concatenate([insides, self._insides][order])
        self._lowest = min(lowest, self._lowest)

    def _beginning(self, x: Array, z: Array, v: Array, reach: Array) -> tuple[Index, Index]:
        """Pairs of a point and a panel with which the search begins."""
        own = np.floor(np.log2(np.maximum(x, v))).astype(int)
        farthest = 2.0 ** int(own.max())
        with np.errstate(over="ignore"):
            while np.any(np.hypot(farthest - x, self._height(np.array(farthest)) - z) < reach):
                farthest *= 2.0
        highest = round(math.log2(farthest))
        own = np.maximum(own, highest - _MOST_OCTAVES)
        self._with_octaves(int(own.min()), highest)
        point, octave = np.nonzero(self._lowest + np.arange(self._octaves.size) >= own[:, None])
        points = np.concatenate([np.arange(x.size), point])
        return points, np.concatenate([self._insides[own - self._lowest], self._octaves[octave]])

    def panels(self, x: Array, z: Array, v: Array, reach: Array) -> tuple[Index, Index, Array]:
        """Pairs of a point and a panel, and their distances.

        Parameters
        ----------
        x, z, v : ndarray, shape (points,)
            Radius and height of each point, and its depth below the face.
        reach : ndarray, shape (points,)
            Distance beyond which the face is left out.
        """
        fine = self._fineness
        point, panel = self._beginning(x, z, v, reach)
        taken = []
        while point.size:
            start, stop, first, middle, level, length, rough = self._shape[panel].T
            at, below = x[point], z[point]
            distance = np.hypot(middle - at, level - below)
            inside = (start <= at) | (np.hypot(start - at, first - below) < reach[point])
            # Comparisons with an overflow are false.
            large = np.isfinite(length) & (distance >= fine.ratio * length)
            with np.errstate(invalid="ignore"):
                smooth = rough <= fine.roughness * (distance - 0.5 * length)
            ends = (large & smooth) | ~(stop - start > _SHORTEST * stop)
            take = inside & ends
            taken.append((point[take], panel[take], distance[take]))
            split = inside & ~ends
            point, panel = np.repeat(point[split], 2), self._halves_of(panel[split])
        points, panels, distances = (np.concatenate(column) for column in zip(*taken, strict=True))
        return points, panels, distances


@lru_cache(maxsize=8)
def face_of(punch: Hashable, fineness: Fineness) -> Face:
    """Return the panels of a punch, which several interactions share."""
    return Face(cast(Punch, punch), fineness)
