"""The cohesive stress against the printed Eq. 77 in 60-digit arithmetic, and against the printed values."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

from comparisons.model import NotApplicable
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from fscm.laws import LennardJones


@pytest.mark.parametrize(
    "n", [0.7, 1.0, 1.59, 1.61, 1.9, 2 - 1e-6, 2 - 1e-15, 2 + 1e-12, 2.1, 2.66, 2.67, 5.0, 1e3, 1e8]
)
def test_equals_printed_formula(n: float) -> None:
    """Eq. 77 as printed; 60 digits absorb the 0/0 at n = 2."""
    with mp.workdps(60):
        x = mp.mpf(n)
        base = 32 / (9 * x - 2) * mp.beta(3 - 2 / x, 2 / x) * (168 * mp.beta(4 - 2 / x, 6)) ** ((3 - 2 / x) / 6)
        expected = float(base ** (x / (x - 2)))
    assert eta(n) == pytest.approx(expected, rel=1e-14)


def test_at_two_and_in_the_limit_of_a_flat_punch() -> None:
    assert eta(2.0) == pytest.approx(eta(2.0 + 1e-15), rel=1e-14)
    peak = float(-LennardJones().traction(np.linspace(0.1, 0.3, 20001)).min())
    assert eta(math.inf) == pytest.approx(THEORETICAL_STRENGTH, rel=1e-14)
    assert peak == pytest.approx(THEORETICAL_STRENGTH, rel=1e-8)


@pytest.mark.parametrize("n", [0.5, 2 / 3])
def test_refuses_an_infinite_rigid_load(n: float) -> None:
    with pytest.raises(NotApplicable, match="2/3"):
        eta(n)
