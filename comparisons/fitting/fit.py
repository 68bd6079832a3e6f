"""Fit of a contact to a measured force-displacement curve: values of a problem file, with uncertainties.

Least squares of the load (by lmfit) over the position that the machine prescribes, and of the positions of both jumps.
The noise is that of the residuals; a value of the file with an uncertainty is a datum like those of the record, so that
the uncertainty of a result contains it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lmfit
import numpy as np
from numpy.typing import NDArray

from comparisons.description.assumptions import assumptions
from comparisons.fitting.equilibria import Equilibria, by_fscm, by_jkr
from comparisons.fitting.machine import Machine, Observations
from comparisons.fitting.parameters import Key, changed, free_keys, uncertain_keys
from comparisons.fitting.record import Record, read_records
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.numerics.bounds import relative_difference
from comparisons.problem import Problem
from comparisons.runs.tasks import evaluate

__all__ = ["Fit", "FittedValue", "fit", "fit_record"]

Array = NDArray[np.float64]

#: The JKR limit stands for the FSCM where its pull-off force is so near; its distance is in the budget.
_LIMIT = 2e-4

#: Tabor numbers at which that distance is computed; beyond, it falls at least as 1/mu (measured for n from 1 to 10, k
#: from 0 to 0.8: as mu^-1.29 at the slowest, n = 5, k = 0; two numbers, because it may change its sign near one).
_KNOWN = (10.0, 20.0)

#: Start values of the JKR limit, as shares of those of the file: a file may be wrong by some powers of ten.
_SHARES = (0.1, 10.0, 0.01, 100.0)

#: Standard deviation of the logarithm of a free value about that of the file: it moves no value that a curve
#: determines, and holds the others within a few powers of ten.
_VAGUE = 5.0

#: And Tabor numbers at which it begins where that limit does not describe the curve.
_STIFF = (0.5, 0.1, 3.0, 0.02)

#: The key on which every pull-off force depends.
_ADHESION = "law.work_of_adhesion"

#: Errors of the equilibria between Tabor numbers of the grid, as a share of the pull-off force (measured worst 8e-4, at
#: a fold; a tenth of that elsewhere): a record without noise does not ask for more.
_MODEL_ERROR = 3e-4

#: A model describes a record where its residuals are at most twice the noise.
_DESCRIBED = 4.0

#: Steps of derivatives, of numbers of keys and of zeros in units of the ranges of load and position: a search with the
#: first one crosses what folds at the points of a record make rough, one with the second goes on from there, or finds
#: what the first one steps over.
_STEPS = (1e-2, 1e-3)

#: Residual of values for which the model has no path: larger than any of a path.
_REFUSED = 1e9

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
        }


def fit(
    curve: str | Path,
    problem: Problem,
    free: Sequence[str],
    *,
    model: str | None = None,
    branch: str = "both",
    stiffness: float | None = None,
    sensitivity: float | None = None,
) -> list[Fit]:
    """Fit values of a problem to the curves of a file.

    Parameters
    ----------
    curve : str or path
        See `comparisons.fitting.record.read_records`.
    problem : Problem
        In physical units; its values are where the fit starts.
    free : sequence of str
        Keys that are fitted, as "solid.E0".
    model : str, optional
        "fscm" or "jkr"; by default JKR where its pull-off force is within 2e-4 of that of the FSCM, else the FSCM.
    branch : str
        "approach", "retreat" or "both".
    stiffness, sensitivity : float, optional
        Of the cantilever, in N/m and m/V.

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
    keys = free_keys(problem, free)
    records = read_records(Path(curve), stiffness, sensitivity)
    return [fit_record(record if branch == "both" else record.only(branch), problem, keys, model) for record in records]


def fit_record(record: Record, problem: Problem, free: Sequence[Key], model: str | None = None) -> Fit:
    """Fit values of a problem to one curve, as `fit`."""
    search = _Search(Observations.of(record), problem, (*free, *uncertain_keys(problem, free)))
    has_limit = problem.is_of_the_paper("solid", "punch", "law")
    if model == "jkr" and not has_limit:
        raise ValueError("--model jkr takes power-law solids and punches under the 9-3 law")
    starts = search.starts() if has_limit else [{}]
    if model is None:
        at_start = changed(problem, search.keys, {key.name: starts[0].get(key.name, 0.0) for key in search.keys})
        model = "jkr" if has_limit and _distance_of_jkr(at_start) < _LIMIT else "fscm"
    return _described(search, search.best(model, starts), model, len(free))


