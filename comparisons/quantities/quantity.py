"""The classes of a row of the registry: scalar quantities, and curves with their two axes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from comparisons.model import Model, Result

if TYPE_CHECKING:
    from comparisons.problem.problem import Problem

__all__ = ["Axis", "CurveQuantity", "Kind", "Points", "Quantity", "ScalarQuantity"]


class Kind(StrEnum):
    """A number, the equilibrium path of a problem, or a distribution over the radius."""

    SCALAR = "scalar"
    CURVE = "curve"
    FIELD = "field"


@dataclass(frozen=True, slots=True)
class Quantity:
    """What every quantity has: name, symbol, title (its name in a sentence) and meaning."""

    name: str
    symbol: str
    title: str
    meaning: str


@dataclass(frozen=True, slots=True)
class _Scale:
    """Unit, that in SI, sign rule, and that rule as a test of a value."""

    unit: str
    si_unit: str
    sign: str
    admits: Callable[[float], bool]


#: The scales of `fscm.Problem.units`.
_SCALES = {
    "load": _Scale(
        "pi Q^(2/n) dgamma z0^(2/n-1)", "N", "positive, though the load is a tension", lambda value: value > 0.0
    ),
    "energy": _Scale("pi Q^(2/n) dgamma z0^(2/n)", "J", "never negative", lambda value: value >= 0.0),
    "displacement": _Scale(
        "z0",
        "m",
        "positive towards the half-space, zero where the undeformed gap at r = 0 is zero",
        lambda value: True,
    ),
    "gap": _Scale(
        "z0", "m", "zero at the equilibrium distance of two flat surfaces, above -1", lambda value: value > -1.0
    ),
    "number": _Scale("1", "1", "positive", lambda value: value > 0.0),
}

#: Units in SI of the scales of axes and columns.
_SI_UNITS = {"displacement": "m", "gap": "m", "radius": "m", "load": "N", "traction": "Pa"}

#: Scales of the columns that a curve may have.
_COLUMNS = {"central_gap": "gap", "edge_radius": "radius", "contact_radius": "radius", "cohesive_radius": "radius"}


@dataclass(frozen=True, slots=True)
class ScalarQuantity(Quantity):
    """A number; its scale decides unit and sign.

    Examples
    --------
    >>> from comparisons.quantities import QUANTITIES
    >>> QUANTITIES["pull_off_force"].unit
    'pi Q^(2/n) dgamma z0^(2/n-1)'
    >>> QUANTITIES["jump_in_gap"].admits(-1.2)
    False
    """

    scale: str

    @property
    def kind(self) -> Kind:
        """Always a scalar."""
        return Kind.SCALAR

    @property
    def unit(self) -> str:
        """The scale of the dimensionless value."""
        return _SCALES[self.scale].unit

    @property
    def si_unit(self) -> str:
        """The unit in SI."""
        return _SCALES[self.scale].si_unit

    @property
    def sign(self) -> str:
        """The positive direction, and the place of zero."""
        return _SCALES[self.scale].sign

    def admits(self, value: float) -> bool:
        """Whether a value keeps the sign rule."""
        return _SCALES[self.scale].admits(value)

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
        Heading of its column in files.
    symbol, unit : str
        As in texts.
    title : str
        Its name in a sentence.
    formula, mathtext : str
        The dimensionless variable in Unicode, and as mathematics of Matplotlib, which begins with the symbol.
    scale : str
        Of `fscm.Problem.units`.
    sign : str
        Meaning of a negative value, where it needs one.
    """

    name: str
    symbol: str
    unit: str
    title: str
    formula: str
    mathtext: str
    scale: str
    sign: str = ""

    @property
    def in_si(self) -> Axis:
        """The same axis in SI."""
        unit = _SI_UNITS[self.scale]
        symbol = self.mathtext.partition(" ")[0]
        return replace(self, mathtext=rf"{symbol}\ \mathrm{{({unit})}}", unit=unit)

    @property
    def label(self) -> str:
        """Label in Unicode."""
        return f"{self.title} {self.formula}"

    @property
    def figure_label(self) -> str:
        """Label in a figure of Matplotlib."""
        return f"{self.title} ${self.mathtext}$"

    @property
    def signed_figure_label(self) -> str:
        """Label in a figure, with the meaning of negative values."""
        return f"{self.figure_label}, {self.sign}" if self.sign else self.figure_label


@dataclass(frozen=True, slots=True)
class Points:
    """Points in the order of the curve, in the units of the problem, and the bound on their distance from it.

    `columns` holds what else a model knows at these points; it is shown and not stored.
    """

    x: list[float]
    y: list[float]
    u_distance: float
    columns: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class CurveQuantity(Quantity):
    """A curve or a field: its axes, the caption of its plot, and the function that evaluates it.

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
    compute: Callable[[Model, Problem], Points]

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
        r"""The same curve with axes in SI.

        Examples
        --------
        >>> from comparisons.quantities import CURVES
        >>> CURVES["force_curve"].in_si.x.figure_label, CURVES["force_curve"].si_unit
        ('displacement $\\delta\\ \\mathrm{(m)}$', 'm; N')
        """
        return replace(self, x=self.x.in_si, y=self.y.in_si)

    @property
    def columns_in_si(self) -> dict[str, str]:
        """The columns of points in SI, with their units: ``displacement [m]``."""
        scales = {self.x.name: self.x.scale, self.y.name: self.y.scale, **_COLUMNS}
        return {name: f"{name} [{_SI_UNITS[scale]}]" for name, scale in scales.items()}

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
        """Return the points of a model, or raise `NotApplicable` or `ComputationFailed`."""
        return self.compute(model, problem)
