"""Enclosures on panels against values."""

import random
from itertools import pairwise

import pytest
from flint import arb, arb_poly, ctx

from tests.certified.panel_functions import BITS, DEGREE, absolute, cut, least, monomials, panels, powers, product

COUNT = 24
PANELS = panels(COUNT)
# Exact numbers, as the approximate states are.
SERIES = [(arb(random.Random(order).uniform(-1, 1)) / (order + 1) ** 2).mid() for order in range(81)]
PLACES = (-1.0, -0.4, 0.0, 0.7, 1.0)


def value(x: arb) -> arb:
    s = 2 * x * x - 1
    return sum((a * s.legendre_p(order) for order, a in enumerate(SERIES)), arb(0))


@pytest.mark.parametrize("index", [0, 1, 11, COUNT - 2, COUNT - 1])
def test_an_enclosure_contains_the_function(index):
    panel = PANELS[index]
    polynomial = monomials(SERIES)
    with ctx.workprec(BITS):
        series = panel.series(polynomial)
        combined = product(series, *powers(panel.sigma, 3)[1:])
        smallest, largest = least(series), absolute(series)
        for t in map(arb, PLACES):
            x = panel.centre + panel.half * t
            with ctx.workprec(2 * BITS):
                exact = value(x)
            assert series(t).overlaps(exact)
            assert combined(t).overlaps(exact * x**6)
            assert smallest <= exact.upper()
            assert abs(exact).lower() <= largest
        # Not only because the enclosure is wide; measured: 2e-29.
        assert series(arb(0)).rad() < 1e-25


def test_the_panels_cover_the_surface_and_what_is_cut_is_in_the_radius():
    ends = [(panel.lower, panel.upper) for panel in PANELS]
    assert (ends[0][0], ends[-1][1]) == (0, 1)
    assert all(bool(a[1] == b[0]) for a, b in pairwise(ends))
    polynomial = arb_poly([1] + [0] * DEGREE + [0.25, -0.125])
    short = cut(polynomial)
    assert short.degree() <= DEGREE
    for t in map(arb, PLACES):
        assert short(t).contains(polynomial(t))
    # The dropped terms are not lost: the constant alone does not contain the value.
    assert not arb(1).contains(polynomial(arb(1)))
