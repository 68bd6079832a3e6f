"""Responses of graded solids to a ring from Taylor series of the equations with 30 digits, and the script for them.

`python -m tests.fscm.graded_digits` writes `graded_digits.json` beside this file: 50 pairs of radii of five solids.

The moduli are polynomials in a variable y with dz = dy / p(y), so that the Taylor coefficients of the equations follow
from a finite recurrence: y = z + z_s, exp(-z/l), 1/(1 + exp(2 (z - h)/w)), or z between two data points.  Numbers are
integers in units of 2^-BITS.  The compliance is a Chebyshev polynomial on each piece of the logarithm of the wave
number, and the Hankel integral a sum of Gauss rules with a smooth end, behind which it oscillates and cancels.
"""

from __future__ import annotations

import json
import sys
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
#: Binary digits after the point, terms of a series, and the share of its radius that is a step: 3^-60 = 1e-29.
BITS, TERMS, SHARE = 130, 60, 3
#: First depth in 1/xi, below which is exp(-64) = 1e-28, and a depth from which on a modulus is constant.
START, CONSTANT = 32, 70
#: Pieces of the wave number, and nodes on each; the change of the response with fewer is below 1e-12 of it.
ENDS, NODES = np.concatenate([np.geomspace(1e-10, 1e-4, 7)[:-1], np.geomspace(1e-4, 1e3, 19)]), 18
#: The integral ends smoothly around this wave number, over this width.
END, WIDTH = 650.0, 85.0
COUNT = 50

mpf = mpmath.mpf


class Variable:
    """Polynomials p m, m and q m of y, lowest power first, where q = dE/dz / E and m makes all of them polynomials."""

    def __init__(self, rate, factor, growth, roots):
        self.rate, self.factor, self.growth, self.roots = rate, factor, growth, roots


