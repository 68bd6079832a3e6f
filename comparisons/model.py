"""The contract of every model: its methods, its results and its two exceptions.

Data flow: a `comparisons.Problem` and the name of a quantity go in, a `Result` comes out.  A model that
does not define the quantity raises `NotApplicable` with one sentence; a computation that did not converge
raises `ComputationFailed`.  No model returns an unconverged number.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from types import ModuleType
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from comparisons.problem.problem import Problem

Array = NDArray[np.float64]

#: Fields are stored out to this gap, in z0, where the traction has fallen to 0.2 % of its largest.
FARTHEST_GAP = 10.0


class NotApplicable(Exception):
    """The model does not define this quantity for this problem; the message has the reason.

    Examples
    --------
    >>> raise NotApplicable("JKR has no jump into contact")
    Traceback (most recent call last):
    comparisons.model.NotApplicable: JKR has no jump into contact
    """


class ComputationFailed(Exception):
    """The computation of the quantity did not converge; the message has the remedy.

    Examples
    --------
    >>> Result(value=float("nan"), u_num=0.0)
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: the model produced nan, which is not a finite number
    """


class NotTaken(NotApplicable):
    """The model does not take the quantity of the problem, as its `skip` states, whatever its events are."""


def refuse(reason: str | None) -> None:
    """Raise `NotTaken` with the reason that `skip` of a model returns; nothing if there is none.

    Examples
    --------
    >>> refuse(None)
    >>> refuse("JKR has no jump into contact")
    Traceback (most recent call last):
    comparisons.model.NotTaken: JKR has no jump into contact
    """
    if reason is not None:
        raise NotTaken(reason)


@contextmanager
def translated(package: ModuleType) -> Iterator[None]:
    """Turn the exceptions of a solver, `fscm` or `fem_reference`, into `NotApplicable` and `ComputationFailed`.

    Examples
    --------
    >>> import fscm
    >>> with translated(fscm):
    ...     raise fscm.NotConverged("50 iterations were not enough")
    Traceback (most recent call last):
    comparisons.model.ComputationFailed: 50 iterations were not enough
    """
    try:
        yield
    except package.NoSuchEvent as reason:
        raise NotApplicable(str(reason)) from reason
    except package.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """What a computation took: the last columns of a table of results.

    Attributes
    ----------
    size : int
        Number of unknowns of the discrete problem (0 for a closed form).
    iterations : int
        Newton or root-finding iterations (0 when none).
    residual : float
        Largest residual of the discrete equations at the solution (0 when none).
    seconds : float
        Wall-clock time of the computation.

    Examples
    --------
    >>> Effort(size=3)
    Effort(size=3, iterations=0, residual=0.0, seconds=0.0)
    """

    size: int | None = 0
    iterations: int | None = 0
    residual: float | None = 0.0
    seconds: float = 0.0


#: Names of these columns.
EFFORT = tuple(column.name for column in fields(Effort))


@dataclass(frozen=True, slots=True)
class Result(Effort):
    """A value of a model with the bound on its numerical error.

    Attributes
    ----------
    value : float
        Dimensionless value, in the unit that `comparisons.QUANTITIES` states.
    u_num : float
        Bound on the numerical error of `value` (same unit, >= 0).  For a closed form this is the rounding
        and root-finding error.  The error of the model itself is not part of it.
    reason : str
        One sentence on a further assumption of the value, for example an equivalent power law; empty if there is none.

    Examples
    --------
    >>> Result(value=1.5, u_num=2e-15).value
    1.5
    """

    value: float
    u_num: float
    reason: str = ""

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ComputationFailed(f"the model produced {self.value}, which is not a finite number")
        if not (math.isfinite(self.u_num) and self.u_num >= 0):
            raise ComputationFailed(f"the model stated u_num = {self.u_num}; it must be finite and >= 0")


@dataclass(frozen=True, slots=True)
class Curve:
    """A force-displacement curve along the equilibrium path (all arrays of one length).

    That of a model is dimensionless; `comparisons.curve` returns it in the units of the problem.

    Attributes
    ----------
    displacement : ndarray, shape (m,)
        Approach delta / z0, positive towards the half-space.
    load : ndarray, shape (m,)
        P / (pi Q^(2/n) dgamma z0^(2/n - 1)), tension negative.
    columns : dict of str to ndarray, shape (m,)
        Further values on the path, e.g. ``central_gap``, ``contact_radius``, ``cohesive_radius``; 1 in
        ``stable_under_displacement`` and ``stable_under_load`` where the state can be held, else 0.
    u_distance : float
        Bound on the numerical distance of the points from the exact curve, as a fraction of its ranges.

    Examples
    --------
    >>> curve = Curve(np.array([-1.0, 0.0]), np.array([-0.5, 0.2]), {"contact_radius": np.array([0.3, 0.8])})
    >>> float(-curve.load.min())
    0.5
    """

    displacement: Array
    load: Array
    columns: dict[str, Array] = field(default_factory=dict)
    u_distance: float = 0.0


@dataclass(frozen=True, slots=True)
class RadialField:
    """The surface where P is smallest (all arrays of one length, dimensionless, radii increasing).

    Attributes
    ----------
    radius, pressure, gap : ndarray, shape (m,)
        r / (Q z0)^(1/n), p z0 / dgamma (tension negative) and H / z0.
    u_distance, u_gap_distance : float
        As of a `Curve`, for the pressure and for the gap over the radius, out to a gap of 10.

    Examples
    --------
    >>> surface = RadialField(np.array([0.1, 0.2]), pressure=np.array([0.3, -1.0]), gap=np.array([-0.1, 11.0]))
    >>> radius, gap, u_distance = surface.shown("gap")
    >>> gap.tolist(), u_distance
    ([-0.1], 0.0)
    """

    radius: Array
    pressure: Array
    gap: Array
    u_distance: float = 0.0
    u_gap_distance: float = 0.0

    def shown(self, name: str) -> tuple[Array, Array, float]:
        """Return radii, the pressure or the gap out to the gap `FARTHEST_GAP`, and its bound."""
        inside = self.gap <= FARTHEST_GAP
        values, u_distance = (self.gap, self.u_gap_distance) if name == "gap" else (self.pressure, self.u_distance)
        return self.radius[inside], values[inside], u_distance


@runtime_checkable
class Model(Protocol):
    """The contract of every model of this repository and of every external model.

    Attributes are plain data; `evaluate` is a pure function of its arguments.  A model of this repository has one
    method more, ``skip(problem, quantity)``: why it does not take the quantity of the problem, or None.  An external
    model may have the attribute `applies_to` instead, the domain for which it promises a result
    (`comparisons.domain`).  A model is not evaluated outside of either.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> class Rigid:
    ...     name, version, citation, domain = "rigid", "1", "Bradley (1932)", "n = 2, mu -> 0"
    ...
    ...     def evaluate(self, problem: Problem, quantity: str) -> Result:
    ...         if quantity != "pull_off_force":
    ...             raise NotApplicable("the rigid sphere has a pull-off force only")
    ...         return Result(value=2.0, u_num=0.0)
    >>> isinstance(Rigid(), Model)
    True
    >>> Rigid().evaluate(Problem.dimensionless(n=2, k=0, mu=1e-3), "pull_off_force").value
    2.0
    """

    name: str
    version: str
    citation: str
    domain: str

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity for the problem, or raise `NotApplicable` or `ComputationFailed`."""
        ...


