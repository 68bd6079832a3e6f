"""Events of a path solved without condensation to the surface: the displacement of the whole mesh, by pyamg.

The condensed path finds an event.  There the whole system takes its last Newton steps: scikit-fem assembles the
traction on the surface facets, conjugate gradients preconditioned with pyamg give the displacement of the mesh under
it, and what the surface then lacks of the displacement that made the traction is the residual of a Newton step.  Its
tangent is that of the condensed system, its residual is not: at the end nothing is left of the condensed compliance but
the number of steps.  The rates along the path are solved in the same way, because a fold is where one of them vanishes.
All events of a problem are columns of one linear system.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from fem_reference._contact.event_equations import EventEquations
from fem_reference._contact.events import Jump, PathEvents, beginning_of
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.mesh_choice import MeshChoice
from fem_reference._contact.path import Point
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference._elastic.assembly import HalfSpace, half_space_of
from fem_reference._elastic.compliance import is_power_law, scaled_modulus, scaled_poisson
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_cg
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._typing import Array
from fem_reference.errors import NotConverged
from fem_reference.modulus import PowerLawModulus
from fem_reference.solids import Solid

__all__ = ["PointsAtEvents", "UncondensedEvents", "UncondensedValue", "uncondensed_events"]

#: Residual of the displacements, about their relative error in energy. Weighted with the adjoint of the event, that is
#: through the tangent and the slope of its condition, it leaves less of a value than the last step of the iteration
#: does, which is a part of the bound (measured: 1e-11 to 1e-9, of bounds of 1e-7): no tighter one is needed.
LINEAR_TOLERANCE = 1e-10

#: Residual that rounding may leave of the displacements: what it leaves of a value is a part of the bound (measured:
#: 3e-9 under a coating of 10 GPa and 30 nm on 1.5 MPa, 4e-10 of the force).
LINEAR_ROUNDING = 1e-6

#: Largest last step and defect, relative to the displacement. The condensed compliance is then right to as much for
#: this traction, and the next step would be smaller by that factor.
NEWTON_TOLERANCE = 1e-9

#: Step, relative to the displacement, that says that there is no equilibrium near the condensed one.
LARGEST_STEP = 0.1

#: Largest last step if rounding keeps the steps above the Newton tolerance (measured: 7e-10 under a cone, 1.4e-8 on
#: elements of a millionth of the radius, k = 0.69, mu = 7, and 2e-7 under a coating 700 times as stiff as the solid).
#: What it changes is in the distance from the condensed value, a part of the bound.
ROUNDING_STEP = 1e-5

#: Ratio of a step to the one before from which on rounding keeps the steps from falling: they fall by 1e3 or more.
SLOWEST = 0.5

#: Steps before giving up: the start is an equilibrium of the same mesh, and one step is usual.
NEWTON_STEPS = 6

#: Largest residual of the whole nonlinear system before the last step, relative to the traction, where the displacement
#: is up to one length of the law; it grows with the displacement, and with the last step where rounding keeps that
#: above the Newton tolerance. It is the Newton tolerance times the slope of the traction, some hundred tractions in a
#: length of the law.
RESIDUAL_TOLERANCE = 1e-6

#: Tractions in a length of the law up to which the slope of the traction is that of the tolerance of the residual. It
#: is in proportion to a larger one (measured at a Tabor number of 1000: 2e4, and a residual of 0.05 of 0.067).
STEEPNESS = 1e3


@dataclass(frozen=True, slots=True)
class UncondensedValue:
    """A quantity from the whole system.

    Attributes
    ----------
    value : float
        The quantity.
    algebra : float
        Its distance from the value of the condensed path, plus what the last step of conjugate gradients and the last
        residual change.
    iterations : int
        Conjugate-gradient iterations.
    residual : float
        Residual of the whole nonlinear system relative to the traction, the largest of the events of the quantity.
    """

    value: float
    algebra: float
    iterations: int
    residual: float


class PointsAtEvents:
    """Points of a path at its events.

    Parameters
    ----------
    points : mapping of str to Point
        By the names of the events.
    path : PathEvents or ResolvedEvents
        The path.
    """

    def __init__(self, points: Mapping[str, Point], path: PathEvents | ResolvedEvents) -> None:
        self.points, self._path = points, path

    def at(self, event: str) -> Point:
        """Return the point at an event."""
        return self.points[event]

    @property
    def jumps(self) -> tuple[Jump, ...]:
        """The jumps of the path."""
        return self._path.jumps


Functional = Callable[[PointsAtEvents], float]


class _Condensed(dict[str, Point]):
    """Points of the condensed path; those that were requested are the keys."""

    def __init__(self, path: PathEvents | ResolvedEvents) -> None:
        super().__init__()
        self._path = path

    def __missing__(self, name: str) -> Point:
        return self.setdefault(name, self._path.at(name))


class UncondensedEvents:
    """Events of a condensed path, each solved again on the whole mesh.

    Parameters
    ----------
    path : PathEvents or ResolvedEvents
        The condensed path, or its events.
    system : callable
        Returns the same problem on the same mesh.
    """

    def __init__(self, path: PathEvents | ResolvedEvents, system: Callable[[], FullSystem]) -> None:
        self._path, self._system = path, system
        self._points: dict[str, Point] = {}
        self._shifted: dict[str, Point] = {}

    def prepare(self, functionals: Iterable[Functional]) -> None:
        """Solve the events of several quantities together.

        Raises
        ------
        NoSuchEvent
            If the path lacks one of them.
        NotConverged
            If the whole system misses a tolerance.
        """
        condensed = _Condensed(self._path)
        for functional in functionals:
            functional(PointsAtEvents(condensed, self._path))
        missing = {name: point for name, point in condensed.items() if name not in self._points}
        if missing:
            # A jump ends at the displacement where it begins, which therefore comes first.
            for end in sorted(missing):
                begin = None if missing[end].held else beginning_of(end)
                if begin is not None:
                    missing = {begin: condensed[begin], **missing}
            self._solve(missing)

    def value(self, functional: Functional) -> UncondensedValue:
        """Return a quantity, with what is known of its algebraic error.

        Raises
        ------
        NoSuchEvent, NotConverged
            As `prepare`.
        """
        self.prepare((functional,))
        condensed = _Condensed(self._path)
        difference = functional(PointsAtEvents(condensed, self._path))
        value = functional(PointsAtEvents(self._points, self._path))
        left = abs(functional(PointsAtEvents(self._shifted, self._path)) - value)
        states = [self._points[name].state for name in condensed]
        return UncondensedValue(
            value,
            abs(value - difference) + left,
            max(state.iterations for state in states),
            max(state.residual for state in states),
        )

    def at(self, event: str) -> Point:
        """Return the state of the whole system at an event.

        Raises
        ------
        NoSuchEvent, NotConverged
            As `prepare`.
        """
        self.prepare((lambda points: points.points[event].state.load,))
        return self._points[event]

    def _solve(self, condensed: Mapping[str, Point]) -> None:
        """Take the last Newton steps at events, all at once."""
        system = self._system()
        surface = system.half_space.surface
        equations = {name: EventEquations(name, point) for name, point in condensed.items()}
        folds = [name for name, equation in equations.items() if equation.is_fold]
        columns = {
            name: (i, len(equations) + folds.index(name) if name in folds else None) for i, name in enumerate(equations)
        }
        start: Array | None = None
        iterations, step, half_space = 0, math.inf, system.half_space
        for _ in range(NEWTON_STEPS):
            loads = [system.load_vector(equation.y) for equation in equations.values()]
            loads += [system.load_vector_rate(equations[name].y, equations[name].rate) for name in folds]
            load = np.stack(loads, axis=1)
            if start is None and half_space.eliminations:
                # Below the surface the condensed state.
                compliance = next(iter(equations.values())).contact.compliance
                start = half_space.recovered(compliance.matrix @ load[surface])
            result = solve_cg(
                half_space,
                load,
                system.preconditioner,
                LINEAR_TOLERANCE,
                start=start,
                rounding=LINEAR_ROUNDING,
            )
            start, iterations = result.solution, iterations + result.iterations
            under = _columns(result.solution[surface], columns)
            controls = np.array([equation.controls for equation in equations.values()])
            # In order, because a jump ends where it begins.
            steps = [equation.step(*under[name], equations) for name, equation in equations.items()]
            before, step = step, float(np.max(steps))
            if step <= NEWTON_TOLERANCE or not step <= LARGEST_STEP or SLOWEST * before <= step <= ROUNDING_STEP:
                break
        if not step <= ROUNDING_STEP:
            raise NotConverged(
                f"the whole system is {step:.1e} of its displacement from the condensed equilibrium after Newton steps "
                "without convergence; take a finer accuracy"
            )
        matrix = next(iter(equations.values())).contact.compliance.matrix
        left = _columns(_left(half_space, load, result.solution, matrix), columns)
        shifted = {name: equation.copy() for name, equation in equations.items()}
        for name, equation in shifted.items():
            equation.shift(*left[name], shifted, equations)
        # The displacements that were solved last belong to the controls before the last step.
        deltas, sizes, factors = controls.T
        residuals = system.residuals(result, load, deltas, sizes, factors)
        solved = factors * result.solution[:, : len(equations)]
        for (name, equation), residual, u in zip(equations.items(), map(float, residuals), solved.T, strict=True):
            displacement = float(np.abs(equation.y[:-2]).max()) / equation.contact.law.z0
            limit = RESIDUAL_TOLERANCE * max(1.0, displacement) * max(1.0, step / NEWTON_TOLERANCE)
            if not residual <= limit:
                # A soft solid bears a pressure that is small for the law, whose slope is then large for it.
                steepness = equation.contact.law.z0 * system.steepness(u, *equation.y[-2:])
                limit *= max(1.0, steepness / STEEPNESS)
            if not residual <= limit:
                raise NotConverged(
                    f"the whole nonlinear system is left with a residual of {residual:.1e} of the traction, not "
                    f"{limit:.0e}; take a finer accuracy"
                )
            self._points[name] = equation.point_of(system, iterations, residual)
            self._shifted[name] = shifted[name].point_of(system, iterations, residual)


def _left(half_space: HalfSpace, load: Array, u: Array, compliance: Array) -> Array:
    """Displacement of the surface that a displacement of the mesh lacks under its load, shape (m, q).

    With U the displacement of the mesh under unit loads on its surface, it is U' (load - K u), whatever u is.
    """
    if not half_space.eliminations:
        surface_stiffness(half_space)
    return np.asarray(compliance @ half_space.gathered(half_space.remainder(load, u)))


def _columns(values: Array, columns: Mapping[str, tuple[int, int | None]]) -> dict[str, tuple[Array, Array | None]]:
    """Surface displacement of each event, and its rate if the event is a fold."""
    return {name: (values[:, i], None if j is None else values[:, j]) for name, (i, j) in columns.items()}


# As many as there are paths: an entry holds surface displacements only.
@lru_cache(maxsize=12)
def uncondensed_events(choice: MeshChoice, spec: MeshSpec, size: float) -> UncondensedEvents:
    """Return the events of a problem on a mesh, solved without condensation when they are needed.

    Parameters
    ----------
    choice : MeshChoice
    spec, size
        As for `MeshChoice.traced`.

    Returns
    -------
    UncondensedEvents

    Raises
    ------
    NotConverged
        If the path cannot be traced.
    """
    solid, punch, law = choice.problem.solid, choice.problem.punch, choice.problem.law

    def system() -> FullSystem:
        half_space, preconditioner = _preconditioned(*_unit(solid, size), spec)
        return FullSystem(half_space, punch, law, preconditioner)

    return UncondensedEvents(choice.traced(spec, size), system)


# One: its factors take some 300 MB on a mesh of 5e4 unknowns.
@lru_cache(maxsize=1)
def _preconditioned(modulus: Any, nu: Any, spec: MeshSpec) -> tuple[HalfSpace, ElasticPreconditioner]:
    half_space = half_space_of(modulus, nu, spec)
    return half_space, ElasticPreconditioner(half_space)


def _unit(solid: Solid, size: float) -> tuple[Any, Any]:
    """Modulus and Poisson ratio of the mesh, in units of the size; `factor` of the compliance is the rest."""
    if is_power_law(solid.modulus, solid.poisson):
        return PowerLawModulus(1.0, 1.0, solid.modulus.depth_exponent), solid.poisson
    return scaled_modulus(solid.modulus, size), scaled_poisson(solid.poisson, size)
