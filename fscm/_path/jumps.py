"""Jumps of a slow cycle of prescribed displacement, from branch to branch of the equilibrium path."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from fscm._path.events import Bracket
from fscm.errors import Failure, NotConverged

__all__ = ["Branch", "jumps_between", "with_accurate_ends"]

#: Ends of branches that differ by less than this, relative to 1 + |delta|, are compared on a finer mesh.
_NEAR = 1e-2


@dataclass(frozen=True)
class Branch:
    """A section of the path that is stable under prescribed displacement; along it the displacement rises.

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
    """The jumps of an approach (`inward`) or a retreat: from which fold, and to which branch.

    A branch is followed to the fold at its end.  The jump lands on the next branch that contains the displacement of
    the fold; other branches are passed over.

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
        When no branch contains the displacement of a fold.

    Examples
    --------
    >>> outer, middle = Branch(high="A", largest=-9.0), Branch("B", "C", -135.0, -119.0)
    >>> inner = Branch(low="D", least=-122.0)
    >>> jumps_between([outer, middle, inner], inward=True) == [("A", inner)]
    True
    >>> jumps_between([outer, middle, inner], inward=False) == [("D", middle), ("B", outer)]
    True
    """
    # A retreat is an approach with the opposite sign of the displacement.
    order = branches if inward else branches[::-1]
    starts = [branch.least if inward else -branch.largest for branch in order]
    ends = [branch.largest if inward else -branch.least for branch in order]
    folds = [branch.high if inward else branch.low for branch in order]
    jumps, index = [], 0
    while (fold := folds[index]) is not None:
        level, later = ends[index], range(index + 1, len(order))
        index = next((i for i in later if starts[i] <= level < ends[i]), -1)
        if index < 0:
            raise NotConverged(
                f"no other stable branch of the path has the displacement {level if inward else -level:.6g}, "
                f"at which a jump-{'in' if inward else 'out'} begins",
                Failure.BRANCH,
            )
        jumps.append((fold, order[index]))
    return jumps


def with_accurate_ends(branches: Sequence[Branch], displacement_of: Callable[[Bracket], float]) -> list[Branch]:
    """The branches, with more accurate displacements at ends that are close to each other.

    Parameters
    ----------
    branches : sequence of Branch
    displacement_of : callable
        Bracket of a fold -> its displacement on a finer mesh.
    """
    ends = [end for branch in branches for end in (branch.least, branch.largest) if math.isfinite(end)]

    def at(bracket: Bracket | None, displacement: float) -> float:
        if bracket is None or sum(abs(displacement - end) < _NEAR * (1.0 + abs(displacement)) for end in ends) == 1:
            return displacement
        return displacement_of(bracket)

    return [
        replace(branch, least=at(branch.low, branch.least), largest=at(branch.high, branch.largest))
        for branch in branches
    ]
