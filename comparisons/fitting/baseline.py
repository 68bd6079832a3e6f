"""The load that a machine shows without a contact: constant, or linear in position and time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from comparisons.fitting.machine import Observations
from comparisons.fitting.record import Record
from comparisons.model import Array

__all__ = ["BASELINES", "CERTAIN", "Baseline", "BaselineName"]

BaselineName = Literal["constant", "linear"]
BASELINES = ("constant", "linear")

#: The load far away changes less than this share of the pull-off force over a twentieth of a record.
_FLAT = 0.1
#: Share of the points of a branch without contact, the farthest, that show a slope: nearer ones feel the attraction.
_FAR = 0.6
#: Fewest of them, and standard errors from which on a slope is one.
_FEWEST, CERTAIN = 10, 5.0


@dataclass(frozen=True, eq=False)
class Baseline:
    """Load without contact: zero + tilt x + drift t, x and t from 0 to 1 over the record, from far away and the begin.

    Attributes
    ----------
    record : Record
    far : ndarray of bool, shape (m,)
        Points before the surfaces snap together or after they part.
    kind : str, optional
        "constant" or "linear"; by default linear where the points without contact show a slope.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 100)
    >>> load = 1e-3 * x + np.where(x < 0.8, 0.0, x - 0.8) + 1e-6 * np.cos(9.0 * np.arange(100))
    >>> record = Record("a", x, load, x < 2.0)
    >>> Baseline(record, x < 0.8).names, Baseline(record, x < 0.8, "constant").names
    (('load', 'tilt'), ('load',))
    """

    record: Record
    far: NDArray[np.bool_]
    kind: BaselineName | None = None

    @classmethod
    def of(cls, observed: Observations, kind: BaselineName | None) -> Baseline:
        """Return the baseline of observations."""
        return cls(observed.record, observed.far, kind)

    @cached_property
    def range(self) -> float:
        """That of the load, in N, the unit of the numbers."""
        return float(np.ptp(self.record.load))

    @cached_property
    def _x(self) -> Array:
        position = self.record.position
        return np.asarray((position - position.min()) / np.ptp(position))

    @cached_property
    def time(self) -> Array:
        """From 0 to 1 over the record."""
        return np.linspace(0.0, 1.0, len(self.record.load))

    @property
    def has_both(self) -> bool:
        """Whether the record has both branches, so that time is not position."""
        return bool(self.record.approach.any() and not self.record.approach.all())

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of its fitted numbers."""
        if self.kind == "constant" or (self.kind is None and not self.is_sloped):
            return ("load",)
        return ("load", "tilt", "load_drift") if self.has_both else ("load", "tilt")

    @cached_property
    def start(self) -> dict[str, float]:
        """Numbers where a search begins."""
        if self.names == ("load",):
            return {"load": self.load / self.range}
        numbers = dict.fromkeys(self.names, 0.0)
        slopes = self._slopes(self.record.load)
        if not slopes:
            return numbers | {"load": self.load / self.range}
        tilt = float(np.mean([slope for slope, _, _ in slopes]))
        return numbers | {
            "tilt": tilt / self.range,
            "load": float(np.mean([zero for _, _, zero in slopes])) / self.range,
        }

    def loads(self, numbers: Mapping[str, float]) -> Array:
        """Return the loads in N, shape (m,)."""
        shares = numbers["load"] + numbers.get("tilt", 0.0) * self._x + numbers.get("load_drift", 0.0) * self.time
        return np.asarray(self.range * (shares + np.zeros_like(self._x)))

    @cached_property
    def load(self) -> float:
        """The load of the tenth that is farthest from the solid; zero if it changes there as in contact."""
        load = self.record.load[np.argsort(self.record.position)]
        farther, nearer = np.array_split(load[: max(len(load) // 10, 2)], 2)
        zero = float(np.median([*farther, *nearer]))
        changes = abs(float(np.median(farther) - np.median(nearer))) > _FLAT * (zero - float(load.min()))
        return 0.0 if changes else zero

    def _far_parts(self) -> list[NDArray[np.bool_]]:
        """The farthest points without contact of each branch."""
        parts = []
        for branch in (self.record.approach, ~self.record.approach):
            mask = self.far & branch
            if mask.sum():
                farthest = float(np.quantile(self._x[mask], _FAR))
                parts.append(mask & (self._x <= farthest))
        return [part for part in parts if part.sum() >= _FEWEST]

    def _slopes(self, loads: Array) -> list[tuple[float, float, float]]:
        """Slope of the loads over x on each branch, its standard error, and the load at x = 0."""
        slopes = []
        for mask in self._far_parts():
            x, load = self._x[mask], loads[mask]
            spread = x - x.mean()
            size = float(spread @ spread)
            if size > 0.0:
                slope = float(spread @ load) / size
                residual = load - load.mean() - slope * spread
                error = math.sqrt(float(residual @ residual) / (len(x) - 2) / size)
                slopes.append((slope, error, float(load.mean()) - slope * float(x.mean())))
        return slopes

    @cached_property
    def is_sloped(self) -> bool:
        """Whether the points without contact show a slope."""
        return self.have_slope(self.record.load)

    def have_slope(self, loads: Array) -> bool:
        """Return whether loads, shape (m,), or what a fit leaves of them, have a slope where there is no contact."""
        # A slope that is less than the noise over the whole record changes nothing.
        return any(abs(slope) > max(CERTAIN * error, self.record.noise) for slope, error, _ in self._slopes(loads))
