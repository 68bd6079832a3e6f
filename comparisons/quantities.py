"""The registry of quantities: numbers, curves and fields, the rows of `comparisons/data/quantities.toml`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar, cast

from comparisons.data.toml_text import shipped
from comparisons.data.validation import known_name
from comparisons.model import Curve, HasCurve, HasProfile, Model, Result

if TYPE_CHECKING:
    from comparisons.problem.problem import Problem

_TABLES = shipped("quantities.toml")


class Kind(StrEnum):
    """A number, the equilibrium path of a problem, or a distribution over the radius."""

    SCALAR = "scalar"
    CURVE = "curve"
    FIELD = "field"


#: Scales of `fscm.Problem.units`: units of a dimensionless number and in SI; of a scalar also sign and smallest value.
_SCALES = _TABLES["scale"]

#: Scales of the columns that a curve may have.
_COLUMNS = {"central_gap": "gap", "edge_radius": "radius", "contact_radius": "radius", "cohesive_radius": "radius"}


@dataclass(frozen=True, slots=True)
class Quantity:
    """What every quantity has: name, symbol, title (its name in a sentence) and meaning."""

    name: str
    symbol: str
    title: str
    meaning: str


@dataclass(frozen=True, slots=True)
class ScalarQuantity(Quantity):
    """A number; its scale decides the other fields.

    Attributes
    ----------
    unit, si_unit : str
        Of a dimensionless number, and in SI.
    sign : str
        The positive direction, and the place of zero.
    lowest : float
        The smallest value; it is not admitted itself if `above` is true.

    Examples
    --------
    >>> from comparisons.quantities import QUANTITIES
    >>> QUANTITIES["pull_off_force"].unit
    'pi Q^(2/n) dgamma z0^(2/n-1)'
    >>> QUANTITIES["jump_in_gap"].admits(-1.2)
    False
    """

    scale: str
    unit: str
    si_unit: str
    sign: str = ""
    lowest: float = -math.inf
    above: bool = False
    kind: ClassVar[Kind] = Kind.SCALAR

    def admits(self, value: float) -> bool:
        """Whether a value keeps the sign rule."""
        return value > self.lowest if self.above else value >= self.lowest

    @property
    def relative(self) -> bool:
        """Whether errors are stated as a fraction of it; displacements and gaps may pass through zero."""
        return self.scale in ("load", "energy")

    def evaluate(self, model: Model, problem: Problem) -> Result:
        """Return the value of a model, or raise `NotApplicable` or `ComputationFailed`."""
        return model.evaluate(problem, self.name)

    def in_units(self, result: Result, units: Mapping[str, float]) -> Result:
        """Return a dimensionless result in the units of a problem."""
        unit = units[self.scale]
        return replace(result, value=result.value * unit, u_num=result.u_num * unit)


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of a curve.

    Attributes
    ----------
    name : str
        Heading of its column in files; for a field also the name in `comparisons.model.RadialField`.
    symbol : str
        As in texts.
    scale : str
        Of `fscm.Problem.units`.
    title : str
        Its name in a sentence.
    formula : str
        The variable with its unit in Unicode.
    unit, si_unit : str
        As in texts, and in SI.
    sign : str
        Meaning of a negative value, where it needs one.
    is_in_si : bool
    """

    name: str
    symbol: str
    scale: str
    title: str
    formula: str
    unit: str
    si_unit: str
    sign: str = ""
    is_in_si: bool = False

    @property
    def in_si(self) -> Axis:
        """The same axis in SI."""
        return replace(self, formula=f"{self.symbol} ({self.si_unit})", unit=self.si_unit, is_in_si=True)

    @property
    def label(self) -> str:
        """Label in a plot."""
        return f"{self.title} {self.formula}"


