"""Arc length of the equilibrium path: continuation parameter, tangent and the condition of a step."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fscm._surface.anchors import AtEdge
from fscm._surface.linearisation import rates_by
from fscm._surface.response import largest_mu
from fscm._surface.state import Control, Rates, State
from fscm.problem import Problem

__all__ = ["ArcLength", "Point", "parameter_control", "parameter_of", "rate_of", "rates_of"]

#: Share of a large displacement or compressive load that is its unit.
_SHARE = 0.1
#: The unit of the load is at least this share of the load: near n = 2/3 the tail alone carries loads of 1e3 and more,
#: relative to which steps in the unit of the contact are negligible.
_SHARE_OF_LOAD = 0.05
#: Attribute of each continuation parameter in a state (but log c) and in its rates.
_NAMES = {"gap": "central_gap", "log_scale": "log_scale", "displacement": "displacement", "load": "load"}


@dataclass(frozen=True)
class Point:
    """A state on the path and its unit tangent in arc length, oriented from separation into contact.

    The points of one `segment` share the continuation parameter and the anchor of the mesh.
    """

    state: State
    rates: Rates
    segment: int = 0


@dataclass(frozen=True)
class ArcLength:
    """Units in which displacement and load enter the arc length; the continuation parameter enters as it is."""

    displacement_in_contact: float
    load_in_contact: float

    @classmethod
    def of(cls, problem: Problem) -> ArcLength:
        """Units of a problem, from the sizes of displacement and load in the two limits."""
        mu = largest_mu(problem)  # of a graded solid, where it is softest
        return cls(1.0 + mu, 2.0 * max(1.0, mu ** ((2.0 - problem.n) / problem.n)))

    def parameter_unit(self, state: State) -> float:
        """Unit of the continuation parameter: 1 for log c, the distance to the singular gap for the central gap."""
        return 1.0 if state.anchor.in_contact else state.central_gap - state.disc.problem.law.singular_gap

    def displacement_unit(self, state: State) -> float:
        """Unit of the displacement: larger far apart and far in contact, where the path is nearly straight."""
        return max(self.displacement_in_contact + max(state.central_gap, 0.0), _SHARE * state.displacement)

    def load_unit(self, state: State) -> float:
        """Unit of the load: larger far in contact, and where the load is much larger than in the two limits."""
        return max(self.load_in_contact, _SHARE * state.load, _SHARE_OF_LOAD * abs(state.load))

    def units(self, state: State) -> dict[str, float]:
        """Units of all quantities that enter the arc length, by name."""
        units = {state.anchor.parameter: self.parameter_unit(state)}
        units |= {"displacement": self.displacement_unit(state), "load": self.load_unit(state)}
        anchor = state.anchor
        if isinstance(anchor, AtEdge) and state.central_gap > anchor.gap_at(state.disc.problem, state.scale):
            # In contact on a ring, the surface inside the ring may move fast while the edge does not.
            units["gap"] = state.central_gap - state.disc.problem.law.singular_gap
        return units

    def tangent(self, state: State) -> Rates:
        rates = rates_of(state)
        shares = _shares(self.units(state), rates)
        if not state.turned:
            shares[state.parameter] = 1.0 / self.parameter_unit(state)
        return rates.scaled(state.orientation / math.hypot(*shares.values()))

    def shares(self, point: Point) -> dict[str, float]:
        """Components of the unit tangent, by name."""
        return _shares(self.units(point.state), point.rates)

    def turn(self, a: Point, b: Point) -> float:
        """Cosine of the angle between the tangents at two points of one segment."""
        shares_a, shares_b = self.shares(a), self.shares(b)
        return float(sum(shares_a[name] * shares_b[name] for name in shares_a if name in shares_b))

    def control(self, state: State, tangent: Rates, step: float) -> Control:
        """The condition that the projection of the move on the tangent is `step`."""
        row = {name: rate_of(tangent, name) / unit**2 for name, unit in self.units(state).items()}
        return Control(sum(a * _value(state, name) for name, a in row.items()) + step, **row)


def parameter_of(state: State) -> float:
    """The continuation parameter: log c when the mesh follows the edge, else the central gap, unless overridden."""
    return _value(state, state.parameter)


def parameter_control(state: State, value: float) -> Control:
    """The condition that the continuation parameter has a value."""
    return Control(value, **{state.parameter: 1.0})


def rates_of(state: State) -> Rates:
    """Exact derivatives per unit of the continuation parameter."""
    return rates_by(state, state.parameter)


def rate_of(rates: Rates, parameter: str) -> float:
    """Rate of a continuation parameter among all rates."""
    return float(getattr(rates, _NAMES[parameter]))


def _shares(units: dict[str, float], rates: Rates) -> dict[str, float]:
    return {name: rate_of(rates, name) / unit for name, unit in units.items()}


def _value(state: State, parameter: str) -> float:
    return math.log(state.scale) if parameter == "log_scale" else float(getattr(state, _NAMES[parameter]))
