"""Knots of a punch between the lines of a mesh, which ask for elements of other lengths."""

import numpy as np
import pytest

from fem_reference import Ball, CustomPunch, Homogeneous, LennardJones, PowerPunch, Problem
from fem_reference._contact.mesh_lengths import KINK_HEIGHT
from fem_reference._contact.other_lengths import has_knots

#: Radii of mesh lines, one between them, and a middle of two, where every other coefficient is 0.
LINES, INSIDE, MIDDLE = np.array([0.0, 0.5, 1.0, 1.5, 3.0, 8.0, 20.0, 40.0]), 1.7, 2.25
R = 1.0
#: Radius at which the paraboloid is as high as knots matter.
REACH = (2.0 * R * KINK_HEIGHT) ** 0.5


def _knots_of(punch):
    return has_knots(Problem(Homogeneous(1.0, 0.3), punch, LennardJones(1.0, 1.0)), LINES)


def _bent(at, order, size=0.1):
    def height(r):
        x = np.clip(r - at, 0.0, 100.0 * at)
        return r**2 / (2.0 * R) + size * x**order * np.exp(-((x / at) ** 2))

    return CustomPunch(height, 2.0)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_a_jump_of_a_derivative_is_a_knot_unless_it_is_a_line(order):
    assert _knots_of(_bent(INSIDE, order))
    assert _knots_of(_bent(MIDDLE, order))
    assert not _knots_of(_bent(LINES[3], order))


def test_a_jump_beyond_the_reach_of_the_law_is_none():
    assert LINES[-2] < REACH < LINES[-1]
    assert not _knots_of(_bent(1.01 * REACH, 2))
    assert _knots_of(_bent(0.95 * REACH, 2))


def test_a_small_jump_is_a_knot_as_well():
    """It moves the height by up to 7e-3 z0 within an element; its coefficient is between 1e-10 and 1e-9."""
    assert _knots_of(_bent(INSIDE, 3, 3e-3))
    assert not _knots_of(_bent(INSIDE, 3, 1e-5))


@pytest.mark.parametrize(
    "punch",
    [
        PowerPunch(2.5, 3.0),
        # Its singularity is next to the end of an element.
        Ball(21.1),
        # In a form that cancels near the tip.
        CustomPunch(lambda r: 30.0 * (np.sqrt(1.0 + (r / 30.0) ** 2) - 1.0), 1.0),
        CustomPunch(lambda r: r**2 / 2.0 + 0.3 * (1.0 - np.exp(-(r**2) / 10.0)), 2.0),
    ],
)
def test_a_smooth_punch_has_none(punch):
    assert not _knots_of(punch)
