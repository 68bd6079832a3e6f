"""Quantities of a problem by name."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from fscm._threads import one_thread
from fscm.accuracy import Accuracy, Meshes
from fscm.analysis import Analysis
from fscm.errors import NoSuchEvent
from fscm.problem import Problem, checked_problem
from fscm.quantities import QUANTITIES, quantity_named
from fscm.solution import Solution

if TYPE_CHECKING:
    from fscm.gibson import GibsonSolid

__all__ = ["QUANTITIES", "solve", "solve_together"]


def _model(problem: Problem, accuracy: Accuracy) -> Analysis | GibsonSolid:
    meshes = Meshes.of(accuracy)
    if problem.k < 1.0:
        return Analysis(problem, meshes)
    from fscm.gibson import GibsonSolid

    return GibsonSolid(problem)


@one_thread()
def solve(
    problem: Problem, quantity: str, accuracy: Accuracy = "default", *, interaction: str | None = None
) -> Solution:
    """Compute one quantity with its numerical uncertainty; k = 1 is solved as the Gibson solid.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `QUANTITIES`.
    accuracy : float or str
        Requested relative error, between 1e-10 and 1e-4, or its name in `ACCURACIES`.  It selects the meshes: it is
        reached nearly always, and `u_num` bounds the error in any case.  If `u_num` exceeds a request above 1e-8, the
        value is computed again at the default.  The Gibson solid is exact to rounding.
    interaction : str, optional
        In place of that of the problem: "derjaguin" or "body".

    Returns
    -------
    Solution
        In the units of a physical problem.  Of a dimensionless one loads are in pi Q^(2/n) dgamma z0^(2/n-1),
        displacements and gaps in z0, energies in pi Q^(2/n) dgamma z0^(2/n).

    Raises
    ------
    ValueError
        For an unknown quantity or accuracy, or an interaction that is not known for punch and law.
    NoSuchEvent
        When the path has no such event, e.g. no jump below the critical Tabor number.
    NotConverged

    Examples
    --------
    >>> round(solve(Problem(n=2, k=0, mu=1.0), "pull_off_force").value, 8)
    1.67066478
    >>> round(solve(Problem(n=2, k=0, mu=1.0), "pull_off_force", accuracy=1e-5).value, 5)
    1.67066

    Newtons, from a physical problem in SI:

    >>> from fscm import LennardJones, PowerLaw, PowerPunch
    >>> pad, law = PowerLaw(E0=2e9, c0=1e-6, k=0.4, nu=0.3), LennardJones(work_of_adhesion=0.05, z0=0.5e-9)
    >>> round(solve(Problem(pad, PowerPunch(n=2, Q=100e-9), law), "pull_off_force").value * 1e9, 6)
    27.066203
    """
    problem = checked_problem(problem).under(interaction)
    kind = quantity_named(quantity).kind
    solution = _model(problem.dimensionless, accuracy).solution(quantity)
    return solution.times(problem.units[kind], problem.unit_name(kind))


@one_thread()
def solve_together(
    problem: Problem,
    quantities: Iterable[str] = QUANTITIES,
    accuracy: Accuracy = "default",
    *,
    interaction: str | None = None,
) -> dict[str, Solution | NoSuchEvent]:
    """Compute several quantities on one path.

    Parameters
    ----------
    problem, accuracy, interaction
        As for `solve`.
    quantities : iterable of str
        Of `QUANTITIES`; all of them by default.

    Returns
    -------
    dict
        Quantity -> `Solution`, or, for a quantity that the problem does not have, the `NoSuchEvent` that `solve`
        would raise; in the order of `quantities`.

    Raises
    ------
    ValueError, NotConverged
        As for `solve`.

    Examples
    --------
    >>> found = solve_together(Problem(n=2, k=0, mu=0.5), ["pull_off_force", "jump_in_gap"])
    >>> round(found["pull_off_force"].value, 8), type(found["jump_in_gap"]).__name__
    (1.78748293, 'NoSuchEvent')
    """
    if isinstance(quantities, str):
        raise ValueError(f"quantities = {quantities!r} is one name: give several as a list, or call solve for one")
    problem = checked_problem(problem).under(interaction)
    kinds = {name: quantity_named(name).kind for name in quantities}
    model = _model(problem.dimensionless, accuracy)
    solutions: dict[str, Solution | NoSuchEvent] = {}
    for name, kind in kinds.items():
        try:
            solutions[name] = model.solution(name).times(problem.units[kind], problem.unit_name(kind))
        except NoSuchEvent as missing:
            solutions[name] = missing
    return solutions
