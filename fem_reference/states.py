"""What lies behind a number: the equilibrium path, the state at an event, and its profile, on the finest mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem_reference._contact.events import locate
from fem_reference._contact.mesh_choice import MeshChoice, chosen
from fem_reference._contact.path import Point
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._threads import one_thread
from fem_reference._typing import Array
from fem_reference.laws import LennardJones
from fem_reference.punch import Punch
from fem_reference.solid import CustomSolid, Solid

__all__ = ["Path", "Profile", "event_state", "profile", "trace"]


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """The equilibrium path: arrays of approach, load (tension negative), gap at r = 0, edge radius."""

    displacement: Array
    load: Array
    central_gap: Array
    contact_radius: Array


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Surface state at a point of the path: radius, gap, pressure (compression positive), displacement."""

    r: Array
    gap: Array
    pressure: Array
    displacement: Array


def trace(solid: Solid | CustomSolid, punch: Punch, law: LennardJones, accuracy: str = "default") -> Path:
    """Walk the equilibrium path from far away until the load is compressive, on the finest mesh.

    Parameters
    ----------
    solid, punch, law, accuracy
        As for `fem_reference.solution.solve`.

    Returns
    -------
    Path
        In the units of the input.

    Raises
    ------
    ValueError
        For an unknown accuracy.
    NotConverged
        If the path cannot be followed.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Solid
    >>> stiff, sphere, law = Solid(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> path = trace(stiff, sphere, law, "quick")
    >>> bool(path.load[0] < 0 < path.load[-1]), round(float(path.load.min()), 2)
    (True, -6.22)
    """
    with one_thread:
        choice, spec, size = _finest(solid, punch, law, "zero_load_displacement", accuracy)
        points = choice.walked(spec, size)
        return Path(
            np.array([p.state.displacement for p in points]),
            np.array([p.state.load for p in points]),
            np.array([p.state.central_gap for p in points]),
            np.array([p.contact_radius for p in points]),
        )


def event_state(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantity: str = "pull_off_force",
    accuracy: str = "default",
) -> tuple[MeshSpec, Point]:
    """Equilibrium at an event on the finest mesh, with the mesh: what fields and cross-checks start from.

    Parameters
    ----------
    solid, punch, law, quantity, accuracy
        As for `fem_reference.solution.solve`.

    Returns
    -------
    spec : MeshSpec
        The finest mesh, in units of the edge radius.
    point : Point
        The equilibrium, in the units of the input.

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If an iteration misses its tolerance.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Solid
    >>> stiff, sphere, law = Solid(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> spec, point = event_state(stiff, sphere, law, "pull_off_force", "quick")
    >>> round(point.state.load, 3), spec.order
    (-6.226, 6)
    """
    with one_thread:
        choice, spec, size = _finest(solid, punch, law, quantity, accuracy)
        return spec, locate(choice.walked(spec, size), quantity)[1]


def profile(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantity: str = "pull_off_force",
    accuracy: str = "default",
    radii: Array | None = None,
) -> Profile:
    """Surface gap, pressure and displacement at an event, at the Gauss points or at the wanted radii.

    Parameters
    ----------
    solid, punch, law, quantity, accuracy
        As for `fem_reference.solution.solve`.
    radii : ndarray, shape (q,), optional
        Where, in the length unit of the input; the Gauss points of the surface mesh by default.

    Returns
    -------
    Profile

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy, or radii beyond the mesh.
    NotConverged
        If the path cannot be followed.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Solid
    >>> stiff, sphere, law = Solid(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    >>> surface = profile(stiff, sphere, law, "pull_off_force", "quick", radii=np.array([0.0, 3.0]))
    >>> bool(abs(surface.gap[1] - surface.gap[0] - 9 / 2) < 0.05)  # the sphere has risen 9/2, the solid hardly moved
    True
    """
    with one_thread:
        _, point = event_state(solid, punch, law, quantity, accuracy)
        mesh = point.leg.contact.compliance.trace
        y = point.state.y
        s = mesh.s if radii is None else np.asarray(radii, float) / y[-1]
        if s.min() < 0 or s.max() > mesh.extent:
            raise ValueError(
                f"radii up to {s.max() * y[-1]:.4g} leave the mesh, which ends at {mesh.extent * y[-1]:.4g}"
            )
        w = mesh.evaluate(s) @ y[:-2]
        gap = -y[-2] + punch.height(s * y[-1]) + w
        return Profile(s * y[-1], gap, law.traction(gap), w)


def _finest(
    solid: Solid | CustomSolid, punch: Punch, law: LennardJones, quantity: str, accuracy: str
) -> tuple[MeshChoice, MeshSpec, float]:
    """Choose the finest mesh for a quantity, and its size."""
    choice, spec, size = chosen(solid, punch, law, (quantity,), accuracy)
    return choice, replace(spec, density=choice.level.densities[-1]), size
