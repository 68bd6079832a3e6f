"""Events of the path of finite strain: extrema of load and displacement, and roots, in one parameter.

In contact the parameter is the logarithm of the material radius of the contact edge, and the mesh has its edge there;
before contact it is the central gap.  An event is sought from that of small strain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference._large_strain.block import Block
from fem_reference._large_strain.discretisation import Discretisation, LinearEvent
from fem_reference._large_strain.equilibrium import Control, State, extrapolated, solve_state
from fem_reference.errors import NotConverged

__all__ = ["EVENTS", "Family", "PathEvent", "found_event"]

#: Steps of the parameter towards an extremum, each tried where the one before fails, and change of the parameter at
#: which the search ends: what is left of the extremum is its square.
FIRST_STEPS, LAST_CHANGE = (0.04, 0.01), 2e-5

#: Step of the parameter below which none is halved, and the largest between two states that predict a third.
SMALLEST_STEP, LARGEST_BASE = 2e-3, 0.1

#: Steps towards an event before giving up, and points of a polynomial.
STEPS, POINTS = 30, 5

#: Change of the parameter at which the search of a root ends: it is superlinear, so that what is left is its square.
ROOT_CHANGE = 1e-6

Measure = Callable[[State], float]


@dataclass(frozen=True, slots=True, eq=False)
class Family:
    """States of a branch by their parameter x, each solved once.

    Attributes
    ----------
    discretisation : Discretisation
    event : LinearEvent
        Event of small strain, at x = 0.
    origin : PathEvent, optional
        The event on other elements, from which the first state is carried over.
    """

    discretisation: Discretisation
    event: LinearEvent
    origin: PathEvent | None = None
    _states: dict[float, State] = field(default_factory=dict)

    @property
    def start(self) -> float:
        """Parameter of the first state."""
        return 0.0 if self.origin is None else self.origin.x

    def state(self, x: float) -> State:
        """Return the state at the parameter.

        Raises
        ------
        NotConverged
            If it is not found.
        """
        if x not in self._states:
            self._states[x] = self._solved(x)
        return self._states[x]

    def _solved(self, x: float) -> State:
        if not self._states:
            return self._first(x)
        nearest = min(self._states, key=lambda other: abs(other - x))
        try:
            return self._continued(x)
        except NotConverged:
            if abs(x - nearest) < SMALLEST_STEP:
                raise
        self.state(0.5 * (x + nearest))
        return self.state(x)

    def _first(self, x: float) -> State:
        """Solve the first state, from that of other elements or of small strain."""
        radius, control = self._condition(x)
        if self.origin is not None:
            with suppress(NotConverged):
                return self.discretisation.carried(self.origin.state, radius, control)
        return self.discretisation.first_state(self.event, radius, control)

    def _condition(self, x: float) -> tuple[float, Callable[[Block], Control]]:
        """Radius of the edge of the mesh, and the control."""
        law, point = self.discretisation.problem.law, self.event.point
        if point.branch.touching:
            radius = self.event.radius * math.exp(x)
            gap = float(self.discretisation.interaction.peak_gap(np.array(radius)))
            return radius, lambda block: Control(block.trace.edge, gap)
        return self.event.radius, lambda block: Control(0, point.parameter + x * law.z0)

    def _continued(self, x: float) -> State:
        """Solve a state from those nearest to it."""
        radius, control = self._condition(x)
        block = self.discretisation.block(radius)
        near, *others = sorted(self._states, key=lambda other: abs(other - x))
        state = self._states[near]
        if block.core.size != state.block.core.size:
            return self.discretisation.carried(state, radius, control)
        start = replace(state, block=block, surface=self.discretisation.surface(block, radius))
        others = [other for other in others if abs(other - near) <= LARGEST_BASE]
        if others and self._states[others[0]].u.size == state.u.size:
            start = extrapolated(self._states[others[0]], start, (x - near) / (near - others[0]))
        return solve_state(start, control(block))


@dataclass(frozen=True, slots=True, eq=False)
class PathEvent:
    """A state at an event, its parameter, and the state before it in the search."""

    x: float
    state: State
    previous: State


def _load(state: State) -> float:
    return state.load


def _displacement(state: State) -> float:
    return state.displacement


#: Measure of each event, and whether it is a minimum (1), a maximum (-1) or a root (0) of it.
EVENTS: Mapping[str, tuple[Measure, int]] = {
    "pull_off": (_load, 1),
    "jump_in": (_displacement, -1),
    "jump_out": (_displacement, 1),
    "zero_load": (_load, 0),
    "landing": (_displacement, 0),
    "separated": (_displacement, 0),
}


def found_event(name: str, family: Family, level: float = 0.0) -> PathEvent:
    """Find an event near that of the origin of a family, or near that of small strain.

    Parameters
    ----------
    name : str
        Of `EVENTS`.
    family : Family
    level : float
        Value of the measure at a root.

    Raises
    ------
    NotConverged
        If there is none near it.
    """
    measure, kind = EVENTS[name]
    if kind:
        return _extremum(family, lambda state: kind * measure(state))
    return _root(family, lambda state: measure(state) - level)


def _extremum(family: Family, measure: Measure) -> PathEvent:
    """Find a minimum, with shorter steps where one is near or states are hard to find."""
    if family.origin is None:
        for step in FIRST_STEPS[:-1]:
            with suppress(NotConverged):
                return _extremum_by(step, family, measure)
    return _extremum_by(FIRST_STEPS[-1], family, measure)


def _extremum_by(step: float, family: Family, measure: Measure) -> PathEvent:
    """Find a minimum by polynomials through the nearest states, going towards it by a step."""
    start = family.start
    values = {start: measure(family.state(start))}
    values[start - step] = measure(family.state(start - step))
    before: float | None = None
    for _ in range(STEPS):
        lowest = min(values, key=values.__getitem__)
        if lowest in (min(values), max(values)):
            x = lowest - step if lowest == min(values) else lowest + step
            values[x] = measure(family.state(x))
            continue
        nearest = sorted(values, key=lambda x: abs(x - lowest))[:POINTS]
        polynomial = np.polynomial.Polynomial.fit(nearest, [values[x] for x in nearest], len(nearest) - 1)
        low = max(x for x in values if x < lowest)
        high = min(x for x in values if x > lowest)
        turns = np.asarray(polynomial.deriv().roots(), complex)
        inside = [x for x in turns[abs(turns.imag) < 1e-12].real.tolist() if low < x < high]
        if not inside:
            raise NotConverged("the path of finite strain has no smooth extremum near that of small strain")
        x = min(inside, key=lambda x: float(polynomial(x)))
        state = family.state(x)
        if before is not None and abs(x - before) <= LAST_CHANGE:
            return PathEvent(x, state, family.state(before))
        before, values[x] = x, measure(state)
    raise NotConverged("the path of finite strain has no such event near that of small strain")


def _root(family: Family, measure: Measure) -> PathEvent:
    """Find a root by the secant method."""
    before, x = family.start, family.start + FIRST_STEPS[-1]
    for _ in range(STEPS):
        first, second = measure(family.state(before)), measure(family.state(x))
        slope = (second - first) / (x - before)
        step = -second / slope if slope else math.inf
        if abs(step) <= ROOT_CHANGE:
            return PathEvent(x + step, family.state(x + step), family.state(x))
        before, x = x, x + math.copysign(min(abs(step), 4.0 * FIRST_STEPS[0]), step)
    raise NotConverged("the path of finite strain has no such event near that of small strain")
