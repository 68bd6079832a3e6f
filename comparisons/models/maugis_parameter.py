"""Maugis's parameter lambda beside the Tabor number of a paraboloid on a homogeneous solid.

Maugis (1992) defines lambda = sigma_0 (9 R / (2 pi dgamma E*^2))^(1/3) (Eq. 2).  With sigma_0 in dgamma / z0 and the
Tabor number mu = (R dgamma^2 / (E*^2 z0^3))^(1/3) (Eq. 1) the ratio has no other parameter:

    lambda / mu = sigma_0 (9 / (2 pi))^(1/3),    1.1570 with the strength 16 sqrt(3) / 27 of the 9-3 law.
"""

from __future__ import annotations

import math

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH

__all__ = ["LAMBDA_OVER_MU", "maugis_parameter"]

#: Maugis's lambda over the Tabor number, with the theoretical strength as cohesive stress.
LAMBDA_OVER_MU = THEORETICAL_STRENGTH * (9.0 / (2.0 * math.pi)) ** (1.0 / 3.0)


def maugis_parameter(mu: float) -> float:
    """Return Maugis's lambda at a Tabor number, n = 2 and k = 0.

    Examples
    --------
    >>> round(maugis_parameter(1.0), 3)
    1.157
    """
    return LAMBDA_OVER_MU * mu
