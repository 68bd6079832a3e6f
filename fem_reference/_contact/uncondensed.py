"""Events of a path solved without condensation to the surface: the displacement of the whole mesh, by pyamg.

The condensed path finds an event.  Newton's method for the whole system begins with the state of elements of a lower
degree there, and with no displacement below the surface: scikit-fem assembles the traction on the surface facets,
conjugate gradients preconditioned with pyamg give the displacement of the mesh under it, and what the surface then
lacks of the displacement that made the traction is the residual of a Newton step.  Its tangent is that of the condensed
system, its residual is not: at the end nothing is left of the condensed compliance but the number of steps.  The first
displacement is a rough one: what it leaves of its traction moves the surface by the condensed system, too, until the
traction belongs to that.  From there on conjugate gradients give every displacement, to their full tolerance.

The rates along the path are solved in the same way, because a fold is where one of them vanishes; where only the load
or displacement that is stationary there is asked for, the fold stays where the condensed path has it: the error of its
place enters by its square.  All events of a problem are columns of one linear system.  Two elastic bodies are two such
systems under the same tractions, and their displacements of the surface add.

The condensation of the same mesh, by another elimination, is the second opinion: what both differ by is a part of the
bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from fem_reference._contact.bodies import meshed_bodies
from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.contact import Contact
from fem_reference._contact.event_equations import EventEquations
from fem_reference._contact.event_kinds import beginning_of
from fem_reference._contact.event_mesh import EventMesh
from fem_reference._contact.events import PathEvents
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.quantity import Quantity
from fem_reference._contact.states import Point
from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.compliance import Addend
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._linear.linear_solver import LinearResult, solve_cg
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged

__all__ = ["UncondensedEvents", "UncondensedValue", "uncondensed_events"]

#: Residual of the displacements. Under a steep traction there are several steps (measured at a Tabor
#: number of 300: 1e-10 would leave 1e-7 of the force).
LINEAR_TOLERANCE = 1e-12

#: Residual at which rounding may keep the displacements: what it leaves of a value is a part of the bound (measured:
#: 1e-12 is reached at a Tabor number of 300, and under a coating 700 times as stiff as the solid).
LINEAR_ROUNDING = 1e-6

#: Largest last step and defect, relative to the displacement. The condensed compliance is then right to as much for
#: this traction, and the next step would be smaller by that factor.
NEWTON_TOLERANCE = 1e-10

#: Step, relative to the displacement, that says that there is no equilibrium near that of the lower degree (measured:
#: 3e-5 to 2e-3 for the first one, and 0.35 on elements far too coarse).
LARGEST_STEP = 0.5

#: Largest last step if rounding keeps the steps above the Newton tolerance (measured: 7e-10 under a cone, 1.4e-8 on
#: elements of a millionth of the radius, k = 0.69, mu = 7, and 2e-7 under a coating 700 times as stiff as the solid).
#: What it changes is in the distance from the condensed value, a part of the bound.
ROUNDING_STEP = 1e-5

#: Ratio of a step to the one before from which on rounding keeps the steps from falling: they fall by 1e3 or more.
SLOWEST = 0.5

#: Steps before giving up: two are usual.
NEWTON_STEPS = 8

#: Largest residual of the whole nonlinear system before the last step, relative to the traction, where the displacement
#: is up to one length of the law; it grows with the displacement, and with the last step where rounding keeps that
#: above the Newton tolerance. It is the Newton tolerance times the slope of the traction, some hundred tractions in a
#: length of the law.
RESIDUAL_TOLERANCE = 1e-7

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
    rounding : float
        Its distance from the value of the condensed path, plus what the displacement leaves of its load changes.
    iterations : int
        Conjugate-gradient iterations, the fewest of the events of the quantity; at least one.
    residual : float
        Residual of the whole nonlinear system relative to the traction, the largest of the events of the quantity.
    """

    value: float
    rounding: float
    iterations: int
    residual: float


