"""Turning points of a displacement."""

import numpy as np
import pytest

from comparisons.paper.statements.paths import jumps, turning_points

T = np.linspace(0.0, 1.0, 401)


@pytest.mark.parametrize(
    ("displacement", "u", "count"),
    [
        (T, 1e-9, 0),
        (np.sin(2.5 * np.pi * T), 1e-9, 2),
        (np.sin(6.5 * np.pi * T), 1e-9, 6),
        # Ripples within twice the bound are no turns.
        (T + 1e-3 * np.sin(40 * np.pi * T), 2e-3, 0),
        (np.sin(2.5 * np.pi * T) + 1e-3 * np.sin(60 * np.pi * T), 2e-3, 2),
    ],
)
def test_turns_are_counted_beyond_the_bound(displacement, u, count):
    assert len(turning_points(displacement, u)) == count


@pytest.mark.parametrize(
    ("corners", "count"),
    [
        ([0, 1], 0),
        ([0, 2, 1, 3], 2),
        # An inner pair within the outer one is passed over both ways.
        ([0, 4, 2, 3, 1, 5], 2),
        # A second maximum above the first stops the machine before it, on the way there or on the way back.
        ([0, 3, 2, 4, 1, 5], 3),
        ([0, 4, 1, 3, 2, 5], 3),
        ([0, 2, 1, 4, 3, 5], 4),
        # A second maximum above the first by less than the bound of the displacement is none.
        ([0, 2, 1, 2, 1 + 1e-4, 3], 2),
    ],
)
def test_jumps_are_those_that_a_machine_sees(corners, count):
    displacement = np.interp(np.linspace(0, len(corners) - 1, 20 * len(corners)), range(len(corners)), corners)
    assert jumps(np.array(displacement), 1e-3) == count
