"""What the continuation of a path relies on, by the punch and the law.

The path of a power-law punch under a law with one well turns at its folds alone.  That of any other punch may turn
sharply where asperities come into contact, and pass close to other branches; so may the path of a law with several
wells, whose barriers are passed one after the other.  With kinks, the mesh moves when the scale does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm._path.arc_length import ArcLength, Point
from fscm._path.edge_width import log_edge_width
from fscm._surface.state import State
from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.problem import Problem
from fscm.punch import PowerPunch, kinks_of
from fscm.wells import has_one_well

__all__ = ["AnyPunch", "Tracking", "rules_of"]

#: Cosine of the angle between two tangents below which a step is repeated with a shorter length: a fold pair turns the
#: path twice and must not be stepped over.
_LARGEST_TURN = 0.85
#: Largest deviation from the trapezoidal rule, relative to the distance of a gap to the singular gap.
_LARGEST_DEVIATION = 0.5
#: The gaps within this multiple of the edge radius determine the orientation of the path.
_NEAR_EDGE = 2.0
#: Beyond the largest tension the path of a power-law punch is smooth: steps grow with the compression, at most to this
#: multiple.  Measured: cubics through the points are as near to a path of small steps as without it (loads to 1000).
_LONGER_IN_COMPRESSION = 8.0
#: The turn of a step is not checked below this length.  Other punches than power laws: a cavity that snaps shut turns
#: the path within 0.01 (measured).
_UNCHECKED_STEP, _UNCHECKED_STEP_OF_ASPERITIES = 0.02, 0.002
#: At a fold of its parameter the path continues in another one, as long as that makes up this share of the tangent.
_LEAST_SHARE = 0.3
#: If the mesh moves with kinks, the usual parameter is taken above this share of the tangent.
_GIVEN_SHARE = 0.05
#: The edge is followed beyond this multiple of the radius of the last kink: a fixed mesh allows steps of the width of
#: the edge only.  Measured: 800 points in place of over 1800 up to a displacement of 91 (random punch 24).
_BEYOND_KINKS = 1.2
#: Decimal logarithm of the width of the cohesive edge, in units of the initial radius, above which a mesh of fixed
#: scale resolves it along the path.
_WIDE = -1.5


@dataclass(frozen=True)
class Tracking:
    """Options of the continuation.

    Attributes
    ----------
    follow : bool
        Whether the mesh follows the contact edge; if not, its scale stays fixed.
    largest_deviation : float
        Largest deviation of a step from the trapezoidal rule, relative to the distance of a gap to the singular gap.
    longest_step : float
        Of the arc length.
    newton : float, optional
        Tolerance of Newton's method; by default its error is negligible relative to that of the mesh.
    largest_turn : float
        Cosine of the angle between two tangents below which a step is repeated with a shorter length.
    prescribed : bool
        Whether a step prescribes the continuation parameter instead of the arc length, unless it hardly changes.
    """

    follow: bool = True
    largest_deviation: float = _LARGEST_DEVIATION
    longest_step: float = math.inf
    newton: float | None = None
    largest_turn: float = _LARGEST_TURN
    prescribed: bool = False


#: Measured: two of a hundred random punches, a ring and waves, need _CAREFUL, because two branches come close.
_FIXED, _CAREFUL = Tracking(follow=False), Tracking(False, 0.1 * _LARGEST_DEVIATION, 0.2)


class AnyPunch:
    """Rules for a punch without kinks that may have asperities, or a law that may have barriers.

    Attributes
    ----------
    may_hide_folds : bool
        Whether folds of the displacement may be anywhere between the points of the path.
    prescribes : bool
        Whether a step prescribes the continuation parameter.
    unchecked_step : float
        Step whose turn is not checked.
    least_share, given_share : float
        Share of the tangent below which another parameter is taken, and above which the usual one is taken again.
    """

    may_hide_folds = True
    prescribes = False
    unchecked_step = _UNCHECKED_STEP_OF_ASPERITIES
    least_share, given_share = _LEAST_SHARE, math.inf

    def trackings(self, problem: Problem) -> list[Tracking]:
        """Options that are tried one after the other: a mesh of fixed scale, too, if the edge is wide."""
        return [Tracking(), _FIXED, _CAREFUL] if log_edge_width(problem) > _WIDE else [Tracking()]

    def follows_edge(self, tracking: Tracking, state: State, hand_over: float) -> bool:
        """Whether the mesh follows the edge of a contact."""
        return tracking.follow

    def stretch(self, load: float, tension: float) -> float:
        """Factor of the longest step at a load, with the largest tension so far."""
        return 1.0

    def turns_too_far(self, turn: float, tracking: Tracking) -> bool:
        """Whether a step has to be repeated, by the cosine of its turn."""
        return abs(turn) < tracking.largest_turn

    def goes_on(self, a: Point, b: Point, step: float, turn: float, tracking: Tracking) -> bool:
        """Whether b has the orientation of a.

        Raises
        ------
        NotConverged
            If b lies on another branch.
        """
        same = turn >= 0.0 if abs(turn) >= tracking.largest_turn else None
        return checked_orientation(a, b, step, same, tracking.largest_deviation)

    def joins(self, arc: ArcLength, before: Point, after: Point) -> bool:
        """Whether the same state, on a mesh that follows another edge, has the orientation of before.

        It is that of load and displacement.  Where contact begins it is that of the central gap, too.
        """
        old, new = arc.shares(before), arc.shares(after)
        product = sum(old[name] * new[name] for name in ("displacement", "load"))
        if not before.state.anchor.in_contact:
            clearance = after.state.central_gap - after.state.disc.problem.law.singular_gap
            product += before.rates.central_gap * after.rates.central_gap / clearance**2
        return product >= 0.0


class _PowerLaw(AnyPunch):
    """Rules for a power-law punch under a law with one well."""

    may_hide_folds = False
    unchecked_step = _UNCHECKED_STEP

    def trackings(self, problem: Problem) -> list[Tracking]:
        return [Tracking()]

    def stretch(self, load: float, tension: float) -> float:
        return min(max(1.0, load / max(1.0, tension)), _LONGER_IN_COMPRESSION)

    def turns_too_far(self, turn: float, tracking: Tracking) -> bool:
        return turn < tracking.largest_turn

    def goes_on(self, a: Point, b: Point, step: float, turn: float, tracking: Tracking) -> bool:
        return turn >= 0.0

    def joins(self, arc: ArcLength, before: Point, after: Point) -> bool:
        # The first contact may be so small that load and displacement do not change within the error of the mesh.
        return before.rates.central_gap * after.rates.central_gap >= 0.0


class _Kinked(AnyPunch):
    """Rules for a punch with kinks, with which the mesh moves: with a prescribed scale no node passes one."""

    prescribes = True
    least_share = given_share = _GIVEN_SHARE

    def trackings(self, problem: Problem) -> list[Tracking]:
        return [_FIXED, Tracking(), _CAREFUL] if log_edge_width(problem) > _WIDE else [Tracking()]

    def follows_edge(self, tracking: Tracking, state: State, hand_over: float) -> bool:
        """As for `AnyPunch`: a fixed mesh does so, too, once the edge is outside all kinks."""
        touching = state.radius[state.gap < hand_over]
        outside = touching.size and touching[-1] > _BEYOND_KINKS * max(kinks_of(state.disc.problem.punch))
        return tracking.follow or bool(outside)


def rules_of(problem: Problem) -> AnyPunch:
    """The rules for the punch and the law of a problem."""
    if isinstance(problem.punch, PowerPunch) and has_one_well(problem.law):
        return _PowerLaw()
    return _Kinked() if kinks_of(problem.punch) else AnyPunch()


def _relative(state: State) -> Array:
    """Gaps; of a steep punch without its height, which is not linear in log c within a step."""
    return state.relative_to_punch(state.unknowns, state.displacement)


def _relative_rates(point: Point) -> Array:
    return point.state.relative_to_punch(point.rates.unknowns, point.rates.displacement)


def checked_orientation(a: Point, b: Point, step: float, same: bool | None, largest: float) -> bool:
    """Whether b has the orientation of a.  Raises NotConverged if b lies on another branch.

    Near a sharp turn of the path, where load and displacement are undecided (`same` is None), it is that of the gaps
    inside the contact.
    """
    old_mesh, new_mesh = a.state.disc.mesh, b.state.disc.mesh
    offsets = np.minimum(new_mesh.seen_from(old_mesh.origin), old_mesh.offsets[-1])
    before, rate = (
        old_mesh.evaluate_at_offsets(_relative(a.state), offsets),
        old_mesh.evaluate_at_offsets(_relative_rates(a), offsets),
    )
    after, new_rate = _relative(b.state), _relative_rates(b)
    clearance = b.state.gap - a.state.disc.problem.law.singular_gap
    near_edge = new_mesh.nodes < _NEAR_EDGE
    product = new_mesh.weights * new_mesh.nodes * rate * new_rate / clearance**2
    if same is None:
        same = bool(np.sum(product[near_edge]) >= 0.0)
    deviation = after - before - 0.5 * step * (rate + (1.0 if same else -1.0) * new_rate)
    if np.max(np.abs(deviation) / clearance) > largest:
        raise NotConverged("Newton converged to a state on another branch of the path", Failure.ITERATION)
    return same
