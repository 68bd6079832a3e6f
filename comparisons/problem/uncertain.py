"""Values with a standard deviation or an interval: their text, as numbers in SI."""

from __future__ import annotations

import re
from dataclasses import dataclass

from uncertainties import ufloat_fromstr

from comparisons.problem.units import NUMBER, NotAValue, in_si

_SIGN = re.compile(r"\+/-|\+-|±")
_INTERVAL = re.compile(rf"\s*\[\s*({NUMBER})\s*,\s*({NUMBER})\s*\]\s*(.*?)\s*")
#: A value with the digits of its standard deviation in brackets, and its unit.
_DIGITS = re.compile(r"\s*([+-]?\d+\.?\d*\(\d+\.?\d*\)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_BRACKETS = re.compile(r"^\s*\(([^()]*)\)")
_PERCENT = re.compile(rf"\s*({NUMBER})\s*%\s*(.*?)\s*")
_PLAIN = re.compile(rf"\s*{NUMBER}\s*")


@dataclass(frozen=True, slots=True)
class Uncertainty:
    """What a file states of a value besides the value.

    Attributes
    ----------
    size : float
        Standard deviation, or half the width of the interval around the value; in SI, > 0.
    is_interval : bool
    written : str
        The text of the file.

    Examples
    --------
    >>> uncertain_in_si("[1.8, 2.2] GPa", "Pa")[1].limits(2e9)
    (1800000000.0, 2200000000.0)
    """

    size: float
    is_interval: bool
    written: str

    def limits(self, value: float) -> tuple[float, float]:
        """Both ends of the interval, or one standard deviation to both sides."""
        return value - self.size, value + self.size


def is_uncertain(value: object) -> bool:
    """Whether a value of a file is a text with an uncertainty.

    Examples
    --------
    >>> [is_uncertain(value) for value in ("2 GPa", "2 GPa +- 5 %", "[1.8, 2.2] GPa", "2.0(1) GPa", 2e9)]
    [False, True, True, True, False]
    """
    if not isinstance(value, str):
        return False
    return bool(_SIGN.search(value) or _DIGITS.fullmatch(value)) or value.lstrip().startswith("[")


def uncertain_in_si(text: str, target: str, power: float = 1.0) -> tuple[float, Uncertainty]:
    """Return the value of a text with an uncertainty, in SI; that of an interval is its middle.

    Parameters
    ----------
    text : str
        ``2 +- 0.1 GPa``, ``(2 +- 0.1) GPa``, ``2 GPa +- 100 MPa``, ``2 GPa +- 5 %``, ``2 +- 5 % GPa``, ``2.0(1) GPa``
        (standard deviations) or ``[1.8, 2.2] GPa``; without a unit for a plain number.  The sign may be ``±`` or
        ``+/-``.
    target : str
        The unit in SI; nothing for a plain number.
    power : float
        Its exponent.

    Raises
    ------
    NotAValue

    Examples
    --------
    >>> value, uncertainty = uncertain_in_si("2 GPa +- 5 %", "Pa")
    >>> value, uncertainty.size
    (2000000000.0, 100000000.0)
    """
    if interval := _INTERVAL.fullmatch(text):
        low, high = (_si(f"{number} {interval[3]}", target, power) for number in interval.groups()[:2])
        if not low < high:
            raise NotAValue("has an interval whose first end is not below the second")
        # The middle of 1.8 and 2.2 is 2 to all digits.
        return float(f"{0.5 * (low + high):.15g}"), Uncertainty(0.5 * (high - low), True, text)
    if digits := _DIGITS.fullmatch(text):
        number = ufloat_fromstr(digits[1])
        texts = [f"{part} {digits[2]}" for part in (number.nominal_value, number.std_dev)]
    else:
        texts = _SIGN.split(_BRACKETS.sub(r"\1 ", text))
    if len(texts) != 2:
        raise NotAValue("is no value +- standard deviation and no [interval] with a unit behind it")
    mean, deviation = texts
    percent = _PERCENT.fullmatch(deviation)
    if percent:
        mean += f" {percent[2]}"
    elif _PLAIN.fullmatch(mean) and not _PLAIN.fullmatch(deviation):
        # One unit behind both numbers.
        mean += re.sub(rf"^\s*{NUMBER}", "", deviation)
    value = _si(mean, target, power)
    size = abs(value) * float(percent[1]) / 100.0 if percent else _si(deviation, target, power)
    if not size > 0.0:
        raise NotAValue("has a standard deviation that is not above 0")
    return value, Uncertainty(size, False, text)


def _si(text: str, target: str, power: float) -> float:
    """A number with a unit, or a plain one, in SI."""
    if target:
        return in_si(text.strip(), target, power)
    if not _PLAIN.fullmatch(text):
        raise NotAValue("is no plain number with an uncertainty, as 0.3 +- 0.02 or [0.25, 0.35]")
    return float(text)
