"""Fit of a contact to a measured force-displacement curve: values of a problem file, with uncertainties.

Least squares of the load over the position that the machine prescribes, and of the positions of both jumps.
The noise is that of the residuals; a value of the file with an uncertainty is a datum like those of the record, so that
the uncertainty of a result contains it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.description.budget import budget
from comparisons.description.shared_errors import Json
from comparisons.fitting.baseline import BaselineName
from comparisons.fitting.curves import Curves
from comparisons.fitting.equilibria import distance_of_hertz, distance_of_jkr, is_limit, is_without_adhesion
from comparisons.fitting.evidence import (
    Jump,
    branches_remark,
    cause,
    jump_in_remark,
    jumps_apart,
    of_branches,
    runs_remark,
)
from comparisons.fitting.least_squares import Minimum
from comparisons.fitting.machine import Observations
from comparisons.fitting.parameters import Key, changed, free_keys, uncertain_keys
from comparisons.fitting.reading import Sensitivity, read_records
from comparisons.fitting.record import Record, checked
from comparisons.fitting.search import Search
from comparisons.model import Array
from comparisons.problem import Problem
from comparisons.problem.units import si_text

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
    start : float or None
        The value of the file.
    prior : float or None
        Its standard deviation by the file; None for a free value without one.
    """

    value: float
    u: float
    unit: str
    determined: bool
    shifts: dict[str, float | None]
    start: float | None = None
    prior: float | None = None


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
        All that moved, by the keys of the problem file: the free ones, and those to which it gives an uncertainty.
    zeros : dict of str to tuple of float
        Displacement and load of the record where both are zero in the problem, and the drift of that displacement
        from the begin to the end of the record, in m and N; where they were fitted, slope of the load without contact
        in N/m, and its drift in N.  Each has its standard deviation.
    residual : float
        Root mean square of the residuals of the load in N.
    noise : float
        Noise of the record as its neighbouring points show it, in N.
    remarks : list of str
        What the curve does not determine.
    position, load : ndarray
        The fitted load at the points of the record, whose positions have the fitted zeros.
    baseline : ndarray
        The load without contact there.
    by_branch : dict of str to dict
        Values of the free keys by "approach" and "retreat" alone, with their standard deviations.
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
    baseline: Array = field(default_factory=lambda: np.zeros(()))
    by_branch: dict[str, dict[str, tuple[float, float]]] = field(default_factory=dict)
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
                | {"start": row.start, "prior": row.prior}
                | {f"shift_by_{cause}": shift for cause, shift in row.shifts.items()}
                for name, row in self.parameters.items()
            },
            "zeros": {name: {"value": value, "u": finite(u)} for name, (value, u) in self.zeros.items()},
            "residual": self.residual,
            "noise": self.noise,
            "points": len(self.record.load),
            "by_branch": {
                branch: {name: {"value": value, "u": finite(u)} for name, (value, u) in of_branch.items()}
                for branch, of_branch in self.by_branch.items()
            },
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
    baseline: BaselineName | None = None,
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
    baseline : str, optional
        Load without contact: "constant" or "linear" in position and time; by default linear where the record shows it.
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
    return [fit_record(record, problem, keys, model, branch, baseline) for record in records]


def checked_keys(problem: Problem, free: Sequence[str], model: str | None) -> list[Key]:
    """Return the free keys of a fit; `ValueError` if there is no such key, or the model cannot describe the problem."""
    if "solid.friction" in problem.surface:
        raise ValueError('friction = "bonded" cannot be fitted: the models of a fit, fscm and jkr, have no friction')
    if model == "jkr" and not problem.is_of_the_paper("solid", "punch", "law"):
        raise ValueError("--model jkr takes power-law solids and punches under the 9-3 law")
    return free_keys(problem, free)


