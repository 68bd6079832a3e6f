"""The classes of a row of the registry: scalar quantities, and curves with their two axes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from comparisons.model import Model, Result
from fscm.problem import Problem

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
    """Unit, sign rule, and that rule as a test of a value."""

    unit: str
    sign: str
    admits: Callable[[float], bool]


#: The scales of `fscm.Problem.units`.
_SCALES = {
    "load": _Scale("pi Q^(2/n) dgamma z0^(2/n-1)", "positive, though the load is a tension", lambda value: value > 0.0),
    "energy": _Scale("pi Q^(2/n) dgamma z0^(2/n)", "never negative", lambda value: value >= 0.0),
    "displacement": _Scale(
        "z0",
        "positive towards the half-space, zero where the undeformed gap at r = 0 is zero",
        lambda value: True,
    ),
    "gap": _Scale("z0", "zero at the equilibrium distance of two flat surfaces, above -1", lambda value: value > -1.0),
    "number": _Scale("1", "positive", lambda value: value > 0.0),
}


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
        The dimensionless variable in Unicode, and as mathematics of Matplotlib.
    sign : str
        Meaning of a negative value, where it needs one.
    """

    name: str
    symbol: str
    unit: str
    title: str
    formula: str
    mathtext: str
    sign: str = ""

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
    """Points in the order of the curve, dimensionless, and the bound on their distance from it.

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
    def sign(self) -> str:
        """The sign rule of the vertical axis."""
        return self.y.sign

    def evaluate(self, model: Model, problem: Problem) -> Points:
        """Return the points of a model, or raise `NotApplicable` or `ComputationFailed`."""
        return self.compute(model, problem)
