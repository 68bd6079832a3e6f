"""Bounds on each panel: defects of the approximate states, surplus of the comparison functions, and ranges."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, arb_poly, ctx

from tests.certified.approximate_states import ApproximateStates
from tests.certified.panel_functions import BITS, Panel, absolute, least, monomials, panels, powers, product, shift_bits
from tests.certified.sphere_form import cubic_coefficients


class NotProved(Exception):
    """A condition of the proof does not hold with these approximations, panels and radii."""


@dataclass(frozen=True)
class PanelBounds:
    """Bounds on one panel, at the displacement of the approximate states.

    Attributes
    ----------
    sigma, gap : arb
        Balls of all values.
    defects : tuple of arb
        Upper bounds on abs(Pi* - N(W*)) and on the defects of the equations of the two derivatives.
    rate, second : arb
        Upper bounds on abs(sigma dW*/d delta - 1) and on the absolute value of the second derivative of W*.
    surplus, comparison : tuple of arb
        Lower bounds on Phi - a v, where a is the derivative of N at W*; upper bounds on v = T Phi.
    """

    sigma: arb
    gap: arb
    defects: tuple[arb, arb, arb]
    rate: arb
    second: arb
    surplus: tuple[arb, ...]
    comparison: tuple[arb, ...]


def panel_bounds(states: ApproximateStates, count: int) -> list[PanelBounds]:
    """Bounds on `count` panels that cover the surface from infinity to the centre.

    Raises
    ------
    NotProved
        If the gap or a comparison function is not positive.
    """
    with ctx.workprec(BITS):
        polynomials = []
        for series in (states.traction, states.first, states.second, *states.comparison):
            # The irrational M with as many bits as its product with the monomials needs.
            with ctx.workprec(shift_bits(states.form.degree)):
                total = series
                if series is states.traction:
                    cubic = cubic_coefficients(states.form.degree)
                    total = [a + states.far * b for a, b in zip(series, cubic, strict=True)]
                deformed = states.form.deformed(total)
            polynomials += [monomials(series), monomials(deformed)]
        return [_on_panel(states, panel, polynomials) for panel in panels(count)]


def _on_panel(states: ApproximateStates, panel: Panel, polynomials: list[arb_poly]) -> PanelBounds:
    Pi, W, Pi1, W1, Pi2, W2, *pairs = (panel.series(p) for p in polynomials)
    x = powers(panel.sigma, 19)
    paraboloid = (1 - x[2]) * (arb(states.form.length**2) / 2)
    n = powers(x[2] * (1 - arb(states.delta)) + paraboloid + product(x[3], W), 11)
    lowest, highest = least(n[1]), absolute(n[1])
    if not lowest > 0:
        raise NotProved(f"the approximate gap is not positive at sigma = {panel.range.str(5)}")
    rate = product(x[1], W1) - 1
    # Numerators over powers of the gap: a n^10, a n^10 / sigma, and N_WW n^11 / sigma^2.
    steep = 8 * (product(x[6], n[6]) - 3 * x[18])
    steep_over_sigma = 8 * (product(x[5], n[6]) - 3 * x[17])
    bent = 8 * (30 * x[19] - 4 * product(x[7], n[6]))
    law = (product(x[3], n[6]) - x[15]) * (arb(8) / 3)
    defects = (
        absolute(product(Pi + states.far * x[3], n[9]) + law) / lowest**9,
        absolute(product(Pi1, n[10]) - product(steep_over_sigma, rate)) / lowest**10,
        absolute(product(Pi2, n[11]) - product(steep, n[1], W2) - product(bent, rate, rate)) / lowest**11,
    )

    def surplus(Phi: arb_poly, v: arb_poly) -> arb:
        if not least(v) > 0:
            raise NotProved(f"a comparison function is not positive at sigma = {panel.range.str(5)}")
        numerator = least(product(Phi, n[10]) - product(steep, v))
        return (numerator / (highest if numerator > 0 else lowest) ** 10).lower()

    return PanelBounds(
        sigma=panel.range,
        gap=lowest.union(highest),
        defects=defects,
        rate=absolute(rate),
        second=absolute(W2),
        surplus=tuple(surplus(Phi, v) for Phi, v in zip(pairs[::2], pairs[1::2], strict=True)),
        comparison=tuple(absolute(v) for v in pairs[1::2]),
    )