def fit_record(
    record: Record,
    problem: Problem,
    free: Sequence[Key],
    model: str | None = None,
    branch: str = "both",
    baseline: BaselineName | None = None,
) -> Fit:
    """Fit values of a problem to one curve, as `fit`."""
    if branch != "both":
        record = checked(record.only(branch), f"the {branch} of {record.name}")
    keys = (*free, *uncertain_keys(problem, free))
    search = Search(Observations.of(record), problem, keys, baseline)
    has_limit = problem.is_of_the_paper("solid", "punch", "law")
    starts = search.starts() if has_limit else [{}]
    if model is None:
        at_start = changed(problem, search.keys, {key.name: starts[0].get(key.name, 0.0) for key in search.keys})
        model = "jkr" if has_limit and is_limit(at_start) else "fscm"
    # The paths of a fit in n or k have no Tabor numbers in common.
    is_costly = model == "fscm" and (not has_limit or any(key.name in ("solid.k", "punch.n") for key in search.keys))
    result, curves = search.best(Curves(model), starts, is_costly)
    # Paths of its own take seconds each.
    if baseline is None and not is_costly and search.is_level(result):
        level = Search(search.observed, problem, keys, "constant")
        start = {name: number for name, number in result.numbers.items() if name not in ("tilt", "load_drift")}
        again, its_curves = level.best(Curves(model), [start], is_costly)
        if not level.baseline.have_slope(level.errors(again.numbers, its_curves)):
            baseline, search, result, curves = "constant", level, again, its_curves
    jumps = jumps_apart(search, result, curves)
    if jumps:
        kept = {True, False} - {jump.approach for jump in jumps}
        search = Search(search.observed, problem, keys, baseline, tuple(kept))
        result, curves = search.best(Curves(model), [result.numbers], is_costly)
    by_branch = {} if is_costly else _by_branch(search, result, curves)

    def without_jump_in() -> Minimum:
        alone = Search(search.observed, problem, keys, baseline, (False,))
        return alone.best(Curves(curves.model), [result.numbers], is_costly)[0]

    described = _described(search, result, curves, len(free), jumps, by_branch)
    is_determined = all(row.determined for row in described.parameters.values())
    if is_determined and (remark := jump_in_remark(search, result, without_jump_in)):
        described.remarks.append(remark)
    return described


def _by_branch(search: Search, result: Minimum, curves: Curves) -> dict[str, dict[str, tuple[float, float]]]:
    """Values by each branch alone, from those by both; none where the record has one."""
    if not search.baseline.has_both:
        return {}

    def fitted(branch: str) -> tuple[Minimum, Search]:
        alone, start = search.of_branch(branch, result)
        return alone.best(curves, [start], False)[0], alone

    return of_branches({branch: partial(fitted, branch) for branch in ("approach", "retreat")})


