"""Contact of a paraboloid with a homogeneous half-space (n = 2, k = 0), written on a sphere.

The surface becomes a sphere by stereographic projection with the length L:

    sigma = (1 + r^2 / L^2)^(-1/2) in [0, 1],   s = 2 sigma^2 - 1 in [-1, 1],   w = sigma W(s),   p = sigma^3 Pi(s).

Two points x, y with images xi, eta have abs(x - y) = L abs(xi - eta) / (2 sigma_x sigma_y), and
dA = L^2 / (4 sigma^4) d eta.  At k = 0 the deformation is w = M / (2 pi) * integral of p(y) / abs(x - y) dA.  So

    W = T Pi,   T Pi = M L / (4 pi) * integral of Pi(eta) / abs(xi - eta) d eta,   T P_l = M L / (2 l + 1) P_l,

because 1 / abs(xi - eta) is the sum of the Legendre polynomials P_l of the cosine of the angle.  With
1 + H = gap / sigma^2, the 9-3 law and the load are

    gap = sigma^2 (1 - delta) + (1 - sigma^2) L^2 / 2 + sigma^3 W,
    Pi = N(W) = -(8/3) (sigma^3 gap^-3 - sigma^15 gap^-9),
    P = 2 * integral of p r dr = 2 L^2 * integral_0^1 of Pi d sigma = (2 L / M) W(s = -1).

No singular kernel, no tail and no quadrature is left: T is diagonal, and N is rational in sigma and W.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, fmpq


def cubic_coefficients(degree: int) -> list[arb]:
    """Legendre coefficients (2 l + 1) I_l of sigma^3: I_0 = 2 / 5, I_(l+1) / I_l = (3 - 2 l) / (7 + 2 l)."""
    result, integral = [], arb(2) / 5
    for order in range(degree + 1):
        result.append((2 * order + 1) * integral)
        integral = integral * (3 - 2 * order) / (7 + 2 * order)
    return result


def at_infinity(coefficients: list[arb]) -> arb:
    """A Legendre series at s = -1, where P_l = (-1)^l."""
    return sum((-x if order % 2 else x for order, x in enumerate(coefficients)), arb(0))


@dataclass(frozen=True)
class SphereForm:
    """The problem n = 2, k = 0 at a Tabor number, in the coordinates of one projection.

    Parameters
    ----------
    mu : fmpq
        Tabor number.
    length : int
        Length L of the projection; every L gives the same equation in other coordinates.
    degree : int
        Degree N of the approximate solution in s.
    """

    mu: fmpq
    length: int
    degree: int

    def compliance(self) -> arb:
        """M = 2 mu^(3/2)."""
        mu = arb(self.mu)
        return 2 * mu * mu.sqrt()

    def eigenvalue(self, order: int) -> arb:
        """Eigenvalue of T at P_l."""
        return self.compliance() * self.length / (2 * order + 1)

    def deformed(self, coefficients: list[arb]) -> list[arb]:
        """Legendre coefficients of T Pi."""
        factor = self.compliance() * self.length
        return [factor * x / (2 * order + 1) for order, x in enumerate(coefficients)]

    def load(self, coefficients: list[arb]) -> arb:
        """2 L^2 times the integral of a Legendre series over sigma."""
        divided = [x / (2 * order + 1) for order, x in enumerate(coefficients)]
        return 2 * self.length**2 * at_infinity(divided)

    def cubic_load(self) -> arb:
        """The same of sigma^3."""
        return arb(self.length**2) / 2

    def cubic_remainder(self) -> tuple[arb, arb]:
        """Bounds on the part of T sigma^3 above the degree N: of its absolute value, and of sigma^2 times it.

        With g_l = abs(T_l I_l) it is, up to the sign, the sum over l > N of (2 l + 1) g_l P_l(u), u = 1 - 2 sigma^2.
        The first bound is this sum with 1 for P_l.  For the second, the sum of (2 l + 1) P_l(u) up to l = j is
        (j + 1) (P_j - P_(j+1)) / (2 sigma^2), at most (j + 1) / sigma^2; summation by parts leaves (2 N + 3) g_(N+1)
        plus the sum of g_l over l > N + 1.  1 / g_l has six factors, of which each grows at least like l + 5/2.  So
        g_l <= g_(N+1) ((N + 7/2) / (l + 5/2))^6, and integrals bound the sums.
        """
        N = self.degree
        first = abs(self.eigenvalue(N + 1) * cubic_coefficients(N + 1)[-1]) / (2 * N + 3)
        shifted = arb(2 * N + 7) / 2
        return 2 * first * shifted * (1 + shifted / 4), first * (2 * N + 3 + shifted / 5)
