"""Jumps of a slow cycle of prescribed displacement, from branch to branch of the equilibrium path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fscm._events import Bracket
from fscm.errors import NotConverged

__all__ = ["Branch", "jumps_between"]


@dataclass(frozen=True)
class Branch:
    """A part of the path that is stable under prescribed displacement; along it the displacement rises.

    Attributes
    ----------
    low, high : (Point, Point), optional
        Brackets of the folds at its ends; none at an end of the path.
    least, largest : float
        Displacements at its ends.
    """

    low: Bracket | None = None
    high: Bracket | None = None
    least: float = -math.inf
    largest: float = math.inf


def jumps_between(branches: Sequence[Branch], inward: bool) -> list[tuple[Bracket, Branch]]:
    """The folds that an approach (`inward`) or a retreat leaves in its jumps, and the branches on which these land.

    A branch is followed to the fold at its end.  The jump lands on the next branch that has the displacement of the
    fold; branches that do not have it are passed over.

    Parameters
    ----------
    branches : sequence of Branch
        From separation into contact.
    inward : bool

    Returns
    -------
    list of (bracket, Branch)
        In the order of the jumps.

    Raises
    ------
    NotConverged
        When no branch has the displacement of a fold.

    Examples
    --------
    >>> outer, middle = Branch(high="A", largest=-9.0), Branch("B", "C", -135.0, -119.0)
    >>> inner = Branch(low="D", least=-122.0)
    >>> jumps_between([outer, middle, inner], inward=True) == [("A", inner)]
    True
    >>> jumps_between([outer, middle, inner], inward=False) == [("D", middle), ("B", outer)]
    True
    """
    # A retreat is an approach with the sign of the displacement changed.
    order = branches if inward else branches[::-1]
    starts = [one.least if inward else -one.largest for one in order]
    ends = [one.largest if inward else -one.least for one in order]
    folds = [one.high if inward else one.low for one in order]
    found, here = [], 0
    while (fold := folds[here]) is not None:
        level, later = ends[here], range(here + 1, len(order))
        here = next((i for i in later if starts[i] <= level < ends[i]), -1)
        if here < 0:
            raise NotConverged(
                f"no other stable branch of the path has the displacement {level if inward else -level:.6g}, "
                f"at which a jump-{'in' if inward else 'out'} begins"
            )
        found.append((fold, order[here]))
    return found
