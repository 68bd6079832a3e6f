"""The load that a machine records: stable sections of the equilibria over the position that it prescribes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comparisons.fitting.equilibria import Equilibria
from comparisons.fitting.record import Record
from comparisons.model import Array, ComputationFailed

#: A section is continued beyond its fold by a straight line, so that a fit feels a fold in the wrong place: over this
#: share of the way from the fold to pull-off and beyond, along its secant.
_SECANT = 0.2
#: Points of a cycle that are farther away than the equilibria begin.
_BEYOND = 40


@dataclass(frozen=True)
class Observations:
    """A record with its jumps.

    Attributes
    ----------
    record : Record
    far, contact : ndarray of bool, shape (m,)
        Points before the surfaces snapped together or after they parted, and points in contact; a point without a jump
        of its branch is in neither.
    used : ndarray of bool, shape (m,)
        Points of the fit: without those at a jump, which the machine may have recorded on its way.
    jumps : dict of bool to tuple
        Approach or not -> numbers of the points before and after the jump.
    """

    record: Record
    far: NDArray[np.bool_]
    contact: NDArray[np.bool_]
    used: NDArray[np.bool_]
    jumps: dict[bool, tuple[int, int]]

    @classmethod
    def of(cls, record: Record) -> Observations:
        """Return the observations of a record."""
        count = len(record.load)
        far, contact, used = np.zeros(count, bool), np.zeros(count, bool), np.ones(count, bool)
        jumps, numbers = {}, np.arange(count)
        for approach in (True, False):
            after = record.jump(approach)
            if after is None:
                continue
            mask = record.approach == approach
            later = mask & (numbers >= after)
            earlier = mask & ~later
            contact |= later if approach else earlier
            far |= earlier if approach else later
            before = int(np.flatnonzero(earlier)[-1])
            used[[before, after]] = False
            jumps[approach] = before, after
        return cls(record, far, contact, used, jumps)

    def thinned(self, every: slice) -> Observations:
        """Return some of the points, without the jumps."""
        points = {name: getattr(self.record, name)[every] for name in ("displacement", "load", "approach")}
        record = replace(self.record, **points)
        return Observations(record, self.far[every], self.contact[every], self.used[every], {})


@dataclass(frozen=True)
class Machine:
    """Stable sections of equilibria over the position; each has shape (2, m), positions rising.

    Attributes
    ----------
    far, contact : ndarray
        From far away to where the approach jumps into contact, and from where the retreat jumps off into contact; the
        same where the surfaces do not jump.  A jump from one section to the next in between is a vertical piece.
    jumps : bool
    """

    far: Array
    contact: Array
    jumps: bool

    @classmethod
    def of(cls, equilibria: Equilibria, stiffness: float) -> Machine:
        """Return the sections for a stiffness of the cantilever in N/m, perhaps infinite.

        Raises
        ------
        comparisons.model.ComputationFailed
            If the equilibria do not end in stable contact.
        """
        position = equilibria.displacement + equilibria.load / stiffness
        path = np.array([position, equilibria.load])
        falls = np.flatnonzero(np.diff(position) <= 0.0)
        if not falls.size:
            return cls(path, path, False)
        begins, ends = np.append(0, falls + 1), np.append(falls + 1, position.size)
        sections = [path[:, begin:end] for begin, end in zip(begins, ends, strict=True) if end - begin > 1]
        if not sections or falls[-1] + 2 >= position.size or falls[0] == 0:
            raise ComputationFailed("the contact is not stable far away or at the largest load of the record")
        return cls(_joined(sections[:-1]), -_joined([-part[:, ::-1] for part in sections[:0:-1]])[:, ::-1], True)

    def cycle(self) -> dict[str, Array]:
        """Return position and load on approach and on retreat, each of shape (2, m), with both ends of a jump.

        Raises
        ------
        comparisons.model.ComputationFailed
            If the equilibria end before a jump lands.

        Examples
        --------
        >>> displacement = np.array([-9.0, -2.0, -1.0, -5.0, 0.0, 1.0])
        >>> machine = Machine.of(Equilibria(displacement, np.array([0.0, -1.0, -2.0, -6.0, -5.0, 3.0])), np.inf)
        >>> machine.cycle()["approach"][0].tolist(), machine.cycle()["retreat"][0].tolist()
        ([-9.0, -2.0, -1.0, -1.0, 0.0, 1.0], [1.0, 0.0, -5.0, -5.0, -9.0])
        """
        if not self.jumps:
            return {"approach": self.far, "retreat": self.far[:, ::-1]}
        snap_in, snap_out = float(self.far[0, -1]), float(self.contact[0, 0])
        if snap_in >= self.contact[0, -1]:
            raise ComputationFailed("the equilibria end before the jump into contact lands on them")
        far = self.far
        if snap_out <= far[0, 0]:
            # A soft cantilever parts farther away than the equilibria begin.
            beyond = np.linspace(snap_out - (far[0, 0] - snap_out) - (snap_in - far[0, 0]), far[0, 0], _BEYOND)[:-1]
            far = np.concatenate([[beyond, self._far_away(beyond)], far], axis=1)
        landed = np.array([[snap_in], [np.interp(snap_in, *self.contact)]])
        parted = np.array([[snap_out], self._far_away(np.array([snap_out]))])
        pressed, apart = self.contact[:, self.contact[0] > snap_in], far[:, far[0] < snap_out]
        return {
            "approach": np.concatenate([far, landed, pressed], axis=1),
            "retreat": np.concatenate([self.contact[:, ::-1], parted, apart[:, ::-1]], axis=1),
        }

    def load(self, position: Array, observed: Observations) -> Array:
        """Return the load at each point of a record, whose zeros are those of the equilibria.

        Parameters
        ----------
        position : ndarray, shape (m,)
            In m.
        observed : Observations
            Which points are in contact; for others it is the model that says where it jumps.
        """
        fold = np.where(observed.record.approach, self.far[0, -1], self.contact[0, 0])
        unknown = ~(observed.far | observed.contact)
        in_contact = observed.contact | (unknown & (position > fold))
        return np.where(in_contact, self._in_contact(position), self._far_away(position))

    def _in_contact(self, position: Array) -> Array:
        x, load = self.contact
        loads = np.interp(position, x, load)
        if self.jumps:
            lowest = int(np.argmin(load))
            reach = x[0] + max(_SECANT * (x[lowest] - x[0]), 1e-3 * float(x[-1] - x[0]))
            slope = (np.interp(reach, x, load) - load[0]) / (reach - x[0])
            loads = np.where(position < x[0], load[0] - abs(slope) * (x[0] - position), loads)
        rise = (load[-1] - load[-2]) / (x[-1] - x[-2])
        return np.where(position > x[-1], load[-1] + rise * (position - x[-1]), loads)

    def _far_away(self, position: Array) -> Array:
        x, load = self.far
        loads = np.interp(position, x, load)
        # The attraction falls like the square of the gap, which is -x far away.
        with np.errstate(divide="ignore", invalid="ignore"):
            beyond = load[0] * (x[0] / np.minimum(position, x[0])) ** 2
        return np.where(position < x[0], beyond, loads)


def _joined(sections: Sequence[Array]) -> Array:
    """Return the first section with those onto which the position jumps from its end, one after the other."""
    joined = sections[0]
    for section in sections[1:]:
        fold = joined[0, -1]
        if section[0, 0] <= fold < section[0, -1]:
            landing = np.array([[fold], [np.interp(fold, *section)]])
            joined = np.concatenate([joined, landing, section[:, section[0] > fold]], axis=1)
    return joined