class UncondensedEvents:
    """Events of a condensed path, each solved again on the whole mesh.

    Parameters
    ----------
    path : PathEvents or CarriedEvents
        The condensed path, or its events.
    other : Contact
        The same problem with elements of another degree or size, with whose states Newton's method begins.
    system : callable
        Returns the same problem on the same mesh.
    """

    def __init__(
        self,
        path: PathEvents | CarriedEvents,
        other: Contact,
        system: Callable[[], FullSystem],
    ) -> None:
        self._path, self._other, self._system = path, other, system
        self._points: dict[str, Point] = {}
        self._shifted: dict[str, Point] = {}
        self._placed: set[str] = set()

    def prepare(self, quantities: Iterable[Quantity]) -> None:
        """Solve the events of several quantities together.

        Raises
        ------
        NoSuchEvent
            If the path lacks one of them.
        NotConverged
            If the whole system misses a tolerance.
        """
        rows = tuple(quantities)
        self._prepare(
            dict.fromkeys(event for row in rows for event in row.events),
            {event for row in rows for event in row.placed},
        )

    def _prepare(self, events: Iterable[str], placed: Set[str]) -> None:
        """Solve events; those whose place does not matter stay where the condensed path has them."""
        known = {event for event in self._points if event not in placed or event in self._placed}
        missing = {event: self._path.at(event) for event in events if event not in known}
        # A jump ends at the displacement where it begins, which therefore comes first.
        for end in sorted(missing):
            begin = None if missing[end].pinned else beginning_of(end)
            if begin is not None:
                missing = {begin: self._path.at(begin), **missing}
        self._placed |= missing.keys() & placed
        missing |= {name: replace(point, pinned=True) for name, point in missing.items() if name not in self._placed}
        if missing:
            self._solve(missing)

    def value(self, quantity: Quantity) -> UncondensedValue:
        """Return a quantity, with what is known of its rounding.

        Raises
        ------
        NoSuchEvent, NotConverged
            As `prepare`.
        """
        self.prepare((quantity,))
        value = quantity.value(self._points.__getitem__)
        left = abs(quantity.value(self._shifted.__getitem__) - value)
        states = [self._points[event].state for event in quantity.events]
        return UncondensedValue(
            value,
            abs(value - quantity.value(self._path.at)) + left,
            min(state.iterations for state in states),
            max(state.residual for state in states),
        )

    def at(self, event: str) -> Point:
        """Return the state of the whole system at an event.

        Raises
        ------
        NoSuchEvent, NotConverged
            As `prepare`.
        """
        self._prepare((event,), {event})
        return self._points[event]

    def _solve(self, condensed: Mapping[str, Point]) -> None:
        """Solve events by Newton's method, all at once."""
        system = self._system()
        equations = {name: EventEquations(name, point, self._other) for name, point in condensed.items()}
        newton = _Newton(system, equations)
        newton.solve()
        shifted, residuals = newton.shifted(), newton.residuals()
        for name, equation in equations.items():
            self._points[name] = equation.point_of(system, newton.iterations[name], residuals[name])
            self._shifted[name] = shifted[name].point_of(system, newton.iterations[name], residuals[name])