def _product(a, b):
    out = [mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


def _of(p, E, roots=()):
    slope = [j * c for j, c in enumerate(E)][1:] or [mpf(0)]
    return Variable(_product(p, E), E, _product(p, slope), [*roots, *np.roots(np.array(E[::-1], float)).tolist()])


class Piece(NamedTuple):
    """Part of the depth: y at its bottom and at its top, Poisson's ratio, and E there over E just below."""

    variable: Variable
    bottom: mpf
    top: mpf
    nu: float
    jump: float = 1.0


def _pieces(solid, deepest):
    """The pieces from a depth to the surface."""
    one, nu = mpf(1), solid.nu_coating if isinstance(solid, Coating) else solid.nu
    if isinstance(solid, OffsetPowerLaw):
        k, z_s = mpf(solid.k), mpf(solid.z_s)
        return [Piece(Variable([mpf(0), one], [mpf(0), one], [k], [mpf(0)]), deepest + z_s, z_s, nu)]
    if isinstance(solid, Exponential):
        length, below = mpf(solid.length), mpf(solid.E_depth)
        variable = _of([mpf(0), -1 / length], [below, mpf(solid.E_surface) - below], [mpf(0)])
        return [Piece(variable, mpmath.exp(-min(deepest, CONSTANT * length) / length), one, nu)]
    if isinstance(solid, Coating) and solid.transition == 0.0:
        uniform, h = _of([one], [one]), mpf(solid.thickness)
        coating = Piece(uniform, min(deepest, h) - h, mpf(0) - h, nu, solid.E_coating / solid.E_substrate)
        return [Piece(uniform, deepest, h, solid.nu_substrate), coating] if deepest > h else [coating]
    if isinstance(solid, Coating):
        h, w, below = mpf(solid.thickness), mpf(solid.transition), mpf(solid.E_substrate)
        variable = _of([mpf(0), -2 / w, 2 / w], [below, mpf(solid.E_coating) - below], [mpf(0), one])
        bottom, top = (1 / (1 + mpmath.exp(2 * (z - h) / w)) for z in (min(deepest, h + CONSTANT * w / 2), mpf(0)))
        return [Piece(variable, bottom, top, nu)]
    curve = scipy.interpolate.PchipInterpolator(solid.depths, solid.moduli)
    pieces = []
    for i, (a, b) in enumerate(pairwise(solid.depths)):
        if deepest > a:
            E = [mpf(c) for c in curve.c[::-1, i].tolist()]
            pieces.append(Piece(_of([one], E), min(deepest, mpf(b)) - mpf(a), mpf(0), nu))
    return pieces[::-1]


def _shifted(coefficients, y):
    """Taylor coefficients at y of a polynomial."""
    out = list(coefficients)
    for i in range(len(out)):
        for j in range(len(out) - 2, i - 1, -1):
            out[j] += y * out[j + 1]
    return out


def _fixed(x):
    return int(mpmath.nint(mpmath.ldexp(x, BITS)))


def _step(variable, y, h, xi, Q, constants):
    """Q = E (U, W)/(T, S) at y + h from that at y, all of them integers."""
    P, m, N = (_shifted(c, y) for c in (variable.rate, variable.factor, variable.growth))
    front = [_fixed(c * h**j / P[0]) for j, c in enumerate(P)]
    on_A = [_fixed(xi * c * h ** (j + 1) / P[0]) for j, c in enumerate(m)]
    on_B = [_fixed(c * h ** (j + 1) / P[0]) for j, c in enumerate(N)]
    a, g, i, e = constants
    unit = 1 << BITS
    ends = []
    for U, W, T, S in ((Q[0], Q[2], unit, 0), (Q[1], Q[3], 0, unit)):
        series, driven = [(U, W, T, S)], []
        for n in range(TERMS):
            U, W, T, S = series[n]
            driven.append((W + (g * T >> BITS), (i * S - a * U) >> BITS, (a * S + e * U) >> BITS, -T))
            new = []
            for q in range(4):
                total = sum(c * driven[n - j][q] for j, c in enumerate(on_A[: n + 1]))
                if q > 1:
                    total -= sum(c * series[n - j][q] for j, c in enumerate(on_B[: n + 1]))
                total -= sum(c * (n + 1 - j) * series[n + 1 - j][q] for j, c in enumerate(front[: n + 1]) if j)
                new.append((total >> BITS) // (n + 1))
            series.append(tuple(new))
        ends.append([sum(term[q] for term in series) for q in range(4)])
    (u1, w1, t1, s1), (u2, w2, t2, s2) = ends
    det = t1 * s2 - t2 * s1
    coefficients = (u1 * s2 - u2 * s1, u2 * t1 - u1 * t2, w1 * s2 - w2 * s1, w2 * t1 - w1 * t2)
    return [(x << BITS) // det for x in coefficients]


def relative_compliance(solid, xi):
    """D = xi C E*/2 of the constants of the surface, with about 25 digits."""
    with mpmath.workdps(45):
        xi, Q = mpf(xi), None
        for variable, y, top, ratio, jump in _pieces(solid, START / xi):
            nu = mpf(ratio)
            constants = [
                _fixed(x) for x in (nu / (1 - nu), 2 * (1 + nu), (1 + nu) * (1 - 2 * nu) / (1 - nu), 1 / (1 - nu**2))
            ]
            if Q is None:  # a homogeneous solid below
                n, m = _fixed(-2 * (1 - nu**2)), _fixed((1 + nu) * (1 - 2 * nu))
                Q = [n, m, m, n]
            else:
                Q = [int(mpmath.nint(x * mpf(jump))) for x in Q]
            while y != top:
                reach = min((abs(y - root) for root in variable.roots), default=mpf(10) ** 9) / SHARE
                p = _shifted(variable.rate, y)[0] / _shifted(variable.factor, y)[0]
                h = min(reach, 2 * abs(p) / xi, abs(top - y))
                ends_here = h == abs(top - y)
                h = h if top > y else -h
                Q = _step(variable, y, h, xi, Q, constants)
                y = top if ends_here else y + h
        return -mpmath.ldexp(mpf(Q[3]), -BITS) / (2 * (1 - nu**2))


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
