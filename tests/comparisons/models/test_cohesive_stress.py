"""The cohesive stress against the printed Eq. 77 in 60-digit arithmetic, and against the printed values."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

from comparisons.model import NotApplicable
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from fscm.laws import LennardJones


def printed_eta(n: float) -> mp.mpf:
    """Eq. 77 as printed; 60 digits absorb the 0/0 at n = 2."""
    with mp.workdps(60):
        n = mp.mpf(n)
        base = 32 / (9 * n - 2) * mp.beta(3 - 2 / n, 2 / n) * (168 * mp.beta(4 - 2 / n, 6)) ** ((3 - 2 / n) / 6)
        return base ** (n / (n - 2))


@pytest.mark.parametrize(("n", "printed"), [(1, 0.347), (1.5, 0.499), (2, 0.588), (5, 0.803)])
def test_printed_values(n: float, printed: float) -> None:
    assert round(eta(n), 3) == printed


@pytest.mark.parametrize("n", [0.7, 0.8, 1.0, 1.3, 1.59, 1.61, 1.9, 2.1, 2.66, 2.67, 3.0, 5.0, 12.0, 1e3, 1e8])
def test_equals_printed_formula(n: float) -> None:
    assert eta(n) == pytest.approx(float(printed_eta(n)), rel=1e-14)


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("distance", [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_smooth_through_two(distance: float, side: int) -> None:
    n = 2.0 + side * distance
    assert eta(n) == pytest.approx(float(printed_eta(n)), rel=1e-14)


def test_at_two_exactly() -> None:
    # The mean over a symmetric pair, h = 1e-6, misses eta(2) by h^2 eta'' / 2 < 1e-12.
    assert eta(2.0) == pytest.approx(float(printed_eta(2 - 1e-6) + printed_eta(2 + 1e-6)) / 2, rel=2e-12)


def test_flat_punch_limit_is_the_theoretical_strength() -> None:
    assert eta(math.inf) == pytest.approx(THEORETICAL_STRENGTH, rel=1e-14)


def test_theoretical_strength_is_the_peak_of_the_law() -> None:
    law = LennardJones()
    gaps = np.linspace(0.1, 0.3, 20001)
    peak = float(-law.traction(gaps).min())
    assert peak == pytest.approx(THEORETICAL_STRENGTH, rel=1e-8)


def test_grows_with_n() -> None:
    values = [eta(n) for n in np.geomspace(0.68, 100.0, 200)]
    assert np.all(np.diff(values) > 0)


@pytest.mark.parametrize("n", [0.5, 2 / 3])
def test_refuses_an_infinite_rigid_load(n: float) -> None:
    with pytest.raises(NotApplicable, match="2/3"):
        eta(n)
