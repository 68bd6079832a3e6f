"""States of a contact problem on the mesh of an accuracy: the equilibrium path, one event, and the surface there.

The path is that of the condensed system.  An event and the surface there are those of the whole system (pyamg).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference._contact.event_kinds import EVENTS
from fem_reference._contact.event_mesh import chosen, whole_path
from fem_reference._contact.friction import FrictionName, with_friction
from fem_reference._contact.states import Point
from fem_reference._contact.turning import turning_slowly
from fem_reference._contact.uncondensed import uncondensed_events
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._presentation import Columns
from fem_reference._threads import one_thread
from fem_reference._typing import Array
from fem_reference.interaction import InteractionName
from fem_reference.problem import Problem

__all__ = ["EVENTS", "EquilibriumPath", "RadialField", "event_state", "profile", "trace"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class EquilibriumPath(Columns):
    """The equilibrium path; each array has one entry per point.

    Attributes
    ----------
    displacement : ndarray
        Approach delta.
    load : ndarray
        P, tension negative.
    central_gap : ndarray
        Gap at r = 0.
    edge_radius : ndarray
        Radius of the largest tension; nan while the central gap is above the gap of largest tension.
    """

    _over, _drawn = "displacement", "load"

    displacement: Array
    load: Array
    central_gap: Array
    edge_radius: Array


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RadialField(Columns):
    """The surface at a point of the path.

    Attributes
    ----------
    radius : ndarray
        Radii.
    gap, pressure, deformation : ndarray
        Gap, pressure (compression positive) and displacement of the solid at those radii; of two elastic bodies their
        displacements together.
    displacement, load : float
        Approach delta and load P (tension negative) of the point.
    """

    _over, _drawn, _least_share = "radius", "pressure", 1e-3

    radius: Array
    gap: Array
    pressure: Array
    deformation: Array
    displacement: float
    load: float


def trace(
    problem: Problem,
    accuracy: float | str = "default",
    largest_turn: float | None = None,
    *,
    friction: FrictionName = "none",
    interaction: InteractionName | None = None,
) -> EquilibriumPath:
    """Trace the equilibrium path from far away until the load is compressive.

    In contact each radius of the edge has a mesh of its own; those of a power law share one compliance.

    Parameters
    ----------
    problem, accuracy, friction
        As for `fem_reference.solve`.
    largest_turn : float, optional
        Angle in degrees, in (0, 180]: points are inserted until the plotted curve of load over displacement turns by
        less from one point to the next.
    interaction : str, optional
        In place of that of the problem (see `fem_reference.solve`).

    Returns
    -------
    EquilibriumPath
        In the units of the input.

    Raises
    ------
    ValueError
        For an unknown accuracy or friction, or an angle outside its range.
    NotConverged
        If the path cannot be followed.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, PowerLaw
    >>> stiff = Problem(PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    >>> path = trace(stiff, "quick")
    >>> bool(path.load[0] < 0 < path.load[-1]), round(float(path.load.min()), 1)
    (True, -6.2)
    """
    if largest_turn is not None and not 0.0 < largest_turn <= 180.0:
        raise ValueError(f"largest_turn = {largest_turn} is outside (0, 180]: it is an angle in degrees")
    with one_thread:
        path = whole_path(
            with_friction(problem if interaction is None else problem.under(interaction), friction), accuracy
        )
        points = path.points if largest_turn is None else turning_slowly(path, largest_turn)
        return EquilibriumPath(
            np.array([p.state.displacement for p in points]),
            np.array([p.state.load for p in points]),
            np.array([p.state.central_gap for p in points]),
            np.array([p.edge_radius if p.branch.touching else np.nan for p in points]),
        )


def event_state(
    problem: Problem, event: str = "pull_off", accuracy: float | str = "default", friction: FrictionName = "none"
) -> tuple[MeshSpec, Point]:
    """Return the equilibrium at an event, with the mesh.

    Parameters
    ----------
    problem, accuracy, friction
        As for `fem_reference.solve`.
    event : str
        One of `EVENTS`.

    Returns
    -------
    spec : MeshSpec
        The mesh, in units of the edge radius.
    point : Point
        The equilibrium, in the units of the input.

    Raises
    ------
    ValueError
        For an unknown event or accuracy.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If an iteration misses its tolerance.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, PowerLaw
    >>> stiff = Problem(PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    >>> spec, point = event_state(stiff, "pull_off", "quick")
    >>> round(point.state.load, 3), spec.order
    (-6.226, 6)
    """
    if event not in EVENTS:
        raise ValueError(f"event {event!r} is unknown; choose one of {', '.join(EVENTS)}")
    with one_thread:
        mesh = chosen(with_friction(problem, friction), (event,), accuracy, lambda mesh: mesh.events)
        return mesh.spec, uncondensed_events(mesh).at(event)


def profile(
    problem: Problem,
    event: str = "pull_off",
    accuracy: float | str = "default",
    radii: Array | None = None,
    friction: FrictionName = "none",
) -> RadialField:
    """Return gap, pressure and deformation of the surface at an event.

    Parameters
    ----------
    problem, accuracy, friction
        As for `fem_reference.solve`.
    event : str
        One of `EVENTS`.
    radii : ndarray, shape (q,), optional
        Where, in the length unit of the input; the Gauss points of the surface mesh by default.

    Returns
    -------
    RadialField

    Raises
    ------
    ValueError
        For an unknown event or accuracy, or radii beyond the mesh.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If the path cannot be followed.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, PowerLaw
    >>> stiff = Problem(PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    >>> surface = profile(stiff, "pull_off", "quick", radii=np.array([0.0, 3.0]))
    >>> bool(abs(surface.gap[1] - surface.gap[0] - 9 / 2) < 0.05)  # the sphere rises 9/2, the solid deforms little
    True
    """
    with one_thread:
        _, point = event_state(problem, event, accuracy, friction)
        mesh = point.branch.contact.compliance.trace
        y = point.state.y
        s = mesh.s if radii is None else np.asarray(radii, float) / y[-1]
        if not (s.min() >= 0 and s.max() <= mesh.extent):
            raise ValueError(
                f"radii from {s.min() * y[-1]:.4g} to {s.max() * y[-1]:.4g} are not all on the mesh, which extends "
                f"from 0 to {mesh.extent * y[-1]:.4g}"
            )
        w = mesh.evaluate(s) @ y[:-2]
        gap = -y[-2] + problem.punch.height(s * y[-1]) + w
        pressure = problem.force.traction(s * y[-1], gap)
        return RadialField(s * y[-1], gap, pressure, w, point.state.displacement, point.state.load)
