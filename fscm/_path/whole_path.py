"""Whole paths: from far separation to an end, on the meshes that the punch needs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

from fscm._path.arc_length import Point
from fscm._path.completeness import completed
from fscm._path.continuation import equilibrium_path
from fscm._path.ends import PathEnd, displacement_of_compression, refusal
from fscm._path.punch_rules import Tracking, rules_of
from fscm._path.surface_rings import ring_limit
from fscm._surface.breaks import end_radius
from fscm._surface.state import State
from fscm.accuracy import Mesh, Meshes
from fscm.errors import Failure, NotConverged, RingsForm
from fscm.problem import Problem
from fscm.wells import has_one_well

__all__ = ["MAX_POINTS", "bracketing_path", "path_by_any_mesh", "path_end", "path_until"]

#: Largest number of points of a path.  Measured: at most 120 of a bracketing path for n >= 1, but 300 to 750 at
#: n = 0.67.  Each takes 2 MB on such meshes.
MAX_POINTS = 1500
#: Mesh for a path that fails on the coarser one.  Measured: 4 of 700 problems, all with k > 0.78 and mu > 2.
_FINER = Mesh(10, 1e-4)
#: Heights of the punch up to which the end of a path is looked for where a barrier has to be passed, in those of the
#: mesh: on a soft solid the pressure of a barrier is that of a deep contact.
_OVER_BARRIERS = 1e3


def path_until(
    problem: Problem,
    order: int,
    tolerance: float,
    ended: Callable[[State], bool],
    end: str,
    most: int = MAX_POINTS,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
    tracking: Tracking | None = None,
) -> list[Point]:
    """Points of the path up to the first state for which `ended` holds.

    Parameters
    ----------
    problem, order, tolerance, longest_step, start_gap, end_height, tracking
        As for `equilibrium_path`.
    ended : callable
        State -> bool; called once for each state in their order.
    end : str
        Name of the end in the message of `NotConverged`.
    most : int
        Largest number of points.

    Raises
    ------
    NotConverged
        When the end is not reached.
    """
    points: list[Point] = []
    for point in equilibrium_path(problem, order, tolerance, longest_step, start_gap, end_height, tracking):
        points.append(point)
        if ended(point.state):
            return points
        if len(points) > most:
            break
    reached = points[-1].state
    raise NotConverged(
        f"the path of {problem} has not reached {end} in {most} steps: the last is at "
        f"delta = {reached.displacement:.6g}, P = {reached.load:.6g}",
        Failure.STEP,
    )


def path_by_any_mesh(
    problem: Problem,
    meshes: Sequence[Mesh],
    ended: Callable[[], Callable[[State], bool]],
    end: str,
    most: int = MAX_POINTS,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
    complete: Callable[[list[Point]], list[Point]] | None = None,
) -> list[Point]:
    """The points of `path_until`, completed, on a moving or a fixed mesh.

    A mesh that follows the edge is preferred, except for a punch with kinks.  A mesh of fixed scale is tried if the
    edge is wide.

    Parameters
    ----------
    problem, end, most, longest_step, start_gap, end_height
        As for `path_until`.
    meshes : sequence of Mesh
        Tried one after the other.
    ended : callable
        () -> condition that ends a new path.
    complete : callable, optional
        Inserts points where turning points may be missed; by default `fscm._path.completeness.completed`.

    Raises
    ------
    RingsForm
        When the surface comes into contact in rings, or may do so and no mesh reaches the end.
    NotConverged
        With the reason of the preferred choice on the last mesh.
    """
    for order, tolerance in meshes:
        finish = partial(completed, tolerance=tolerance) if complete is None else complete
        errors = []
        for tracking in rules_of(problem).trackings(problem):
            arguments = ended(), end, most, longest_step, start_gap, end_height, tracking
            try:
                return finish(path_until(problem, order, tolerance, *arguments))
            except RingsForm:
                raise
            except NotConverged as error:
                errors.append(error)
    rings = ring_limit(problem)
    if rings is not None:
        raise rings.refusal(problem) from errors[0]
    raise errors[0]


def bracketing_path(problem: Problem, meshes: Meshes) -> list[Point]:
    """The coarse path from far separation to a compressive load.

    It is completed, except for a power-law punch, between whose points turning points may be missed.
    """
    end = partial(path_end, problem, meshes.end_height)
    complete = None if rules_of(problem).may_hide_folds else list
    name, height = "a compressive load", meshes.end_height
    tried = [mesh for mesh in (meshes.path, _FINER) if mesh is meshes.path or mesh.tolerance < meshes.path.tolerance]
    return path_by_any_mesh(problem, tried, end, name, end_height=height, complete=complete)


def path_end(problem: Problem, end_height: float) -> PathEnd:
    """Condition that ends one path, beyond which no state carries tension; it stores the largest delta."""
    examined = end_height if has_one_well(problem.law) else _OVER_BARRIERS * end_height
    radius = end_radius(problem, examined)
    displacement = displacement_of_compression(problem, radius)
    if displacement == math.inf:
        raise refusal(problem, radius, f"of the path of {problem} it cannot be told where its last tension is")
    return PathEnd(displacement)
