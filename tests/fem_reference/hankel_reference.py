"""Adhesive contact of a half-space E(z) by Hankel transforms: a reference for the finite elements, of other parts.

Under a pressure J0(xi r) the surface moves by C(xi) J0(xi r).  With u_r = U J1, u_z = W J0, sigma_rz = T J1,
sigma_zz = S J0 and (T, S) = xi R (U, W), the matrix R obeys a Riccati equation in the depth, integrated from the deep
homogeneous solid up to the surface.  Then xi C = 2 (1 - nu^2)/E(0) (1 - g(xi)): the first term is the kernel of the
homogeneous half-space (an elliptic integral, product integration on panels), the second a smooth kernel (Gauss rule in
xi).  Newton's method for the gap at the nodes, with the central gap as the parameter; the pull-off is where dP = 0.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import linalg, special
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

#: Gauss points a panel.
POINTS = 16

#: Depth times xi where the integration starts: the solution has decayed by exp(-40).
DECADES_OF_DECAY = 40.0

#: Of the integration, relative to its length in log depth: no transition fits between two steps.
LARGEST_STEP = 1 / 300


def _gauss(ends: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    x, w = np.polynomial.legendre.leggauss(POINTS)
    a, h = np.array(ends[:-1])[:, None], np.diff(ends)[:, None]
    return (a + 0.5 * h * (x + 1)).ravel(), (0.5 * h * w).ravel()


def _slope(a, b, d, E, nu):  # R = [[a, b], [b, d]]; R' = C - A^T R - R A - R B R, in x = xi z
    poisson = nu / (1 - nu)
    G, L = 0.5 / (1 + nu) * E, (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * E
    return (
        L * (1 - poisson**2) + 2 * poisson * b - a * a / G - b * b / L,
        -a + poisson * d - a * b / G - b * d / L,
        -2 * b - b * b / G - d * d / L,
    )


def _compliance(a, b, d, bonded):
    """W / (-S) with T = 0, or with U = 0 where the surface is bonded."""
    return -1 / d if bonded else -a / (a * d - b * b)


def power_law_constant(k: float, nu: float, bonded: bool = False) -> float:
    """xi^(1-k) C(xi) of E = z^k.  The modulus vanishes at the surface; in u, x = u^(1/(1-k)), the slopes are finite."""

    def rate(u, R):
        x = u ** (1 / (1 - k))
        return np.array(_slope(*R, x**k, nu)) * u ** (k / (1 - k)) / (1 - k)

    depth = DECADES_OF_DECAY ** (1 - k)
    done = solve_ivp(rate, (depth, 1e-14), [-1.0, 0.0, -1.0], "DOP853", rtol=1e-12, atol=1e-13)
    return float(_compliance(*done.y[:, -1], bonded))


def transform(
    E: Callable,
    nu: float | Callable,
    xi: np.ndarray,
    sharp: Sequence[float] = (),
    length: float = 1.0,
    bonded: bool = False,
) -> np.ndarray:
    """xi C(xi) of a half-space that is homogeneous at great depth; E and nu jump at the depths `sharp` only."""
    ratio = nu if callable(nu) else lambda z: nu + 0.0 * z

    def rise(top, bottom, R, inside):
        """Integrate from the depths `bottom` up to `top`, one of each xi, with ln(z + length) as the variable."""
        low, high = np.log(top + length), np.log(bottom + length)

        def rate(t, y):
            z = np.exp(low + t * (high - low)) - length
            factor = xi * (z + length) * (high - low)
            return np.concatenate([factor * rate for rate in _slope(*y.reshape(3, -1), E(inside(z)), ratio(inside(z)))])

        done = solve_ivp(rate, (1.0, 0.0), R.ravel(), "DOP853", rtol=1e-11, atol=1e-12, max_step=LARGEST_STEP)
        return done.y[:, -1].reshape(3, -1)

    start = DECADES_OF_DECAY / xi
    below_all = float(ratio(np.array(1e9 * length)))
    unit = solve_ivp(
        lambda x, y: np.array(_slope(*y, 1.0, below_all)), (40, 0), [-1.0, 0, -1.0], "DOP853", rtol=1e-13, atol=1e-14
    )
    deep = E(np.maximum(start, 1e6 * length))
    R = unit.y[:, -1][:, None] * deep
    bottom = start
    for depth in (*sorted(sharp, reverse=True), 0.0):
        top = np.full_like(xi, depth)
        # Where the solution has decayed before that depth, nothing below it matters.
        bottom = np.maximum(bottom, top)
        inside = np.nextafter(np.inf, 0)
        below = min([s for s in sharp if s > depth], default=inside)
        R = rise(top, np.minimum(bottom, below), R, lambda z, a=depth, b=below: np.clip(z, a, np.nextafter(b, a)))
        bottom = top
    return _compliance(*R, bonded)


@dataclass
class PullOff:
    """Load and displacement at the pull-off (load: tension positive)."""

    force: float
    displacement: float


def pull_off(
    E: Callable,
    nu: float | Callable,
    height: Callable,
    *,
    sharp=(),
    nearest=2.5,
    width=0.25,
    radius=16.0,
    wave=20.0,
    start=2.0,
) -> PullOff:
    """Pull-off of a punch f(r) with the 9-3 law, work of adhesion and z0 both 1: first minimum of the load.

    `nearest`: radius within which panels have the given `width`; `radius`: where they end; `wave`: largest xi, to which
    the panels resolve a wave; `start`: central gap where the search begins.
    """
    inner = np.linspace(0, nearest, round(nearest / width) + 1)
    far = np.linspace(nearest, radius, max(1, round((radius - nearest) * wave / 25)) + 1)
    ends = np.concatenate([inner, far[1:]])
    r, weight = _gauss(ends)
    ratio = nu if callable(nu) else lambda z: nu + 0.0 * z
    modulus = 2 * (1 - float(ratio(np.array(0.0))) ** 2) / float(E(np.array(0.0)))
    xi, dxi = _gauss(np.concatenate([[0, 0.01, 0.03, 0.1], np.arange(0.2, wave, 6.0 / radius), [wave]]))
    remainder = modulus - transform(E, nu, xi, sharp)
    J = special.j0(np.outer(r, xi))
    A = modulus * _homogeneous(ends, r, weight) - (J * (remainder * dxi)) @ J.T * (r * weight)
    centre = modulus * weight - (remainder * dxi) @ J.T * (r * weight)
    deep = np.array(1e9)
    tail = Tail(radius, 2 * (1 - float(ratio(deep)) ** 2) / float(E(deep)), height)

    def solve(gap: float, H: np.ndarray, delta: float):
        """State and rates at a central gap: H, delta, P, dP/d(gap)."""
        for _ in range(25):
            p, slope = _law(H)
            _, far_w, _, w_slope = tail(delta, 2 * np.pi * (weight * r) @ p)
            F = np.append(H + delta - height(r) - A @ p - far_w, centre @ p + far_w - delta - gap)
            K = np.empty((r.size + 1, r.size + 1))
            K[:-1, :-1] = -A * slope
            K[np.arange(r.size), np.arange(r.size)] += 1
            K[:-1, -1], K[-1, :-1], K[-1, -1] = 1 - w_slope, centre * slope, w_slope - 1
            factors = linalg.lu_factor(K)
            step = linalg.lu_solve(factors, F)
            # No gap may pass the singular one in a step.
            share = min(1.0, 0.5 / max(float(np.max(step[:-1] / (1 + H))), 1e-300))
            H, delta = H - share * step[:-1], delta - share * step[-1]
            if share == 1 and np.abs(step).max() < 1e-11:
                break
        else:
            raise RuntimeError(f"Newton's method of the reference does not converge at the central gap {gap}")
        rate = linalg.lu_solve(factors, np.append(np.zeros(r.size), 1.0))
        p, slope = _law(H)
        ring = 2 * np.pi * weight * r
        far_load, _, load_slope, _ = tail(delta, ring @ p)
        return H, delta, ring @ p + far_load, ring @ (slope * rate[:-1]) + load_slope * rate[-1], rate

    states = {start: solve(start, height(r) + start, -start)}

    def load_rate(gap: float) -> float:
        before = min(states, key=lambda g: abs(g - gap))
        H, delta, _, _, rate = states[before]
        states[gap] = solve(gap, H + (gap - before) * rate[:-1], delta + (gap - before) * rate[-1])
        return states[gap][3]

    gap = start
    step = 0.2
    while states[gap][3] > 0:
        try:
            load_rate(gap - step)
            above, gap = gap, gap - step
        except RuntimeError:
            step /= 2
    root = brentq(load_rate, gap, above, xtol=1e-11)
    _, delta, load, _, _ = states[root]
    return PullOff(-load, delta)


def _law(H: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    q = 1 / (1 + H)
    return 8 / 3 * (q**9 - q**3), 8 * (q**4 - 3 * q**10)


@dataclass
class Tail:
    """Traction beyond the panels, where the surface moves as under a point load: its load, its displacement, rates."""

    radius: float
    modulus: float
    height: Callable

    def __call__(self, delta: float, load: float) -> tuple[float, float, float, float]:
        x, w = _gauss(np.linspace(0, 1, 5))
        t, weight = self.radius / x, self.radius * w / x**2
        p, slope = _law(self.height(t) - delta + self.modulus * load / (2 * np.pi * t))
        ring, displacement = 2 * np.pi * weight * t, self.modulus * weight
        return ring @ p, displacement @ p, -ring @ slope, -displacement @ slope


def _homogeneous(ends: np.ndarray, r: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Matrix of the integral of p(t) (2/pi) t/(r+t) K(m) dt, for p a polynomial on every panel."""
    matrix = _ring(r[:, None], r, r[:, None] - r) * weight
    node, _ = np.polynomial.legendre.leggauss(POINTS)
    barycentric = np.array([1 / np.prod(x - np.delete(node, i)) for i, x in enumerate(node)])
    x12, w12 = np.polynomial.legendre.leggauss(12)
    halves = np.append(0.5 ** np.arange(46), 0.0)
    for panel, (a, b) in enumerate(pairwise(ends)):
        columns = slice(panel * POINTS, (panel + 1) * POINTS)
        for i in np.flatnonzero((r > a - (b - a)) & (r < b + (b - a))):
            distance, dt = [], []
            for sign in (-1.0, 1.0):
                reach = max(sign * ((b if sign > 0 else a) - r[i]), 0.0)
                start = max(sign * ((a if sign > 0 else b) - r[i]), 0.0)
                cuts = np.clip(reach * halves[::-1], start, reach) if reach > start else np.zeros(1)
                h = np.diff(cuts)
                distance.append(sign * (cuts[:-1, None] + 0.5 * h[:, None] * (x12 + 1)).ravel())
                dt.append((0.5 * h[:, None] * w12).ravel())
            d, dt = np.concatenate(distance), np.concatenate(dt)
            d, dt = d[dt > 0], dt[dt > 0]
            t = r[i] + d
            u = 2 * (t - a) / (b - a) - 1
            away = u[:, None] - node
            away[away == 0] = 1e-300
            lagrange = barycentric / away
            lagrange /= lagrange.sum(axis=1)[:, None]
            matrix[i, columns] = (_ring(r[i], t, d) * dt) @ lagrange
    return matrix


def _ring(r, t, distance):
    """(2/pi) t/(r+t) K(m), from the distance r - t: 1 - m is (r-t)^2/(r+t)^2."""
    complement = np.maximum((distance / (r + t)) ** 2, 1e-300)
    return 2 / np.pi * t / (r + t) * special.ellipkm1(complement)
