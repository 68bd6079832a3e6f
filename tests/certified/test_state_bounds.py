"""Bounds on panels and in tubes against values and derivatives at points, by power series."""

import pytest
from flint import arb, arb_series, ctx, fmpq

from tests.certified.approximate_states import ApproximateStates, approximate_states
from tests.certified.panel_bounds import PanelBounds, panel_bounds
from tests.certified.panel_functions import BITS, panels
from tests.certified.sphere_form import SphereForm, cubic_coefficients
from tests.certified.state_bounds import _slopes

FORM, COUNT = SphereForm(fmpq(1, 10), 5, 60), 40
# Panels at infinity, at the edge of the attraction and at the centre.
INDICES = [0, 3, 20, 33, 36, 38, 39]
PLACES = (0.0, 0.3, 1.0)


@pytest.fixture(scope="module")
def states() -> ApproximateStates:
    return approximate_states(FORM, -0.05)


@pytest.fixture(scope="module")
def bounds(states: ApproximateStates) -> list[PanelBounds]:
    return panel_bounds(states, COUNT)


def law(x: arb, gap: arb_series) -> arb_series:
    """N as a power series."""
    third = 1 / (gap * gap * gap)
    return -arb(8) / 3 * (x**3 * third - x**15 * third * third * third)


def along(states: ApproximateStates, x: arb) -> tuple[arb_series, arb_series, list[arb]]:
    """Pi* and the gap as power series in t = delta - delta*, and the coefficients of W*."""
    legendre = [(2 * x * x - 1).legendre_p(order) for order in range(FORM.degree + 1)]

    def value(series: list[arb]) -> arb:
        return sum((a * b for a, b in zip(series, legendre, strict=True)), arb(0))

    cubic = [states.far * b for b in cubic_coefficients(FORM.degree)]
    traction = [value(states.traction) + states.far * x**3, value(states.first), value(states.second) / 2]
    W = [
        value(FORM.deformed([a + b for a, b in zip(states.traction, cubic, strict=True)])),
        value(FORM.deformed(states.first)),
        value(FORM.deformed(states.second)) / 2,
    ]
    base = x * x * (1 - arb(states.delta)) + (1 - x * x) * FORM.length**2 / 2
    return arb_series(traction), arb_series([base + x**3 * W[0], x**3 * W[1] - x * x, x**3 * W[2]]), W


@pytest.mark.parametrize("index", INDICES)
def test_the_bounds_of_a_panel_cover_its_points(states, bounds, index):
    panel, bound = panels(COUNT)[index], bounds[index]
    largest = [arb(0)] * 3
    with ctx.workprec(BITS):
        for t in map(arb, PLACES):
            x = panel.centre + panel.half * t
            Pi, gap, W = along(states, x)
            defect = Pi - law(x, gap)
            for order, factor in enumerate((1, 1, 2)):
                value = abs(factor * defect[order])
                assert value <= bound.defects[order]
                largest[order] = largest[order].max(value)
            assert bound.gap.overlaps(gap[0])
            assert abs(x * W[1] - 1) <= bound.rate
            assert abs(2 * W[2]) <= bound.second
            slopes, top = _slopes(bound, arb(0), arb(0)), bound.sigma.upper()
            third = slopes.third * bound.rate**3 + 3 * slopes.second * top * bound.rate * bound.second
            assert abs(6 * defect[3]) <= third
    # The bounds are not loose: measured, the points reach 0.05 of them on each panel.
    assert all(value > limit / 40 for value, limit in zip(largest, bound.defects, strict=True))


@pytest.mark.parametrize("index", INDICES)
@pytest.mark.parametrize(("move", "radius"), [(0.0, 0.0), (0.01, 0.003)])
def test_the_slopes_of_a_tube_cover_its_points(states, bounds, index, move, radius):
    panel, bound = panels(COUNT)[index], bounds[index]
    with ctx.workprec(BITS):
        slopes = _slopes(bound, arb(move), arb(radius))
        limits = (slopes.first, slopes.second, slopes.third)
        for t in map(arb, PLACES):
            x = panel.centre + panel.half * t
            _, gap, _ = along(states, x)
            for sign in (-1, 1):
                n = gap[0] + sign * x * x * (arb(move) + x * arb(radius))
                series = law(x, arb_series([n, x**3]))
                values = [abs(series[1]) / x, abs(2 * series[2]) / x**2, abs(6 * series[3]) / x**3]
                assert all(value <= limit for value, limit in zip(values, limits, strict=True))
        if move == 0.0:
            # At infinity sigma^4 and more varies by orders over one panel; the slopes change their sign elsewhere.
            assert index == 0 or max(float(v / m) for v, m in zip(values, limits, strict=True)) > 0.1
