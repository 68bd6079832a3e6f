"""Proof that an equilibrium is near an approximate one, by comparison; bounds on its load and on two derivatives.

Let Pi* be the approximate traction at the displacement delta* + t, abs(t) <= eta: a quadratic polynomial in t.  Let
W* = T Pi* - rho be the approximate state, D = Pi* - N(W*), and v = T Phi > 0 with Phi - f v >= omega > 0 on [-1, 1] for
every slope f of N in the tube abs(W - W*) <= R.

Comparison.  If e = T g with a continuous g = f e + q, where f is a mean of slopes of the tube at each point, and
    abs(q) <= kappa omega, then abs(e) <= kappa v.  Otherwise let m > 0 be the maximum of (abs(e) - kappa v) / v, taken
    at s0 with e(s0) > 0, say.  Then y = (kappa + m) v - e >= 0 vanishes at s0.  exp(-t / T) multiplies P_l by
    exp(-t (2 l + 1) / (M L)); its kernel is the Poisson kernel, which is positive.  So exp(-t / T) y >= 0, and its
    derivative at t = 0 in s0, which is -(kappa + m) Phi + g, is not negative.  But it equals
    -(kappa + m) (Phi - f v) + q <= -(kappa + m) omega + kappa omega < 0.
Existence.  Outside the tube continue N linearly with its slope a at W*.  1 - T a is invertible by the comparison with
    q = 0, and the rest is bounded: e = (1 - T a)^-1 T (bounded continuous function of e) has a solution (Schauder).
    Here e = W - T Pi* = W - W* - rho is T (f e + f rho - D): abs(e) <= kappa v if abs(f rho) + abs(D) <= kappa omega.
    If kappa v + abs(rho) < R, W is in the tube and a solution of the equation itself.
Uniqueness in the tube and smoothness in delta.  The comparison with q = 0: the difference of two solutions is 0, and
    1 - T f is invertible at a solution.
Load.  P = (2 L / M) W(s = -1), so it differs from the load of Pi* by at most (2 L / M) kappa v(s = -1).

The two derivatives in delta solve linear equations X = T (f X + g) with the slope f at the solution: the same
comparison bounds their errors.  Two functions v are used, one for a defect that is spread evenly, one for a defect that
is large where the law is steep: kappa v and kappa omega are then sums of two terms.  The proof never uses that e is a
function of s alone: in the tube no equilibrium without axial symmetry exists either.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce

from flint import arb, ctx

from tests.certified.approximate_states import ApproximateStates
from tests.certified.panel_bounds import NotProved, PanelBounds
from tests.certified.panel_functions import BITS
from tests.certified.sphere_form import at_infinity


@dataclass(frozen=True)
class StateEnclosure:
    """Balls of P, P' and P'' for every displacement within `eta`; greatest distance to the approximate state."""

    distance: arb
    load: arb
    first: arb
    second: arb


@dataclass(frozen=True)
class _Slopes:
    """Upper bounds in the tube on one panel: abs(N_W) / sigma, abs(N_WW) / sigma^2, abs(N_WWW) / sigma^3."""

    first: arb
    second: arb
    third: arb


def _largest(values: Iterable[arb]) -> arb:
    return reduce(lambda a, b: a.max(b), values).upper()


def _slopes(bounds: PanelBounds, move: arb, radius: arb) -> _Slopes:
    """Bounds where 1 + H moves by `move` along the approximate states, and then by the tube."""
    low, top = bounds.sigma.lower().max(arb(0)), bounds.sigma.upper()
    width = top * top * (top * radius + move)
    narrow, wide = (bounds.gap.lower() - width).lower(), (bounds.gap.upper() + width).upper()
    if not narrow > 0:
        raise NotProved(f"the gap is not positive in the whole tube at sigma = {bounds.sigma.str(5)}")

    def difference(a: int, i: int, j: int, b: int, k: int, m: int) -> arb:
        """Upper bound on 8 abs(a sigma^i / gap^j - b sigma^k / gap^m), by the ends: a ball of a power may contain 0."""
        first = a * low**i / wide**j, a * top**i / narrow**j
        second = b * low**k / wide**m, b * top**k / narrow**m
        return (8 * (first[1] - second[0]).max(second[1] - first[0])).upper()

    return _Slopes(
        first=difference(1, 5, 4, 3, 17, 10),
        second=difference(30, 19, 11, 4, 7, 5),
        third=difference(20, 9, 6, 330, 21, 12),
    )


