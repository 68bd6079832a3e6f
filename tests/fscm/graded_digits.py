"""Responses of graded solids to a ring from compliances with 16 digits, and the script for them.

`python -m tests.fscm.graded_digits` writes `graded_digits.json` beside this file: 50 pairs of radii of five solids.

The compliance of a wave is that of a homogeneous solid deep below, and changes over the depth by a Riccati equation,
which midpoint steps solve, extrapolated to any number of digits.  It is a Chebyshev polynomial on each piece of the
logarithm of the wave number, and the Hankel integral a sum of Gauss rules with a smooth end, behind which it
oscillates and cancels.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import mpmath
import numpy as np
import scipy
from numpy.polynomial import chebyshev

from fscm import Coating, Exponential, OffsetPowerLaw, TabulatedModulus

FILE = Path(__file__).with_suffix(".json")
SOLIDS = {
    "offset power law": OffsetPowerLaw(1.0, 1.0, 0.4, 1.0, 0.25),
    "exponential": Exponential(1.0, 10.0, 1.0, 0.25),
    "smooth coating": Coating(5.0, 1.0, 1.0, 0.25, 0.25),
    "table": TabulatedModulus([0.0, 1.0, 2.0, 5.0], [1.0, 3.0, 4.0, 10.0], 0.25),
    # Last by its name, too, since seeds follow the names in order.
    "two materials": Coating(1.0, 10.0, 1.0, 0.0, 0.25, 0.45),
}
#: Digits of a step over the depth, its extrapolations at most, and the first depth in 1/xi, below which is exp(-64).
DIGITS, ROUNDS, START = 18, 12, 22
#: Pieces of the wave number, and nodes on each; the change of the response with fewer is below 1e-12 of it.
ENDS, NODES = np.concatenate([np.geomspace(1e-10, 1e-4, 7)[:-1], np.geomspace(1e-4, 1e3, 19)]), 18
#: The integral ends smoothly around this wave number, over this width.
END, WIDTH = 650.0, 85.0
COUNT = 50

mpf = mpmath.mpf


class Piece(NamedTuple):
    """Part of the depth, from its bottom to its top, with its modulus as a function and its Poisson's ratio."""

    bottom: mpf
    top: mpf
    modulus: Callable[[mpf], mpf]
    nu: float


def _pieces(solid, deepest):
    """The pieces from a depth to the surface."""
    if isinstance(solid, OffsetPowerLaw):
        return [Piece(deepest, mpf(0), lambda z: (z + solid.z_s) ** mpf(solid.k), solid.nu)]
    if isinstance(solid, Exponential):
        surface, below, length = solid.E_surface, solid.E_depth, solid.length
        return [Piece(deepest, mpf(0), lambda z: below + (surface - below) * mpmath.exp(-z / length), solid.nu)]
    if isinstance(solid, Coating) and solid.transition == 0.0:
        top = min(deepest, mpf(solid.thickness))
        coating = Piece(top, mpf(0), lambda z: solid.E_coating, solid.nu_coating)
        return [Piece(deepest, top, lambda z: solid.E_substrate, solid.nu_substrate), coating]
    if isinstance(solid, Coating):
        h, w, above, below = solid.thickness, solid.transition, solid.E_coating, solid.E_substrate
        share = lambda z: 1 / (1 + mpmath.exp(2 * (z - h) / w))  # noqa: E731  # one line
        return [Piece(deepest, mpf(0), lambda z: below + (above - below) * share(z), solid.nu_coating)]
    curve = scipy.interpolate.PchipInterpolator(solid.depths, solid.moduli)
    cubics = curve.c[::-1].T.tolist()
    between = [
        Piece(
            min(deepest, mpf(b)),
            mpf(a),
            lambda z, a=a, cubic=cubic: sum(c * (z - a) ** j for j, c in enumerate(cubic)),
            solid.nu,
        )
        for (a, b), cubic in zip(pairwise(solid.depths), cubics, strict=True)
    ]
    return [piece for piece in between[::-1] if piece.bottom > piece.top]


def _rates(piece, xi):
    """Rates over the depth of the compliances of what is below it: U and W by the stresses T and S of a wave."""
    nu = mpf(piece.nu)
    across, shear, confined = nu / (1 - nu), 2 * (1 + nu), (1 + nu) * (1 - 2 * nu) / (1 - nu)

    def rates(z, C):
        E, (ut, us, ws) = piece.modulus(z), C
        plane = E / (1 - nu**2)
        return (
            xi * (2 * us + shear / E - plane * ut**2),
            xi * (ws - across * ut - plane * ut * us),
            xi * (confined / E - 2 * across * us - plane * us**2),
        )

    return rates


def _midpoints(rates, z, C, h, count):
    """The compliances at z + h by steps of the midpoint rule, an even number of them."""
    step, before = h / count, C
    at = [c + step * rate for c, rate in zip(C, rates(z, C), strict=True)]
    for i in range(1, count):
        moved = [c + 2 * step * rate for c, rate in zip(before, rates(z + i * step, at), strict=True)]
        before, at = at, moved
    return at


