"""Rates of states from their neighbours on a branch between two kinks of a punch."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference._contact.path import RATE_POINTS, filled, with_rates

#: Ends of a branch shorter than a step of the path, and the state that a step leaves next to the first.
ENDS, BESIDE = (13.36, 15.83), 13.54
#: Share of the largest rate that five states leave (measured: 0.07; three in equal steps leave 0.5).
LEFT = 0.1


@dataclass(frozen=True)
class _Point:
    parameter: float
    rates: tuple[float, float] | None = None

    @property
    def state(self):
        return SimpleNamespace(load=_load(self.parameter), displacement=self.parameter)


def _load(radius):
    """Falls to a minimum before the end, as on a facet of a table."""
    x = radius - ENDS[0]
    return -90.0 - 1.2 * x + 0.08 * np.exp(1.5 * x)


def _rate(radius):
    return -1.2 + 0.12 * np.exp(1.5 * (radius - ENDS[0]))


def test_a_short_branch_has_the_rates_of_its_load():
    points = with_rates(filled(_Point, [_Point(radius) for radius in (ENDS[0], BESIDE, ENDS[1])]))
    assert [point.parameter for point in points[:: RATE_POINTS - 1]] == pytest.approx(ENDS)
    found, exact = (np.array(rates) for rates in zip(*((p.rates[0], _rate(p.parameter)) for p in points), strict=True))
    assert abs(found - exact).max() < LEFT * abs(exact).max()


def test_a_long_branch_stays():
    branch = [_Point(radius) for radius in np.geomspace(1.0, 3.0, RATE_POINTS)]
    assert filled(_Point, branch) == branch
