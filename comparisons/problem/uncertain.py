"""Values with a standard deviation or an interval: their text, as numbers in SI."""

from __future__ import annotations

import re
from dataclasses import dataclass

from uncertainties import UFloat, ufloat_fromstr

from comparisons.problem.units import NUMBER, NotAValue, in_si

_INTERVAL = re.compile(rf"\s*\[\s*({NUMBER})\s*,\s*({NUMBER})\s*\]\s*(.*?)\s*")
#: A value with the digits of its standard deviation in brackets, and its unit.
_DIGITS = re.compile(r"\s*([+-]?\d+\.?\d*\(\d+\.?\d*\)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
#: What is on each side of the sign.
_VALUE = re.compile(rf"\s*({NUMBER})\s*(%?)\s*(.*?)\s*")
_SIGN = re.compile(r"\+/-|\+-|±")
_BRACKETS = re.compile(r"^\s*\(([^()]*)\)")


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


def uncertain_in_si(text: object, target: str, power: float = 1.0) -> tuple[float, Uncertainty] | None:
    """Return the value of a text with an uncertainty, in SI; that of an interval is its middle.

    Parameters
    ----------
    text : str or UFloat
        A number of `uncertainties`, in SI, or a text:
        ``2 +- 0.1 GPa``, ``(2 +- 0.1) GPa``, ``2 GPa +- 100 MPa``, ``2 GPa +- 5 %``, ``2 +- 5 % GPa``, ``2.0(1) GPa``
        (standard deviations) or ``[1.8, 2.2] GPa``; without a unit for a plain number.  The sign may be ``±`` or
        ``+/-``.
    target : str
        The unit in SI; nothing for a plain number.
    power : float
        Its exponent.

    Returns
    -------
    tuple or None
        None for a text of another form, and for any other number.

    Raises
    ------
    NotAValue

    Examples
    --------
    >>> value, uncertainty = uncertain_in_si("2 GPa +- 5 %", "Pa")
    >>> value, uncertainty.size
    (2000000000.0, 100000000.0)
    >>> uncertain_in_si("2 GPa", "Pa") is None
    True
    """
    if isinstance(text, UFloat):
        if not text.std_dev > 0.0:
            raise NotAValue("has a standard deviation that is not above 0")
        return float(text.nominal_value), Uncertainty(float(text.std_dev), False, f"{text} {target}".strip())
    if not isinstance(text, str):
        return None
    if interval := _INTERVAL.fullmatch(text):
        low, high = (_si(number, interval[3], target, power) for number in interval.groups()[:2])
        if not low < high:
            raise NotAValue("has an interval whose first end is not below the second")
        # The middle of 1.8 and 2.2 is 2 to all digits.
        return float(f"{0.5 * (low + high):.15g}"), Uncertainty(0.5 * (high - low), True, text)
    if digits := _DIGITS.fullmatch(text):
        number = ufloat_fromstr(digits[1])
        mean, deviation = str(number.nominal_value), str(number.std_dev)
        percent, unit, unit_behind = "", digits[2], digits[2]
    elif _SIGN.search(text):
        sides = [_VALUE.fullmatch(side) for side in _SIGN.split(_BRACKETS.sub(r"\1 ", text))]
        if len(sides) != 2 or not (sides[0] and sides[1]):
            raise NotAValue("is no value +- standard deviation with a unit behind it")
        (mean, share, unit), (deviation, percent, unit_behind) = sides[0].groups(), sides[1].groups()
        unit = share + unit
    else:
        return None
    if percent:
        value = _si(mean, f"{unit} {unit_behind}".strip(), target, power)
        size = abs(value) * float(deviation) / 100.0
    else:
        value = _si(mean, unit or unit_behind, target, power)
        size = _si(deviation, unit_behind, target, power)
    if not size > 0.0:
        raise NotAValue("has a standard deviation that is not above 0")
    return value, Uncertainty(size, False, text)


def _si(number: str, unit: str, target: str, power: float) -> float:
    """A number with a unit, or a plain one, in SI."""
    if target:
        return in_si(f"{number} {unit}", target, power)
    if unit:
        raise NotAValue("is no plain number with an uncertainty, as 0.3 +- 0.02 or [0.25, 0.35]")
    return float(number)
