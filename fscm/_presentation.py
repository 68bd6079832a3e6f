"""Numbers with bounds as text, paths and surfaces as tables and pictures."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

__all__ = ["Columns", "unit_name", "with_bound"]

#: Significant digits of a number without a bound: all of them.
_ALL_DIGITS = 17


#: Names of the units of a dimensionless problem, and in SI, by kind of quantity.
_SCALES = {
    "displacement": ("z0", "m"),
    "gap": ("z0", "m"),
    "radius": ("(Q z0)^(1/n)", "m"),
    "traction": ("dgamma / z0", "Pa"),
    "load": ("pi Q^(2/n) dgamma z0^(2/n-1)", "N"),
    "energy": ("pi Q^(2/n) dgamma z0^(2/n)", "J"),
    "stiffness": ("pi Q^(2/n) dgamma z0^(2/n-2)", "N/m"),
    "energy_per_area": ("dgamma", "J/m^2"),
}


def unit_name(kind: str, *, is_physical: bool) -> str:
    """Name of the unit of a kind of quantity.

    Examples
    --------
    >>> unit_name("gap", is_physical=False), unit_name("load", is_physical=True), unit_name("number", is_physical=True)
    ('z0', 'N in SI', '1')
    """
    if kind == "number":
        return "1"
    scale, si = _SCALES[kind]
    return f"{si} in SI" if is_physical else scale


def with_bound(value: float, u_num: float) -> str:
    """A value down to the first digit of its bound, and the bound."""
    digits = _ALL_DIGITS
    if u_num > 0.0 and value:
        digits = 1 + math.floor(math.log10(abs(value))) - math.floor(math.log10(u_num))
    return f"{value:#.{min(max(digits, 1), _ALL_DIGITS)}g} +- {u_num:.0e}"


class Columns:
    """A dataclass whose arrays have one length: the columns of a table, and a picture of one over another."""

    __slots__ = ()
    _over: ClassVar[str]
    _drawn: ClassVar[str]
    # Points whose drawn size is a smaller share of the largest are left out at the end of the picture.
    _least_share: ClassVar[float] = 0.0
    # Whether the arrays are those of a physical problem.
    is_physical: bool

    def __repr__(self) -> str:
        over, drawn = getattr(self, self._over), getattr(self, self._drawn)
        ranges = (f"{name} {min(y):.4g} to {max(y):.4g}" for name, y in ((self._over, over), (self._drawn, drawn)))
        return f"{type(self).__name__}({len(over)} points, {', '.join(ranges)})"

    def to_frame(self) -> pd.DataFrame:
        """Return the arrays as columns, one row a point, in the units of the problem."""
        import pandas as pd

        names = [field.name for field in fields(self)]  # type: ignore[arg-type]  # each subclass is a dataclass
        arrays: dict[str, Any] = {name: getattr(self, name) for name in names}
        return pd.DataFrame({name: array for name, array in arrays.items() if isinstance(array, np.ndarray)})

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw into axes of matplotlib, new ones by default, and return them.

        The load of a path over its displacement; the pressure of a surface over the radius, out to where it has fallen
        to a thousandth.  The axes state the unit; numbers are not converted.
        """
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots(layout="constrained")[1]
        x, y = getattr(self, self._over), getattr(self, self._drawn)
        end = int(np.flatnonzero(np.abs(y) >= self._least_share * np.abs(y).max())[-1]) + 1
        axes.plot(x[:end], y[:end])
        axes.set(xlabel=self._label(self._over), ylabel=self._label(self._drawn))
        return axes

    def unit_of(self, name: str) -> str:
        """Name of the unit of an array; of a physical problem that in SI."""
        return unit_name({"pressure": "traction"}.get(name, name), is_physical=self.is_physical)

    def _label(self, name: str) -> str:
        return f"{name.replace('_', ' ')} [{self.unit_of(name)}]"
