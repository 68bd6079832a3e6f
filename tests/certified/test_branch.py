"""Certified branch: pieces, their links, and the one minimum on it."""

from dataclasses import replace

import pytest
from flint import arb, fmpq

from tests.certified.approximate_states import approximate_states
from tests.certified.branch import Piece, Shape, branch, linked, one_minimum, piece
from tests.certified.panel_bounds import NotProved
from tests.certified.pull_off_enclosure import CERTIFIED
from tests.certified.sphere_form import SphereForm

FORM, COUNT = SphereForm(fmpq(1, 10), 5, 60), 40
LONG_FORM, LONG_COUNT = SphereForm(fmpq(1, 10), 5, 120), 64
PULL_OFF = -0.0586


@pytest.fixture(scope="module")
def pieces() -> list[Piece]:
    return branch(FORM, COUNT, -0.08, -0.045)


def test_a_short_branch_has_one_minimum(pieces):
    assert one_minimum(pieces)
    assert pieces[0].lower <= arb(-0.08)
    assert pieces[-1].upper >= arb(-0.045)
    assert any(p.lower < PULL_OFF < p.upper for p in pieces if p.shape is Shape.CONVEX)
    # It needs the order.
    assert not one_minimum(pieces[::-1])
    assert not one_minimum(pieces[:1])


def test_neighbours_are_linked_and_others_are_not(pieces):
    before, after, *_ = pieces
    assert linked(before, after)
    # They share no displacement.
    assert not linked(after, before)
    # The second one is a state of another displacement, or of another problem.
    moved = replace(after.states, first=[10 * x for x in after.states.first])
    assert not linked(before, replace(after, states=moved))
    assert not linked(before, replace(after, states=replace(after.states, form=replace(FORM, mu=fmpq(1, 2)))))


def test_a_piece_that_is_too_wide_is_not_proved():
    with pytest.raises(NotProved):
        piece(approximate_states(FORM, PULL_OFF), COUNT, 0.1)


@pytest.mark.heavy
def test_the_certified_pull_off_is_the_only_minimum_of_a_long_branch():
    certified = CERTIFIED["mu = 1/10"]
    pieces = branch(LONG_FORM, LONG_COUNT, -1.0, 0.45)
    assert one_minimum(pieces)
    assert pieces[0].enclosure.load > -0.75
    assert pieces[-1].enclosure.load > 0
    states = approximate_states(certified.form, float(arb(certified.displacement)))
    at_pull_off = piece(states, certified.panel_count, certified.eta)
    around = [p for p in pieces if p.shape is Shape.CONVEX and linked(at_pull_off, p)]
    assert around
    assert around[0].lower < at_pull_off.lower
