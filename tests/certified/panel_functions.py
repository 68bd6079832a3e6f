"""Polynomial enclosures of functions of sigma on panels of [0, 1], by ball arithmetic.

On a panel sigma = centre + half * t with abs(t) <= 1.  A function is enclosed by a polynomial in t of degree `DEGREE`
with ball coefficients: at every t there are values in the balls that give the value of the function.  Products are cut
at `DEGREE`, and a bound on what is dropped goes into the radius of the constant coefficient.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from flint import arb, arb_poly, ctx, fmpz_poly

DEGREE = 40
BITS = 200


def shift_bits(degree: int) -> int:
    """Bits for the shift of a Legendre series: its monomials grow like (3 + 2 sqrt 2)^degree, 2.55 bits a degree."""
    return BITS + 64 + 13 * degree // 5


@cache
def _legendre(order: int) -> fmpz_poly:
    """P_l as a polynomial in sigma^2: the sum of (-1)^(l+j) C(l, j) C(l+j, j) sigma^2j."""
    row = [(-1) ** order]
    for j in range(order):
        row.append(-row[-1] * (order - j) * (order + j + 1) // (j + 1) ** 2)
    return fmpz_poly(row)


def monomials(coefficients: Sequence[arb]) -> arb_poly:
    """A Legendre series as a polynomial in sigma^2."""
    with ctx.workprec(shift_bits(len(coefficients) - 1)):
        total = arb_poly([0])
        for order, x in enumerate(coefficients):
            total += x * arb_poly(_legendre(order))
        return total


def _about_zero(radius: arb) -> arb_poly:
    return arb_poly([arb(0, radius.abs_upper())])


def cut(polynomial: arb_poly) -> arb_poly:
    """The polynomial cut at DEGREE, with what is dropped in the radius of the constant."""
    coefficients = polynomial.coeffs()
    dropped = sum((x.abs_upper() for x in coefficients[DEGREE + 1 :]), arb(0))
    return arb_poly(coefficients[: DEGREE + 1]) + _about_zero(dropped)


def product(*factors: arb_poly) -> arb_poly:
    """Enclosure of a product."""
    result = factors[0]
    for factor in factors[1:]:
        result = cut(result * factor)
    return result


def powers(base: arb_poly, highest: int) -> list[arb_poly]:
    """Enclosures of the powers 0 ... highest."""
    result = [arb_poly([1])]
    for _ in range(highest):
        result.append(product(result[-1], base))
    return result


def absolute(polynomial: arb_poly) -> arb:
    """Upper bound on the absolute value on the panel."""
    return sum((x.abs_upper() for x in polynomial.coeffs()), arb(0)).upper()


def least(polynomial: arb_poly) -> arb:
    """Lower bound on the value on the panel."""
    constant, *others = polynomial.coeffs()
    return (constant - sum((x.abs_upper() for x in others), arb(0))).lower()


@dataclass(frozen=True)
class Panel:
    """Interval of sigma; its ends are exact."""

    lower: arb
    upper: arb

    @property
    def centre(self) -> arb:
        """Middle of the panel."""
        return (self.lower + self.upper) / 2

    @property
    def half(self) -> arb:
        """Half of the width."""
        return (self.upper - self.lower) / 2

    @property
    def range(self) -> arb:
        """Ball of all sigma of the panel."""
        return self.lower.union(self.upper)

    @property
    def sigma(self) -> arb_poly:
        """The coordinate itself."""
        return arb_poly([self.centre, self.half])

    def series(self, polynomial: arb_poly) -> arb_poly:
        """Enclosure of a polynomial in sigma^2, which has `shift_bits` bits."""
        with ctx.workprec(shift_bits(polynomial.degree())):
            centre, half = self.centre, self.half
            reach = 2 * centre * half + half * half
            coefficients = polynomial(arb_poly([centre * centre, 1])).coeffs()
            dropped, power = arb(0), reach ** (DEGREE + 1)
            for x in coefficients[DEGREE + 1 :]:
                dropped += x.abs_upper() * power
                power *= reach
            local = arb_poly(coefficients[: DEGREE + 1])(arb_poly([0, 2 * centre * half, half * half]))
        return cut(local + _about_zero(dropped))


def panels(count: int) -> list[Panel]:
    """Panels that cover [0, 1], equally long in the polar angle."""
    ends = np.sin(np.linspace(0.0, np.pi / 2, count + 1))
    ends[-1] = 1.0
    return [Panel(arb(float(a)), arb(float(b))) for a, b in pairwise(ends)]
