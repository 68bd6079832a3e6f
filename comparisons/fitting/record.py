"""A measured force-displacement curve, and where it jumps."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from comparisons.model import Array
from comparisons.problem.units import LARGEST_SIZE

#: Fewest points of a curve, several for each number that is fitted.
_FEWEST = 20

#: A step of the load is a jump where it is so many standard deviations of the noise, and so many times the usual step
#: of its neighbourhood.
_NOISE, _USUAL, _NEIGHBOURHOOD = 8.0, 6.0, 8


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a curve of a map was measured; None is unknown.

    Attributes
    ----------
    x, y : float or None
        In m.
    column, row : int or None
        Of the grid of the map.
    """

    x: float | None = None
    y: float | None = None
    column: int | None = None
    row: int | None = None


@dataclass(frozen=True, eq=False)
class Record:
    """One measured curve in SI, in the order in which it was recorded.

    Attributes
    ----------
    name : str
    displacement : ndarray, shape (m,)
        Of the punch towards the solid, from any zero, in m.
    load : ndarray, shape (m,)
        In N, tension negative, from any zero.
    approach : ndarray of bool, shape (m,)
        Whether a point is of the approach.
    stiffness : float
        Of the cantilever in N/m; infinite where the displacement is prescribed.
    remarks : list of str
        What of its file was left out or read against the convention.

    Examples
    --------
    >>> x = np.linspace(-1.0, 0.0, 30)
    >>> record = Record("a", x, np.where(x < -0.5, 0.0, -1.0), x < 1.0)
    >>> record.jump(True), record.jump(False)
    (15, None)
    """

    name: str
    displacement: Array
    load: Array
    approach: NDArray[np.bool_]
    stiffness: float = math.inf
    remarks: list[str] = field(default_factory=list)

    @property
    def position(self) -> Array:
        """Position of the base of the cantilever towards the solid, which the machine prescribes, in m."""
        return self.displacement + self.load / self.stiffness

    @property
    def noise(self) -> float:
        """Standard deviation of the load, as if neighbours had independent errors, in N."""
        errors = [np.diff(self.load[mask], 2) for mask in (self.approach, ~self.approach) if mask.sum() > 2]
        # The median of the size of a normal error is 0.6745 standard deviations; a second difference has sqrt(6).
        deviation = float(np.median(np.abs(np.concatenate(errors)))) / (0.6745 * math.sqrt(6.0))
        # A computed curve has none.
        return max(deviation, 1e-6 * float(np.ptp(self.load)))

    def only(self, branch: str) -> Record:
        """Return the approach or the retreat alone."""
        mask = self.approach if branch == "approach" else ~self.approach
        return replace(self, displacement=self.displacement[mask], load=self.load[mask], approach=self.approach[mask])

    def jump(self, approach: bool) -> int | None:
        """Return the number of the first point after the jump of the approach, or of the retreat; None without one."""
        where = np.flatnonzero(self.approach == approach)
        if len(where) < _FEWEST:
            return None
        # The surfaces snap together, which draws the punch, or part, which ends the tension.
        steps = np.diff(self.load[where]) * (-1.0 if approach else 1.0)
        largest = int(np.argmax(steps))
        around = np.abs(steps[max(largest - _NEIGHBOURHOOD, 0) : largest + _NEIGHBOURHOOD + 1])
        usual = float(np.median(around))
        is_jump = steps[largest] > max(_NOISE * math.sqrt(2.0) * self.noise, _USUAL * usual)
        return int(where[largest + 1]) if is_jump else None


def checked(record: Record, source: str) -> Record:
    """Return a record; `ValueError` if no values can be fitted to it, in one sentence that begins with the source."""
    if len(record.load) < _FEWEST:
        raise ValueError(f"{source}: {len(record.load)} points are fewer than {_FEWEST}; a fit needs more")
    for name, values, unit in (("loads", record.load, "N"), ("displacements", record.displacement, "m")):
        span = float(np.ptp(values))
        if span == 0.0:
            raise ValueError(f"{source}: all {name} are equal; check the columns")
        if not 1.0 / LARGEST_SIZE <= span <= LARGEST_SIZE:
            raise ValueError(
                f"{source}: the {name} have a range of {span:.3g} {unit}, outside {1.0 / LARGEST_SIZE:g} to "
                f"{LARGEST_SIZE:g} {unit}; check the units of the columns"
            )
    return record
