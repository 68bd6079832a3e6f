r"""The ring response of the graded half-space and its primitives, to rounding error.

A ring of unit pressure at radius t lifts the surface at radius r by (Eqs. 6 and 8, without 2 b c0^k / E*)

    G_k(r, t) = t (r+t)^{-(1+k)} F((k+1)/2, 1/2; 1; 4rt/(r+t)^2),

whose primitives are Phi_k and Psi_k = Phi_k - s^{1-k} (Eqs. 18-22).  With a = (k+1)/2 they equal

    Phi_k(s) = (1-k) (s^2/2) F(a, a; 2; s^2),  s <= 1,        Phi_k(s) = s^{1-k} F(a, a-1; 1; s^-2),  s >= 1,

which follows from integrating the Gauss series of Eq. 6 term by term; both sides agree at s = 1.

Each F is used in two zones.  Far from the singular circle its Taylor polynomial converges fast.  Near it the
connection formula F = A(y) + y^-c B(y) holds, but A and B grow like 1/k and cancel as k -> 0.  It is written
as

    F = D(y) + C(y) L_c(y),     D = A + B,   C = c B,   L_c = (y^-c - 1)/c  (-log y at c = 0),

where D and C stay finite.  Their expansion coefficients are computed once for each k in extended precision,
so nothing cancels in double precision for any 0 <= k < 1.  y comes from the *distance* of the radii, never
from 1 - x^2, and the logarithm is taken of the distance, so distances down to 1e-300 are exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal, localcontext
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from fscm._surface.gamma import gamma
from fscm._typing import Array

__all__ = ["NEAR_LIMIT", "Kernel", "Phi", "Psi", "box_cox", "kernel_of", "ring_response"]

#: The near form is expanded on 0 <= y <= 1/2; its nearest singularity is y = 1, so Chebyshev coefficients
#: fall like (3 + sqrt 8)^-m and 24 of them reach 1e-18.
_NEAR_DEGREE = 24
NEAR_LIMIT = 0.5
#: Terms of the Taylor series at y <= 1/2.  Those of D, C and F are of the size of 1, so that the others are below
#: 2^-70 < 1e-21.
_SERIES_TERMS = 70
#: Below this exponent the k = 0 limit is exact in double precision even for distances of 1e-300, where the
#: relative change of the kernel is k log(1e300) < 700 k.
_SMALLEST_K = 1e-22
#: Stand-in for k = 0: the O(k) remainder is below double precision.
_ZERO_K = "1e-30"
#: Digits of D where none are lost; it loses 2 log10(1/k): k - 1 rounds relative to 1, then the gamma function has its
#: pole there.  The gamma function loses a few more.
_DIGITS, _MORE_DIGITS = 40, 10
#: Binary digits with which D and C, of the size of 1, are summed before they are rounded.
_BITS = 128


def box_cox(log_y: Array, c: float) -> Array:
    """(y^-c - 1)/c from log y, with the limit -log y at c = 0.

    Parameters
    ----------
    log_y : ndarray
        Logarithm of y > 0.
    c : float
        Exponent.

    Returns
    -------
    ndarray, shape of `log_y`
    """
    return -log_y if c == 0.0 else np.expm1(-c * log_y) / c


def _digits(k: float) -> int:
    """Decimal digits with which the expansions for an exponent are computed."""
    return _DIGITS + math.ceil(-2.0 * math.log10(k or float(_ZERO_K)))


class _Series:
    """Taylor coefficients of multiples of Gauss series in integers, units of 2^-bits.

    Parameters
    ----------
    k : float
        Gradient exponent, whose expansions need the digits.
    """

    def __init__(self, k: float) -> None:
        self.bits = math.ceil(_digits(k) * math.log2(10.0))
        self.unit = 1 << self.bits

    def integer(self, x: Decimal) -> int:
        """A number in these units."""
        return int(x * self.unit)

    def gauss(self, a: Decimal, b: Decimal, c: Decimal, terms: int, factor: Decimal | int = 1) -> list[int]:
        """Those of `factor` times F(a, b; c; x)."""
        bits, unit = self.bits, self.unit
        a_m, b_m, c_m = (self.integer(x) for x in (a, b, c))
        coefficients = [unit]
        for m in range(1, terms):
            coefficients.append((coefficients[-1] * a_m >> bits) * b_m // (c_m * m))
            a_m, b_m, c_m = a_m + unit, b_m + unit, c_m + unit
        return coefficients if factor == 1 else self.times(coefficients, Decimal(factor))

    def times(self, coefficients: list[int], factor: Decimal) -> list[int]:
        """Those of a multiple."""
        by = self.integer(factor)
        return [c * by >> self.bits for c in coefficients]

    def polynomial(self, coefficients: list[int]) -> Array:
        """`_polynomial` of these coefficients."""
        return _polynomial([c >> self.bits - _BITS for c in reversed(coefficients)])


@lru_cache(maxsize=1)
def _places() -> tuple[Array, list[int]]:
    """Chebyshev points u, and (u + 1) NEAR_LIMIT / 2 in units of 2^-_BITS."""
    nodes = chebyshev.chebpts1(_NEAR_DEGREE + 1)
    return nodes, [int((Decimal(u) + 1) * Decimal(0.5 * NEAR_LIMIT) * (1 << _BITS)) for u in nodes.tolist()]


def _polynomial(coefficients: list[int]) -> Array:
    """Economised power coefficients, in u = 2 y / NEAR_LIMIT - 1, of a Taylor series on 0 <= y <= NEAR_LIMIT.

    Parameters
    ----------
    coefficients : list of int
        From the last one on, in units of 2^-_BITS.
    """
    nodes, places = _places()
    values = []
    for y in places:
        total = 0
        for c in coefficients:
            total = (total * y >> _BITS) + c
        values.append(total / (1 << _BITS))
    powers = np.asarray(chebyshev.cheb2poly(chebyshev.chebfit(nodes, np.array(values), _NEAR_DEGREE)), float)
    # Those at the end that are 0, perhaps by rounding, are left out there.
    return np.pad(powers, (0, _NEAR_DEGREE + 1 - len(powers)))


def _horner(coefficients: Array, u: Array) -> Array:
    """Evaluate a polynomial with coefficients in ascending order, without temporaries."""
    total = np.full_like(u, coefficients[-1])
    for c in coefficients[-2::-1]:
        total *= u
        total += c
    return total


class Kernel:
    """The ring response for one gradient exponent.

    Parameters
    ----------
    k : float
        Gradient exponent, 0 <= k < 1.

    Attributes
    ----------
    near_D, near_C : ndarray
        Power coefficients of D and C in 2 y / NEAR_LIMIT - 1.
    far : ndarray
        Those of F in the square of the ratio of the radii.

    Raises
    ------
    ValueError
        When k is outside [0, 1).
    """

    def __init__(self, k: float) -> None:
        if not 0.0 <= k < 1.0:
            raise ValueError(f"gradient exponent k = {k} is outside [0, 1): the ring response diverges at k = 1")
        self.k = 0.0 if k < _SMALLEST_K else float(k)
        series, terms = _Series(self.k), _SERIES_TERMS
        with localcontext(prec=_digits(self.k) + _MORE_DIGITS):
            q = self._exponent
            a, half = (1 + q) / 2, Decimal("0.5")
            root = gamma(half)
            # F(a, 1/2; 1; 1 - y) = A + y^{-k/2} B
            A = series.gauss(a, half, 1 + q / 2, terms, gamma(-q / 2) / (gamma(1 - a) * root))
            B = series.gauss(1 - a, half, 1 - q / 2, terms, gamma(q / 2) / (gamma(a) * root))
            self.near_D = series.polynomial([x + y for x, y in zip(A, B, strict=True)])
            self.near_C = series.polynomial(series.times(B, q / 2))
            self.far = np.array([c / series.unit for c in series.gauss(a, a, Decimal(1), 12)])

    @property
    def _exponent(self) -> Decimal:
        return Decimal(self.k or _ZERO_K)

    def _primitive_series(self, less: int, c: int) -> _Primitive:
        with localcontext(prec=_digits(self.k) + _MORE_DIGITS):
            a = (1 + self._exponent) / 2
            return _Primitive(a, a - less, Decimal(c), self._exponent)

    @cached_property
    def _inner(self) -> _Primitive:
        """F of Phi within the ring, computed on demand: the panels do not need the primitives."""
        return self._primitive_series(0, 2)

    @cached_property
    def _outer(self) -> _Primitive:
        """F of Phi beyond the ring."""
        return self._primitive_series(1, 1)

    def near_parts(self, r: Array, t: Array, distance: Array) -> tuple[Array, Array]:
        """Factors (S, C) of G = S + C L_k(distance / (r + t)), smooth in t across t = r.

        Valid where distance / (r + t) <= sqrt(1/2); all arguments are arrays of one shape.
        """
        total = r + t
        ratio = distance / total
        u = ratio * ratio
        u *= 2.0 / NEAR_LIMIT
        u -= 1.0
        front = t * total ** (-1.0 - self.k)
        # y = ratio^2, so L_{k/2}(y) = 2 L_k(ratio).
        return front * _horner(self.near_D, u), 2.0 * front * _horner(self.near_C, u)

    def response(self, r: Array, t: Array, distance: Array) -> Array:
        """G_k(r, t), dimension radius^-k; `distance` is abs(r - t), > 0, to full relative accuracy.

        All arguments are arrays of one shape; r may be 0.
        """
        out = np.empty(np.shape(distance))
        is_near = distance <= math.sqrt(NEAR_LIMIT) * (r + t)
        rn, tn, dn = r[is_near], t[is_near], distance[is_near]
        S, C = self.near_parts(rn, tn, dn)
        with np.errstate(divide="ignore"):
            C *= box_cox(np.log(dn / (rn + tn)), self.k)
        out[is_near] = S + C
        far = ~is_near
        rf, tf = r[far], t[far]
        larger = np.maximum(rf, tf)
        x = np.minimum(rf, tf) / larger
        out[far] = tf * larger ** (-1.0 - self.k) * _horner(self.far, x * x)
        return out

    def Phi(self, s: Array, offset: Array) -> Array:
        """Primitive Phi_k(s) of Eq. 18; `offset` is s - 1 to full relative accuracy.

        Examples
        --------
        >>> s = np.array([1.0])
        >>> float(Kernel(0.0).Phi(s, s - 1.0)[0])  # 2 / pi
        0.6366197...
        """
        return self._primitive(s, offset, subtract_power=False)

    def Psi(self, s: Array, offset: Array) -> Array:
        """Psi_k(s) = Phi_k(s) - s^{1-k} (Eq. 22), without cancellation at large s.

        Examples
        --------
        >>> kernel, s = Kernel(0.5), np.array([4.0])
        >>> bool(np.isclose(kernel.Psi(s, s - 1.0)[0], kernel.Phi(s, s - 1.0)[0] - 2.0, atol=1e-14))
        True
        """
        return self._primitive(s, offset, subtract_power=True)

    def _primitive(self, s: Array, offset: Array, subtract_power: bool) -> Array:
        d = np.abs(offset)
        out = np.empty_like(s)
        inside = offset <= 0.0
        si = s[inside]
        Fi = self._inner.value(si, d[inside] * (1.0 + si))
        out[inside] = 0.5 * (1.0 - self.k) * si * si * Fi
        if subtract_power:
            out[inside] -= si ** (1.0 - self.k)
        so = s[~inside]
        x = 1.0 / so
        Fo = self._outer.value(x, d[~inside] * x * (1.0 + x), minus_one=subtract_power)
        out[~inside] = so ** (1.0 - self.k) * Fo
        return out


class _Primitive:
    """F(a, b; c; x^2) with c - a - b = 1 - k on 0 <= x <= 1; the case behind Phi and Psi."""

    def __init__(self, a: Decimal, b: Decimal, c: Decimal, k: Decimal) -> None:
        self._k = float(k) if k >= _SMALLEST_K else 0.0
        series, terms = _Series(self._k), _SERIES_TERMS
        # F(a, b; c; 1 - y) = A(y) + y^{1-k} B(y); y^{m+1} of A and y^m of B are paired so that 1/k cancels.
        A = series.gauss(a, b, k, terms + 1, gamma(c) * gamma(1 - k) / (gamma(c - a) * gamma(c - b)))
        B = series.gauss(c - a, c - b, 2 - k, terms, gamma(c) * gamma(k - 1) / (gamma(a) * gamma(b)))
        self._at_one = A[0] / series.unit
        self._at_one_minus_one = (A[0] - series.unit) / series.unit
        self._D = series.polynomial([x + y for x, y in zip(A[1:], B, strict=True)])
        self._C = series.polynomial(series.times(B, k))
        self._taylor_minus_one = series.polynomial(series.gauss(a, b, c, terms)[1:])

    def value(self, x: Array, y: Array, minus_one: bool = False) -> Array:
        """F(x^2), or F - 1; `y` is 1 - x^2 to full relative accuracy."""
        out = np.empty_like(x)
        is_near = y <= NEAR_LIMIT
        yn = y[is_near]
        u = yn * (2.0 / NEAR_LIMIT) - 1.0
        # y = 0 is the value at one; the smallest float stands in for it under the logarithm.
        L = box_cox(np.log(np.maximum(yn, np.finfo(float).tiny)), self._k)
        start = self._at_one_minus_one if minus_one else self._at_one
        # y L first: near k = 1 either factor alone is at the end of the range of numbers.
        out[is_near] = start + yn * _horner(self._D, u) + _horner(self._C, u) * (yn * L)
        x2 = x[~is_near] ** 2
        out[~is_near] = x2 * _horner(self._taylor_minus_one, x2 * (2.0 / NEAR_LIMIT) - 1.0) + (
            0.0 if minus_one else 1.0
        )
        return out


@lru_cache(maxsize=64)
def kernel_of(k: float) -> Kernel:
    """The kernel of an exponent, cached."""
    return Kernel(k)


def ring_response(k: float, r: Array, t: Array, distance: Array | None = None) -> Array:
    """G_k(r, t) of Eq. 8 without the factor 2 b c0^k / E*.

    Parameters
    ----------
    k : float
        Gradient exponent in [0, 1).
    r, t : array_like
        Radii of the point (>= 0) and of the ring (> 0), any consistent unit, broadcast together.
    distance : array_like, optional
        abs(r - t), where the difference of the radii would lose digits.

    Returns
    -------
    ndarray
        Radius^-k; infinite at r = t.

    Examples
    --------
    >>> ring_response(0.5, 0.0, 4.0)          # t^-k on the axis
    array(0.5)
    """
    r, t = np.broadcast_arrays(np.asarray(r, float), np.asarray(t, float))
    d = np.abs(r - t) if distance is None else np.broadcast_to(np.asarray(distance, float), r.shape)
    return kernel_of(k).response(np.atleast_1d(r), np.atleast_1d(t), np.atleast_1d(d)).reshape(r.shape)


def _of_ratio(method: Callable[[Array, Array], Array], s: Array, offset: Array | None) -> Array:
    s = np.asarray(s, float)
    delta = s - 1.0 if offset is None else np.broadcast_to(np.asarray(offset, float), s.shape)
    return method(np.atleast_1d(s), np.atleast_1d(delta)).reshape(s.shape)


def Phi(k: float, s: Array, offset: Array | None = None) -> Array:
    """Primitive Phi_k(s) of (1-k) G_k (Eq. 18), s >= 0; `offset` is s - 1 where this difference would lose digits.

    Examples
    --------
    >>> float(Phi(0.0, 1.0))                  # 2 / pi at s = 1, k = 0
    0.6366197...
    """
    return _of_ratio(kernel_of(k).Phi, s, offset)


def Psi(k: float, s: Array, offset: Array | None = None) -> Array:
    """Psi_k(s) = Phi_k(s) - s^{1-k} (Eq. 22), s >= 0; bounded, 0 at both ends.

    Examples
    --------
    >>> bool(abs(Psi(0.4, 1e8)) < 1e-9)
    True
    """
    return _of_ratio(kernel_of(k).Psi, s, offset)