def _described(
    search: Search,
    result: Minimum,
    curves: Curves,
    count: int,
    jumps: Sequence[Jump],
    by_branch: dict[str, dict[str, tuple[float, float]]],
) -> Fit:
    """Return values, uncertainties and the budget."""
    values, deviations = result.numbers, result.deviations
    problem = changed(search.problem, search.keys, values)
    position, baseline = search.zeros(values)
    load = search.machine(values, curves).load(position, search.observed)
    used, record = search.observed.used, search.observed.record
    errors = search.errors(values, curves)
    moved = [(key, key.value(values[key.name])) for key in search.keys]
    by_noise = {key.name: key.uncertainty(value, deviations[key.name]) for key, value in moved}
    is_determined = all(by_noise[key.name] <= _UNDETERMINED * abs(value) for key, value in moved[:count])
    # The contact that a curve does not determine has no error.
    assumed = budget(problem, curves.model) if is_determined else None
    shifts = _shifts(search, result, curves, problem, assumed)
    parameters = {}
    for key, value in moved:
        of_key = {
            by: None if changed_values is None else key.value(changed_values[key.name]) - value
            for by, changed_values in shifts.items()
        }
        # The error of the model is a bound of this program, that of the assumptions is one of the physics.
        u = math.hypot(by_noise[key.name], of_key["model"] or 0.0)
        determined = u <= _UNDETERMINED * abs(value)
        parameters[key.name] = FittedValue(value, u, key.unit, determined, of_key, key.start, _prior(key))
    load_range = search.load_range
    scale = {"displacement": search.range, "drift": search.range}
    scale |= {"load": load_range, "tilt": load_range / search.range, "load_drift": load_range}
    zeros = {name: (values[name] * size, deviations[name] * size) for name, size in scale.items() if name in values}
    residual = float(np.sqrt(np.mean(errors[used] ** 2)))
    deep = _deep(problem, position)
    remarks = [
        *record.remarks,
        *_baseline_remark(search, values, errors),
        *(jump.remark() for jump in jumps),
        *filter(None, [branches_remark(by_branch, {key.name: key.unit for key in search.keys})]),
        *filter(None, [runs_remark(errors[used], record.approach[used], search.noise)]),
    ]
    described = cause(result, residual / search.noise, bool(deep), remarks, _held(search))
    return Fit(
        record=record,
        model=curves.model,
        problem=problem,
        parameters=parameters,
        zeros=zeros,
        residual=residual,
        noise=record.noise,
        remarks=[
            *_remarks(parameters, result),
            *remarks,
            *filter(None, [described]),
            *_stiff(curves.model, problem),
            *deep,
        ],
        position=position,
        load=load,
        baseline=baseline,
        by_branch=by_branch,
        assumptions=assumed,
    )


def _held(search: Search) -> list[str]:
    """Work of adhesion and modulus of the file that are not fitted."""
    names = {key.name for key in search.keys}
    usual = [("law", "work_of_adhesion"), *(("solid", name) for name in ("E", "E0"))]
    problem: Any = search.problem
    present = [f"{part}.{name}" for part, name in usual if name in getattr(problem, part).values]
    return [name for name in present if name not in names]


def _prior(key: Key) -> float | None:
    """The standard deviation of a value by the file, where it states one."""
    return None if key.deviation is None else key.uncertainty(key.start, key.deviation)


def _baseline_remark(search: Search, values: dict[str, float], errors: Array) -> list[str]:
    if "tilt" not in values:
        sloped = "the load without contact changes with the position: fit with --baseline linear"
        # Attraction of long range changes the load, too, but the model has it.
        return [sloped] if search.baseline.have_slope(errors) else []
    change = float(f"{values['tilt'] * search.load_range:.2g}")
    return [f"the load without contact is linear: it changes by {si_text(change, 0.0, 'N')} over the travel"]


def _shifts(
    search: Search, result: Minimum, curves: Curves, problem: Problem, assumed: Json | None
) -> dict[str, dict[str, float] | None]:
    """What the errors of the model and of the assumptions in the load change, as fitted numbers."""
    errors: dict[str, float | None] = {"model": 0.0, "assumptions": None}
    largest = search.largest(result.numbers)
    if is_without_adhesion(problem, largest):
        errors["model"] = distance_of_hertz(problem, largest)
    elif curves.model == "jkr":
        distance = distance_of_jkr(problem)
        errors["model"] = distance if math.isfinite(distance) else None
    if assumed is not None:
        errors["assumptions"] = assumed["total"]["error"]
    shifts: dict[str, dict[str, float] | None] = dict.fromkeys(errors)
    for name, error in errors.items():
        if error is not None:
            shifts[name] = search.scaled(curves, result, 1.0 / (1.0 + error)) if error else result.numbers
    return shifts


def _remarks(parameters: dict[str, FittedValue], result: Minimum) -> list[str]:
    remarks = [f"the curve does not determine {name}" for name, row in parameters.items() if not row.determined]
    names = list(parameters)
    for i, name in enumerate(names):
        remarks += [
            f"{name} and {other} are coupled: only their combination is determined well"
            for other in names[i + 1 :]
            if abs(result.correlation(name, other)) > _COUPLED
        ]
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
