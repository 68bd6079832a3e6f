"""Turning points of a displacement."""

import numpy as np
import pytest

from comparisons.paper.statements.paths import turning_points

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
