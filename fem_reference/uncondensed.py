"""Solutions without condensation: quantities at the events of the finest mesh, solved by pyamg."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace

from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.uncondensed import UncondensedEvents
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.compliance import scaled_modulus
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._threads import one_thread
from fem_reference.errors import NoSuchEvent
from fem_reference.modulus import PowerLawModulus
from fem_reference.problem import Problem
from fem_reference.quantities import QUANTITIES, quantity_named
from fem_reference.solution import Solution, solve_together

__all__ = ["solve_uncondensed"]


def solve_uncondensed(
    problem: Problem, quantities: Iterable[str] = QUANTITIES, accuracy: float | str = "default"
) -> dict[str, Solution | NoSuchEvent]:
    """Compute quantities whose values are those of the whole nonlinear system, solved by pyamg.

    The condensed path finds each event; there all displacements of the finest mesh take the last Newton steps.  The
    difference from the condensed value is added to `u_num`.

    Parameters
    ----------
    problem, quantities, accuracy
        As for `fem_reference.solve_together`.

    Returns
    -------
    dict of str to Solution or NoSuchEvent
        As `fem_reference.solve_together`; `values` remain those of the condensed meshes.

    Raises
    ------
    ValueError, NotConverged
        As `fem_reference.solve_together`.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Problem, Solid, solve_uncondensed
    >>> stiff = Problem(Solid(E0=50.0, c0=1.0, k=0.0, nu=0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))
    >>> solution = solve_uncondensed(stiff, ("pull_off_force",), accuracy="quick")["pull_off_force"]
    >>> round(solution.value, 3), abs(solution.value - solution.values[-1]) < 1e-8
    (6.226, True)
    """
    begin = time.perf_counter()
    found = solve_together(problem, tuple(quantities), accuracy)
    existing = [name for name, solution in found.items() if isinstance(solution, Solution)]
    if not existing:
        return found
    with one_thread:
        # As `solve_together`: the meshes suit the first quantity that exists.
        choice, spec, size = chosen(problem, quantity_named(existing[0]).events, accuracy)
        spec = replace(spec, density=choice.level.densities[-1])
        events = UncondensedEvents(choice.traced(spec, size), _full_system(problem, spec, size))
        for name in existing:
            solution = found[name]
            if isinstance(solution, Solution):
                value = quantity_named(name).functional(events)
                found[name] = replace(solution, value=value, u_num=solution.u_num + abs(value - solution.value))
    seconds = time.perf_counter() - begin
    return {name: replace(s, seconds=seconds) if isinstance(s, Solution) else s for name, s in found.items()}


def _full_system(problem: Problem, spec: MeshSpec, size: float) -> FullSystem:
    """Assemble the whole half-space, in units of the size."""
    modulus = problem.solid.modulus
    unit = (
        PowerLawModulus(1.0, 1.0, modulus.k) if isinstance(modulus, PowerLawModulus) else scaled_modulus(modulus, size)
    )
    half_space = assemble_half_space(spec.grid(), unit, problem.solid.nu, spec.order)
    return FullSystem(half_space, problem.punch, problem.law)