class _Comparison:
    """The factors kappa of the two functions v, and what follows from them."""

    def __init__(self, states: ApproximateStates, bounds: list[PanelBounds], loss: list[arb]) -> None:
        self.states, self.bounds = states, bounds
        self.omega = [
            [(s - change * v).lower() for s, v in zip(b.surplus, b.comparison, strict=True)]
            for b, change in zip(bounds, loss, strict=True)
        ]
        if not all(w > 0 for row in self.omega for w in row):
            raise NotProved("Phi - f v is not positive in the whole tube")

    def kappa(self, even: list[arb], steep: list[arb]) -> tuple[arb, ...]:
        """Factors whose sum covers the sum of two parts of a defect."""
        return tuple(
            _largest(d / row[i] for d, row in zip(part, self.omega, strict=True))
            for i, part in enumerate((even, steep))
        )

    def errors(self, kappa: tuple[arb, ...]) -> list[arb]:
        """Bound on the error on each panel."""
        return [sum((k * v for k, v in zip(kappa, b.comparison, strict=True)), arb(0)).upper() for b in self.bounds]

    def load_error(self, kappa: tuple[arb, ...]) -> arb:
        """Ball about zero of the error of the load."""
        form = self.states.form
        ends = [at_infinity(form.deformed(Phi)) for Phi in self.states.comparison]
        error = 2 * form.length / form.compliance() * sum((k * v for k, v in zip(kappa, ends, strict=True)), arb(0))
        return arb(0, error.abs_upper())


def enclose(states: ApproximateStates, bounds: list[PanelBounds], eta: arb, radius: arb) -> StateEnclosure:
    """Prove one equilibrium in the tube of `radius` for every displacement within `eta`, and bound its load.

    Raises
    ------
    NotProved
        If the comparison fails in this tube, or the state may leave it.
    """
    with ctx.workprec(BITS):
        tops = [b.sigma.upper() for b in bounds]
        # Greatest change of 1 + H along the approximate states, and the greatest abs(d (1 + H) / d delta).
        moves = [eta * b.rate + eta**2 * x * b.second / 2 for b, x in zip(bounds, tops, strict=True)]
        rates = [b.rate + eta * x * b.second for b, x in zip(bounds, tops, strict=True)]
        slopes = [_slopes(b, move, radius) for b, move in zip(bounds, moves, strict=True)]
        loss = [s.second * x * (x * radius + move) for s, x, move in zip(slopes, tops, moves, strict=True)]
        comparison = _Comparison(states, bounds, loss)
        rows = list(zip(slopes, tops, rates, [b.second for b in bounds], strict=True))
        d0, d1, d2 = ([b.defects[i] for b in bounds] for i in range(3))
        # Third derivative of D along the approximate states: D and its derivatives follow by Taylor's formula.
        d3 = [s.third * rate**3 + 3 * s.second * x * rate * second for s, x, rate, second in rows]

        highest, squared = (abs(states.far) * bound for bound in states.form.cubic_remainder())
        rho = [highest.min(squared / x**2) if (x := b.sigma.lower()) > 0 else highest for b in bounds]
        kappa = comparison.kappa(
            [a + eta * b + eta**2 * c / 2 for a, b, c in zip(d0, d1, d2, strict=True)],
            [eta**3 * d / 6 + x * r * s.first for (s, x, _, _), d, r in zip(rows, d3, rho, strict=True)],
        )
        e = [error + r for error, r in zip(comparison.errors(kappa), rho, strict=True)]
        if not all(error < radius for error in e):
            raise NotProved(f"the state may leave the tube: {_largest(e).str(3)} against the radius {radius.str(3)}")

        kappa1 = comparison.kappa(
            [b + eta * c for b, c in zip(d1, d2, strict=True)],
            [eta**2 * d / 2 + s.second * x * f * rate for (s, x, rate, _), d, f in zip(rows, d3, e, strict=True)],
        )
        e1 = comparison.errors(kappa1)
        kappa2 = comparison.kappa(
            d2,
            [
                eta * d + s.second * x * (x * f * second + f1 * (2 * rate + x * f1)) + s.third * x * f * rate**2
                for (s, x, rate, second), d, f, f1 in zip(rows, d3, e, e1, strict=True)
            ],
        )
        form, t = states.form, arb(0, eta)
        P = form.load(states.traction) + states.far * form.cubic_load()
        P1, P2 = form.load(states.first), form.load(states.second)
        return StateEnclosure(
            distance=_largest(e),
            load=P + t * P1 + t * t * P2 / 2 + comparison.load_error(kappa),
            first=P1 + t * P2 + comparison.load_error(kappa1),
            second=P2 + comparison.load_error(kappa2),
        )
