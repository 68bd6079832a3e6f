"""Least squares of a model for one record: where the search begins, its residuals and their derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import lmfit
import numpy as np

from comparisons.fitting.baseline import Baseline, BaselineName
from comparisons.fitting.curves import Curves, NearbyCurves
from comparisons.fitting.machine import Machine, Observations
from comparisons.fitting.parameters import Key, changed
from comparisons.model import Array, ComputationFailed, NotApplicable
from comparisons.problem import Problem
from comparisons.runs.tasks import evaluate

#: Start values of the JKR limit, as shares of those of the file: a file may be wrong by some powers of ten.
_SHARES = (0.1, 10.0, 0.01, 100.0)

#: Standard deviation of the logarithm of a free value about that of the file: it moves no value that a curve
#: determines, and holds the others within a few powers of ten.
_VAGUE = 5.0

#: The limit is near the values of contacts of larger Tabor numbers even where it does not describe the curve.
_SOFT = 0.5

#: Tabor numbers at which the search begins where that limit does not describe the curve.
_STIFF = (0.5, 0.1, 3.0, 0.02)

#: The key on which every pull-off force depends.
_ADHESION = "law.work_of_adhesion"

#: Errors of the equilibria as a share of the pull-off force, between Tabor numbers of the grid (measured worst 8e-4, at
#: a fold; a tenth of that elsewhere) or of a series (measured worst 1e-4): a record without noise does not ask for
#: more.
_MODEL_ERROR = 3e-4

#: A model describes a record where its residuals are at most twice the noise.
DESCRIBED = 4.0

#: Steps of derivatives, of numbers of keys and of zeros in units of the ranges of load and position: a search with the
#: first one crosses what folds at the points of a record make rough, one with the second goes on from there, or finds
#: what the first one steps over.
_STEPS = (1e-2, 1e-3)

#: Largest change of a number by one expansion at first, their largest count, the change that ends a search, in standard
#: deviations, and the growth of the sum of squares that makes a step too long.
_REACH, _EXPANSIONS, _SMALL, _WORSE = 1.0, 40, 0.25, 1.01

#: Ratio of the loads to which equilibria reach, and how many of a search are kept: those of one table of derivatives.
_REACHES, _KEPT = 1.1, 16

#: Residual of values for which the model has no path: larger than any of a path.
_REFUSED = 1e9


class Search:
    """Least squares for one record."""

    def __init__(
        self,
        observed: Observations,
        problem: Problem,
        keys: Sequence[Key],
        baseline: BaselineName | None = None,
        jumps: Sequence[bool] = (True, False),
    ) -> None:
        self.observed, self.problem, self.keys, self.jumps = observed, problem, tuple(keys), tuple(jumps)
        self.baseline = Baseline.of(observed, baseline)
        record = observed.record
        depth = float(np.median(record.load) - record.load.min())
        self.noise = math.hypot(record.noise, _MODEL_ERROR * depth)
        self._position = record.position
        self.range = float(np.ptp(self._position))
        self.load_range = self.baseline.range
        self._machines: dict[tuple[Any, ...], Machine] = {}

    def starts(self) -> list[dict[str, float]]:
        """Return where the search may begin: at the fit of the JKR limit, which takes no time.

        If that does not describe the record, the search may also begin at the pull-off force of the record and several
        Tabor numbers, and only there if that of the limit is small.
        """
        free = [key.name for key in self.keys if key.logarithmic and key.prior is None]
        near_limit = []
        for shift in ({}, *({name: math.log(share)} for share in _SHARES for name in free)):
            try:
                near_limit.append(_best(self.minimised(Curves("jkr"), shift, step) for step in _STEPS))
            except (NotApplicable, ComputationFailed, ValueError):
                continue
            # Without the end of the tension several values describe a record, and not equally well.
            if near_limit[-1].redchi < DESCRIBED and False in self.observed.jumps:
                break
        if near_limit and (nearest := _best(near_limit)).redchi < DESCRIBED:
            return [numbers_of(nearest.params)]
        starts = [self._of_pull_off(mu) for mu in _STIFF]
        if near_limit:
            values = numbers_of(_best(near_limit).params)
            if self._problem_of(values).posed.mu > _SOFT:
                return [values, *starts]
        return starts

    def _problem_of(self, values: dict[str, float]) -> Problem:
        return changed(self.problem, self.keys, values)

    def _of_pull_off(self, mu: float) -> dict[str, float]:
        """Return numbers with the pull-off force of the record and, if a modulus is free, a Tabor number."""
        numbers = dict.fromkeys((key.name for key in self.keys), 0.0)
        loads = self.observed.record.load
        force = self.baseline.load - float(loads.min())
        if _ADHESION in numbers:
            posed = Problem.dimensionless(n=self.problem.posed.n, k=self.problem.posed.k, mu=mu)
            # The unit of the load is proportional to the work of adhesion.
            stated = float(evaluate("fscm", "pull_off_force", posed)) * self.problem.units["load"]
            numbers[_ADHESION] = math.log(force / stated) if force > 0.0 else 0.0
        moduli = [key.name for key in self.keys if key.name.startswith("solid.") and key.logarithmic]
        if moduli:
            logs = []
            for number in (0.0, 1.0):
                numbers |= dict.fromkeys(moduli, number)
                logs.append(math.log(changed(self.problem, self.keys, numbers).posed.mu))
            # The Tabor number is a power of the modulus.
            numbers |= dict.fromkeys(moduli, (math.log(mu) - logs[0]) / (logs[1] - logs[0]))
        return numbers

    def best(self, curves: Curves, starts: Sequence[dict[str, float]], is_costly: bool) -> tuple[Any, Curves]:
        """Return the best result of lmfit from several starts, and the curves that it is of.

        Parameters
        ----------
        curves : Curves
        starts : sequence of dict
        is_costly : bool
            Whether each problem has a path of its own, which takes seconds.

        Raises
        ------
        comparisons.model.ComputationFailed
            If none of them leads to numbers that describe the record.
        """
        results, refusal = [], ComputationFailed("no values of the free keys describe the curve")
        for start in starts:
            try:
                results.append(self._nearby(start) if is_costly else (self._from(curves, start), curves))
            except ComputationFailed as error:
                refusal = error
            if results and results[-1][0].redchi < DESCRIBED:
                break
        if not results:
            raise refusal
        return min(results, key=lambda result: float(result[0].chisqr))

    def _nearby(self, start: dict[str, float]) -> tuple[Any, Curves]:
        """The result from one start, and its curves: each expansion of them gives the numbers of the next one.

        The reach of an expansion shrinks where the record is described worse at the next numbers, or they have no path.
        """
        curves, center, values, reach, least = NearbyCurves("fscm"), start, start, _REACH, math.inf
        ended = False
        for number in range(_EXPANSIONS):
            try:
                expanded = curves.moved(self.problem, self.keys, values, 1.2 * self.largest(values))
                squares = float(np.sum(self._residuals(values, expanded) ** 2)) if number else math.inf
            except ComputationFailed:
                if not number:
                    raise
                squares = math.inf
            if number and squares > _WORSE * least:
                reach *= 0.25
            else:
                curves, center, least = expanded, values, squares
            result = self.minimised(curves, center, _STEPS[1], reach)
            values = numbers_of(result.params)
            if all(
                abs(values[name] - at_center) < _SMALL * (result.params[plain(name)].stderr or _STEPS[1])
                for name, at_center in curves.center.items()
            ):
                ended = True
                break
        if result.redchi >= DESCRIBED and not (ended and result.errorbars):
            raise ComputationFailed("the search found no values that describe the curve: begin nearer to them")
        return result, curves

    def _from(self, curves: Curves, start: dict[str, float]) -> Any:
        """The better result from one start and from where a coarse search from it ends."""
        coarse = numbers_of(self.minimised(curves, start, _STEPS[0]).params)
        return _best(self.minimised(curves, each, _STEPS[1]) for each in (start, coarse))

    def scaled(self, curves: Curves, result: Any, factor: float) -> dict[str, float]:
        """Return the numbers that a result becomes if all loads of the model are larger by a factor."""
        return numbers_of(self.minimised(replace(curves, factor=factor), numbers_of(result.params), _STEPS[1]).params)

    def machine(self, values: dict[str, float], curves: Curves) -> Machine:
        """Return the stable sections of the problem of fitted numbers."""
        # The load to which they reach changes in steps: two thirds of the numbers of a search move only the record.
        largest = 1.2 * self.largest(values)
        end = _REACHES ** math.ceil(math.log(largest, _REACHES)) if largest > 0.0 else largest
        asked = curves, end, *(values[key.name] for key in self.keys)
        if asked not in self._machines:
            if len(self._machines) >= _KEPT:
                self._machines.pop(next(iter(self._machines)))
            equilibria = curves.equilibria(self._problem_of(values), values, end)
            self._machines[asked] = Machine.of(equilibria, self.observed.record.stiffness)
        return self._machines[asked]

    def largest(self, values: dict[str, float]) -> float:
        """The largest load of the record from its zero."""
        return float((self.observed.record.load - self.baseline.loads(self.baseline.start | values)).max())

    def zeros(self, values: dict[str, float]) -> tuple[Array, Array]:
        """Return the positions of the record from their zero, and its loads without contact."""
        shift = values["displacement"] + values.get("drift", 0.0) * (self.baseline.time - 0.5)
        compliance = values["load"] * self.load_range / self.observed.record.stiffness
        return self._position - compliance - shift * self.range, self.baseline.loads(values)

    def minimised(self, curves: Curves, start: dict[str, float], step: float, reach: float = math.inf) -> Any:
        """Return the result of lmfit from given numbers, of keys within a reach of them.

        Raises
        ------
        comparisons.model.ComputationFailed
            If none near them describe the record.
        """
        parameters = lmfit.Parameters()
        for key in self.keys:
            low, high = (key.number(limit) for limit in key.limits)
            value = start.get(key.name, 0.0)
            low, high = max(low, value - reach), min(high, value + reach)
            room = {} if math.isinf(low) and math.isinf(high) else {"min": low, "max": high}
            parameters.add(plain(key.name), value=value, **room)
        for name, number in self.baseline.start.items():
            parameters.add(name, value=start.get(name, number))
        if "displacement" in start:
            displacement = start["displacement"]
        else:
            values = numbers_of(parameters)
            machine = self.machine(values, curves)
            displacement = self._aligned(machine, values) / self.range
        parameters.add("displacement", value=displacement)
        if self.baseline.has_both:
            parameters.add("drift", value=start.get("drift", 0.0))

        worst = np.full(int(self.observed.used.sum()) + len(self.keys) + 2, _REFUSED)

        def residuals(parameters: lmfit.Parameters) -> Array:
            try:
                errors = self._residuals(numbers_of(parameters), curves)
            except (ComputationFailed, NotApplicable, ValueError):
                return worst
            return np.concatenate([errors, np.zeros(len(worst) - len(errors))])

        def jacobian(parameters: lmfit.Parameters) -> Array:
            return derivatives(residuals, parameters, step)

        result = lmfit.minimize(residuals, parameters, method="leastsq", Dfun=jacobian, max_nfev=40 * len(parameters))
        if not result.chisqr < _REFUSED**2:
            raise ComputationFailed("no values of the free keys describe the curve")
        return result

    def _aligned(self, machine: Machine, values: dict[str, float]) -> float:
        """The zero of the position at which the record has the load of the model: the best of those along it."""
        states = machine.contact[0, :: max(machine.contact.shape[1] // 40, 1)]
        tried = np.linspace(self._position.min() - states.max(), self._position.max() - states.min(), 400)
        every = slice(None, None, max(len(self._position) // 400, 1))
        observed, position = self.observed.thinned(every), self._position[every]
        loads = observed.record.load - self.baseline.loads(values)[every]
        errors = [float(np.sum((machine.load(position - shift, observed) - loads) ** 2)) for shift in tried]
        return float(tried[int(np.argmin(errors))])

    def _residuals(self, values: dict[str, float], curves: Curves) -> Array:
        machine = self.machine(values, curves)
        position, zero = self.zeros(values)
        observed = self.observed
        errors = (machine.load(position, observed) + zero - observed.record.load)[observed.used] / self.noise
        others = [values[key.name] / (key.deviation or _VAGUE) for key in self.keys if key.deviation or key.logarithmic]
        others += self.jump_residuals(machine, position, curves.model).values()
        return np.concatenate([errors, others])

    def jump_residuals(self, machine: Machine, position: Array, model: str) -> dict[bool, float]:
        """Return the distance of each jump that counts from the computed one, in its standard deviation."""
        if not machine.jumps:
            return {}
        distances = {}
        for approach, points in self.observed.jumps.items():
            # Surfaces of JKR do not attract before contact.
            if approach not in self.jumps or (approach and model == "jkr"):
                continue
            fold = machine.far[0, -1] if approach else machine.contact[0, 0]
            around = position[list(points)]
            # The jump is evenly anywhere between both points.
            distances[approach] = float((around.mean() - fold) / (np.ptp(around) / math.sqrt(12.0)))
        return distances


def numbers_of(parameters: lmfit.Parameters) -> dict[str, float]:
    """Return the numbers of parameters, by the names of keys and zeros."""
    return {dotted(name): float(parameter.value) for name, parameter in parameters.items()}


def _best(results: Iterable[Any]) -> Any:
    """Return the result of lmfit with the smallest sum of squares."""
    return min(results, key=lambda result: float(result.chisqr))


def derivatives(residuals: Callable[[lmfit.Parameters], Array], parameters: lmfit.Parameters, step: float) -> Array:
    """Return derivatives of residuals by differences over a step, shape (m, number of parameters).

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
        if not slopes:
            raise ComputationFailed(
                f"{dotted(parameter.name)} has no room for a change: begin nearer to the true values"
            )
        columns.append(np.where(np.abs(slopes[0]) < np.abs(slopes[-1]), slopes[0], slopes[-1]))
    return np.column_stack(columns)


def plain(name: str) -> str:
    """Return the name of a key as lmfit takes it."""
    return name.replace(".", "__")


def dotted(name: str) -> str:
    """Return the name of a key from that of lmfit."""
    return name.replace("__", ".")
