"""Parts of the benchmark, by name."""

from __future__ import annotations

from collections.abc import Iterable

from comparisons.bench.cold_starts import COLD_STARTS
from comparisons.bench.elements import ELEMENTS
from comparisons.bench.growth import GROWTH
from comparisons.bench.part import Part
from comparisons.bench.two_workers import WORKERS
from comparisons.bench.work_precision import WORK_PRECISION

__all__ = ["PARTS", "chosen"]

#: In the order in which they are measured: the shortest parts first.
PARTS = {part.name: part for part in (GROWTH, COLD_STARTS, WORKERS, ELEMENTS, WORK_PRECISION)}


def chosen(names: Iterable[str] | None) -> list[Part]:
    """Return the parts of some names, all by default.

    Raises
    ------
    ValueError
        For a name that no part has.

    Examples
    --------
    >>> [part.name for part in chosen(["growth"])]
    ['growth']
    """
    wanted = set(PARTS if names is None else names)
    if unknown := sorted(wanted - set(PARTS)):
        raise ValueError(f"there is no part {', '.join(unknown)}; the parts are {', '.join(PARTS)}")
    return [part for name, part in PARTS.items() if name in wanted]
