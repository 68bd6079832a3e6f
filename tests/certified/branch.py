"""Certified branch of equilibria over a wide interval of displacements, with one minimum of the load.

The interval is covered by pieces, each with its own approximate state and tube (`state_bounds`).  Neighbours share a
displacement, at which the state of the first piece is in the tube of the second: by uniqueness in the tube both are one
state.  So the pieces are parts of one smooth branch.  If P' < 0 is proved on the first pieces, P'' > 0 on the next
ones, and P' > 0 on the rest, P has exactly one minimum on the branch.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from itertools import pairwise, zip_longest

from flint import arb, ctx

from tests.certified.approximate_states import ApproximateStates, approximate_states
from tests.certified.panel_bounds import NotProved, panel_bounds
from tests.certified.panel_functions import BITS
from tests.certified.sphere_form import SphereForm, cubic_coefficients
from tests.certified.state_bounds import StateEnclosure, enclose

# A piece may be this wide, and has to be at least so wide; a rejected one is halved, the next one is tried wider.
_WIDEST, _NARROWEST, _GROWTH = 2e-2, 1e-5, 1.3
# Neighbours overlap by this part of a half-width, so that the rounding of a centre leaves no space between them.
_OVERLAP = 1e-6
_TUBE = arb(1e-3)


class Shape(Enum):
    """What is proved of P on a piece."""

    FALLS = 0
    CONVEX = 1
    RISES = 2


@dataclass(frozen=True)
class Piece:
    """Equilibria for every displacement within `eta` of that of `states`."""

    states: ApproximateStates
    eta: float
    enclosure: StateEnclosure
    shape: Shape

    @property
    def lower(self) -> arb:
        """Least displacement."""
        return arb(self.states.delta) - arb(self.eta)

    @property
    def upper(self) -> arb:
        """Greatest displacement."""
        return arb(self.states.delta) + arb(self.eta)


def piece(states: ApproximateStates, panel_count: int, eta: float) -> Piece:
    """One piece, if its equilibria and the shape of P are proved.

    Raises
    ------
    NotProved
        If they are not.
    """
    enclosure = enclose(states, panel_bounds(states, panel_count), arb(eta), _TUBE)
    if enclosure.first < 0:
        shape = Shape.FALLS
    elif enclosure.first > 0:
        shape = Shape.RISES
    elif enclosure.second > 0:
        shape = Shape.CONVEX
    else:
        raise NotProved(f"P neither falls, rises nor is convex: P' = {enclosure.first.str(5)}")
    return Piece(states, eta, enclosure, shape)


def linked(before: Piece, after: Piece) -> bool:
    """Whether both pieces have the same state at the end of the first one; their degrees may differ."""
    mine, other = before.states.form, after.states.form
    if (mine.mu, mine.length) != (other.mu, other.length):
        return False
    with ctx.workprec(BITS):
        end = before.upper
        if not (after.lower <= end <= after.upper):
            return False
        pairs = zip_longest(_deformation(before.states, end), _deformation(after.states, end), fillvalue=arb(0))
        # abs(P_l) <= 1.
        distance = sum((abs(a - b) for a, b in pairs), arb(0))
        return bool(distance + before.enclosure.distance < _TUBE)


def _deformation(states: ApproximateStates, delta: arb) -> list[arb]:
    """Legendre coefficients of the approximate W."""
    form, t = states.form, delta - arb(states.delta)
    parts = zip(states.traction, states.first, states.second, cubic_coefficients(form.degree), strict=True)
    return form.deformed([a + t * b + t * t * c / 2 + states.far * d for a, b, c, d in parts])


def branch(form: SphereForm, panel_count: int, lower: float, upper: float) -> list[Piece]:
    """Pieces that cover [lower, upper], each linked to the next.

    Raises
    ------
    NotProved
        If a piece of the least width is not proved, or two neighbours are not linked.
    """
    pieces: list[Piece] = []
    reached, eta = lower, _WIDEST
    while not pieces or not pieces[-1].upper >= arb(upper):
        try:
            new = piece(approximate_states(form, reached + eta * (1 - _OVERLAP)), panel_count, eta)
        except NotProved:
            eta /= 2
            if eta < _NARROWEST:
                raise
            continue
        if pieces and not linked(pieces[-1], new):
            raise NotProved(f"two pieces at {reached} are not linked")
        pieces.append(new)
        reached, eta = new.states.delta + eta, min(_GROWTH * eta, _WIDEST)
    return pieces


def one_minimum(pieces: list[Piece]) -> bool:
    """Whether P falls, then is convex, then rises: one minimum, in the convex part."""
    shapes = [p.shape for p in pieces]
    in_order = all(a.value <= b.value for a, b in pairwise(shapes))
    return in_order and shapes[0] is Shape.FALLS and shapes[-1] is Shape.RISES
