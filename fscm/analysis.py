"""Path, events and quantities of one problem, computed on demand."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial, singledispatchmethod

from fscm._bound.defect import Errors
from fscm._bound.parts import EventErrors, bounds, energy_of_jump
from fscm._known_minimum import known_minimum
from fscm._path import events
from fscm._path.arc_length import Point
from fscm._path.completeness import completed
from fscm._path.events import Bracket, Condition
from fscm._path.jumps import Branch, jumps_between, with_accurate_ends
from fscm._path.pull_off_path import deepest_minimum, pull_off_path, without_tension
from fscm._path.punch_rules import rules_of
from fscm._path.whole_path import bracketing_path
from fscm._threads import one_thread
from fscm.accuracy import Accuracy, Mesh, Meshes
from fscm.critical import critical_tabor_number
from fscm.errors import AccuracyWarning, Failure, NoSuchEvent, NotConverged, RingsForm
from fscm.folds import Fold, edge_radius, folds_of
from fscm.problem import Problem
from fscm.punch import check_reach
from fscm.quantities import EXTREMAL, AtEvent, Critical, LostInJumps, Quantity, quantity_named
from fscm.solution import EventPair, Parts, Solution, solution_of
from fscm.stability import stable_sections

__all__ = ["Analysis"]

#: Mesh of a second path where the usual one, which resolves 3e-3 of a load of at least 1, leads to no event.  Measured:
#: a tall asperity with a force of 2.9e-3, which is the same to 3e-13 down to a tolerance of 1e-7.
_FINER_PATH = Mesh(8, 1e-4)


class Analysis:
    """The full self-consistent model of one problem; several quantities share its path and its events.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1, dimensionless: `solve` hands over `Problem.dimensionless`.
    accuracy : float or str
        Requested relative error, or its name in `ACCURACIES` (see `solve`).

    Raises
    ------
    ValueError
        For k = 1, which is `fscm.gibson`, and for an accuracy outside its range.

    Examples
    --------
    >>> model = Analysis(Problem(n=2, k=0.4, mu=1.0))
    >>> round(model.solution("pull_off_force").value, 8)
    1.78848171
    """

    problem: Problem
    meshes: Meshes

    def __init__(self, problem: Problem, accuracy: Accuracy = "default") -> None:
        if problem.k >= 1.0:
            raise ValueError("gradient exponent k = 1 is the Gibson solid, whose model is fscm.gibson")
        self.problem = problem
        self.meshes = Meshes.of(accuracy)
        self._pairs: dict[str, EventPair] = {}
        self._jumps: dict[str, list[tuple[EventPair, EventPair]]] = {}
        self._parts: dict[tuple[str, str], Parts] = {}
        # Of one event at a time: it holds several square matrices.
        self._latest_errors: tuple[str, EventErrors] | None = None
        self._fold_errors: dict[str, tuple[Errors, Errors]] = {}

    @cached_property
    @one_thread()
    def points(self) -> list[Point]:
        """The coarse path from far separation to its end, with all turning points of load and displacement."""
        return completed(self._traced, self.meshes.path.tolerance)

    @cached_property
    def _traced(self) -> list[Point]:
        """The coarse path, on which turning points may be missed."""
        return bracketing_path(self.problem, self.meshes)

    @cached_property
    @one_thread()
    def folds(self) -> tuple[Fold, ...]:
        """All turning points of load and displacement, in the order of the path, to the accuracy of the coarse path.

        Examples
        --------
        >>> for fold in Analysis(Problem(n=2, k=0.4, mu=1.0)).folds:
        ...     print(fold.quantity, "maximum" if fold.maximum else "minimum", round(fold.displacement, 2))
        displacement maximum -1.56
        displacement minimum -1.62
        load minimum -0.41
        """
        return folds_of(self.points)

    @cached_property
    def _folds(self) -> tuple[list[Bracket], list[Bracket]]:
        """Brackets of the maxima and of the minima of the displacement, in the order of the path."""
        maxima = events.brackets(self.points, events.displacement_fold, rising=False)
        if maxima:
            return maxima, events.brackets(self.points, events.displacement_fold, rising=True)
        # The two folds may be between neighbouring points, where the rate of displacement is least.
        before, at, after, rate = events.slowest(self.points)
        if rate < 0.0:
            return [(before, at)], [(at, after)]
        end = self.points[-1].state
        beyond = "below the critical Tabor number"
        if rules_of(self.problem).may_hide_folds:
            beyond = f"up to delta = {end.displacement:.4g}, P = {end.load:.4g}, beyond which no state carries tension"
        raise NoSuchEvent(
            f"the displacement rises monotonically along the path at mu = {self.problem.mu}: there is no jump {beyond}"
        )

    @cached_property
    def _branches(self) -> list[Branch]:
        """The branches that are stable under prescribed displacement, from separation into contact."""
        maxima, minima = self._folds
        if len(maxima) == len(minima) == 1:
            return [Branch(high=maxima[0], largest=0.0), Branch(low=minima[0], least=0.0)]  # no displacement is needed
        turns = [i for i, fold in enumerate(self.folds) if fold.quantity == "displacement"]
        if [self.folds[i].maximum for i in turns] != [j % 2 == 0 for j in range(len(maxima) + len(minima))]:
            raise NotConverged(
                f"the turning points of the displacement on the path of {self.problem} do not alternate", Failure.FOLDS
            )
        sections = stable_sections(
            self.points[0], self.points[-1], [(fold.quantity, fold.displacement) for fold in self.folds]
        )
        places = [self.folds[i].displacement for i in turns]
        branches = []
        for j, start in enumerate([-1, *turns[1::2]]):
            if sections[start + 1][0]:
                low = (minima[j - 1], places[2 * j - 1]) if j else (None, -math.inf)
                high = (maxima[j], places[2 * j]) if j < len(maxima) else (None, math.inf)
                branches.append(Branch(low[0], high[0], low[1], high[1]))
        if len(branches) < 2:
            raise NotConverged(
                f"no part of the path of {self.problem} in contact was found to be stable", Failure.BRANCH
            )
        return with_accurate_ends(branches, lambda fold: self._pair(fold, events.displacement_fold).value.displacement)

    def _least_load(self) -> Bracket:
        points = None
        if "_traced" not in self.__dict__:
            known = known_minimum(self.problem, self.meshes)
            if known is not None:
                return known
            points = pull_off_path(self.problem, self.meshes)
        if points is None:
            points = events.with_minima(self._traced)
        return deepest_minimum(points, self.meshes)

    def _last_zero_load(self) -> Bracket:
        zeros = events.crossings(self.points, events.zero_load, events.load_fold)
        if not zeros:
            raise NoSuchEvent(f"the load is positive along the path of {self.problem}: it has no zero")
        return zeros[-1]

    @one_thread()
    def event(self, name: str) -> EventPair:
        """The state at one of `EVENTS` on the value mesh, and on the check mesh on demand.

        Parameters
        ----------
        name : str

        Returns
        -------
        EventPair

        Raises
        ------
        NoSuchEvent
            When the path has no such point.
        NotConverged
            When it has one that was not reached.
        ValueError
            For an unknown name.

        Examples
        --------
        >>> state = Analysis(Problem(n=2, k=0.4, mu=1.0)).event("zero_load").value
        >>> abs(state.load) < 1e-9, round(state.displacement, 6)
        (True, 2.085962)
        """
        if name not in _EVENTS:
            raise ValueError(f"unknown event {name!r}; known are {', '.join(_EVENTS)}")
        if name not in self._pairs:
            bracket, condition = _EVENTS[name]
            pair = self._pair(bracket(self), condition)
            if name == "pull_off" and not pair.value.load < 0.0:
                raise NoSuchEvent(without_tension(self.problem))
            self._pairs[name] = pair
        return self._pairs[name]

    def _pair(self, bracket: Bracket, condition: Condition) -> EventPair:
        end = self.meshes.end_height
        check = partial(events.event_between, bracket, condition, *self.meshes.check, end)
        value = events.event_between(bracket, condition, *self.meshes.value, end)
        check_reach(self.problem.punch, edge_radius(value))
        return EventPair(value, check)

    @one_thread()
    def parts(self, event: str, functional: str) -> Parts:
        """Bounds on the error of one of `FUNCTIONALS` at an event.

        Examples
        --------
        >>> parts = Analysis(Problem(n=2, k=0.4, mu=1.0)).parts("pull_off", "load")
        >>> parts.total < 1e-10
        True
        """
        if (event, functional) not in self._parts:
            errors, extremal = self._errors(event), EXTREMAL[event]
            self._parts[event, functional] = (
                bounds(errors.controlled(functional, "load", 0.0))
                if extremal is None
                else errors.at_extreme(functional, extremal)
            )
        return self._parts[event, functional]

    def _errors(self, event: str) -> EventErrors:
        if self._latest_errors is None or self._latest_errors[0] != event:
            errors = EventErrors(self.event(event).value)
            self._latest_errors = event, errors
            if event in _NAMED:
                self._fold_errors[event] = errors.at_fold()
        return self._latest_errors[1]

    @one_thread()
    def jump_parts(self, jump: str) -> Parts:
        """Bounds on the error of the energy that is lost in all jumps of an approach or a retreat, see `jumps`.

        Examples
        --------
        >>> Analysis(Problem(n=2, k=0.4, mu=1.0)).jump_parts("jump_in").total < 1e-8
        True
        """
        parts = Parts()
        for fold, landing in self.jumps(jump):
            if fold is not self.event(jump):
                errors = EventErrors(fold.value).at_fold()
            else:
                if jump not in self._fold_errors:
                    self._errors(jump)
                errors = self._fold_errors[jump]
            # The errors of two jumps may cancel by accident: their sizes are added.
            parts = parts.plus(energy_of_jump(*errors, fold.value, landing.value))
        return parts

    @one_thread()
    def landing(self, event: str) -> EventPair:
        """Where the "jump_in" or the "jump_out" under displacement control lands: on the next stable branch."""
        return self.jumps(event)[_NAMED[event]][1]

    @one_thread()
    def jumps(self, event: str) -> list[tuple[EventPair, EventPair]]:
        """Every jump of an approach ("jump_in") or a retreat ("jump_out") under displacement control.

        Returns
        -------
        list of (EventPair, EventPair)
            The fold and the landing of each, in their order: "jump_in" is the first of the approach and "jump_out" the
            last of the retreat.  A punch with asperities, or a stiff film on a soft solid, may jump several times.
        """
        if event not in _NAMED:
            raise ValueError(f"unknown jump {event!r}; known are {', '.join(_NAMED)}")
        if event not in self._jumps:
            self._jumps[event] = self._all_jumps(event)
        return self._jumps[event]

    def _all_jumps(self, event: str) -> list[tuple[EventPair, EventPair]]:
        jumps = jumps_between(self._branches, event == "jump_in")
        named, pairs = jumps[_NAMED[event]][0], []
        for bracket, branch in jumps:
            fold = self.event(event) if bracket is named else self._pair(bracket, events.displacement_fold)
            pairs.append((fold, self._landing(event, fold, branch)))
        return pairs

    def _landing(self, event: str, fold: EventPair, branch: Branch) -> EventPair:
        """State on a branch in which a jump from a fold lands."""

        def at(displacement: float) -> Condition:
            return lambda state, rates: state.displacement - displacement

        condition = at(fold.value.displacement)
        # A fold between neighbouring points is not among them.
        places = {id(point): i for i, point in enumerate(self.points)}
        start = 0 if branch.low is None else places.get(id(branch.low[0]), 0)
        stop = len(places) if branch.high is None else places.get(id(branch.high[1]), len(places))
        crossings = events.crossings(self.points[start : stop + 1], condition, events.displacement_fold)
        rising = [pair for pair in crossings if condition(pair[0].state, pair[0].rates) < 0.0]
        if not rising:
            raise NotConverged(
                f"the path of {self.problem} does not reach the displacement {fold.value.displacement:.6g}, "
                f"at which the {event.replace('_', '-')} lands",
                Failure.BRANCH,
            )
        coarse = events.locate(*rising[-1 if event == "jump_in" else 0], condition)
        value = events.root_near(coarse, condition, *self.meshes.value)
        return EventPair(value, lambda: events.root_near(coarse, at(fold.check.displacement), *self.meshes.check))

    @one_thread()
    def solution(self, quantity: str) -> Solution:
        """One of `QUANTITIES`, with its uncertainty.

        Raises
        ------
        NoSuchEvent, NotConverged, ValueError
        """
        row = quantity_named(quantity)
        start = time.perf_counter()
        try:
            solution = self._computed(row)
        except RingsForm:
            raise
        except NotConverged:
            if self.meshes.path.tolerance <= _FINER_PATH.tolerance:
                raise
            return self._on_finer_path.solution(quantity)
        if solution.u_num > self.meshes.recompute_above * abs(solution.value):
            solution = self._finer._computed(row)
        if self._alternatives:
            # Uncertainty by the smoothing of a law.
            change = max(
                abs(alternative.solution(quantity).value - solution.value) for alternative in self._alternatives
            )
            solution = replace(solution, parts=solution.parts.plus(Parts(law=change)))
        if solution.u_num > self.meshes.warn_above * abs(solution.value):
            warnings.warn(
                f"accuracy = {self.meshes.warn_above:g} is not reached for the {quantity} of {self.problem}: "
                f"its bound is {solution.u_num / abs(solution.value):.1e} of it, mainly of {solution.parts.largest}",
                AccuracyWarning,
                stacklevel=2,
            )
        return replace(solution, seconds=time.perf_counter() - start)

    @singledispatchmethod
    def _computed(self, row: Quantity) -> Solution:
        """A quantity, without the uncertainty by the smoothing of a law and without its time."""
        raise TypeError(f"{row!r} is of no kind that is computed")

    @_computed.register
    def _(self, row: AtEvent) -> Solution:
        pair = self.event(row.event)
        return solution_of(row.value(pair.value), self.parts(row.event, row.functional), [pair])

    @_computed.register
    def _(self, row: LostInJumps) -> Solution:
        """The drops of energy at constant displacement."""
        value, parts, pairs = 0.0, Parts(), []
        for event in row.events:
            for fold, landing in self.jumps(event):
                value += fold.value.energy - landing.value.energy
                pairs += [fold, landing]
            parts = parts.plus(self.jump_parts(event))
        return solution_of(value, parts, pairs)

    @_computed.register
    def _(self, row: Critical) -> Solution:
        return critical_tabor_number(self.problem, self.meshes)

    @cached_property
    def _on_finer_path(self) -> Analysis:
        """The problem with a path that also resolves loads much smaller than 1, such as of an asperity."""
        return Analysis(self.problem, replace(self.meshes, path=_FINER_PATH))

    @cached_property
    def _finer(self) -> Analysis:
        """The problem on the default meshes."""
        return Analysis(self.problem)

    @cached_property
    def _alternatives(self) -> list[Analysis]:
        """The problem with the alternatives of a smoothed law."""
        analyses = []
        for law in getattr(self.problem.law, "alternatives", ()):
            analysis = Analysis(replace(self.problem, law=law), self.meshes)
            analysis._alternatives = []
            analyses.append(analysis)
        return analyses


#: Bracket and condition of each event.
_EVENTS: dict[str, tuple[Callable[[Analysis], Bracket], Condition]] = {
    "pull_off": (Analysis._least_load, events.load_fold),
    "jump_in": (lambda analysis: analysis._folds[0][0], events.displacement_fold),
    "jump_out": (lambda analysis: jumps_between(analysis._branches, inward=False)[-1][0], events.displacement_fold),
    "zero_load": (Analysis._last_zero_load, events.zero_load),
}
#: Index of the event among the jumps of an approach or a retreat: the first one into contact, the last one out of it.
_NAMED = {"jump_in": 0, "jump_out": -1}
