"""Least squares of a model for one record: where the search begins, its residuals and their derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from comparisons.fitting.baseline import CERTAIN, Baseline, BaselineName
from comparisons.fitting.curves import Curves, NearbyCurves
from comparisons.fitting.equilibria import pull_off_force
from comparisons.fitting.least_squares import Limits, Minimum, minimised
from comparisons.fitting.machine import Machine, Observations
from comparisons.fitting.parameters import Key, changed
from comparisons.fitting.record import checked
from comparisons.model import Array, ComputationFailed, NotApplicable
from comparisons.problem import Problem

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


class _Precision(NamedTuple):
    """Step of derivatives, of numbers of keys and of zeros in their ranges, and tolerance of a search."""

    step: float
    tolerance: float


#: A coarse search crosses what folds at the points of a record make rough, a fine one goes on from there, or finds what
#: the coarse one steps over.  The tolerances: a start is good to a thousandth of the sum of squares; that of MINPACK.
_COARSE, _FINE = _Precision(1e-2, 1e-3), _Precision(1e-3, 1.5e-8)

#: Largest change of a number by one expansion at first, their largest count, the change that ends a search, in standard
#: deviations, and the growth of the sum of squares that makes a step too long.
_REACH, _EXPANSIONS, _SMALL, _WORSE = 1.0, 40, 0.25, 1.01

#: Share by which a coarse search has to lower the sum of squares of a fine one to have gone on from its end.
_LESS = 1e-6

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
        if (nearest := self._of_limit(free)) is not None and nearest.reduced < DESCRIBED:
            return [nearest.numbers]
        starts = [self._of_pull_off(mu) for mu in _STIFF]
        if nearest is not None and self._problem_of(nearest.numbers).posed.mu > _SOFT:
            return [nearest.numbers, *starts]
        return starts

    def _of_limit(self, free: Sequence[str]) -> Minimum | None:
        """The fit of the JKR limit from the values of the file, or from shares of them; None if there is none."""
        curves, ends = Curves("jkr"), []
        for shift in ({}, *({name: math.log(share)} for share in _SHARES for name in free)):
            try:
                ends.append(self.minimised(curves, shift, _COARSE))
            except (NotApplicable, ComputationFailed, ValueError):
                continue
            # Without the end of the tension several values describe a record, and not equally well.
            if ends[-1].reduced < DESCRIBED and False in self.observed.jumps:
                return ends[-1]
        if not ends:
            return None
        return _best((*ends, self.minimised(curves, _best(ends).numbers, _FINE)))

    def _problem_of(self, values: Mapping[str, float]) -> Problem:
        return changed(self.problem, self.keys, values)

    def _of_pull_off(self, mu: float) -> dict[str, float]:
        """Return numbers with the pull-off force of the record and, if a modulus is free, a Tabor number."""
        numbers = dict.fromkeys((key.name for key in self.keys), 0.0)
        loads = self.observed.record.load
        force = self.baseline.load - float(loads.min())
        if _ADHESION in numbers:
            # The unit of the load is proportional to the work of adhesion.
            stated = pull_off_force(self.problem.posed.n, self.problem.posed.k, mu) * self.problem.units["load"]
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

    def best(self, curves: Curves, starts: Sequence[dict[str, float]], is_costly: bool) -> tuple[Minimum, Curves]:
        """Return the best minimum from several starts, and the curves that it is of.

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
            if results and results[-1][0].reduced < DESCRIBED:
                break
        if not results:
            raise refusal
        return min(results, key=lambda result: result[0].squares)

    def _nearby(self, start: dict[str, float]) -> tuple[Minimum, Curves]:
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
            result = self.minimised(curves, center, _FINE, reach)
            values = result.numbers
            deviations = result.deviations if result.covariance is not None else dict.fromkeys(values, _FINE.step)
            if all(
                abs(values[name] - at_center) < _SMALL * deviations[name] for name, at_center in curves.center.items()
            ):
                ended = True
                break
        if result.reduced >= DESCRIBED and not (ended and result.covariance is not None):
            raise ComputationFailed("the search found no values that describe the curve: begin nearer to them")
        return result, curves

    def _from(self, curves: Curves, start: dict[str, float]) -> Minimum:
        """The least of a fine search from one start, and of one from where a coarse search ends.

        The coarse one begins at the first minimum if this describes the record: often it ends there.
        """
        fine = self.minimised(curves, start, _FINE)
        is_near = fine.reduced < DESCRIBED
        coarse = self.minimised(curves, fine.numbers if is_near else start, _COARSE)
        if is_near and coarse.squares > (1.0 - _LESS) * fine.squares:
            return fine
        return _best((fine, self.minimised(curves, coarse.numbers, _FINE)))

    def of_branch(self, branch: str, result: Minimum) -> tuple[Search, dict[str, float]]:
        """Return the search for one branch of the record, and where it begins: at the numbers of both.

        Raises
        ------
        ValueError
            If the branch is too short.
        """
        record = self.observed.record
        of_points, numbers = record.approach == (branch == "approach"), dict(result.numbers)
        baseline: BaselineName = "linear" if "tilt" in self.baseline.names else "constant"
        alone = checked(record.only(branch), f"the {branch} of {record.name}")
        search = Search(Observations.of(alone), self.problem, self.keys, baseline, self.jumps)
        time = float(self.baseline.time[of_points].mean())
        numbers["displacement"] += numbers.pop("drift", 0.0) * (time - 0.5)
        numbers["load"] += numbers.pop("load_drift", 0.0) * time
        # Each search counts displacements and loads in the ranges of its own record.
        units = {"displacement": self.range / search.range}
        units |= dict.fromkeys(("load", "tilt"), self.load_range / search.load_range)
        return search, {name: number * units.get(name, 1.0) for name, number in numbers.items()}

    def scaled(self, curves: Curves, result: Minimum, factor: float) -> dict[str, float]:
        """Return the numbers that a result becomes if all loads of the model are larger by a factor."""
        return self.minimised(replace(curves, factor=factor), result.numbers, _FINE).numbers

    def machine(self, values: Mapping[str, float], curves: Curves) -> Machine:
        """Return the stable sections of the problem of fitted numbers."""
        end = self._end(values)
        asked = curves, end, *(values[key.name] for key in self.keys)
        if asked not in self._machines:
            if len(self._machines) >= _KEPT:
                self._machines.pop(next(iter(self._machines)))
            equilibria = curves.equilibria(self._problem_of(values), values, end)
            self._machines[asked] = Machine.of(equilibria, self.observed.record.stiffness)
        return self._machines[asked]

    def _end(self, values: Mapping[str, float]) -> float:
        """The load to which equilibria reach.

        It changes in steps: two thirds of the numbers of a search move only the record.
        """
        largest = 1.2 * self.largest(values)
        return _REACHES ** math.ceil(math.log(largest, _REACHES)) if largest > 0.0 else largest

    def largest(self, values: Mapping[str, float]) -> float:
        """The largest load of the record from its zero."""
        return float((self.observed.record.load - self.baseline.loads({**self.baseline.start, **values})).max())

    def zeros(self, values: Mapping[str, float]) -> tuple[Array, Array]:
        """Return the positions of the record from their zero, and its loads without contact."""
        shift = values["displacement"] + values.get("drift", 0.0) * (self.baseline.time - 0.5)
        compliance = values["load"] * self.load_range / self.observed.record.stiffness
        return self._position - compliance - shift * self.range, self.baseline.loads(values)

    def minimised(
        self, curves: Curves, start: Mapping[str, float], precision: _Precision, reach: float = math.inf
    ) -> Minimum:
        """Return the least squares from given numbers, of keys within a reach of them.

        Raises
        ------
        comparisons.model.ComputationFailed
            If none near them describe the record.
        """
        numbers = {key.name: start.get(key.name, 0.0) for key in self.keys}
        limits = {}
        for key in self.keys:
            low, high = (key.number(limit) for limit in key.limits)
            limits[key.name] = Limits(max(low, numbers[key.name] - reach), min(high, numbers[key.name] + reach))
        numbers |= {name: start.get(name, number) for name, number in self.baseline.start.items()}
        if "displacement" in start:
            numbers["displacement"] = start["displacement"]
        else:
            numbers["displacement"] = self._aligned(self.machine(numbers, curves), numbers) / self.range
        if self.baseline.has_both:
            numbers["drift"] = start.get("drift", 0.0)
        worst = np.full(int(self.observed.used.sum()) + len(self.keys) + 2, _REFUSED)

        def residuals(values: Mapping[str, float], curves: Curves) -> Array:
            try:
                errors = self._residuals(values, curves)
            except (ComputationFailed, NotApplicable, ValueError):
                return worst
            return np.concatenate([errors, np.zeros(len(worst) - len(errors))])

        result = minimised(
            lambda values: residuals(values, curves),
            lambda values: self.derivatives(residuals, values, curves, precision.step),
            numbers,
            limits,
            precision.tolerance,
        )
        if not result.squares < _REFUSED**2:
            raise ComputationFailed("no values of the free keys describe the curve")
        return result

    def derivatives(
        self,
        function: Callable[[Mapping[str, float], Curves], Array],
        values: Mapping[str, float],
        curves: Curves,
        step: float,
    ) -> Array:
        """Return derivatives of a function of the numbers and the curves, as `differences`.

        The curves of the neighbours are those of the given numbers with their own derivatives, where these are known.
        """
        try:
            near = curves.expanded(self._problem_of(values), self._end(values))
        except (ComputationFailed, NotApplicable, ValueError):
            near = curves
        return differences(lambda numbers: function(numbers, near), values, step)

    def _aligned(self, machine: Machine, values: Mapping[str, float]) -> float:
        """The zero of the position at which the record has the load of the model: the best of those along it."""
        states = machine.contact[0, :: max(machine.contact.shape[1] // 40, 1)]
        tried = np.linspace(self._position.min() - states.max(), self._position.max() - states.min(), 400)
        every = slice(None, None, max(len(self._position) // 400, 1))
        observed, position = self.observed.thinned(every), self._position[every]
        loads = observed.record.load - self.baseline.loads(values)[every]
        errors = np.sum((machine.load(position - tried[:, None], observed) - loads) ** 2, axis=1)
        return float(tried[int(np.argmin(errors))])

    def errors(self, values: Mapping[str, float], curves: Curves) -> Array:
        """Return how much larger the loads of fitted numbers are than those of the record, in N."""
        position, zero = self.zeros(values)
        return self.machine(values, curves).load(position, self.observed) + zero - self.observed.record.load

    def is_level(self, result: Minimum) -> bool:
        """Return whether a linear baseline changes by less than the noise, or by no more than it may by chance."""
        slopes = [name for name in ("tilt", "load_drift") if name in result.numbers]
        return bool(slopes) and all(
            abs(result.numbers[name]) * self.load_range < self.observed.record.noise
            or abs(result.numbers[name]) < CERTAIN * result.deviations[name]
            for name in slopes
        )

    def _residuals(self, values: Mapping[str, float], curves: Curves) -> Array:
        machine = self.machine(values, curves)
        position, _ = self.zeros(values)
        errors = self.errors(values, curves)[self.observed.used] / self.noise
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


def _best(results: Iterable[Minimum]) -> Minimum:
    """Return the least one."""
    return min(results, key=lambda result: result.squares)


def differences(function: Callable[[Mapping[str, float]], Array], values: Mapping[str, float], step: float) -> Array:
    """Return derivatives of a function of numbers by differences over a step, shape (m, count of numbers).

    A step over the fold of a branch changes some residuals at once.  Only one of the steps to both sides goes over
    it, so the smaller of both derivatives is that of the residual.
    """
    central, columns = function(values), []
    for name, value in values.items():
        moved = [value + signed for signed in (step, -step)]
        if value in moved:
            raise ComputationFailed(f"{name} has no room for a change: begin nearer to the true values")
        slopes = [(function({**values, name: other}) - central) / (other - value) for other in moved]
        columns.append(np.where(np.abs(slopes[0]) < np.abs(slopes[1]), slopes[0], slopes[1]))
    return np.column_stack(columns)
