"""Values with a unit as numbers in SI, and numbers in SI as text with a prefix."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Any

from comparisons.data.validation import nearest_name, shown
from comparisons.numerics.number_text import short

#: A decimal number in a text.
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_NAME = r"[A-Za-zµμΩÅ°]+(?:\s*(?:\^|\*\*)\s*\(?[+-]?\d{1,2}(?:\.\d{1,4})?\)?)?"
#: A product of powers of units, and nothing else: pint would also calculate.
_UNIT = re.compile(rf"(?:1\s*/\s*)?{_NAME}(?:\s*[*/·]\s*{_NAME}|\s+{_NAME})*")
#: Signs of a unit that pint does not read.
_SIGNS = str.maketrans({"·": "*", "²": "^2", "³": "^3"})
_VALUE = re.compile(rf"\s*({NUMBER})\s*(.*?)\s*")

#: Prefixes by which text shows a number, and their powers of ten: moduli of 1e9 Pa, energies of contacts of 1e-18 J.
_PREFIXES = tuple(zip(range(9, -24, -3), ("G", "M", "k", "", "m", "µ", "n", "p", "f", "a", "z"), strict=True))

#: A usual unit is one in SI with a prefix of this table.  Any other is read by pint, whose import and registry take
#: half a second.
_POWERS = {"": 0, "G": 9, "M": 6, "k": 3, "c": -2, "m": -3, "n": -9, "p": -12, "f": -15, "a": -18} | dict.fromkeys(
    ("u", "µ", "μ"), -6
)
#: Units in SI before which a prefix is one of the first factor.
_IN_SI = frozenset({"m", "Pa", "N", "J", "J/m^2", "N/m", "m/V", "V", "A", "s"})

#: Largest value in SI of a length, a modulus, a pressure or an energy per area, and the inverse of the smallest: none
#: of a contact is near them (z0 > 1e-11 m, E < 1e13 Pa), and cubes of their products stay in the range of a double.
LARGEST_SIZE = 1e20
#: Smallest value of another unit than those: Hamaker constants are near 1e-20 J.
_SMALLEST = {"J": 1e-30}

#: Relative error of a few multiplications, and decimals of an exponent, of which a unit has fewer.
_ROUNDING, _DIGITS = 1e-14, 12


class NotAValue(Exception):
    """The text is no value of the dimension; the message is the end of a sentence."""


@lru_cache
def _registry() -> Any:
    # Imported here: a file with plain numbers does not need it, nor do other commands.
    import pint

    return pint.UnitRegistry()


@lru_cache(maxsize=256)
def unit_factor(unit: str, target: str, power: float = 1.0) -> float:
    """Return the number of target units to a power that one unit is.

    Raises
    ------
    NotAValue
        If the unit is unknown, or of another dimension.

    Examples
    --------
    >>> unit_factor("GPa", "Pa"), round(unit_factor("um^2", "m", 2.0) * 1e12, 12)
    (1000000000.0, 1.0)
    """
    if unit.startswith(","):
        raise NotAValue("has a comma in place of a decimal point")
    plain = unit.translate(_SIGNS)
    if not _UNIT.fullmatch(plain):
        raise NotAValue(f"has the unit {shown(unit)}, which is no product of units{_meant(unit, target)}")
    prefix = plain.removesuffix(target)
    if power == 1.0 and target in _IN_SI and plain.endswith(target) and prefix in _POWERS:
        return float(f"1e{_POWERS[prefix]}")
    registry = _registry()
    # Not 0.19999999999999996, which n - 1 may be.
    aim = registry.Unit(target) ** round(power, _DIGITS)
    try:
        source_unit = registry.Unit(plain)
    except Exception:  # pint has several for what it does not know, and the tokens of Python others
        raise NotAValue(f"has the unknown unit {shown(unit)}{_meant(unit, target)}") from None
    # An angle has no dimension, nor has a percentage: their root units differ.
    if registry.get_root_units(source_unit)[1] != registry.get_root_units(aim)[1]:
        target_unit = target if power == 1.0 else f"{target}^({power:g})"
        raise NotAValue(f"has the unit {unit}, which is not one of {target_unit}")
    return float(registry.Quantity(1.0, source_unit).to(aim).magnitude)


def _meant(unit: str, target: str) -> str:
    """The usual unit that is written nearly like an unknown one, as the end of a sentence; nothing if none is."""
    # Units below Pa are refused, and those above the others are of no contact.
    usual = [f"{prefix}{target}" for prefix in ("GMk" if target == "Pa" else ("", "m", "u", "n", "p")) if target]
    of_letters = {name.lower(): name for name in usual}
    near = of_letters.get(unit.lower()) or nearest_name(unit, usual)
    return f" (did you mean {near}?)" if near else ""


def magnitude_in_si(value: object, target: str, power: float = 1.0) -> object:
    """Return the magnitude of a quantity of `pint` in SI; anything else as it is.

    Parameters
    ----------
    value : object
        A quantity of any registry has `magnitude` and `m_as`.
    target, power
        As for `in_si`.

    Raises
    ------
    NotAValue
        If it has another dimension.

    Examples
    --------
    >>> magnitude_in_si("2 GPa", "Pa"), magnitude_in_si(_registry().Quantity(2.0, "GPa"), "Pa")
    ('2 GPa', 2000000000.0)
    """
    if not (hasattr(value, "magnitude") and hasattr(value, "m_as")):
        return value
    try:
        return value.m_as(f"({target})**{round(power, _DIGITS)}" if target else "dimensionless")
    except Exception:  # that of pint is of the version of the quantity
        raise NotAValue(f"has another unit than {target or 'none'}") from None


def in_si(value: object, target: str, power: float = 1.0) -> float:
    """Return a value in SI.

    Parameters
    ----------
    value : object
        A number, which is in SI, or a text of a number and a unit.
    target : str
        The unit in SI.
    power : float
        Its exponent.

    Raises
    ------
    NotAValue

    Examples
    --------
    >>> in_si("2 GPa", "Pa"), in_si(3e-7, "m"), in_si("50 mJ/m^2", "J/m^2"), in_si("200 mrad", "rad")
    (2000000000.0, 3e-07, 0.05, 0.2)
    """
    if isinstance(value, str):
        match = _VALUE.fullmatch(value)
        if not match:
            raise NotAValue("is not a number with a unit")
        if not match[2]:
            raise NotAValue("has no unit")
        factor = unit_factor(match[2], target, power)
        # Division by 10^9 keeps all digits of 100 nm; the double of 1e-9 is no power of ten.
        inverse = round(1.0 / factor)
        divides = abs(inverse * factor - 1.0) < _ROUNDING
        scaled = float(match[1]) / inverse if divides else float(match[1]) * factor
    elif isinstance(value, int | float) and not isinstance(value, bool):
        scaled = float(value) if abs(value) < 1e300 else math.inf
    else:
        raise NotAValue("is not a number")
    if not math.isfinite(scaled):
        raise NotAValue("is not a finite number")
    smallest = _SMALLEST.get(target, 1.0 / LARGEST_SIZE)
    if target and power == 1.0 and scaled and not smallest <= abs(scaled) <= LARGEST_SIZE:
        raise NotAValue(f"has a size outside {smallest:g} to {LARGEST_SIZE:g} {target}")
    return scaled


def si_text(value: float, u_num: float, unit: str, last: float = 0.0) -> str:
    """Return a value in SI with the prefix of its size, and its last digit as of `short`.

    Examples
    --------
    >>> si_text(2.71721234e-8, 4e-18, "N", 1e-12), si_text(2.71721234e-8, 4e-11, "N", 1e-12)
    ('27.172 nN', '27.17(4) nN')
    >>> si_text(2.7172e-8, 4e-11, "N"), si_text(-3.2e-10, 0.0, "m"), si_text(1.5, 1e-3, "1")
    ('27.17(4) nN', '-320 pm', '1.5000(10)')
    """
    if unit == "1":
        return short(value, u_num, last)
    power, prefix = _prefix(max(abs(value), u_num))
    # A floor for the uncertainty: scaling by the prefix changes the last bit of an exact value.
    scaled = float(f"{value * 10.0**-power:.15g}")
    return f"{short(scaled, u_num * 10.0**-power, last * 10.0**-power)} {prefix}{unit}"


def prefixed_unit(size: float, unit: str) -> tuple[int, str]:
    """Return the power of ten and the name of a unit in SI with the prefix of a size.

    Examples
    --------
    >>> prefixed_unit(2.7e-8, "N"), prefixed_unit(0.05, "J/m^2"), prefixed_unit(0.3, "1"), prefixed_unit(1e-12, "m^2")
    ((-9, 'nN'), (-3, 'mJ/m^2'), (0, '1'), (0, 'm^2'))
    """
    if unit == "1" or "^" in unit.partition("/")[0]:
        return 0, unit
    power, prefix = _prefix(size)
    return power, f"{prefix}{unit}"


def _prefix(size: float) -> tuple[int, str]:
    return next((pair for pair in _PREFIXES if size >= 10.0 ** pair[0]), _PREFIXES[-1] if size else (0, ""))
