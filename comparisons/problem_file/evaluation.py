"""Values and curves of the problem of a file by any model, in SI units."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from comparisons.domain import declared_domain
from comparisons.model import ComputationFailed, Model, NotApplicable, Result
from comparisons.problem_file.description import ProblemFile
from comparisons.problem_file.dimensionless import dimensionless_problem
from comparisons.quantities import CURVES, QUANTITIES, Points
from comparisons.quantities.points import FARTHEST_GAP
from comparisons.registry import create

__all__ = [
    "REFERENCES",
    "SI_UNITS",
    "SOLVERS",
    "PhysicalValue",
    "dimensionless_value",
    "evaluate_problem",
    "model_for",
    "points_of",
    "units_of",
    "value_in_si",
]

#: Models that solve the equations; every other one is a closed form or another approximation.
REFERENCES = ("fscm", "fem", "fscm-stieltjes", "fscm-stieltjes-400", "atlas")

#: Those that take every solid, punch and law.
SOLVERS = ("fscm", "fem")

#: Unit in SI of each kind of quantity.
SI_UNITS = {
    "load": "N",
    "energy": "J",
    "displacement": "m",
    "gap": "m",
    "radius": "m",
    "traction": "Pa",
    "number": "1",
}

#: Kind of the columns that a curve may have.
_COLUMNS = {"central_gap": "gap", "edge_radius": "radius", "contact_radius": "radius", "cohesive_radius": "radius"}

#: Kinds of the two axes of each curve.
_AXES = {
    "force_curve": ("displacement", "load"),
    "pull_off_pressure": ("radius", "traction"),
    "pull_off_gap": ("radius", "gap"),
}


@dataclass(frozen=True, slots=True)
class PhysicalValue:
    """A quantity of the problem of a file by one model.

    Attributes
    ----------
    model, quantity : str
    problem : dict
        The content of the file in SI.
    value, u_num : float or None
        In `unit`; None unless `status` is "ok".
    unit : str
        N, m, J, or 1 for a number.
    status : str
        "ok", "not-applicable" or "failed".
    reason : str
        One sentence where there is no value.
    seconds : float
    dimensionless : dict or None
        "value", "u_num" and "unit" in the units of the paper, where the punch is a power law.
    """

    model: str
    quantity: str
    problem: dict[str, Any]
    value: float | None
    u_num: float | None
    unit: str
    status: str
    reason: str
    seconds: float
    dimensionless: dict[str, float | str] | None = None


def model_for(problem: ProblemFile, spec: str) -> Model:
    """Return the model of a SPEC, with Poisson's ratio of the surface where it needs one.

    Raises
    ------
    ValueError
        As `create`.
    """
    nu = problem.solid.get("nu")
    return create(spec, nu if problem.is_of_the_paper else None)


def evaluate_problem(problem: ProblemFile, model: str | Model, quantity: str) -> PhysicalValue:
    """Evaluate a model for the problem of a file.

    Parameters
    ----------
    problem : ProblemFile
    model : str or Model
        A name, a SPEC or a model.
    quantity : str
        One of `comparisons.QUANTITIES`.

    Raises
    ------
    ValueError
        If the model or the quantity is unknown; any other failure is a status with its reason.

    Examples
    --------
    >>> from pathlib import Path
    >>> from comparisons.problem_file.description import Section
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> problem = ProblemFile(Path("silica.toml"), solid, Section("sphere", {"R": 1e-6}), law)
    >>> round(evaluate_problem(problem, "bradley", "pull_off_force").value * 1e9, 3)  # 2 pi R dgamma, in nN
    314.159
    """
    if quantity not in QUANTITIES:
        raise ValueError(f"unknown quantity {quantity!r}; the quantities are {', '.join(QUANTITIES)}")
    if isinstance(model, str):
        model = model_for(problem, model)
    started = time.perf_counter()
    kind = QUANTITIES[quantity].scale
    result, status, reason = None, "ok", ""
    try:
        result = value_in_si(problem, model, quantity)
    except NotApplicable as refusal:
        status, reason = "not-applicable", str(refusal)
    except ComputationFailed as failure:
        status, reason = "failed", str(failure)
    except ValueError:
        raise
    except Exception as error:
        # A defect of the model: it is named, as in a run.
        status, reason = "failed", f"{type(error).__name__}: {error}"
    return PhysicalValue(
        model=model.name,
        quantity=quantity,
        problem=problem.parameters,
        value=result.value if result else None,
        u_num=result.u_num if result else None,
        unit=SI_UNITS[kind],
        status=status,
        reason=result.reason if result else reason,
        seconds=(result and result.seconds) or time.perf_counter() - started,
        dimensionless=dimensionless_value(problem, quantity, result) if result else None,
    )


def dimensionless_value(problem: ProblemFile, quantity: str, result: Result) -> dict[str, float | str] | None:
    """Return a result in SI in the units of the paper, as value, u_num and unit; None where these are not defined."""
    kind = QUANTITIES[quantity].scale
    if kind == "number" or not problem.has_power_punch:
        return None
    unit = dimensionless_problem(problem)[1][kind]
    return {"value": result.value / unit, "u_num": result.u_num / unit, "unit": QUANTITIES[quantity].unit}


def value_in_si(problem: ProblemFile, model: Model, quantity: str) -> Result:
    """Return a quantity in SI.

    Raises
    ------
    NotApplicable, ComputationFailed
        As the model.
    """
    if model.name not in REFERENCES and problem.has_other_solid_alone:
        return _with_equivalent_solid(problem, model, quantity)
    _refuse(problem, model, quantity)
    if model.name == "fem" and quantity != "critical_tabor_number":
        # Imported here: the other models do not need the finite elements.
        from comparisons.problem_file.finite_elements import value_of

        return value_of(problem, quantity)
    posed, units = dimensionless_problem(problem)
    domain = declared_domain(model)
    if domain is not None and not domain.contains(quantity, {"n": posed.n, "k": posed.k, "mu": posed.mu}):
        raise NotApplicable(domain.refusal(quantity))
    result = model.evaluate(posed, quantity)
    kind = QUANTITIES[quantity].scale
    if kind == "number":
        return result
    return dataclasses.replace(result, value=result.value * units[kind], u_num=result.u_num * units[kind])


def _with_equivalent_solid(problem: ProblemFile, model: Model, quantity: str) -> Result:
    """Evaluate a model that knows n, k and mu alone with the power law that stands for the solid of a problem."""
    # Imported here: other problems do not need the spectrum of the elastic energy.
    from comparisons.problem_file.equivalent_solid import equivalent_solids

    with_law, coarser = equivalent_solids(problem)
    result, other = (value_in_si(one, model, quantity) for one in (with_law, coarser))
    return dataclasses.replace(
        result,
        u_num=result.u_num + abs(result.value - other.value),
        reason=f"with the equivalent power law of the {problem.solid.kind} solid, k = {with_law.solid['k']:.4f}",
    )


def _refuse(problem: ProblemFile, model: Model, quantity: str) -> None:
    """Raise `NotApplicable` where a model does not take the parts of a problem."""
    if problem.is_of_the_paper:
        return
    if model.name not in SOLVERS:
        raise NotApplicable(
            f"{model.name} takes a power-law or homogeneous solid, a sphere, cone or power-law punch and the 9-3 law; "
            f"this problem has a {problem.solid.kind} solid, a {problem.punch.kind} punch and a {problem.law.kind} law"
        )
    if quantity == "critical_tabor_number":
        raise NotApplicable("the critical Tabor number is that of a power-law solid and punch with the 9-3 law")


def points_of(problem: ProblemFile, model: Model, quantity: str) -> Points:
    """Return a curve or a field in SI: displacement or radius in m; load in N, pressure in Pa, gap in m.

    Raises
    ------
    NotApplicable, ComputationFailed
        As the model.
    """
    _refuse(problem, model, quantity)
    posed, units = dimensionless_problem(problem)
    if model.name == "fem":
        return _of_elements(problem, quantity, FARTHEST_GAP * units["gap"])
    found = CURVES[quantity].evaluate(model, posed)
    x, y = (units[kind] for kind in _AXES[quantity])
    columns = {name: values * units.get(_COLUMNS.get(name, ""), 1.0) for name, values in found.columns.items()}
    return Points([a * x for a in found.x], [b * y for b in found.y], found.u_distance, columns)


def _of_elements(problem: ProblemFile, quantity: str, farthest_gap: float) -> Points:
    from comparisons.problem_file.finite_elements import curve_of, field_of

    fields: dict[str, Callable[[], Points]] = {
        "force_curve": lambda: curve_of(problem),
        "pull_off_pressure": lambda: field_of(problem, "pressure", farthest_gap),
        "pull_off_gap": lambda: field_of(problem, "gap", farthest_gap),
    }
    return fields[quantity]()


def units_of(quantity: str) -> tuple[str, str]:
    """Return the units in SI of the two axes of a curve.

    Examples
    --------
    >>> units_of("force_curve")
    ('m', 'N')
    """
    x, y = _AXES[quantity]
    return SI_UNITS[x], SI_UNITS[y]
