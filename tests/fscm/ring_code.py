r"""A second solver of the integral equation, which shares no line with `fscm`.

The ring response is written as two Abel transforms (Copson's formula; a = (1+k)/2):

    (1 / 2 pi) int_0^{2 pi} dphi / (r^2 + t^2 - 2 r t cos phi)^a
        = (2 / pi) cos(k pi / 2) int_0^{min(r, t)} x^k (r^2 - x^2)^{-a} (t^2 - x^2)^{-a} dx.

The power of x makes both sides homogeneous of degree -2a; at r -> 0 the left side is t^{-2a} and the integral is
t^{-2a} Gamma(a) Gamma(1 - a) / 2, which gives the constant.  Hence w = M (1-k) (2/pi) cos(k pi/2) B A p with

    (A p)(x) = int_x^inf t p(t) (t^2 - x^2)^{-a} dt = int_0^inf p(sqrt(x^2 + s^2)) s^{-k} ds,
    (B q)(r) = int_0^r x^k (r^2 - x^2)^{-a} q(x) dx,

and no hypergeometric function is left.  What else differs from `fscm`: Chebyshev points of the first kind on a mesh
that is fixed in the radius and ends where nothing is left (no tail in closed form); Newton's method on differences to
one node, whose gap is prescribed, so that the displacement is no unknown; a path that is a sequence of such nodes; and
an extreme of the load or the displacement as that of the polynomial through nine states.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import roots_jacobi

Array = np.ndarray

# Nodes a panel and nodes of the rule on a piece: t^-9 between r and 2r leaves (3 + sqrt 8)^-16 = 6e-13.
ORDER, RULE = 16, 20
# A piece of an integral is at most this many times as far from the singular point as it begins.
RATIO = 3.0
STATES = 9
# Half widths of the last searches, relative to the distance of the gap to the singular one.
WINDOWS = (0.05, 0.005)
# Part of the load beyond the last panel: of the path, which brackets the event, and of the result.
PATH_REMAINDER, REMAINDER = 1e-4, 1e-13
# Largest effect of the last coefficients of a panel.
TOLERANCE = 1e-11


class RingCodeFailed(Exception):
    """The iteration does not converge."""


@lru_cache(maxsize=32)
def gauss(alpha: float, beta: float) -> tuple[Array, Array]:
    """Nodes and weights on [0, 1] for the weight (1-u)^alpha u^beta."""
    x, w = roots_jacobi(RULE, alpha, beta)
    return 0.5 * (1.0 + x), w / 2.0 ** (1.0 + alpha + beta)


class Law(NamedTuple):
    """Traction and slope of a law, the gap of its largest tension, and one where only a wrong step leads."""

    traction: Callable[[Array], Array]
    slope: Callable[[Array], Array]
    peak_gap: float
    lowest: float


NINE_THREE = Law(
    lambda H: 8.0 / 3.0 * ((H + 1.0) ** -9 - (H + 1.0) ** -3),
    lambda H: 8.0 * (H + 1.0) ** -4 - 24.0 * (H + 1.0) ** -10,
    3.0 ** (1.0 / 6.0) - 1.0,
    -0.7,
)


def cardinals(order: int, u: Array) -> Array:
    """Values at u in [-1, 1] of the polynomials that are 1 at one Chebyshev point and 0 at the others."""
    points = chebyshev.chebpts1(order)
    to_modes = (2.0 / order) * chebyshev.chebvander(points, order - 1).T
    to_modes[0] *= 0.5
    return chebyshev.chebvander(u, order - 1) @ to_modes


def subdivided(near: float, far: float) -> list[tuple[float, float]]:
    """Pieces of [near, far], near > 0, whose ends have at most the ratio RATIO."""
    count = max(1, int(np.ceil(np.log(far / near) / np.log(RATIO))))
    ends = near * (far / near) ** (np.arange(count + 1) / count)
    return list(pairwise(ends))


@dataclass
class Surface:
    """Panels between breaks, with the matrix of the displacement and the weights of the load."""

    n: float
    k: float
    mu: float
    breaks: Array
    law: Law = NINE_THREE

    def __post_init__(self) -> None:
        u = 0.5 * (1.0 + chebyshev.chebpts1(ORDER))
        lengths = np.diff(self.breaks)
        self.radius = (self.breaks[:-1, None] + lengths[:, None] * u).ravel()
        self.height = self.radius**self.n / self.n
        v, weight = gauss(0.0, 0.0)
        at = self.breaks[:-1, None] + lengths[:, None] * v
        self.area = ((2.0 * at * lengths[:, None] * weight) @ cardinals(ORDER, 2.0 * v - 1.0)).ravel()
        factor = 4.0 / np.pi * self.mu ** ((2.0 * self.n + self.k - 1.0) / self.n) * (1.0 - self.k)
        inner, outer = (np.array([self.row(*rule(r)) for r in self.radius]) for rule in (self._inner, self._outer))
        self.response = factor * np.cos(self.k * np.pi / 2.0) * (outer @ inner)

    def row(self, at: Array, weight: Array) -> Array:
        """Weights of the nodal values in the sum of weight times value at the radii `at`."""
        panel = np.clip(np.searchsorted(self.breaks, at, side="right") - 1, 0, len(self.breaks) - 2)
        u = 2.0 * (at - self.breaks[panel]) / (self.breaks[panel + 1] - self.breaks[panel]) - 1.0
        row = np.zeros((len(self.breaks) - 1, ORDER))
        np.add.at(row, panel, weight[:, None] * cardinals(ORDER, u))
        return row.ravel()

    def _inner(self, x: float) -> tuple[Array, Array]:
        """Radii and weights of A at x: in s = sqrt(t^2 - x^2), with the weight s^-k."""
        u, w = gauss(0.0, -self.k)
        v, plain = gauss(0.0, 0.0)
        s = np.sqrt((self.breaks[self.breaks > x] - x) * (self.breaks[self.breaks > x] + x))
        # sqrt(x^2 + s^2) is not smooth at s = +- i x, so that the first piece ends at s = x.
        s = np.concatenate([[min(s[0], x)], s]) if s[0] > x else s
        at, weight = [s[0] * u], [s[0] ** (1.0 - self.k) * w]
        for near, far in (piece for ends in pairwise(s) for piece in subdivided(*ends)):
            at.append(near + (far - near) * v)
            weight.append((far - near) * plain * at[-1] ** -self.k)
        return np.hypot(x, np.concatenate(at)), np.concatenate(weight)

    def _outer(self, r: float) -> tuple[Array, Array]:
        """Radii and weights of B at r: in x, with the weights x^k at the axis and (r - x)^-a at r."""
        a = 0.5 * (1.0 + self.k)
        below = self.breaks[self.breaks < r]
        if len(below) == 1:
            u, w = gauss(-a, self.k)
            return r * u, w * (1.0 + u) ** -a
        first, last = below[1], below[-1]
        (x, wx), (y, wy), (v, plain) = gauss(0.0, self.k), gauss(-a, 0.0), gauss(0.0, 0.0)
        # The singular point r may be close to the first panel, which is then integrated from both of its ends.
        inside = min(first, 0.5 * r)
        at = [inside * x, last + (r - last) * y]
        weight = [inside ** (1.0 + self.k) * wx * ((r - at[0]) * (r + at[0])) ** -a]
        weight.append((r - last) ** (1.0 - a) * wy * (r + at[1]) ** -a * at[1] ** self.k)
        ends = np.unique(np.concatenate([[inside], below[1:]]))
        for left, right in pairwise(ends):
            # Near r the distance is exact, far from it the radius.
            pieces = subdivided(r - right, r - left) if r - right < right - left else [None]
            for piece in pieces:
                length = right - left if piece is None else piece[1] - piece[0]
                distance = r - left - length * v if piece is None else piece[0] + length * v
                at.append(left + length * v if piece is None else r - distance)
                weight.append(length * plain * at[-1] ** self.k * (distance * (r + at[-1])) ** -a)
        return np.concatenate(at), np.concatenate(weight)

    def state(self, pin: int, gap: float, guess: Array) -> State:
        """The equilibrium with a prescribed gap at one node; damped by the size of the residual."""
        H = guess + (gap - guess[pin])
        H = np.maximum(H, 0.5 * (guess - 1.0))
        H[pin] = gap
        traction, slope = self.law.traction, self.law.slope
        differences = self.response - self.response[pin]
        shape = self.height - self.height[pin]

        def residual(H: Array) -> Array:
            out = (H - H[pin] - shape - differences @ traction(H)) / (1.0 + self.height)
            out[pin] = 0.0
            return out

        R = residual(H)
        for _ in range(60):
            J = -differences * slope(H)
            J[np.diag_indices_from(J)] += 1.0
            J[:, pin] -= 1.0
            J[pin], J[pin, pin] = 0.0, 1.0
            step = np.linalg.solve(J, R * (1.0 + self.height))
            damping = 1.0
            while True:
                new = H - damping * step
                if new.min() > self.law.lowest:
                    R_new = residual(new)
                    if np.max(np.abs(R_new)) < (1.0 - 0.1 * damping) * np.max(np.abs(R)) + 1e-13:
                        break
                damping *= 0.5
                if damping < 1e-4:
                    raise RingCodeFailed(f"no smaller residual at the gap {gap:g} of node {pin}")
            H, R = new, R_new
            if damping == 1.0 and np.max(np.abs(step) / (1.0 + np.abs(H))) < 1e-9:
                p = traction(H)
                displacement = self.height[pin] + self.response[pin] @ p - gap
                return State(pin, H, float(self.area @ p), float(displacement))
        raise RingCodeFailed(f"60 iterations at the gap {gap:g} of node {pin}")


@dataclass
class State:
    """Gaps at the nodes, load and displacement; the gap was prescribed at the node `pin`."""

    pin: int
    gap: Array
    load: float
    displacement: float


def breaks_to(n: float, remainder: float) -> Array:
    """Panels of one length near the axis, and doubling ones to where this part of the load is left."""
    count = max(1, int(np.ceil(np.log2(remainder ** (-1.0 / (3.0 * n - 2.0)) / 4.0))))
    return np.concatenate([np.arange(0.0, 3.9, 0.25), 4.0 * 2.0 ** np.arange(count + 1)])


def path(surface: Surface, start_gap: float, event: str) -> list[State]:
    """States from separation on: the gap of the first node falls, then that of the peak moves from node to node.

    The path ends behind the jump that is sought, or where a contact is compressed and load and displacement rise.
    """
    states: list[State] = []
    peak = surface.law.peak_gap
    gaps = peak + (start_gap - peak) * np.linspace(1.0, 0.0, 40) ** 1.5
    places = [(0, float(gap)) for gap in gaps] + [(pin, peak) for pin in range(2, len(surface.radius), 2)]
    H = surface.height + start_gap
    for pin, gap in places:
        states.append(surface.state(pin, gap, H))
        H = states[-1].gap
        if len(states) == 1:
            continue
        rises = np.diff([(state.displacement, state.load) for state in states], axis=0) > 0.0
        pressed = pin > 0 and states[-1].load > 0.0 and rises[-1].all()
        if pressed or np.count_nonzero(np.diff(rises[:, 0])) >= JUMPS.get(event, len(places)):
            break
    return states


#: Folds of the displacement up to the end of each jump.
JUMPS = {"jump_in": 1, "jump_out": 2}
EXTREMES = {
    "pull_off": (lambda state: state.load, 1.0),
    "jump_in": (lambda state: state.displacement, -1.0),
    "jump_out": (lambda state: state.displacement, 1.0),
}


def bracket(states: list[State], event: str) -> tuple[State, float, float]:
    """The state next to an extreme, and gaps of its node on either side of it."""
    functional, sign = EXTREMES[event]
    values = sign * np.array([functional(state) for state in states])
    minima = np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] <= values[2:])) + 1
    if not minima.size:
        raise RingCodeFailed(f"the path has no {event}")
    i = {"pull_off": minima[np.argmin(values[minima])], "jump_in": minima[0], "jump_out": minima[-1]}[event]
    pin = states[i].pin
    return states[i], states[i - 1].gap[pin], states[i + 1].gap[pin]


def extreme(surface: Surface, state: State, high: float, low: float, event: str) -> State:
    """The state at the extreme of the polynomial through those at STATES gaps between two."""
    functional, sign = EXTREMES[event]
    gaps = 0.5 * (high + low) + 0.5 * (high - low) * chebyshev.chebpts1(STATES)
    states = [state]

    def at(gap: float) -> State:
        """From the nearest known state."""
        states.append(surface.state(state.pin, gap, min(states, key=lambda s: abs(s.gap[s.pin] - gap)).gap))
        return states[-1]

    gaps = sorted((float(gap) for gap in gaps), key=lambda gap: abs(gap - state.gap[state.pin]))
    values = [sign * functional(at(gap)) for gap in gaps]
    ends = sorted((low, high))
    fit = chebyshev.Chebyshev.fit(gaps, values, STATES - 1, domain=ends)
    roots = fit.deriv().roots()
    inside = roots.real[(np.abs(roots.imag) < 1e-9) & (ends[0] <= roots.real) & (roots.real <= ends[1])]
    if not inside.size:
        raise RingCodeFailed(f"no {event} between the gaps {low:g} and {high:g} of node {state.pin}")
    return at(float(min(inside, key=fit)))


def unresolved(surface: Surface, state: State, tolerance: float) -> Array:
    """Panels whose last Chebyshev coefficients of the pressure change load or displacement by more than a tolerance."""
    modes = (
        (2.0 / ORDER)
        * surface.law.traction(state.gap).reshape(-1, ORDER)
        @ chebyshev.chebvander(chebyshev.chebpts1(ORDER), ORDER - 1)
    )
    highest_modes = np.max(np.abs(modes[:, -2:]), axis=1)
    lengths = np.diff(surface.breaks)
    M = 2.0 * surface.mu ** ((2.0 * surface.n + surface.k - 1.0) / surface.n)
    return highest_modes * np.maximum(2.0 * surface.breaks[1:] * lengths, M * lengths ** (1.0 - surface.k)) > tolerance


def on_breaks(old: Surface, state: State, breaks: Array) -> tuple[Surface, State]:
    """The state on other panels; the gap is kept at the node nearest to the old one."""
    new = Surface(old.n, old.k, old.mu, breaks, old.law)
    smooth = state.gap - old.height
    at = np.minimum(new.radius, old.breaks[-1])
    H = new.height + np.array([old.row(np.array([r]), np.ones(1)) @ smooth for r in at])
    pin = int(np.argmin(np.abs(new.radius - old.radius[state.pin])))
    return new, new.state(pin, float(H[pin]), H)


def solve(
    n: float, k: float, mu: float, event: str = "pull_off", tolerance: float = TOLERANCE, law: Law = NINE_THREE
) -> State:
    """The state at an event; load and displacement are its results.

    Raises
    ------
    RingCodeFailed
    """
    surface = Surface(n, k, mu, breaks_to(n, PATH_REMAINDER), law)
    state = extreme(surface, *bracket(path(surface, 4.0 + 3.0 * mu, event), event), event)
    surface, state = on_breaks(surface, state, breaks_to(n, REMAINDER))
    while (split := unresolved(surface, state, tolerance)).any():
        added = 0.5 * (surface.breaks[:-1] + surface.breaks[1:])[split]
        if split[0]:  # r^n is smooth between radii of a fixed ratio only
            added = np.append(added, surface.breaks[1] * 0.5 ** np.arange(2, 7))
        surface, state = on_breaks(surface, state, np.sort(np.append(surface.breaks, added)))
    # On the last panels the extreme may be beside the one of the first; the second interval gives its place.
    for window in WINDOWS:
        gap = float(state.gap[state.pin])
        half = window * (gap + 1.0)
        state = extreme(surface, state, gap + half, gap - half, event)
    return state
