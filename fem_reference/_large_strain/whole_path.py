"""The whole path of finite strain: a state for each one of the path of small strain."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.friction import FrictionName
from fem_reference._contact.states import Point, joined, point_at
from fem_reference._large_strain.discretisation import Discretisation, LinearEvent, linear_problem
from fem_reference._large_strain.equilibrium import State
from fem_reference._large_strain.error_parts import state_bounds
from fem_reference._large_strain.events import Family
from fem_reference.errors import NotConverged
from fem_reference.problem import Problem

__all__ = ["PathState", "path_states"]

#: Largest share of the picture of displacement and load between two states in contact: the last steps of the path of
#: small strain double the displacement.
_LARGEST_STEP = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class PathState:
    """A state of the path, the state of small strain from which it was found, and the bounds of both its coordinates.

    The bounds are those of the errors of displacement and load at this gap or this edge.
    """

    state: State
    linear: LinearEvent
    u_displacement: float
    u_load: float

    @property
    def edge_radius(self) -> float:
        """Material radius of the contact edge; nan before contact."""
        point = self.linear.point
        return point.edge_radius if point.branch.touching else math.nan


def path_states(
    problem: Problem,
    accuracy: float | str,
    friction: FrictionName,
    discretised: Callable[[LinearEvent], Discretisation],
) -> tuple[list[PathState], str]:
    """Return the states along the path, and why it ends earlier than that of small strain, or nothing.

    A linear solid can be compressed without an end.  Where a state of finite strain is not found after the load has
    become compressive, the path ends.

    Parameters
    ----------
    problem : Problem
    accuracy : float or str
    friction : {"none", "bonded"}
    discretised : callable
        Elements for a point of the path of small strain.

    Raises
    ------
    NotConverged
        If a state before that is not found, or not on one of the meshes of its bounds.
    """
    mesh = chosen(linear_problem(problem, friction), ("zero_load",), accuracy, lambda mesh: mesh.whole_path.points)
    states: list[PathState] = []
    in_contact = False
    for point in _refined(list(mesh.whole_path.points)):
        linear = LinearEvent(point, mesh.spec, mesh.size)
        try:
            path_state = _state_at(linear, discretised(linear))
        except NotConverged as error:
            if in_contact and states[-1].state.load > 0.0:
                return states, f"no equilibrium was found at the edge radius {linear.radius:.4g}: {error}"
            raise
        # The first contact edges of small strain may lie before the last gap of finite strain.
        in_contact = in_contact or not states or path_state.state.gap_at(0) < states[-1].state.gap_at(0)
        if in_contact or not point.branch.touching:
            in_contact = point.branch.touching
            states.append(path_state)
    return states, ""


def _state_at(linear: LinearEvent, discretisation: Discretisation) -> PathState:
    state = Family(discretisation, linear).state(0.0)
    return PathState(state.light, linear, *state_bounds(state, discretisation, linear))


def _refined(points: list[Point]) -> list[Point]:
    """Return the points with others between those in contact that are far apart."""
    curve = np.array([(point.state.displacement, point.state.load) for point in points])
    steps = np.linalg.norm(np.diff(curve / np.ptp(curve, axis=0), axis=0), axis=1)
    refined = points[:1]
    for a, b, step in zip(points[:-1], points[1:], steps.tolist(), strict=True):
        if a.branch.touching and joined(a, b):
            count = math.ceil(step / _LARGEST_STEP)
            for i in range(1, count):
                nearest = a if 2 * i <= count else b
                refined.append(point_at(nearest, a.parameter + i / count * (b.parameter - a.parameter)))
        refined.append(b)
    return refined
