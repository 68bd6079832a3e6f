"""Approximate solution and its two derivatives in delta, as Legendre series of many digits.

Nothing here is proved or needs to be: the bounds of `state_bounds` hold for every series, and are small for a good one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from flint import arb, ctx
from scipy.linalg import lu_factor, lu_solve
from threadpoolctl import threadpool_limits

from tests.certified.collocation import Collocation
from tests.certified.panel_functions import BITS
from tests.certified.sphere_form import SphereForm, cubic_coefficients

# Each correction of the states adds the digits of a double.
_CORRECTIONS = 3
# The second weight would elsewhere be smaller than the error of its interpolation.
_LEAST_WEIGHT = 1e-3


@dataclass(frozen=True)
class ApproximateStates:
    """Approximate state at one displacement; all numbers are exact binary numbers.

    Attributes
    ----------
    far : arb
        Factor of sigma^3 in the traction, which no polynomial in s follows well.
    traction, first, second : list of arb
        Legendre coefficients of Pi* - far sigma^3 and of the two derivatives of Pi* in delta.
    comparison : tuple of list of arb
        Legendre coefficients of the functions Phi of the comparison.
    """

    form: SphereForm
    delta: float
    far: arb
    traction: list[arb]
    first: list[arb]
    second: list[arb]
    comparison: tuple[list[arb], ...]


def approximate_states(form: SphereForm, delta: float) -> ApproximateStates:
    """State and derivatives at `delta`, with two functions for the comparison."""
    with ctx.workprec(BITS), threadpool_limits(1):
        nodes = Collocation(form)
        return _many_digits(nodes, delta, nodes.follow(delta))


def _many_digits(nodes: Collocation, delta: float, h: np.ndarray) -> ApproximateStates:
    L, x, y = nodes.form.length, nodes.sigma, nodes.x
    float_slope = 8 * (h**-4 - 3 * h**-10) / y**2
    factors = lu_factor(np.eye(len(y)) - float_slope[:, None] * nodes.T)
    base = [v * v * (1 - arb(delta)) + (1 - v * v) * L**2 / 2 for v in x]
    far = arb(-8 / 3 * (2 / L**2) ** 3)
    cubic = [far * b for b in cubic_coefficients(nodes.form.degree)]

    def refined(values: list[arb], residual: Callable[[list[arb]], list[arb]]) -> list[arb]:
        for _ in range(_CORRECTIONS):
            change = lu_solve(factors, [float(v) for v in residual(values)])
            values = [(v - arb(float(c))).mid() for v, c in zip(values, change, strict=True)]
        return values

    def gaps(values: list[arb]) -> list[arb]:
        return [b + v**3 * w for b, v, w in zip(base, x, nodes.deform(values, cubic), strict=True)]

    def traction_residual(values: list[arb]) -> list[arb]:
        pairs = zip(values, x, gaps(values), strict=True)
        return [p + far * v**3 + arb(8) / 3 * (v**3 / n**3 - v**15 / n**9) for p, v, n in pairs]

    start = -8 / 3 * (h**-3 - h**-9) / y**3
    traction = refined([arb(p) - far * v**3 for p, v in zip(start, x, strict=True)], traction_residual)
    n = gaps(traction)
    slope = [8 * (v**6 / m**4 - 3 * v**18 / m**10) for v, m in zip(x, n, strict=True)]

    def linear(right: list[arb]) -> list[arb]:
        def residual(values: list[arb]) -> list[arb]:
            return [f - a * w - g for f, a, w, g in zip(values, slope, nodes.deform(values), right, strict=True)]

        return refined([arb(0)] * len(x), residual)

    first = linear([-a / v for a, v in zip(slope, x, strict=True)])
    rate = [v * w - 1 for v, w in zip(x, nodes.deform(first), strict=True)]
    bent = [8 * (30 * v**19 / m**11 - 4 * v**7 / m**5) for v, m in zip(x, n, strict=True)]
    second = linear([b * z * z for b, z in zip(bent, rate, strict=True)])
    # Right sides Phi - a T Phi of the comparison functions: even, and like the slope of the law.
    weights = (np.ones_like(y), 8 * (h**-4 + 3 * h**-10) / y**2 + _LEAST_WEIGHT)
    return ApproximateStates(
        form=nodes.form,
        delta=delta,
        far=far,
        traction=nodes.coefficients(traction),
        first=nodes.coefficients(first),
        second=nodes.coefficients(second),
        comparison=tuple(nodes.coefficients([arb(v) for v in lu_solve(factors, weight)]) for weight in weights),
    )