class _Newton:
    """Newton's method for the whole system at several events, whose loads are columns of one linear system.

    Parameters
    ----------
    system : FullSystem
    equations : mapping of str to EventEquations
        By name, a jump before its end.
    """

    def __init__(self, system: FullSystem, equations: Mapping[str, EventEquations]) -> None:
        self._system, self._equations = system, equations
        self._folds = [name for name, equation in equations.items() if equation.is_fold]
        self.iterations = dict.fromkeys(equations, 0)
        self._step, self._load = math.inf, self._loads()
        self._results = [_at_rest(system.on_body(self._load, body)) for body in system.bodies]

    def solve(self) -> None:
        """Take Newton steps until they are small.

        Raises
        ------
        NotConverged
            If they are not after a number of them, or the displacement of an event took no iteration.
        """
        self._begin()
        for _ in range(NEWTON_STEPS):
            if not self._step <= LARGEST_STEP:
                break
            self._follow(LINEAR_TOLERANCE)
            before, self._step = self._step, self._newton_step()
            if self._step <= NEWTON_TOLERANCE or SLOWEST * before <= self._step <= ROUNDING_STEP:
                break
        if not self._step <= ROUNDING_STEP:
            raise NotConverged(
                f"the last Newton step of the whole system is {self._step:.1e} of its displacement, not "
                f"{NEWTON_TOLERANCE:g}",
                Failure.ITERATION,
            )
        if not all(self.iterations.values()):
            raise NotConverged(
                "the displacement of an event took no iteration of conjugate gradients", Failure.UNSOLVED
            )

    def _begin(self) -> None:
        """Step from the state of the lower degree to that of the condensed system."""
        for _ in range(NEWTON_STEPS):
            before, self._step = self._step, self._newton_step(self._lacking())
            if self._step <= NEWTON_TOLERANCE or not self._step <= min(LARGEST_STEP, SLOWEST * before):
                break

    def _lacking(self) -> Array:
        """Displacement that the surface lacks under its tractions, by the condensed bodies."""
        system, change = self._system, self._loads() - self._load
        bodies = zip(self._parts, system.bodies, self._results, strict=True)
        return np.asarray(
            sum(
                part.matrix @ _on_surface_of(body.half_space, result.remainder + system.on_body(change, body))
                for part, body, result in bodies
            )
        )

    def _newton_step(self, lacking: Array | float = 0.0) -> float:
        """Take a step of every event, from the displacement under its traction; return the largest."""
        equations = self._equations
        self._controls = np.array([equation.controls for equation in equations.values()]).T
        under = self._by_event(self._on_surface() + lacking)
        # In order, because a jump ends where it begins.
        return float(np.max([equation.step(*under[name], equations) for name, equation in equations.items()]))

    def _follow(self, tolerance: float) -> None:
        """Let the displacement of the mesh follow the tractions of the last step."""
        load, before, system = self._loads(), self._results, self._system
        # What the displacement leaves of the new load: it has left that remainder of the old one.
        changed = load - self._load
        loads = [
            system.on_body(changed, body) + result.remainder for body, result in zip(system.bodies, before, strict=True)
        ]
        # What was at rest has left the whole of its load, and its norm is that of the load.
        norms = [result.norm for result in before] if any(self.iterations.values()) else None
        changes = self._displaced(loads, tolerance, norms)
        self._load = load
        self._results = [
            replace(change, solution=result.solution + change.solution)
            for change, result in zip(changes, before, strict=True)
        ]

    def _displaced(
        self, loads: Sequence[Array], tolerance: float, norms: Sequence[Array] | None = None
    ) -> list[LinearResult]:
        """Solve for the displacement of the mesh of each body under its loads, and count the iterations."""
        each_norm: Sequence[Array | None] = norms or [None] * len(loads)
        results = [
            solve_cg(body.half_space, load, body.preconditioner, tolerance, norm=norm, rounding=LINEAR_ROUNDING)
            for body, load, norm in zip(self._system.bodies, loads, each_norm, strict=True)
        ]
        fewest = np.min([result.iterations for result in results], axis=0)
        for name, (of_state, of_rate) in self._by_event(fewest[None, :].astype(float)).items():
            self.iterations[name] += int(max(of_state[0], 0.0 if of_rate is None else of_rate[0]))
        return results

    @property
    def _parts(self) -> tuple[Addend, ...]:
        """The condensed bodies."""
        return next(iter(self._equations.values())).contact.compliance.parts

    def _on_surface(self) -> Array:
        """Displacement of the surface by all bodies, per unit factor of the compliance; shape (m, q)."""
        bodies = zip(self._parts, self._system.bodies, self._results, strict=True)
        return np.asarray(sum(part.share * result.solution[body.half_space.surface] for part, body, result in bodies))

    def shifted(self) -> dict[str, EventEquations]:
        """Return the events with the displacement changed by what it lacks under its traction."""
        bodies = zip(self._parts, self._system.bodies, self._results, strict=True)
        lacking = [
            part.matrix @ _left(body.half_space, self._system.on_body(self._load, body), result.solution)
            for part, body, result in bodies
        ]
        left = self._by_event(np.asarray(sum(lacking)))
        shifted = {name: equation.copy() for name, equation in self._equations.items()}
        for name, equation in shifted.items():
            equation.shift(*left[name], shifted, self._equations)
        return shifted

    def residuals(self) -> dict[str, float]:
        """Return what is left of the whole nonlinear systems, relative to their tractions.

        Raises
        ------
        NotConverged
            If that is more than the steepness of the traction explains.
        """
        system = self._system
        # The displacements that were solved last belong to the controls before the last step.
        deltas, sizes, factors = self._controls
        solved = factors * self._on_surface()[:, : len(self._equations)]
        residuals = system.residuals(self._results, self._load, solved, deltas, sizes)
        for equation, residual, w in zip(self._equations.values(), residuals, solved.T, strict=True):
            displacement = float(np.abs(equation.y[:-2]).max()) / equation.contact.law.z0
            limit = RESIDUAL_TOLERANCE * max(1.0, displacement) * max(1.0, self._step / NEWTON_TOLERANCE)
            if not residual <= limit:
                # A soft solid bears a pressure that is small for the law, whose slope is then large for it.
                steepness = equation.contact.law.z0 * system.steepness(system.on_surface(w), *equation.y[-2:])
                limit *= max(1.0, steepness / STEEPNESS)
            if not residual <= limit:
                raise NotConverged(
                    f"the whole nonlinear system is left with a residual of {residual:.1e} of the traction, not "
                    f"{limit:.0e}",
                    Failure.ITERATION,
                )
        return dict(zip(self._equations, map(float, residuals), strict=True))

    def _loads(self) -> Array:
        """Load vectors of all events, and then their rates at the folds."""
        system, equations = self._system, self._equations
        loads = [system.load_vector(equation.y) for equation in equations.values()]
        loads += [system.load_vector_rate(equations[name].y, equations[name].rate) for name in self._folds]
        return np.stack(loads, axis=1)

    def _by_event(self, columns: Array) -> dict[str, tuple[Array, Array | None]]:
        """Column of each event, and that of its rate if the event is a fold."""
        rates = dict(zip(self._folds, columns.T[len(self._equations) :], strict=True))
        return {name: (column, rates.get(name)) for name, column in zip(self._equations, columns.T, strict=False)}


