"""Surface compliance of a half-space E(z) by Hankel transforms: a reference for the finite elements, of other parts.

Under a pressure J0(xi r) the surface moves by C(xi) J0(xi r).  With u_r = U J1, u_z = W J0, sigma_rz = T J1,
sigma_zz = S J0 and (T, S) = xi R (U, W), the matrix R obeys a Riccati equation in the depth, integrated from the deep
homogeneous solid up to the surface.
"""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import solve_ivp

#: Depth times xi where the integration starts: the solution has decayed by exp(-40).
DECADES_OF_DECAY = 40.0

#: Of the integration, relative to its length in log depth: no transition fits between two steps.
LARGEST_STEP = 1 / 300


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
