"""The factor b(k, nu) by which Poisson's ratio and the gradient enter the surface response (Eq. 7)."""

from __future__ import annotations

import math

__all__ = ["response_factor", "response_factor_per_rest"]


def response_factor(k: float, nu: float) -> float:
    """Factor b of Eq. 7: the ring of Eq. 6 lifts the surface by 2 b c0^k / E* times G_k.

    The printed form is 0/0 at k = 0.  With k B(k/2, 1/2) = 2 Gamma(1 + k/2) Gamma(1/2) / Gamma((1+k)/2) it is
    regular there, and q^2 = (1+k) [(1 - 2 nu) + nu (1 - k)] / (1 - nu) keeps its digits as k -> 1, nu -> 1/2.

    Parameters
    ----------
    k : float
        Gradient exponent, in [0, 1].
    nu : float
        Poisson's ratio, in [0, 1/2].

    Returns
    -------
    float
        Dimensionless; 1 at k = 0 for every nu, 0 at k = 1 and nu = 1/2.
    """
    q = math.sqrt((1.0 + k) * ((1.0 - 2.0 * nu) + nu * (1.0 - k)) / (1.0 - nu))
    if k == 0.0:
        # q = 1 and every factor is elementary; the gamma functions would leave the last digit to chance.
        return 1.0
    beta = math.gamma((3.0 + k + q) / 2.0) * math.gamma((3.0 + k - q) / 2.0) / math.gamma(3.0 + k)
    front = (
        2.0**k * (k + 2.0) / (k + 1.0) * math.gamma((1.0 + k) / 2.0) / (math.sqrt(math.pi) * math.gamma(1.0 + k / 2.0))
    )
    return front * q * math.sin(q * math.pi / 2.0) * beta


def response_factor_per_rest(k: float, nu: float) -> float:
    """Ratio b / (1 - k) of Eqs. 20 and 29, with its limit 1 for the Gibson solid k = 1, nu = 1/2."""
    return 1.0 if k == 1.0 else response_factor(k, nu) / (1.0 - k)
