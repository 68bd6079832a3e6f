r"""The gamma function in decimal arithmetic, to about the precision of the current context.

By Stirling's series at z = x + N, for which N exceeds the number of digits,

    ln Gamma(z) = (z - 1/2) ln z - z + c + sum_j B_2j / (2j (2j - 1) z^(2j-1)),
    Gamma(x) = Gamma(z) / (x (x + 1) ... (z - 1)),

where c follows from Gamma(N + 1) = N!.
"""

from __future__ import annotations

import math
from decimal import Decimal, getcontext
from functools import lru_cache

__all__ = ["gamma"]


def gamma(x: Decimal) -> Decimal:
    """Gamma(x) of a number above -1 that is no pole.

    Examples
    --------
    >>> gamma(Decimal("0.5")) ** 2  # pi
    Decimal('3.1415926535897932384626...')
    """
    digits = getcontext().prec
    rising = math.prod((x + i for i in range(1, digits)), start=x)
    coefficients, constant = _stirling(digits)
    return (_series(x + digits, coefficients) + constant).exp() / rising


def _series(z: Decimal, coefficients: list[Decimal]) -> Decimal:
    """ln Gamma(z) - c."""
    square, total = z * z, Decimal(0)
    for coefficient in reversed(coefficients):
        total = total / square + coefficient
    return (z - Decimal("0.5")) * z.ln() - z + total / z


@lru_cache(maxsize=8)
def _stirling(digits: int) -> tuple[list[Decimal], Decimal]:
    """Coefficients B_2j / (2j (2j - 1)), and c, in the current context.

    |B_2j| = 2j T_j / (4^j (4^j - 1)) with the tangent numbers T_j: 1, 2, 16, 272, ...
    """
    count = digits // 2
    tangent = [math.factorial(j) for j in range(count)]
    for k in range(1, count):
        for j in range(k, count):
            tangent[j] = (j - k) * tangent[j - 1] + (j - k + 2) * tangent[j]
    coefficients = []
    for j, number in enumerate(tangent, 1):
        size = Decimal(number) / (4**j * (4**j - 1) * (2 * j - 1))
        coefficients.append(size if j % 2 else -size)
    constant = Decimal(math.factorial(digits)).ln() - _series(Decimal(digits + 1), coefficients)
    return coefficients, constant
