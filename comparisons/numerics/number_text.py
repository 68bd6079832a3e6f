"""A number printed with its uncertainty, to the digit the uncertainty leaves it."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Decimal

__all__ = ["exact", "limits_text", "short"]

#: A double has 17 digits; where the uncertainty is far below the last of them, zeros in between say nothing.
_MOST_DIGITS = 20


def exact(value: float) -> str:
    """Return the shortest decimal that is the value, with every digit it was declared with: 2 rather than 2.0.

    Examples
    --------
    >>> exact(-0.6495), exact(2.0), exact(1e-06), exact(-math.inf)
    ('-0.6495', '2', '1e-06', '-inf')
    """
    return repr(float(value)).removesuffix(".0")


def limits_text(lower: float, upper: float) -> str:
    """Return the limits of a gate with every digit they were declared with, for tables of texts.

    Examples
    --------
    >>> limits_text(-0.651, -0.6495)
    '-0.651 to -0.6495'
    """
    return f"{exact(lower)} to {exact(upper)}"


def short(value: float, uncertainty: float | None) -> str:
    """Return e.g. 1.788482(3): the digits in brackets are the uncertainty of the last ones before them.

    The uncertainty is rounded up, to one digit, or to two when the first is 1 (so that 0.0014 does not become
    0.002).

    Parameters
    ----------
    value : float
    uncertainty : float or None
        Not negative.  Zero gives the shortest decimal that is the value; None or NaN six digits and no
        brackets.

    Examples
    --------
    >>> short(1.7884817, 2.6e-6), short(-0.4123, 0.0101), short(123456.0, 2300.0), short(1.5, 0.0)
    ('1.788482(3)', '-0.412(11)', '123(3)e3', '1.5')
    """
    if not math.isfinite(value):
        return str(value)
    if uncertainty is None or math.isnan(uncertainty):
        return f"{value:.6g}"
    if uncertainty == 0.0:
        return exact(value)
    if math.isinf(uncertainty):
        return f"{value:.6g}(inf)"
    # The shortest decimal of a double is what was meant: 3e-6 is 3 and not 3.0000000000000001 rounded up.
    u = Decimal(repr(float(uncertainty)))
    # Digits of the uncertainty that stay: one, or two if the first is 1; rounding 9.5 up gives 10, again two.
    place = u.adjusted()
    if u.scaleb(-place) < 2:
        place -= 1
    step = Decimal(1).scaleb(place)
    u = u.quantize(step, ROUND_CEILING)
    number = Decimal(repr(float(value)))
    if number.adjusted() - place > _MOST_DIGITS:
        return f"{float(value)!r}({int(u.scaleb(-place))}e{place})"
    rounded = number.quantize(step, ROUND_HALF_EVEN)
    if place <= 0:
        return f"{rounded:f}({int(u.scaleb(-place))})"
    return f"{int(rounded.scaleb(-place))}({int(u.scaleb(-place))})e{place}"
