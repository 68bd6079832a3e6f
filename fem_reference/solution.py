"""Quantities of a contact problem, each computed on meshes that suit it."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial

from fem_reference._contact.critical import stiffer_than_critical
from fem_reference._contact.event_kinds import JUMP_IN
from fem_reference._contact.event_mesh import EventMesh, chosen, whole_path
from fem_reference._contact.friction import FrictionName, with_friction
from fem_reference._contact.mesh_lengths import scales
from fem_reference._contact.parts import EventsOnMeshes, events_on_meshes
from fem_reference._contact.quantity import Quantity
from fem_reference._contact.uncondensed import uncondensed_events
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._threads import one_thread
from fem_reference.accuracy import coarser_accuracy, relative_error
from fem_reference.errors import AccuracyWarning, NoSuchEvent, NotConverged
from fem_reference.interaction import InteractionName
from fem_reference.problem import Problem, checked_problem
from fem_reference.punch import check_contact
from fem_reference.quantities import (
    CRITICAL_MODULUS,
    QUANTITIES,
    TABLE,
    critical_quantity,
    further_losses,
    quantity_named,
)
from fem_reference.result import Solution

__all__ = ["solve", "solve_together"]

#: Share of an accuracy that the meshes of a critical modulus are made for: where the folds merge both rates vanish, so
#: that an error of the mesh counts more than in a force (measured at n = 2, k = 0.4: the bound is 1.0e-7 of the Tabor
#: number on meshes for 1e-7, and 0.7e-8 on those for 3e-8).
CUSP_SHARE = 0.3


def solve(
    problem: Problem,
    quantity: str,
    accuracy: float | str = "default",
    *,
    friction: FrictionName = "none",
    interaction: InteractionName | None = None,
) -> Solution:
    """Compute one quantity with a bound on its numerical error.

    Parameters
    ----------
    problem : Problem
        In consistent units.
    quantity : str
        One of `QUANTITIES` or `LOSSES`, or `CRITICAL_MODULUS`.
    accuracy : float or str
        Requested relative error, in [1e-8, 1), or one of `ACCURACIES`.  It selects the meshes; `u_num` bounds the
        actual error.  Finer meshes are used where the path cannot be traced.  A value at an accuracy finer than
        "default" that misses it is also computed at "default", and the one with the smaller `u_num` is returned.  If
        the bound exceeds a requested number, an `AccuracyWarning` says so.
    friction : {"none", "bonded"}
        "bonded": no point of the surface changes its radius, inside and outside the contact.  This is at least as stiff
        as any bond of the part in contact.
    interaction : str, optional
        In place of that of the problem: "derjaguin", "body" or "auto" (see `Problem`).

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        For an unknown quantity, accuracy, friction or interaction, an interaction that is not known for this punch and
        law, an elastic punch that is bonded, or the critical modulus of two bodies or of a solid with surface tension.
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If an iteration misses its tolerance.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, PowerLaw, solve
    >>> sphere, law = PowerPunch(n=2.0, Q=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0)
    >>> stiff = PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3)
    >>> solution = solve(Problem(stiff, sphere, law), "pull_off_force", accuracy=1e-6)
    >>> round(solution.value, 3), solution.u_num < 1e-5  # Bradley's 2 pi for a rigid solid
    (6.226, True)
    """
    result = solve_together(problem, (quantity,), accuracy, friction=friction, interaction=interaction)[quantity]
    if isinstance(result, NoSuchEvent):
        raise result
    return result


def solve_together(
    problem: Problem,
    quantities: Iterable[str] = QUANTITIES,
    accuracy: float | str = "default",
    *,
    friction: FrictionName = "none",
    interaction: InteractionName | None = None,
) -> dict[str, Solution | NoSuchEvent]:
    """Compute several quantities on the same meshes, tracing each path once.

    Parameters
    ----------
    problem, accuracy, friction, interaction
        As for `solve`.
    quantities : iterable of str
        Of `QUANTITIES`, `LOSSES` and `CRITICAL_MODULUS`; all of `QUANTITIES` by default.  The mesh is made for the
        first of them that exists, other than the jump into contact.  In a solid that is not a power law, quantities
        whose contact edge this mesh does not resolve get a mesh of their own, as does the critical modulus.

    Returns
    -------
    dict of str to Solution or NoSuchEvent
        In the order of `quantities`; a quantity that the path does not have gives the exception, which is not raised.
        `seconds` is the time of all quantities together.

    Raises
    ------
    ValueError, NotConverged
        As `solve`, if one of them fails.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, PowerLaw
    >>> stiff = Problem(PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    >>> found = solve_together(stiff, ("pull_off_force", "jump_in_gap"), accuracy="quick")
    >>> round(found["pull_off_force"].value, 3)  # Bradley's 2 pi for a rigid solid
    6.226
    >>> found["jump_in_gap"]
    NoSuchEvent('the displacement rises all along the path: this solid is too stiff for jumps')
    """
    if isinstance(quantities, str):
        raise ValueError(f"quantities = {quantities!r} is one name: give several as a list, or call solve for one")
    problem = with_friction(checked_problem(problem).under(interaction), friction)
    rows = {name: quantity_named(name) for name in quantities}
    if not rows:
        raise ValueError(f"no quantity is named; choose at least one of {', '.join(TABLE)}")
    results: dict[str, Solution | NoSuchEvent] = {}
    with one_thread:
        of_problem = {name: row for name, row in rows.items() if name != CRITICAL_MODULUS}
        if of_problem:
            results |= _no_less_certain(problem, of_problem, accuracy)
        if CRITICAL_MODULUS in rows:
            results[CRITICAL_MODULUS] = _critical_modulus(problem, accuracy)
    if not isinstance(accuracy, str):
        _say_what_is_missed(results, float(accuracy))
    return {name: results[name] for name in rows}


def _say_what_is_missed(solutions: dict[str, Solution | NoSuchEvent], accuracy: float) -> None:
    """Warn of bounds above a relative error that was asked for; the names of accuracies select meshes only."""
    for name, solution in solutions.items():
        if isinstance(solution, Solution) and solution.u_num > accuracy * abs(solution.value):
            warnings.warn(
                f"accuracy = {accuracy:g} is not reached for the {name}: its bound is "
                f"{solution.u_num / abs(solution.value):.1e} of it",
                AccuracyWarning,
                stacklevel=3,
            )


def _no_less_certain(
    problem: Problem, rows: Mapping[str, Quantity], accuracy: float | str
) -> dict[str, Solution | NoSuchEvent]:
    """Compute quantities, those that miss an accuracy finer than "default" there as well; the more certain one stays.

    On the finer mesh the bound may be larger: it is what the degrees happen to show.
    """
    results = _by_addends(problem, rows, accuracy)
    coarser = coarser_accuracy(accuracy)
    if coarser is None:
        return results
    solved = {name: solution for name, solution in results.items() if isinstance(solution, Solution)}
    uncertain = [name for name, solution in solved.items() if solution.u_num > coarser[0] * abs(solution.value)]
    at_default: dict[str, Solution | NoSuchEvent] = {}
    if uncertain:
        with suppress(NotConverged):
            at_default = _by_addends(problem, {name: rows[name] for name in uncertain}, coarser[1])
    for name, alternative in at_default.items():
        if isinstance(alternative, Solution):
            seconds = solved[name].seconds + alternative.seconds
            best = min(solved[name], alternative, key=lambda solution: solution.u_num)
            results[name] = replace(best, seconds=seconds)
    return results


def _by_addends(
    problem: Problem, rows: Mapping[str, Quantity], accuracy: float | str
) -> dict[str, Solution | NoSuchEvent]:
    """Compute quantities, those of several contact edges as a sum where no mesh is fine at more than one."""
    single: dict[str, Quantity] = {}
    for name, row in rows.items():
        addends = () if scales(problem) else row.addends
        single |= {addend: quantity_named(addend) for addend in addends} or {name: row}
    # A jump into contact before there is an edge gets a path without contact, on which no other event is.
    single = dict(sorted(single.items(), key=lambda item: item[1].events[0] == JUMP_IN))
    solved = _solved_together(problem, single, accuracy)
    parts = {name: (name,) if name in single else row.addends for name, row in rows.items()}
    sums = {name: _sum(solved[part] for part in names) for name, names in parts.items()}
    for name, solution in sums.items():
        if rows[name].addends and isinstance(solution, Solution):
            further = further_losses(whole_path(problem, accuracy))
            if further:
                sums[name] = _sum((solution, *_solved_together(problem, further, accuracy).values()))
    return sums


def _sum(terms: Iterable[Solution | NoSuchEvent]) -> Solution | NoSuchEvent:
    """Add quantities, or return why one of them does not exist."""
    total, *addends = terms
    for addend in addends:
        if isinstance(total, NoSuchEvent) or isinstance(addend, NoSuchEvent):
            return total if isinstance(total, NoSuchEvent) else addend
        total = total.plus(addend)
    return total


def _critical_modulus(problem: Problem, accuracy: float | str) -> Solution | NoSuchEvent:
    """Compute the critical modulus on the meshes of a slightly stiffer problem."""
    begin = time.perf_counter()
    try:
        accuracy = max(CUSP_SHARE * relative_error(accuracy), relative_error("fine"))
        stiffer = stiffer_than_critical(problem, accuracy)
    except NoSuchEvent as reason:
        return reason.with_traceback(None)
    row = critical_quantity(stiffer.E0)
    solution = _solved_together(stiffer.problem, {CRITICAL_MODULUS: row}, accuracy, stiffer.start)[CRITICAL_MODULUS]
    return replace(solution, seconds=time.perf_counter() - begin) if isinstance(solution, Solution) else solution


def _solved_together(
    problem: Problem, rows: Mapping[str, Quantity], accuracy: float | str, start: tuple[MeshSpec, float] | None = None
) -> dict[str, Solution | NoSuchEvent]:
    """Compute quantities whose path is that of the problem, on meshes found from `start`."""
    begin = time.perf_counter()
    results: dict[str, Solution | NoSuchEvent] = {}
    missed: dict[str, NotConverged] = {}
    force_alone = all(row.kind == "force" for row in rows.values())
    for name, row in rows.items():
        try:
            mesh = chosen(problem, row.events, accuracy, partial(_estimated, row), start, force_alone)
        except NoSuchEvent as reason:
            results[name] = reason.with_traceback(None)
        else:
            break
    else:
        return results
    meshes = events_on_meshes(mesh)
    for name, row in rows.items():
        if name not in results:
            try:
                results[name] = _solution(row, meshes)
            except NoSuchEvent as reason:
                results[name] = reason.with_traceback(None)
            except NotConverged as reason:
                missed[name] = reason
    solved = {name: solution for name, solution in results.items() if isinstance(solution, Solution)}
    unresolved = _unresolved(mesh, rows, solved, missed)
    # All events of the whole system are columns of one linear system.
    events = uncondensed_events(mesh)
    on_mesh = [name for name in solved if name not in unresolved]
    events.prepare(rows[name] for name in on_mesh)
    seconds = time.perf_counter() - begin
    for name in on_mesh:
        results[name] = replace(solved[name].with_whole_system(events.value(rows[name])), seconds=seconds)
    if unresolved:
        results |= _solved_together(problem, unresolved, accuracy)
    for name, failure in missed.items():
        if name not in results:
            raise failure
    return results


def _estimated(row: Quantity, mesh: EventMesh) -> None:
    """Solve a quantity on the condensed system of all meshes, which keep the states.

    If one mesh does not carry the path, also on the whole system, which may not resolve the rates at a narrow edge.
    """
    with suppress(NoSuchEvent):
        _solution(row, events_on_meshes(mesh))
        if not mesh.meshes.scale:
            uncondensed_events(mesh).prepare((row,))


def _unresolved(
    mesh: EventMesh, rows: Mapping[str, Quantity], solved: Iterable[str], missed: Iterable[str]
) -> dict[str, Quantity]:
    """Quantities whose contact edge is not resolved on the mesh of another event, or which that mesh has missed.

    The quantities of the jump out of contact come first: before the jump into contact there is no edge, and the mesh of
    the other jump is fine enough for it.
    """
    candidates = [name for name in rows if name in solved or name in missed]
    elsewhere = [name for name in candidates if rows[name].events[0] != rows[candidates[0]].events[0]]
    poor = [name for name in elsewhere if name in missed or not mesh.resolves(rows[name].events[0])]
    return {name: rows[name] for name in sorted(poor, key=lambda name: rows[name].events[0] != "jump_out")}


def _solution(row: Quantity, meshes: EventsOnMeshes) -> Solution:
    """Evaluate a quantity on the condensed system of all meshes."""
    estimate = meshes.estimate(lambda events: row.value(events.at))
    for event in row.events:
        point = meshes.fine.at(event)
        check_contact(point.branch.contact.punch, point.edge_radius)
    unknowns = meshes.fine.at(row.events[0]).branch.contact.compliance.unknowns
    u_num = math.fsum(estimate.parts.values())
    values, parts = estimate.values, estimate.parts
    return Solution(values[-1], u_num, unknowns, 0, 0.0, 0.0, meshes.degrees, values, parts, row.unit)