def _at_rest(load: Array) -> LinearResult:
    """No displacement under loads, shape (2 N, q)."""
    count = load.shape[1]
    return LinearResult(np.zeros_like(load), load, np.ones(count), np.zeros(count, np.intp), 1.0, 0.0)


def _left(half_space: HalfSpace, load: Array, u: Array) -> Array:
    """Load on the surface that moves it by what a displacement of the mesh lacks under its load, shape (m, q).

    With U the displacement of the mesh under unit loads on its surface, that lacks U' (load - K u), whatever u is.
    """
    return _on_surface_of(half_space, half_space.remainder(load, u))


def _on_surface_of(half_space: HalfSpace, load: Array) -> Array:
    """Load on the surface that moves it as a load on the mesh does: shapes (m, q) and (2 N, q)."""
    if not half_space.eliminations:
        surface_stiffness(half_space)
    return half_space.gathered(load)


# As many as there are paths: an entry holds surface displacements only.
@lru_cache(maxsize=12)
def uncondensed_events(mesh: EventMesh) -> UncondensedEvents:
    """Return the events of a problem on a mesh, solved without condensation when they are needed.

    Parameters
    ----------
    mesh : EventMesh

    Returns
    -------
    UncondensedEvents

    Raises
    ------
    NotConverged
        If the path cannot be traced.
    """

    def system() -> FullSystem:
        problem = mesh.meshes.problem
        first, *others = meshed_bodies(problem.solids, mesh.spec, mesh.size)
        return FullSystem(first.half_space, problem.force, first.preconditioner, others)

    return UncondensedEvents(mesh.events, mesh.lower_contact, system)