def _extrapolated(rates, z, C, h):
    """The compliances at z + h by more and more midpoint steps, extrapolated; None if that does not end."""
    last = []
    for count in range(2, 2 * ROUNDS + 2, 2):
        row = [_midpoints(rates, z, C, h, count)]
        for order, old in enumerate(last, 1):
            factor = mpf(count) / (count - 2 * order)
            row.append([b + (b - a) / (factor**2 - 1) for a, b in zip(old, row[-1], strict=True)])
        if last and max(map(abs, np.subtract(*row[-2:]))) < mpf(10) ** -DIGITS * max(map(abs, row[-1])):
            return row[-1]
        last = row
    return None


def relative_compliance(solid, xi):
    """D = xi C E*/2 of the constants of the surface, with about 16 digits."""
    with mpmath.workdps(DIGITS + 15):
        xi, C = mpf(xi), None
        for piece in _pieces(solid, START / xi):
            nu, z = mpf(piece.nu), piece.bottom
            if C is None:  # a homogeneous solid below
                C = [c / piece.modulus(z) for c in (-2 * (1 - nu**2), (1 + nu) * (1 - 2 * nu), -2 * (1 - nu**2))]
            h = 1 / xi
            while z > piece.top:
                # No longer than half the depth: nothing on the way up to the surface is passed over.
                h = min(h, (z + solid.length) / 2, z - piece.top)
                moved = _extrapolated(_rates(piece, xi), z, C, -h)
                if moved is None:
                    h /= 2
                    continue
                z, C = (piece.top if h == z - piece.top else z - h), moved
                h *= 2
        return -C[2] * piece.modulus(mpf(0)) / (2 * (1 - nu**2))


def tabulated(solid):
    """Chebyshev coefficients of D - 1 on each piece, shape (NODES, pieces)."""
    nodes, values = chebyshev.chebpts1(NODES), []
    for a, b in pairwise(np.log(ENDS).tolist()):
        xi = [float(np.exp(a + 0.5 * (b - a) * (1.0 + u))) for u in nodes]
        values.append([float(relative_compliance(solid, x) - 1) for x in xi])
    return chebyshev.chebfit(nodes, np.array(values).T, NODES - 1)


def excess(modes, xi):
    """D - 1 from its table."""
    ends, x = np.log(ENDS), np.log(np.clip(xi, ENDS[0], ENDS[-1]))
    i = np.clip(np.searchsorted(ends, x) - 1, 0, len(ends) - 2)
    u = 2.0 * (x - ends[i]) / (ends[i + 1] - ends[i]) - 1.0
    return np.einsum("nm,mn->n", chebyshev.chebvander(u, len(modes) - 1), modes[:, i])


def response(modes, r, t, nodes=16):
    """G(r, t): the ring of a homogeneous solid in closed form, and the integral of (D - 1) J0(xi r) J0(xi t)."""
    end = END + 4.2 * WIDTH
    # Pieces of six radians at most, and no longer than half their distance from the origin.
    step = 6.0 / (r + t + 1.0)
    high = np.linspace(2.0 * step, end, int(end / step))
    ends = np.concatenate([[0.0], np.geomspace(1e-12, 2.0 * step, 75), high[1:]])
    x, w = np.polynomial.legendre.leggauss(nodes)
    xi = (ends[:-1, None] + 0.5 * np.diff(ends)[:, None] * (1.0 + x)).ravel()
    weights = (0.5 * np.diff(ends)[:, None] * w).ravel()
    # D - 1 falls like c/xi: c xi/(xi^2 + 1) in closed form, and the rest with a smooth end.
    c = float(end * excess(modes, np.array([end]))[0])
    remainder = (excess(modes, xi) - c * xi / (xi * xi + 1.0)) * 0.5 * scipy.special.erfc((xi - END) / WIDTH)
    total = float((weights * remainder) @ (scipy.special.j0(xi * r) * scipy.special.j0(xi * t)))
    with mpmath.workdps(30):
        closed = c * mpmath.besseli(0, min(r, t)) * mpmath.besselk(0, max(r, t))
        return float(t * (1 / mpmath.agm(mpf(r) + mpf(t), abs(mpf(r) - mpf(t))) + closed + total))


def pairs(name):
    """50 random pairs of radii, apart by a tenth at least."""
    rng = np.random.default_rng(sorted(SOLIDS).index(name))
    r, t = 10.0 ** rng.uniform(-1.0, 0.7, (2, 4 * COUNT))
    apart = np.abs(r - t) > 0.1
    return r[apart][:COUNT].tolist(), t[apart][:COUNT].tolist()


def main():
    """Write the values of one solid, or of all."""
    for name in sys.argv[1:] or SOLIDS:
        modes = tabulated(SOLIDS[name])
        r, t = pairs(name)
        values = [response(modes, *pair) for pair in zip(r, t, strict=True)]
        coarse = [response(modes[:-2], *pair, nodes=13) for pair in zip(r, t, strict=True)]
        stored = json.loads(FILE.read_text()) if FILE.exists() else {}
        error = float(np.max(np.abs(np.array(coarse) / np.array(values) - 1.0)))
        stored[name] = {"r": r, "t": t, "G": values, "modes": modes.T.tolist(), "error": error}
        FILE.write_text(json.dumps(stored) + "\n")


if __name__ == "__main__":
    main()
