"""Numbers with a bound of their error: arithmetic, order and text."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any, Protocol, TypeAlias, cast, runtime_checkable

from fem_reference._presentation import with_bound

__all__ = ["Arithmetic", "BoundedNumber", "HasBound"]

#: A value and the bound of its error.
_Pair: TypeAlias = tuple[float, float]

#: Relative rounding of one operation of double precision: half a unit in the last place.
_ROUNDING = 2.0**-53


@runtime_checkable
class HasBound(Protocol):
    """A value with a bound of its error, of this package or of another one."""

    @property
    def value(self) -> float:
        """The value."""
        ...

    @property
    def u_num(self) -> float:
        """Bound on its error."""
        ...


def _parts(operand: object) -> tuple[float, float] | None:
    """Value and bound of an operand; None if it is no number."""
    if isinstance(operand, Real):
        return float(operand), 0.0
    if isinstance(operand, HasBound) and isinstance(operand.value, Real) and isinstance(operand.u_num, Real):
        return float(operand.value), float(operand.u_num)
    return None


def _combined(rule: Callable[[_Pair, _Pair], Any], first: object, second: object) -> Any:
    """What a rule makes of two operands; NotImplemented if one of them is no number."""
    a, b = _parts(first), _parts(second)
    return NotImplemented if a is None or b is None else rule(a, b)


def _ordered(order: Callable[[float, float], bool], first: object, second: object) -> bool:
    """The order of the values of two operands."""
    return cast(bool, _combined(lambda a, b: order(a[0], b[0]), first, second))


class Arithmetic:
    """The operations of a class with `value` and `u_num`; their results are `BoundedNumber`."""

    __slots__ = ()

    def __float__(self) -> float:
        # A class with this base has both numbers.
        return cast(_Pair, _parts(self))[0]

    def __str__(self) -> str:
        return with_bound(*cast(_Pair, _parts(self)))

    def __format__(self, spec: str) -> str:
        return format(float(self), spec) if spec else str(self)

    def __add__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_sum, self, other))

    def __radd__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_sum, other, self))

    def __sub__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_difference, self, other))

    def __rsub__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_difference, other, self))

    def __mul__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_product, self, other))

    def __rmul__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_product, other, self))

    def __truediv__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_ratio, self, other))

    def __rtruediv__(self, other: object) -> BoundedNumber:
        return cast(BoundedNumber, _combined(_ratio, other, self))

    def __neg__(self) -> BoundedNumber:
        return BoundedNumber(*_signed(-1.0, self))

    def __abs__(self) -> BoundedNumber:
        return BoundedNumber(*_signed(math.copysign(1.0, float(self)), self))

    def __lt__(self, other: object) -> bool:
        return _ordered(operator.lt, self, other)

    def __le__(self, other: object) -> bool:
        return _ordered(operator.le, self, other)

    def __gt__(self, other: object) -> bool:
        return _ordered(operator.gt, self, other)

    def __ge__(self, other: object) -> bool:
        return _ordered(operator.ge, self, other)


def _signed(sign: float, operand: object) -> _Pair:
    """An operand times a sign, which rounds nothing."""
    value, bound = cast(_Pair, _parts(operand))
    return sign * value, bound


@dataclass(frozen=True, slots=True)
class BoundedNumber(Arithmetic):
    """The result of arithmetic with solutions: a value, and a bound on its error for the worst case of all operands.

    Numbers are ordered by value: two of them differ for certain if ``abs(a - b)`` is above its own bound.

    Attributes
    ----------
    value : float
    u_num : float
        The errors of the operands add in the worst way, and so does the rounding of each operation.

    Examples
    --------
    >>> ratio = BoundedNumber(3.0, 0.1) / BoundedNumber(2.0, 0.0)
    >>> ratio.value, round(ratio.u_num, 12), f"{ratio:.3f}", ratio > 1
    (1.5, 0.05, '1.500', True)
    >>> print(1 - ratio)
    -0.50 +- 5e-02
    """

    value: float
    u_num: float


def _rounded(value: float, bound: float) -> BoundedNumber:
    # The bound takes at most eight operations itself.
    return BoundedNumber(value, (1.0 + 8.0 * _ROUNDING) * bound + _ROUNDING * abs(value))


def _sum(a: _Pair, b: _Pair) -> BoundedNumber:
    return _rounded(a[0] + b[0], a[1] + b[1])


def _difference(a: _Pair, b: _Pair) -> BoundedNumber:
    return _rounded(a[0] - b[0], a[1] + b[1])


def _product(a: _Pair, b: _Pair) -> BoundedNumber:
    return _rounded(a[0] * b[0], abs(a[0]) * b[1] + abs(b[0]) * a[1] + a[1] * b[1])


def _ratio(a: _Pair, b: _Pair) -> BoundedNumber:
    if abs(b[0]) <= b[1]:
        raise ZeroDivisionError(f"the divisor {with_bound(*b)} may be zero: a ratio has no bound")
    value = a[0] / b[0]
    # |x/y - a/b| with |x - a| <= ua and |y - b| <= ub is at most (ua + |a/b| ub) / (|b| - ub).
    bound = (a[1] + abs(value) * b[1]) / (abs(b[0]) - b[1])
    return _rounded(value, bound)