def _distance_of_jkr(problem: Problem) -> float:
    """Bound on the relative distance of the pull-off forces of JKR and the FSCM; infinite where none is known."""
    posed = problem.posed
    if posed.mu < _KNOWN[-1]:
        nearer = [problem]
    else:
        nearer = [Problem.dimensionless(n=posed.n, k=posed.k, mu=mu) for mu in _KNOWN]
    distances = []
    for case in nearer:
        limit, force = (evaluate(model, "pull_off_force", case).value for model in ("jkr", "fscm"))
        if limit is None or force is None:
            return math.inf
        share = 1.0 if case is problem else case.posed.mu / posed.mu
        distances.append(share * abs(relative_difference(limit, force)))
    return max(distances)


class _Search:
    """Least squares for one record."""

    def __init__(self, observed: Observations, problem: Problem, keys: Sequence[Key]) -> None:
        self.observed, self.problem, self.keys = observed, problem, tuple(keys)
        record = observed.record
        depth = float(np.median(record.load) - record.load.min())
        self.noise = math.hypot(record.noise, _MODEL_ERROR * depth)
        self._position = record.position
        self._time = np.linspace(0.0, 1.0, len(record.load))
        self._range = float(np.ptp(self._position))
        self._load_range = float(np.ptp(record.load))
        self._has_both = bool(record.approach.any() and not record.approach.all())
        # The paths of a fit in n or k have no Tabor numbers in common.
        self._exact = any(key.name in ("solid.k", "punch.n") for key in keys)

    def starts(self) -> list[dict[str, float]]:
        """Return where the search may begin: at the best fit of the JKR limit, which takes no time.

        Stiff solids are not near that limit.  Where it does not describe the record, the search begins at the pull-off
        force of the record and several Tabor numbers.
        """
        free = [key.name for key in self.keys if key.logarithmic and key.prior is None]
        for shift in ({}, *({name: math.log(share)} for share in _SHARES for name in free)):
            try:
                result = _best(self._minimised(by_jkr, shift, step) for step in _STEPS)
            except (NotApplicable, ComputationFailed, ValueError):
                continue
            if result.redchi < _DESCRIBED:
                return [self._values(result)]
        return [self._of_pull_off(mu) for mu in _STIFF]

    def _of_pull_off(self, mu: float) -> dict[str, float]:
        """Return numbers with the pull-off force of the record and, if a modulus is free, a Tabor number."""
        numbers = dict.fromkeys((key.name for key in self.keys), 0.0)
        loads = self.observed.record.load
        force = float(np.median(loads[self._unloaded()]) - loads.min())
        if _ADHESION in numbers:
            stated = evaluate("jkr", "pull_off_force", self.problem).value
            numbers[_ADHESION] = math.log(force / stated) if stated and force > 0.0 else 0.0
        moduli = [key.name for key in self.keys if key.section == "solid" and key.logarithmic]
        if moduli:
            logs = []
            for number in (0.0, 1.0):
                numbers |= dict.fromkeys(moduli, number)
                logs.append(math.log(changed(self.problem, self.keys, numbers).posed.mu))
            # The Tabor number is a power of the modulus.
            numbers |= dict.fromkeys(moduli, (math.log(mu) - logs[0]) / (logs[1] - logs[0]))
        return numbers

    def best(self, model: str, starts: Sequence[dict[str, float]]) -> Any:
        """Return the best result of lmfit of a model from several starts, by `by`."""
        results, refusal = [], ComputationFailed("no values of the free keys describe the curve")
        for start in starts:
            try:
                results.append(self.by(model, start))
            except ComputationFailed as error:
                refusal = error
            if results and results[-1].redchi < _DESCRIBED:
                break
        if not results:
            raise refusal
        return _best(results)

    def by(self, model: str, start: dict[str, float]) -> Any:
        """Return the result of lmfit of a model, from given numbers."""
        equilibria = by_jkr if model == "jkr" else (lambda problem, largest: by_fscm(problem, largest, self._exact))
        coarse, fine = _STEPS
        starts = (start, self._values(self._minimised(equilibria, start, coarse)))
        return _best(self._minimised(equilibria, each, fine) for each in starts)

    def scaled(self, model: str, result: Any, factor: float) -> Any:
        """Return the result with loads of the model that are larger by a factor."""
        self._factor = factor
        try:
            return self.by(model, self._values(result))
        finally:
            self._factor = 1.0

    _factor = 1.0

    def _values(self, result: Any) -> dict[str, float]:
        return {_dotted(name): float(parameter.value) for name, parameter in result.params.items()}

    def machine(self, values: dict[str, float], equilibria: Callable[[Problem, float], Equilibria]) -> Machine:
        """Return the stable sections of the problem of fitted numbers."""
        problem = changed(self.problem, self.keys, values)
        largest = float(self.observed.record.load.max()) - values.get("load", 0.0) * self._load_range
        computed = equilibria(problem, 1.2 * largest)
        computed = Equilibria(computed.displacement, computed.load * self._factor)
        return Machine.of(computed, self.observed.record.stiffness)

    def zeros(self, values: dict[str, float]) -> tuple[Array, float]:
        """Return the positions of the record from their zero, and the zero of the load."""
        shift = values["displacement"] + values.get("drift", 0.0) * (self._time - 0.5)
        load = values["load"] * self._load_range
        compliance = load / self.observed.record.stiffness
        return self._position - compliance - shift * self._range, load

    def _minimised(
        self, equilibria: Callable[[Problem, float], Equilibria], start: dict[str, float], step: float
    ) -> Any:
        parameters = lmfit.Parameters()
        for key in self.keys:
            low, high = (key.number(limit) for limit in key.limits)
            value = start.get(key.name, 0.0)
            room = {} if math.isinf(low) and math.isinf(high) else {"min": low, "max": high}
            parameters.add(_plain(key.name), value=value, **room)
        loads, far = self.observed.record.load, self._unloaded()
        parameters.add("load", value=start.get("load", float(np.median(loads[far])) / self._load_range))
        if "displacement" in start:
            displacement = start["displacement"]
        else:
            values = {_dotted(name): float(parameter.value) for name, parameter in parameters.items()}
            machine = self.machine(values, equilibria)
            displacement = self._aligned(machine, values) / self._range
        parameters.add("displacement", value=displacement)
        if self._has_both:
            parameters.add("drift", value=start.get("drift", 0.0))

        worst = np.full(int(self.observed.used.sum()) + len(self.keys) + 2, _REFUSED)

        def residuals(parameters: lmfit.Parameters) -> Array:
            values = {_dotted(name): float(parameter.value) for name, parameter in parameters.items()}
            try:
                errors = self._residuals(values, equilibria)
            except (ComputationFailed, NotApplicable, ValueError):
                return worst
            return np.concatenate([errors, np.zeros(len(worst) - len(errors))])

        def jacobian(parameters: lmfit.Parameters) -> Array:
            return _jacobian(residuals, parameters, step)

        result = lmfit.minimize(residuals, parameters, method="leastsq", Dfun=jacobian, max_nfev=40 * len(parameters))
        if not result.chisqr < _REFUSED**2:
            raise ComputationFailed("no values of the free keys describe the curve")
        return result

    def _unloaded(self) -> NDArray[np.bool_]:
        """Points of the tenth that is farthest from the solid."""
        return np.asarray(self._position <= np.quantile(self._position, 0.1))

    def _aligned(self, machine: Machine, values: dict[str, float]) -> float:
        """The zero of the position at which the record has the load of the model: the best of those along it."""
        shifts = self._position[:, None] - machine.contact[0][None, :: max(machine.contact.shape[1] // 40, 1)]
        tried = np.linspace(shifts.min(), shifts.max(), 400)
        loads = self.observed.record.load - values["load"] * self._load_range
        thinned = slice(None, None, max(len(loads) // 400, 1))
        errors = [
            float(np.sum((machine.load(self._position - shift, self.observed) - loads)[thinned] ** 2))
            for shift in tried
        ]
        return float(tried[int(np.argmin(errors))])

    def _residuals(self, values: dict[str, float], equilibria: Callable[[Problem, float], Equilibria]) -> Array:
        machine = self.machine(values, equilibria)
        position, zero = self.zeros(values)
        observed = self.observed
        errors = (machine.load(position, observed) + zero - observed.record.load)[observed.used] / self.noise
        others = [values[key.name] / (key.deviation or _VAGUE) for key in self.keys if key.deviation or key.logarithmic]
        if machine.jumps:
            for approach, points in observed.jumps.items():
                if approach and equilibria is by_jkr:
                    continue  # Its surfaces do not attract before contact.
                fold = machine.far[0, -1] if approach else machine.contact[0, 0]
                around = position[list(points)]
                # The jump is evenly anywhere between both points.
                others.append((around.mean() - fold) / (np.ptp(around) / math.sqrt(12.0)))
        return np.concatenate([errors, others])


def _best(results: Iterable[Any]) -> Any:
    """Return the result of lmfit with the smallest sum of squares."""
    return min(results, key=lambda result: float(result.chisqr))


def _jacobian(residuals: Callable[[lmfit.Parameters], Array], parameters: lmfit.Parameters, step: float) -> Array:
    """Derivatives of residuals by differences over a step, shape (m, number of parameters).

    A step over the fold of a branch changes some residuals at once.  Only one of the steps to both sides goes over
    it, so the smaller of both derivatives is that of the residual.
    """
    central, columns = residuals(parameters), []
    for parameter in parameters.values():
        value, slopes = float(parameter.value), []
        for signed in (step, -step):
            parameter.value = value + signed
            # A value at its limit moves to one side alone.
            if moved := float(parameter.value) - value:
                slopes.append((residuals(parameters) - central) / moved)
        parameter.value = value
        columns.append(np.where(np.abs(slopes[0]) < np.abs(slopes[-1]), slopes[0], slopes[-1]))
    return np.column_stack(columns)


def _plain(name: str) -> str:
    return name.replace(".", "__")


def _dotted(name: str) -> str:
    return name.replace("__", ".")


def _described(search: _Search, result: Any, model: str, count: int) -> Fit:
    """Return values, uncertainties and the budget."""
    values = search._values(result)
    problem = changed(search.problem, search.keys, values)
    equilibria = by_jkr if model == "jkr" else (lambda problem, largest: by_fscm(problem, largest, search._exact))
    machine = search.machine(values, equilibria)
    position, zero = search.zeros(values)
    load = machine.load(position, search.observed)
    errors = (load + zero - search.observed.record.load)[search.observed.used]
    deviations = {
        _dotted(name): float(parameter.stderr) if parameter.stderr else math.inf
        for name, parameter in result.params.items()
    }
    is_determined = all(deviations[key.name] <= _UNDETERMINED for key in search.keys[:count])
    shifts = _shifts(search, result, model, problem, is_determined)
    parameters = {}
    for key in search.keys[:count]:
        value = key.value(values[key.name])
        of_key = {
            cause: None if changed_values is None else key.value(changed_values[key.name]) - value
            for cause, changed_values in shifts.items()
        }
        # The error of the model is a bound of this program, that of the assumptions is one of the physics.
        u = math.hypot(key.uncertainty(value, deviations[key.name]), of_key["model"] or 0.0)
        determined = u <= _UNDETERMINED * abs(value)
        parameters[key.name] = FittedValue(value, u, key.unit, determined, of_key)
    scale = {"displacement": search._range, "load": search._load_range, "drift": search._range}
    zeros = {name: (values[name] * size, deviations[name] * size) for name, size in scale.items() if name in values}
    return Fit(
        record=search.observed.record,
        model=model,
        problem=problem,
        parameters=parameters,
        zeros=zeros,
        residual=float(np.sqrt(np.mean(errors**2))),
        noise=search.observed.record.noise,
        remarks=[*_remarks(parameters, result), *_stiff(model, problem), *_deep(problem, position)],
        position=position,
        load=load,
    )


def _shifts(
    search: _Search, result: Any, model: str, problem: Problem, is_determined: bool
) -> dict[str, dict[str, float] | None]:
    """What the errors of the model and of the assumptions in the load change, as fitted numbers."""
    errors: dict[str, float | None] = {"model": 0.0, "assumptions": None}
    if model == "jkr":
        distance = _distance_of_jkr(problem)
        errors["model"] = distance if math.isfinite(distance) else None
    # The error of small strains is unknown for a graded solid, whose force takes long at large Tabor numbers, and for a
    # contact that the curve does not determine.
    if is_determined and (model == "fscm" or problem.posed.k == 0.0):
        assumed = assumptions(problem, evaluate("fscm", "pull_off_force", problem))
        errors["assumptions"] = assumed["total"]["error"] if assumed else None
    return {
        cause: None if error is None else search._values(search.scaled(model, result, 1.0 / (1.0 + error)))
        for cause, error in errors.items()
    }


def _remarks(parameters: dict[str, FittedValue], result: Any) -> list[str]:
    remarks = [f"the curve does not determine {name}" for name, row in parameters.items() if not row.determined]
    names = list(parameters)
    for i, name in enumerate(names):
        correlations = result.params[_plain(name)].correl or {}
        for other in names[i + 1 :]:
            if abs(correlations.get(_plain(other), 0.0)) > _COUPLED:
                remarks.append(f"{name} and {other} are coupled: only their combination is determined well")
    return remarks


def _stiff(model: str, problem: Problem) -> list[str]:
    """Say where JKR is taken for a contact that is too stiff for it."""
    if model == "fscm" or problem.posed.mu >= _LEAST_MU:
        return []
    return [f"JKR does not hold at a Tabor number of {problem.posed.mu:.2g}: its modulus is wrong by more than its u"]


def _deep(problem: Problem, position: Array) -> list[str]:
    """Say where a sphere is pressed in so deep that its paraboloid is another punch."""
    if problem.punch.kind not in ("sphere", "ball"):
        return []
    share = math.sqrt(max(float(position.max()), 0.0) / problem.punch["R"])
    if share < _WIDE:
        return []
    return [f"at the largest load the contact is about {share:.2g} R wide; the error of the assumptions is of pull-off"]
