"""The whole path of finite strain: a state for each one of the path of small strain."""

from __future__ import annotations

import math
from collections.abc import Callable

from fem_reference._contact.mesh_choice import MeshChoice, chosen, followed_path
from fem_reference._contact.path import Point
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._large_strain.discretisation import Discretisation, LinearEvent, linear_problem
from fem_reference._large_strain.equilibrium import Friction, State
from fem_reference._large_strain.events import Family
from fem_reference.problem import Problem

__all__ = ["path_states"]


def path_states(
    problem: Problem, accuracy: float | str, friction: Friction, discretised: Callable[[LinearEvent], Discretisation]
) -> list[tuple[float, State]]:
    """Return material radius of the contact edge (nan before contact) and state along the path.

    Parameters
    ----------
    problem : Problem
    accuracy : float or str
    friction : {"frictionless", "bonded"}
    discretised : callable
        Elements for a point of the path of small strain.

    Raises
    ------
    NotConverged
        If a state is not found.
    """

    def followed(choice: MeshChoice, spec: MeshSpec, size: float) -> list[Point]:
        path = choice.path(spec, size) if choice.scaling else followed_path(choice).events()
        return list(path.points)

    choice, spec, size = chosen(linear_problem(problem, friction), ("zero_load",), accuracy, followed)
    states: list[tuple[float, State]] = []
    joined = False
    for point in followed(choice, spec, size):
        event = LinearEvent(point, spec, size)
        state = Family(discretised(event), event).state(0.0)
        # The first contact edges of small strain may lie before the last gap of finite strain.
        joined = joined or not states or state.gap_at(0) < states[-1][1].gap_at(0)
        if joined or not point.branch.touching:
            joined = point.branch.touching
            states.append((point.edge_radius if point.branch.touching else math.nan, state))
    return states
