"""Fit of a contact to a measured force-displacement curve: values of a problem file, with uncertainties.

Least squares of the load (by lmfit) over the position that the machine prescribes, and of the positions of both jumps.
The noise is that of the residuals; a value of the file with an uncertainty is a datum like those of the record, so that
the uncertainty of a result contains it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.description.budget import budget
from comparisons.description.shared_errors import Json
from comparisons.fitting.curves import Curves
from comparisons.fitting.equilibria import distance_of_jkr, is_limit
from comparisons.fitting.machine import Observations
from comparisons.fitting.parameters import Key, changed, free_keys, uncertain_keys
from comparisons.fitting.reading import Sensitivity, read_records
from comparisons.fitting.record import Record, checked
from comparisons.fitting.search import DESCRIBED, Search, dotted, numbers_of, plain
from comparisons.model import Array
from comparisons.problem import Problem

#: A value is called undetermined where its standard deviation is a larger share of it.
_UNDETERMINED = 0.5

#: Below this Tabor number a modulus by JKR is wrong by more than the error of its pull-off force (study `fit_by_jkr`).
_LEAST_MU = 1.0

#: A contact is called wide where its radius is a larger share of that of the sphere: the force of a ball is 1 % less.
_WIDE = 0.3

#: Two values are called coupled where their correlation is larger.
_COUPLED = 0.99


@dataclass(frozen=True)
class FittedValue:
    """A fitted value in SI.

    Attributes
    ----------
    value, u : float
        With its standard uncertainty by noise, uncertain values of the file and error of the model; infinite where the
        curve does not determine it.
    unit : str
    determined : bool
    shifts : dict of str to float or None
        What the error of the model, and that of its assumptions, would change; None where it is unknown.
    """

    value: float
    u: float
    unit: str
    determined: bool
    shifts: dict[str, float | None]


@dataclass(frozen=True)
class Fit:
    """The fit of one curve.

    Attributes
    ----------
    record : Record
    model : str
        "fscm" or "jkr".
    problem : Problem
        With the fitted values.
    parameters : dict of str to FittedValue
        By the keys of the problem file.
    zeros : dict of str to tuple of float
        Displacement and load of the record where both are zero in the problem, and the drift of that displacement
        from the begin to the end of the record, each with its standard deviation, in m and N.
    residual : float
        Root mean square of the residuals of the load in N.
    noise : float
        Noise of the record as its neighbouring points show it, in N.
    remarks : list of str
        What the curve does not determine.
    position, load : ndarray
        The fitted load at the points of the record, whose positions have the fitted zeros.
    assumptions : dict, optional
        Errors of the pull-off force by the assumptions, as of `comparisons.description.budget.budget`; None where the
        curve does not determine the contact.

    Examples
    --------
    >>> FittedValue(0.05, 1e-3, "J/m^2", True, {}).u
    0.001
    """

    record: Record
    model: str
    problem: Problem
    parameters: dict[str, FittedValue]
    zeros: dict[str, tuple[float, float]]
    residual: float
    noise: float
    remarks: list[str]
    position: Array
    load: Array
    assumptions: Json | None = None

    def as_json(self) -> dict[str, Any]:
        """Return the fit ready for JSON."""

        def finite(number: float) -> float | None:
            return number if math.isfinite(number) else None

        return {
            "curve": self.record.name,
            "model": self.model,
            "mu": self.problem.posed.mu if self.problem.is_of_the_paper("solid", "punch") else None,
            "parameters": {
                name: {"value": row.value, "u": finite(row.u), "unit": row.unit, "determined": row.determined}
                | {f"shift_by_{cause}": shift for cause, shift in row.shifts.items()}
                for name, row in self.parameters.items()
            },
            "zeros": {name: {"value": value, "u": finite(u)} for name, (value, u) in self.zeros.items()},
            "residual": self.residual,
            "noise": self.noise,
            "points": len(self.record.load),
            "remarks": self.remarks,
            "assumptions": self.assumptions,
        }


def fit(
    curve: str | Path,
    problem: Problem,
    free: Sequence[str],
    *,
    model: str | None = None,
    branch: str = "both",
    stiffness: float | None = None,
    sensitivity: float | Sensitivity | None = None,
) -> list[Fit]:
    """Fit values of a problem to the curves of a file.

    Parameters
    ----------
    curve : str or path
        See `comparisons.fitting.reading.read_records`.
    problem : Problem
        In physical units; its values are where the fit starts.
    free : sequence of str
        Keys that are fitted, as "solid.E0".
    model : str, optional
        "fscm" or "jkr"; by default JKR where its pull-off force is within 2e-4 of that of the FSCM, else the FSCM.
    branch : str
        "approach", "retreat" or "both".
    stiffness : float, optional
        Of the cantilever in N/m.
    sensitivity : float or comparisons.fitting.reading.Sensitivity, optional
        Its deflection for a signal, a number in m/V.

    Returns
    -------
    list of Fit
        One for each curve of the file.

    Raises
    ------
    ValueError
        One sentence, if the file or a key cannot be used.
    comparisons.model.ComputationFailed
        If no values describe the curve.
    """
    keys = checked_keys(problem, free, model)
    records = read_records(Path(curve), stiffness, sensitivity)
    return [fit_record(record, problem, keys, model, branch) for record in records]


def checked_keys(problem: Problem, free: Sequence[str], model: str | None) -> list[Key]:
    """Return the free keys of a fit; `ValueError` if there is no such key, or the model cannot describe the problem."""
    if "solid.friction" in problem.surface:
        raise ValueError('friction = "bonded" cannot be fitted: the models of a fit, fscm and jkr, have no friction')
    if model == "jkr" and not problem.is_of_the_paper("solid", "punch", "law"):
        raise ValueError("--model jkr takes power-law solids and punches under the 9-3 law")
    return free_keys(problem, free)


def fit_record(
    record: Record, problem: Problem, free: Sequence[Key], model: str | None = None, branch: str = "both"
) -> Fit:
    """Fit values of a problem to one curve, as `fit`."""
    if branch != "both":
        record = checked(record.only(branch), f"the {branch} of {record.name}")
    search = Search(Observations.of(record), problem, (*free, *uncertain_keys(problem, free)))
    has_limit = problem.is_of_the_paper("solid", "punch", "law")
    starts = search.starts() if has_limit else [{}]
    if model is None:
        at_start = changed(problem, search.keys, {key.name: starts[0].get(key.name, 0.0) for key in search.keys})
        model = "jkr" if has_limit and is_limit(at_start) else "fscm"
    # The paths of a fit in n or k have no Tabor numbers in common.
    exact = not has_limit or any(key.name in ("solid.k", "punch.n") for key in search.keys)
    result, curves = search.best(Curves(model), starts, model == "fscm" and exact)
    return _described(search, result, curves, len(free))


def _described(search: Search, result: Any, curves: Curves, count: int) -> Fit:
    """Return values, uncertainties and the budget."""
    values = numbers_of(result.params)
    problem = changed(search.problem, search.keys, values)
    machine = search.machine(values, curves)
    position, zero = search.zeros(values)
    load = machine.load(position, search.observed)
    errors = (load + zero - search.observed.record.load)[search.observed.used]
    deviations = {
        dotted(name): float(parameter.stderr) if parameter.stderr else math.inf
        for name, parameter in result.params.items()
    }
    free = [(key, key.value(values[key.name])) for key in search.keys[:count]]
    by_noise = {key.name: key.uncertainty(value, deviations[key.name]) for key, value in free}
    is_determined = all(by_noise[key.name] <= _UNDETERMINED * abs(value) for key, value in free)
    # The contact that a curve does not determine has no error.
    assumed = budget(problem, curves.model) if is_determined else None
    shifts = _shifts(search, result, curves, problem, assumed)
    parameters = {}
    for key, value in free:
        of_key = {
            cause: None if changed_values is None else key.value(changed_values[key.name]) - value
            for cause, changed_values in shifts.items()
        }
        # The error of the model is a bound of this program, that of the assumptions is one of the physics.
        u = math.hypot(by_noise[key.name], of_key["model"] or 0.0)
        determined = u <= _UNDETERMINED * abs(value)
        parameters[key.name] = FittedValue(value, u, key.unit, determined, of_key)
    scale = {"displacement": search.range, "load": search.load_range, "drift": search.range}
    zeros = {name: (values[name] * size, deviations[name] * size) for name, size in scale.items() if name in values}
    return Fit(
        record=search.observed.record,
        model=curves.model,
        problem=problem,
        parameters=parameters,
        zeros=zeros,
        residual=float(np.sqrt(np.mean(errors**2))),
        noise=search.observed.record.noise,
        remarks=[
            *search.observed.record.remarks,
            *_remarks(parameters, result),
            *_stiff(curves.model, problem),
            *_deep(problem, position),
        ],
        position=position,
        load=load,
        assumptions=assumed,
    )


def _shifts(
    search: Search, result: Any, curves: Curves, problem: Problem, assumed: Json | None
) -> dict[str, dict[str, float] | None]:
    """What the errors of the model and of the assumptions in the load change, as fitted numbers."""
    errors: dict[str, float | None] = {"model": 0.0, "assumptions": None}
    if curves.model == "jkr":
        distance = distance_of_jkr(problem)
        errors["model"] = distance if math.isfinite(distance) else None
    if assumed is not None:
        errors["assumptions"] = assumed["total"]["error"]
    shifts: dict[str, dict[str, float] | None] = dict.fromkeys(errors)
    for cause, error in errors.items():
        if error is not None:
            shifts[cause] = search.scaled(curves, result, 1.0 / (1.0 + error)) if error else numbers_of(result.params)
    return shifts


def _remarks(parameters: dict[str, FittedValue], result: Any) -> list[str]:
    remarks = [f"the curve does not determine {name}" for name, row in parameters.items() if not row.determined]
    if result.redchi >= DESCRIBED:
        remarks.append(
            "the model does not describe the curve with these values: begin nearer to the true ones, and see that "
            "tension is negative"
        )
    names = list(parameters)
    for i, name in enumerate(names):
        correlations = result.params[plain(name)].correl or {}
        for other in names[i + 1 :]:
            if abs(correlations.get(plain(other), 0.0)) > _COUPLED:
                remarks.append(f"{name} and {other} are coupled: only their combination is determined well")
    return remarks


def _stiff(model: str, problem: Problem) -> list[str]:
    """Say where JKR is taken for a contact that is too stiff for it."""
    if model == "fscm" or problem.posed.mu >= _LEAST_MU:
        return []
    return [f"JKR does not hold at a Tabor number of {problem.posed.mu:.2g}: the error of the modulus is above its u"]


def _deep(problem: Problem, position: Array) -> list[str]:
    """Say where a sphere is pressed in so deep that its paraboloid is another punch."""
    if problem.punch.kind not in ("sphere", "ball"):
        return []
    share = math.sqrt(max(float(position.max()), 0.0) / problem.punch["R"])
    if share < _WIDE:
        return []
    return [
        f"at the largest load the contact is about {share:.2g} R wide: the error of the assumptions there is unknown"
    ]
