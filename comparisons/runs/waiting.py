"""Items that wait for a process, and which of them a process gets next.

The first work on a solid costs more than the next: a solver stores tables for its exponent.  So a process gets, among
the next items in their order, one like those it has worked on; the order, longest first, is kept but for that.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Generic, TypeVar

__all__ = ["Waiting"]

Item = TypeVar("Item")

#: Number of next items among which a process gets one that is like its earlier ones.
AHEAD = 50


class Waiting(Generic[Item]):
    """Items in their order, with what each process has worked on.

    Parameters
    ----------
    items : iterable
    alike : callable
        Returns the same for items that are alike.

    Examples
    --------
    >>> waiting = Waiting(["a1", "b1", "c1", "a2", "b2", "c2"], alike=lambda item: item[0])
    >>> [waiting.take(process) for process in (0, 1, 0, 1, 0, 1)]
    ['a1', 'b1', 'a2', 'b2', 'c1', 'c2']
    """

    def __init__(self, items: Iterable[Item], alike: Callable[[Item], Hashable]) -> None:
        self._items = [(alike(item), item) for item in items]
        self._seen: dict[int, set[Hashable]] = {}

    def __bool__(self) -> bool:
        return bool(self._items)

    def take(self, process: int) -> Item:
        """Remove and return the next item for a process: one like its earlier ones, or like no one's, or the first."""
        seen = self._seen.setdefault(process, set())
        by_others = set().union(*self._seen.values()) - seen
        ahead = range(min(AHEAD, len(self._items)))
        own = (place for place in ahead if self._items[place][0] in seen)
        new = (place for place in ahead if self._items[place][0] not in by_others)
        key, item = self._items.pop(next(own, next(new, 0)))
        seen.add(key)
        return item

    def forget(self, process: int) -> None:
        """Note that a process was replaced by a new one, which has worked on nothing."""
        self._seen.pop(process, None)
