"""Arc length of the equilibrium path: continuation parameter, tangent and the condition of a step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm._equilibrium import Control, Rates, State
from fscm.problem import Problem

__all__ = ["ArcLength", "Point", "parameter_control", "parameter_of", "rates_of"]


@dataclass(frozen=True)
class Point:
    """A state on the path and its unit tangent in arc length, oriented from separation into contact.

    The points of one `stretch` share the continuation parameter and the place to which the mesh is fixed.
    """

    state: State
    rates: Rates
    stretch: int = 0


# The unit of the load is at least this share of the load: near n = 2/3 the tail alone carries loads of 1e3 and more,
# on which steps in the unit of the contact are lost.
_SHARE_OF_LOAD = 0.05


@dataclass(frozen=True)
class ArcLength:
    """Units in which displacement and load enter the arc length; the continuation parameter enters as it is."""

    displacement_in_contact: float
    load_in_contact: float

    @classmethod
    def of(cls, problem: Problem) -> ArcLength:
        """Units of a problem, from the sizes of displacement and load in the two limits."""
        return cls(1.0 + problem.mu, 2.0 * max(1.0, problem.mu ** ((2.0 - problem.n) / problem.n)))

    def parameter_unit(self, state: State) -> float:
        """Unit of the continuation parameter: 1 for log c, the distance to the singular gap for the central gap."""
        return 1.0 if state.follows_edge else state.central_gap - state.disc.problem.law.singular_gap

    def displacement_unit(self, state: State) -> float:
        """Unit of the displacement: larger far apart, where the path is nearly straight."""
        return self.displacement_in_contact + max(state.central_gap, 0.0)

    def load_unit(self, state: State) -> float:
        """Unit of the load: larger where the load is much larger than in the two limits."""
        return max(self.load_in_contact, _SHARE_OF_LOAD * abs(state.load))

    def tangent(self, state: State) -> Rates:
        rates = rates_of(state)
        parameter = 1.0 / self.parameter_unit(state)
        norm = math.hypot(
            parameter, rates.displacement / self.displacement_unit(state), rates.load / self.load_unit(state)
        )
        return rates.scaled((1.0 if state.follows_edge else -1.0) / norm)

    def turn(self, a: Point, b: Point) -> float:
        """Cosine of the angle between the tangents at two points of one stretch."""

        def direction(point: Point) -> np.ndarray:
            state, rates = point.state, point.rates
            parameter = rates.log_scale if state.follows_edge else rates.central_gap
            units = (self.parameter_unit(state), self.displacement_unit(state), self.load_unit(state))
            return np.array([parameter, rates.displacement, rates.load]) / units

        return float(direction(a) @ direction(b))

    def control(self, state: State, tangent: Rates, step: float) -> Control:
        """The condition that the projection of the move on the tangent is `step`."""
        unit = self.parameter_unit(state) ** 2
        a = (tangent.log_scale if state.follows_edge else tangent.central_gap) / unit
        b = tangent.displacement / self.displacement_unit(state) ** 2
        c = tangent.load / self.load_unit(state) ** 2
        value = a * parameter_of(state) + b * state.displacement + c * state.load + step
        if state.follows_edge:
            return Control(value, log_scale=a, displacement=b, load=c)
        return Control(value, gap=a, displacement=b, load=c)


def parameter_of(state: State) -> float:
    """The continuation parameter: log c when the mesh follows the edge, else the central gap."""
    return math.log(state.scale) if state.follows_edge else state.central_gap


def parameter_control(state: State, value: float) -> Control:
    """The condition that the continuation parameter has a value."""
    return Control(value, log_scale=1.0) if state.follows_edge else Control(value, gap=1.0)


def rates_of(state: State) -> Rates:
    """Exact derivatives per unit of the continuation parameter."""
    return state.rates("log_scale" if state.follows_edge else "gap")