@runtime_checkable
class HasSkip(Protocol):
    """A model of this repository.

    Examples
    --------
    >>> from comparisons.registry import create
    >>> isinstance(create("jkr"), HasSkip)
    True
    """

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return in one sentence why the model does not take a quantity of a problem; None if it does."""
        ...


@runtime_checkable
class HasCurve(Protocol):
    """A model with a force-displacement curve.

    Examples
    --------
    >>> from comparisons.registry import create
    >>> isinstance(create("jkr"), HasCurve)
    True
    """

    def curve(self, problem: Problem) -> Curve:
        """Return the curve, or raise `NotApplicable` or `ComputationFailed`."""
        ...


@runtime_checkable
class HasCurveTo(HasCurve, Protocol):
    """A model whose force-displacement curve goes on to any load.

    Examples
    --------
    >>> from comparisons.registry import create
    >>> isinstance(create("fscm"), HasCurveTo), isinstance(create("bradley"), HasCurveTo)
    (True, False)
    """

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the curve at least to a compressive load, dimensionless, or raise as `curve`."""
        ...


@runtime_checkable
class HasProfile(Protocol):
    """A model with gap and pressure over the radius.

    Examples
    --------
    >>> from comparisons.registry import create
    >>> isinstance(create("fscm"), HasProfile), isinstance(create("jkr"), HasProfile)
    (True, False)
    """

    def pull_off_profile(self, problem: Problem) -> RadialField:
        """Return the surface where P is smallest, or raise `NotApplicable` or `ComputationFailed`."""
        ...
