"""Pull-off forces that are proved, with which the reference of the benchmark is compared."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["CERTIFIED", "Enclosure"]


class Enclosure(NamedTuple):
    """An interval that contains a number."""

    centre: float
    radius: float

    def overlaps(self, value: float, bound: float) -> bool:
        """Whether it has a point in common with the interval of a value and its bound.

        Examples
        --------
        >>> Enclosure(1.0, 0.1).overlaps(1.25, 0.1), Enclosure(1.0, 0.1).overlaps(1.15, 0.1)
        (False, True)
        """
        return abs(value - self.centre) <= self.radius + bound


#: Tabor number -> pull-off force for n = 2, k = 0, from docs/certified_value.md; the proof is tests/certified.
CERTIFIED = {
    0.1: Enclosure(1.96895637932829, 1e-11),
    0.5: Enclosure(1.78748293102689, 6e-13),
    1.0: Enclosure(1.6706647764763, 1.6e-12),
}
