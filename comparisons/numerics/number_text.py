"""Texts of numbers with their uncertainty, in the notation 1.788482(3)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Decimal
from typing import Any

#: A double has 17 digits; where the uncertainty is far below the last of them, zeros in between have no meaning.
_MOST_DIGITS = 20

#: Smaller uncertainties of a value are shown as this one: sixteen digits are hard to read.
LEAST_SHOWN = 5e-10

#: Values below it have a power of ten: newtons and metres of a problem file.
_SMALL_VALUE = 1e-6

#: Last digits of a relative error in percent, alone and beside others, where its uncertainty does not reach them.
_LAST_PERCENT, SHORT_PERCENT = 1e-5, 1e-3

#: Last digit of the error of a gate; an error below `_SMALL_ERROR` has a power of ten.
_LAST_ERROR, _SMALL_ERROR = 1e-6, 1e-3
#: Powers of ten below it are no normal doubles.
_LEAST_POWER = -300

#: What siunitx reads as a number: sign and digits, decimals, uncertainty, power of ten.
_NUMBER = re.compile(r"-?([0-9]+)(?:\.([0-9]+))?(?:\(([0-9]+)\))?(?:e([+-]?[0-9]+))?")


def exact(value: float) -> str:
    """Return the shortest decimal that is the value, with every digit it was declared with: 2 rather than 2.0.

    Examples
    --------
    >>> exact(-0.6495), exact(2.0), exact(1e-06), exact(-math.inf)
    ('-0.6495', '2', '1e-06', '-inf')
    """
    return repr(float(value)).removesuffix(".0")


def short_percent(kappa: float) -> str:
    """Return an error in percent with its sign and three digits.

    Examples
    --------
    >>> short_percent(-0.0694811), short_percent(11.3294), short_percent(3e-7), short_percent(0.0)
    ('−6.95', '+1133', '+3e-5', '0')
    """
    percent = 100.0 * kappa
    if percent == 0.0:
        return "0"
    size = abs(percent)
    if size >= 1e5:
        text = f"{size:.0e}".replace("e+0", "e").replace("e+", "e")
    elif size < 5e-4:
        text = f"{size:.0e}".replace("e-0", "e-")
    else:
        text = f"{size:.{max(0, 2 - max(-1, math.floor(math.log10(size))))}f}"
    return ("−" if percent < 0.0 else "+") + text


def limits_text(lower: float, upper: float) -> str:
    """Return the limits of a gate with every digit they were declared with; nothing for a gate without (NaN).

    Examples
    --------
    >>> limits_text(-0.651, -0.6495)
    '-0.651 to -0.6495'
    """
    return "" if math.isnan(lower) else f"{exact(lower)} to {exact(upper)}"


def short(value: float, uncertainty: float | None, last: float = 0.0) -> str:
    """Return e.g. 1.788482(3): the digits in brackets are the uncertainty of the last ones before them.

    The uncertainty is rounded up, to one digit, or to two when the first is 1 (so that 0.0014 does not become
    0.002).  A value without brackets has an uncertainty of at most half of its last digit.

    Parameters
    ----------
    value : float
    uncertainty : float or None
        Not negative.  Zero gives the shortest decimal that is the value; None or NaN six digits and no
        brackets.
    last : float
        The last digit that is shown, a power of ten; by default as many as the uncertainty leaves.

    Examples
    --------
    >>> short(-4.51409156, 1.5e-11, 1e-3), short(-4.51409156, 4e-3, 1e-3), short(-1e-5, 0.0, 1e-3)
    ('-4.514', '-4.514(4)', '0.000')
    >>> short(1.7884817, 2.6e-6), short(-0.4123, 0.0101), short(123456.0, 2300.0), short(1.5, 0.0), short(-1e-4, 5e-3)
    ('1.788482(3)', '-0.412(11)', '123(3)e3', '1.5', '0.000(5)')
    >>> short(1.7884817, 1.4e-6), short(-1.7884817, 9.6e-6), short(0.0, 0.003), short(1e20, 1e-12)
    ('1.7884817(14)', '-1.788482(10)', '0.000(3)', '1e+20(10e-13)')
    >>> short(1.5, None), short(math.nan, 0.1), short(1.5, math.inf)
    ('1.5', 'nan', '1.5(inf)')
    """
    if not math.isfinite(value):
        return str(value)
    if uncertainty is None or math.isnan(uncertainty):
        return f"{value:.6g}"
    if last and uncertainty <= 0.5 * last:
        return f"{Decimal(repr(float(value))).quantize(_power_of_ten(last), ROUND_HALF_EVEN) + 0:f}"
    if uncertainty == 0.0:
        return exact(value)
    if math.isinf(uncertainty):
        return f"{value:.6g}(inf)"
    # The shortest decimal of a double is what was meant: 3e-6 is 3 and not 3.0000000000000001 rounded up.
    u = Decimal(repr(float(uncertainty)))
    # Digits of the uncertainty that stay: one, or two if the first is 1; rounding 9.5 up gives 10, again two.
    digit = u.adjusted()
    if u.scaleb(-digit) < 2:
        digit -= 1
    step = Decimal(1).scaleb(digit)
    u = u.quantize(step, ROUND_CEILING)
    number = Decimal(repr(float(value)))
    if number.adjusted() - digit > _MOST_DIGITS:
        return f"{float(value)!r}({int(u.scaleb(-digit))}e{digit})"
    # The sum has no sign where it is zero: -0.0002(5) is 0.000(5).
    rounded = number.quantize(step, ROUND_HALF_EVEN) + 0
    if digit <= 0:
        return f"{rounded:f}({int(u.scaleb(-digit))})"
    return f"{int(rounded.scaleb(-digit))}({int(u.scaleb(-digit))})e{digit}"


def _power_of_ten(size: float) -> Decimal:
    """The power of ten at most as large as a size; rounding leaves digits above it alone."""
    return Decimal(1).scaleb(Decimal(repr(float(size))).adjusted())


def value_text(value: float | None, u: float | None) -> str:
    """Return a value for a table; a missing value is nothing.

    An uncertainty below 5e-10 is shown as that; of a value with a power of ten, below 5e-10 of that power.

    Examples
    --------
    >>> value_text(1.7884817, 2.6e-6), value_text(2.0, 0.0), value_text(1.3194643e-7, 2e-12), value_text(None, None)
    ('1.788482(3)', '2.0000000000(5)', '1.31946(2)e-7', '')
    """
    if value is None or math.isnan(value):
        return ""
    u, size = float(u or 0.0), abs(value)
    power = _power(size) if size < _SMALL_VALUE and not u > size else 0
    # NaN, from a table, is a missing uncertainty; max keeps it where it is its first argument.
    return _with_power(short(value / 10.0**power, max(u / 10.0**power, LEAST_SHOWN)), power)


def _power(size: float) -> int:
    return max(math.floor(math.log10(size)), _LEAST_POWER) if size else 0


def _with_power(text: str, power: int) -> str:
    return f"{text}e{power}" if power else text


def percent_text(fraction: float, u: float, last: float = _LAST_PERCENT) -> str:
    """Return a relative error in percent; "inf" where that is above the largest number.

    Examples
    --------
    >>> percent_text(0.066931234, 1e-9), percent_text(-1e307, 1e-9), percent_text(-0.0494, 1e-9, SHORT_PERCENT)
    ('6.69312', '-inf', '-4.940')
    >>> percent_text(0.066931234, 3e-5)
    '6.693(3)'
    """
    return short(100 * float(fraction), 100 * float(u), last)


def error_text(error: float | None, u: float | None) -> str:
    """Return the error of a gate; one far below 1 has a power of ten, a missing one is nothing.

    Examples
    --------
    >>> error_text(-0.0494, 3e-9), error_text(2.1e-7, 4e-9), error_text(1e-9, 3e-7), error_text(None, None)
    ('-0.049400', '2.10(4)e-7', '0(3)e-7', '')
    """
    if error is None or u is None or math.isnan(error):
        return ""
    size = max(abs(error), u)
    power = _power(size) if size < _SMALL_ERROR else 0
    return _with_power(short(error / 10.0**power, u / 10.0**power, _LAST_ERROR), power)


def case_text(case: Mapping[str, Any]) -> str:
    """Return the label of the problem of a case, or its parameters that have a value; nothing where none has.

    Examples
    --------
    >>> case_text({"n": 2.0, "k": 0.4, "mu": 1.0, "nu": None})
    'n = 2, k = 0.4, mu = 1'
    """
    return str(case.get("problem") or "") or ", ".join(
        f"{name} = {number:g}"
        for name, number in case.items()
        if name != "problem" and number is not None and not math.isnan(number)
    )


def number_parts(text: str) -> re.Match[str] | None:
    """Return the parts of a number with its uncertainty: digits, decimals, uncertainty, power of ten.

    Examples
    --------
    >>> number_parts("-1.79(2)e-7").groups()
    ('1', '79', '2', '-7')
    """
    return _NUMBER.fullmatch(text)


def aligned(texts: Iterable[str]) -> bool:
    """Whether a column of texts is one of numbers: at least half of those that are not empty.

    Examples
    --------
    >>> aligned(["-5.0(3)", "failed", ""]), aligned(["jkr", "2"]), aligned([])
    (True, True, False)
    """
    filled = [text for text in texts if text]
    return 2 * sum(number_parts(text) is not None for text in filled) >= max(len(filled), 1)