@dataclass(frozen=True, slots=True)
class Points:
    """Points in the order of the curve, in the units of the problem, and the bound on their distance from it.

    The bound is that in the plane in which both axes are scaled by the range of the curve (see
    `comparisons.numerics.curve_distance`).  `columns` holds what else a model knows at these points; it is shown and
    not stored.
    """

    x: list[float]
    y: list[float]
    u_distance: float
    columns: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class CurveQuantity(Quantity):
    """A curve or a field: its axes and the caption of its plot.

    Examples
    --------
    >>> from comparisons.quantities import CURVES
    >>> CURVES["force_curve"].unit
    'z0; pi Q^(2/n) dgamma z0^(2/n-1)'
    """

    kind: Kind
    x: Axis
    y: Axis
    caption: str

    @property
    def unit(self) -> str:
        """The units of both axes."""
        return f"{self.x.unit}; {self.y.unit}"

    @property
    def si_unit(self) -> str:
        """The units of both axes in SI."""
        return self.in_si.unit

    @property
    def in_si(self) -> CurveQuantity:
        """The same curve with axes in SI.

        Examples
        --------
        >>> from comparisons.quantities import CURVES
        >>> CURVES["force_curve"].in_si.x.label, CURVES["force_curve"].si_unit
        ('displacement δ (m)', 'm; N')
        """
        return replace(self, x=self.x.in_si, y=self.y.in_si)

    @property
    def columns_in_si(self) -> dict[str, str]:
        """The columns of points in SI, with their units: ``displacement [m]``."""
        scales = {self.x.name: self.x.scale, self.y.name: self.y.scale, **_COLUMNS}
        return {name: f"{name} [{_SCALES[scale]['si_unit']}]" for name, scale in scales.items()}

    def in_units(self, points: Points, units: Mapping[str, float]) -> Points:
        """Return dimensionless points in the units of a problem."""
        x, y = units[self.x.scale], units[self.y.scale]
        columns = {name: values * units.get(_COLUMNS.get(name, ""), 1.0) for name, values in points.columns.items()}
        return Points([a * x for a in points.x], [b * y for b in points.y], points.u_distance, columns)

    @property
    def sign(self) -> str:
        """The sign rule of the vertical axis."""
        return self.y.sign

    def evaluate(self, model: Model, problem: Problem) -> Points:
        """Return the points of a model, or raise `NotApplicable` or `ComputationFailed`.

        Fields are those where P is smallest, out to the gap `comparisons.model.FARTHEST_GAP`.

        Examples
        --------
        >>> from comparisons.problem import Problem
        >>> from comparisons.quantities import CURVES
        >>> from comparisons.registry import create
        >>> problem = Problem.dimensionless(n=2, k=0, mu=0.1)
        >>> round(min(CURVES["force_curve"].evaluate(create("bradley"), problem).y), 3)
        -2.0
        """
        if self.kind is Kind.CURVE:
            return points_of(cast(HasCurve, model).curve(problem))
        x, y, u_distance = cast(HasProfile, model).pull_off_profile(problem).shown(self.y.name)
        return Points(list(map(float, x)), list(map(float, y)), float(u_distance))


def points_of(curve: Curve) -> Points:
    """Return the points of a force-displacement curve."""
    x, y = (list(map(float, values)) for values in (curve.displacement, curve.load))
    return Points(x, y, float(curve.u_distance), curve.columns)


def _axis(name: str, scale: str, **row: Any) -> Axis:
    return Axis(name, scale=scale, unit=_SCALES[scale]["unit"], si_unit=_SCALES[scale]["si_unit"], **row)


_AXES = {name: _axis(name, **row) for name, row in _TABLES["axis"].items()}

#: Every scalar, by name.
QUANTITIES = {name: ScalarQuantity(name, **row, **_SCALES[row["scale"]]) for name, row in _TABLES["scalar"].items()}


def _curve(name: str, x: str, y: str, kind: str, **texts: str) -> CurveQuantity:
    return CurveQuantity(name, kind=Kind(kind), x=_AXES[x], y=_AXES[y], **texts)


#: Curves and fields, by name.
CURVES = {name: _curve(name, **row) for name, row in _TABLES["curve"].items()}

#: Every scalar and every curve, by name.
ALL_QUANTITIES: dict[str, ScalarQuantity | CurveQuantity] = {**QUANTITIES, **CURVES}


def title_of(quantity: str) -> str:
    """Return the name of a quantity in a sentence; one that is not in the registry keeps its words.

    Examples
    --------
    >>> title_of("pull_off_force"), title_of("force_curve"), title_of("work_of_adhesion")
    ('pull-off force', 'force-displacement curve', 'work of adhesion')
    """
    row = ALL_QUANTITIES.get(quantity)
    return row.title if row else quantity.replace("_", " ")


def known_scalar(name: str, where: str) -> None:
    """Refuse what is no scalar quantity.

    Raises
    ------
    ValueError
        One sentence with the command that has it, or with the nearest names.

    Examples
    --------
    >>> known_scalar("pull_off_force", "--quantity")
    >>> known_scalar("stress", "--quantity")
    Traceback (most recent call last):
    ValueError: --quantity: stress is no single number: it is a field inside the solid, which fscm-bench fem writes
    """
    for row in _TABLES["elsewhere"]:
        if name in row["names"]:
            raise ValueError(f"{where}: {name} is no single number: {row['remedy']}")
    known_name("quantity", name, QUANTITIES, where)
