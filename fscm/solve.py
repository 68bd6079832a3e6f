"""One question, one answer: a quantity of a problem by name."""

from __future__ import annotations

from fscm._threads import one_thread
from fscm.analysis import EVENT_QUANTITIES, Analysis, Solution
from fscm.critical import critical_tabor_number
from fscm.gibson import GibsonSolid
from fscm.problem import Problem

__all__ = ["QUANTITIES", "solve"]

QUANTITIES = (*EVENT_QUANTITIES, "hysteresis_energy", "critical_tabor_number")


@one_thread()
def solve(problem: Problem, quantity: str) -> Solution:
    """Compute one quantity with its numerical uncertainty; k = 1 is solved as the Gibson solid.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `QUANTITIES`.

    Returns
    -------
    Solution
        Dimensionless; loads in pi Q^(2/n) dgamma z0^(2/n-1), displacements and gaps in z0, energies in
        pi Q^(2/n) dgamma z0^(2/n).

    Raises
    ------
    ValueError
        For an unknown quantity.
    NoSuchEvent
        When the path has no such event, e.g. no jump below the critical Tabor number.
    NotConverged

    Examples
    --------
    >>> round(solve(Problem(n=2, k=0, mu=1.0), "pull_off_force").value, 8)
    1.67066478
    """
    if quantity not in QUANTITIES:
        raise ValueError(f"unknown quantity {quantity!r}; known are {', '.join(QUANTITIES)}")
    if problem.k == 1.0:
        return GibsonSolid(problem).solution(quantity)
    if quantity == "critical_tabor_number":
        return critical_tabor_number(problem)
    return Analysis(problem).solution(quantity)
