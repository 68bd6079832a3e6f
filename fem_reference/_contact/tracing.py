"""Extent of a traced path: where it begins far away, and where it ends in compression."""

from __future__ import annotations

from collections.abc import Sequence

from fem_reference._contact.completeness import displacement_range
from fem_reference._contact.contact import Contact
from fem_reference._contact.path import Point, continuation, equilibrium_points

__all__ = ["beginning", "traced"]

#: Lengths of the law by which a path begins below the displacement of its jump out of contact.
FARTHER = 2.0


def traced(contact: Contact) -> list[Point]:
    """Trace the path until the load is compressive again and every fold is on it, with the ends of both jumps.

    Parameters
    ----------
    contact : Contact
        The problem on one mesh.

    Returns
    -------
    list of Point
        In the order of the path, from far away into compression.

    Raises
    ------
    NotConverged
        If the path cannot be followed.
    """
    approach: list[Point] = []
    touching: list[Point] = []
    for point in equilibrium_points(contact):
        (touching if point.branch.touching else approach).append(point)
        settled = point.state.load > 0 and point.displacement_rate > 0 and point.load_rate > 0
        # After a jump-in, the contact branch at the displacement of the jump belongs to the hysteresis cycle.
        if touching and settled and point.state.displacement >= _highest_fold(approach, touching):
            break
    return [*beginning(approach, touching), *approach, *touching]


def _highest_fold(approach: Sequence[Point], touching: Sequence[Point]) -> float:
    """Bound of the displacements at which it turns from rising to falling."""
    falling = [i for i, point in enumerate(touching) if point.displacement_rate < 0]
    to_last_fold = touching[: falling[-1] + 1] if falling else touching[:1]
    return max(displacement_range(approach)[1], displacement_range(to_last_fold)[1])


def beginning(approach: Sequence[Point], touching: Sequence[Point]) -> list[Point]:
    """Points before the first, out to the displacement where a jump out of contact ends."""
    outermost, length = approach[0], approach[0].branch.contact.law.z0
    falling = [i for i, point in enumerate(approach) if point.displacement_rate < 0]
    segments = (approach[falling[0] :] if falling else approach[-1:], touching)
    lowest = min(displacement_range(segment)[0] for segment in segments if segment)
    if lowest > outermost.state.displacement:
        return []
    # The solid rises under tension: the displacement is below -H0.
    farthest = FARTHER * length - lowest
    return list(continuation(outermost, farthest - outermost.parameter, farthest))[::-1]
