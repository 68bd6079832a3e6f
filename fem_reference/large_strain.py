"""Quantities of a contact of finite strain, each with a bound of its error in parts."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fem_reference._contact.friction import FrictionName
from fem_reference._large_strain.discretisation import Discretisation, LinearEvent, linear_event
from fem_reference._large_strain.error_parts import estimate
from fem_reference._large_strain.events import Family, found_event
from fem_reference._large_strain.quantities import TABLE
from fem_reference._large_strain.whole_path import path_states
from fem_reference._threads import one_thread
from fem_reference._typing import Array
from fem_reference.accuracy import relative_error
from fem_reference.interaction import InteractionName, interaction_of
from fem_reference.problem import Problem
from fem_reference.punch import radius_at_height
from fem_reference.quantities import quantity_named
from fem_reference.result import Solution
from fem_reference.states import EquilibriumPath, RadialField

__all__ = [
    "LARGE_STRAIN_QUANTITIES",
    "LargeStrainPath",
    "profile_large_strain",
    "solve_large_strain",
    "trace_large_strain",
]

#: Names of the quantities of finite strain.
LARGE_STRAIN_QUANTITIES = tuple(TABLE)

#: Poisson's ratio from which on the pressure is an unknown of its own.
NEARLY_INCOMPRESSIBLE = 0.45

#: Side of the core in radii of the contact edge, and in those at which the punch is one length of the law high, since a
#: spot on which contact begins is much smaller than what attracts; where the solid is not a power law it is that of
#: small strain at least, whose exterior takes one.
CORE_EXTENT = 32.0

#: Side of the core in lengths 2 Y/E* of the surface tension, within which the surface resists as the solid does: the
#: exterior has none.
TENSION_EXTENT = 16.0

#: Height of the punch, in lengths of the law, at the end of the core at least.
CORE_HEIGHT = 1000.0

#: Resolved width of the contact edge in lengths of the law: on shorter elements the surface is resolved beyond what
#: the law acts on.
EDGE_WIDTH = 0.4

Form = Literal["auto", "displacement", "mixed"]


def _check(problem: Problem, friction: FrictionName, form: Form, interaction: InteractionName) -> None:
    """Refuse what finite strain has no answer for, before anything is computed.

    Raises
    ------
    ValueError
    """
    if friction not in ("none", "bonded"):
        raise ValueError(f"friction {friction!r} is unknown; choose 'none' or 'bonded'")
    if form not in ("auto", "displacement", "mixed"):
        raise ValueError(f"form {form!r} is unknown; choose 'auto', 'displacement' or 'mixed'")
    interaction_of(problem.punch, problem.law, interaction)
    if problem.punch_solid is not None:
        raise ValueError(
            f"punch_solid = {problem.punch_solid!r} cannot be had at finite strain, where displacements do not add and "
            "the punch is rigid; take `solve`, or leave it out"
        )
    if problem.solid.surface_exponent > 0.0:
        raise ValueError(
            "the modulus vanishes at the surface, where any tension makes short waves of a compressible surface "
            "unstable at finite strain; take a modulus that does not vanish, such as one with an offset z_s"
        )


def _discretisation(
    problem: Problem, event: LinearEvent, friction: FrictionName, form: Form, interaction: InteractionName = "auto"
) -> Discretisation:
    """Elements for an event."""
    largest = float(np.max(problem.solid.poisson(event.radius * np.geomspace(1e-6, 1e6, 200))))
    if form == "displacement" and largest >= 0.5:
        raise ValueError("form 'displacement' has no incompressible solid; choose 'mixed' or 'auto'")
    mixed = form == "mixed" or (form == "auto" and largest > NEARLY_INCOMPRESSIBLE)
    width = max(event.spec.edge_width, min(EDGE_WIDTH * problem.law.z0 / event.radius, 0.25))
    # The first layer is as deep for its width as that of small strain.
    depth = event.spec.surface_depth * width / event.spec.edge_width
    spec = replace(event.spec, edge_width=width, surface_depth=depth)
    attracting, reach = (radius_at_height(problem.punch, height * problem.law.z0) for height in (1.0, CORE_HEIGHT))
    stiffness = float(problem.solid.modulus(np.array(event.radius))) / (1.0 - largest**2)
    tense = TENSION_EXTENT * 2.0 * problem.solid.surface_tension / stiffness
    extent = max(CORE_EXTENT * max(event.radius, attracting), reach, tense) / event.radius
    if math.isfinite(problem.solid.surface_depth):
        extent = max(extent, spec.extent)
    force = interaction_of(problem.punch, problem.law, interaction)
    return Discretisation(problem, spec, event.size, extent, mixed, friction, force).at(event.radius)


def solve_large_strain(
    problem: Problem,
    quantity: str,
    accuracy: float | str = "quick",
    friction: FrictionName = "none",
    form: Form = "auto",
    interaction: InteractionName = "auto",
) -> Solution:
    """Compute one quantity of the contact with a neo-Hookean solid, with a bound on its numerical error.

    The energy per reference volume is psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2 with the constants of the solid.
    A pressure p acts normal to the deformed surface: the potential of the punch at the place of the point
    ("body"), or the law at the vertical gap H = f(r + u_r) - delta + u_z ("derjaguin").  The first is what the atoms of
    an incompressible solid do, and counts the work of adhesion for the true area of the contact; the second counts it
    for the projected area.  A surface tension Y of the solid has the energy Y times the true area of the surface.
    Beyond 32 contact radii the solid is linear, and extends to infinity.

    Parameters
    ----------
    problem : Problem
        In consistent units, with any solid or a `NeoHookean`, which may be incompressible.  The punch is not
        approximated; take `Ball` for a sphere.
    quantity : str
        One of `LARGE_STRAIN_QUANTITIES`.
    accuracy : float or str
        Selects the meshes, as for `solve`.
    friction : {"none", "bonded"}
        "bonded" is the opposite limit: no point of the surface changes its radius, inside and outside the contact.
    form : {"auto", "displacement", "mixed"}
        Whether the pressure is a separate unknown ("mixed"); "auto" is "mixed" for nu > 0.45.
    interaction : {"auto", "body", "derjaguin"}
        Where the surface force is taken, as for `Problem`.

    Returns
    -------
    Solution
        `u_num` is the sum of `parts`: "mesh", "first layer", "core" (extent of the nonlinear part, the exterior),
        "quadrature", "search" (of the event) and "algebra".  `degrees` and `values` are those of two degrees, and nan
        for the third.

    Raises
    ------
    ValueError
        For an unknown name, the form "displacement" for an incompressible solid, a modulus that vanishes at the
        surface, or the energy lost by a solid with surface tension.
    NoSuchEvent
        If the small-strain path, where the search begins, has no such event.
    NotConverged
        If no equilibrium is found: the surface of a compressible solid becomes unstable under a tension near half of
        its modulus, and any solid where it is compressed by a third.

    Examples
    --------
    >>> from fem_reference import Ball, LennardJones, NeoHookean, Problem, solve_large_strain
    >>> gel = Problem(NeoHookean(E0=150.0, nu=0.5), Ball(R=1.0), LennardJones(work_of_adhesion=1.0, z0=0.0146201))
    >>> solution = solve_large_strain(gel, "pull_off_force")
    >>> round(solution.value / np.pi, 4), solution.u_num < 1e-5  # 1.5322 at small strain and vertical gaps
    (1.5651, True)
    """
    if quantity not in TABLE:
        raise ValueError(f"quantity {quantity!r} is unknown; choose one of {', '.join(TABLE)}")
    relative_error(accuracy)
    _check(problem, friction, form, interaction)
    if quantity == "hysteresis_energy" and problem.solid.surface_tension:
        raise ValueError(
            "hysteresis_energy of finite strain has no bound with a surface_tension, whose energy differs by up to "
            "1e-3 between the meshes of two events; take a force or a displacement, or leave the tension out"
        )
    row, start = TABLE[quantity], time.perf_counter()
    with one_thread:
        linear = {name: linear_event(problem, name, accuracy, friction) for name in row.events}
        bases = {name: _discretisation(problem, event, friction, form, interaction) for name, event in linear.items()}
        result = estimate(linear, bases, row.functional, row.stationary)
    states = [event.state for event in result.events.values()]
    order = next(iter(bases.values())).spec.order
    return Solution(
        result.value,
        sum(result.parts.values()),
        max(state.block.core.size for state in states),
        0,
        max(state.residual for state in states),
        time.perf_counter() - start,
        (order - 2, order - 1, order),
        (float("nan"), result.lower_degree, result.value),
        result.parts,
        quantity_named(quantity).unit,
    )


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LargeStrainPath(EquilibriumPath):
    """The equilibrium path of finite strain; `edge_radius` is that of the material point before it was deformed.

    Attributes
    ----------
    u_displacement, u_load : ndarray
        Bounds of the numerical errors of each state at its central gap, or in contact at its edge radius.
    end : str
        Why the path ends earlier than that of small strain; empty if it does not.
    """

    u_displacement: Array
    u_load: Array
    end: str


def trace_large_strain(
    problem: Problem,
    accuracy: float | str = "quick",
    friction: FrictionName = "none",
    form: Form = "auto",
    interaction: InteractionName = "auto",
) -> LargeStrainPath:
    """Trace the equilibrium path of finite strain, a point for each one of small strain.

    A ball is pressed into a linear solid as deep as one likes.  Where the load is compressive and no state of finite
    strain is found, the path ends, and `LargeStrainPath.end` is the reason.

    Parameters
    ----------
    problem, accuracy, friction, form, interaction
        As for `solve_large_strain`.

    Returns
    -------
    LargeStrainPath

    Raises
    ------
    ValueError, NotConverged
        As `solve_large_strain`.

    Examples
    --------
    >>> from fem_reference import Ball, LennardJones, NeoHookean, Problem
    >>> stiff = Problem(NeoHookean(E0=50.0, nu=0.3), Ball(R=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0))
    >>> path = trace_large_strain(stiff)  # doctest: +SKIP
    """
    relative_error(accuracy)
    _check(problem, friction, form, interaction)

    def discretised(event: LinearEvent) -> Discretisation:
        return _discretisation(problem, event, friction, form, interaction)

    with one_thread:
        points, end = path_states(problem, accuracy, friction, discretised)
        return LargeStrainPath(
            np.array([point.state.displacement for point in points]),
            np.array([point.state.load for point in points]),
            np.array([point.state.gap_at(0) for point in points]),
            np.array([point.edge_radius for point in points]),
            np.array([point.u_displacement for point in points]),
            np.array([point.u_load for point in points]),
            end,
        )


def profile_large_strain(
    problem: Problem,
    event: str = "pull_off",
    accuracy: float | str = "quick",
    friction: FrictionName = "none",
    form: Form = "auto",
    interaction: InteractionName = "auto",
) -> RadialField:
    """Return gap, pressure and deformation of the deformed surface at an event.

    Parameters
    ----------
    problem, accuracy, friction, form, interaction
        As for `solve_large_strain`.
    event : str
        "pull_off", "jump_in", "jump_out" or "zero_load".

    Returns
    -------
    RadialField
        At the current radii of the Gauss points of the surface.

    Raises
    ------
    ValueError, NoSuchEvent, NotConverged
        As `solve_large_strain`.

    Examples
    --------
    >>> from fem_reference import Ball, LennardJones, NeoHookean, Problem, profile_large_strain
    >>> gel = Problem(NeoHookean(E0=150.0, nu=0.5), Ball(R=1.0), LennardJones(work_of_adhesion=1.0, z0=0.0146201))
    >>> surface = profile_large_strain(gel)
    >>> bool(surface.deformation[0] < 0.0 < surface.pressure[0])  # drawn out, compressed in the middle
    True
    """
    if event not in ("pull_off", "jump_in", "jump_out", "zero_load"):
        raise ValueError(f"event {event!r} is unknown; choose pull_off, jump_in, jump_out or zero_load")
    _check(problem, friction, form, interaction)
    with one_thread:
        linear = linear_event(problem, event, accuracy, friction)
        family = Family(_discretisation(problem, linear, friction, form, interaction), linear)
        state = found_event(event, family).state
    faces, size = state.faces, state.surface.size
    gap = size * faces.gap
    radius = size * faces.rho
    deformation = gap - np.asarray(problem.punch.height(radius)) + state.displacement
    pressure = state.surface.pressure(faces) * state.surface.modulus
    return RadialField(radius, gap, pressure, deformation, state.displacement, state.load)
