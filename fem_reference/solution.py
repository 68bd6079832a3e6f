"""The front door: one number of one contact problem, with its uncertainty from three meshes.

Physical quantities in any consistent units go in and come out.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

from fem_reference._contact.events import locate
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.uncertainty import three_meshes
from fem_reference._threads import one_thread
from fem_reference.laws import LennardJones
from fem_reference.punch import Punch
from fem_reference.solid import CustomSolid, Solid

__all__ = ["Solution", "solve", "solve_together"]

GAP_ORDER = 2.0
"""Declared order of the central gap at jump-out, in contact: the stress under the tip of a cone is singular, which
decides it, not the element (measured worst error / u_num with the element's order: 1.15 at n = 1, k = 0.6, mu = 3)."""


@dataclass(frozen=True, slots=True)
class Solution:
    """One quantity, in the units of the input.

    Attributes
    ----------
    value, u_num : float
        The quantity and a bound on its numerical error.
    size : int
        Unknowns of the finest finite-element mesh.
    iterations : int
        Newton steps along the path on the finest mesh.
    residual : float
        Residual of the equilibrium at the event, in units of z0.
    seconds : float
        Wall-clock time of everything.
    observed_order : float
        Order of convergence in the mesh density over the three meshes.
    densities, values : tuple of float
        The meshes, coarse to fine, and the quantity on each.
    """

    value: float
    u_num: float
    size: int
    iterations: int
    residual: float
    seconds: float
    observed_order: float
    densities: tuple[float, float, float]
    values: tuple[float, float, float]


def solve(
    solid: Solid | CustomSolid, punch: Punch, law: LennardJones, quantity: str, accuracy: str = "default"
) -> Solution:
    """Compute one quantity with its numerical uncertainty from three meshes.

    Parameters
    ----------
    solid, punch, law
        The problem, in consistent units.
    quantity : str
        One of `QUANTITIES` or `LOSSES`.
    accuracy : {"default", "fine", "quick"}
        Mesh densities; finer ones are taken where a path cannot be walked on these.

    Returns
    -------
    Solution

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
    >>> from fem_reference import LennardJones, PowerPunch, Solid, solve
    >>> sphere, law = PowerPunch(n=2.0, Q=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0)
    >>> solid = Solid(E0=1.0, c0=1.0, k=0.0, nu=0.0)  # Tabor's ratio (Q w^2 / E*^2 z0^3)^(1/3) is 1
    >>> answer = solve(solid, sphere, law, "pull_off_force", accuracy="quick")
    >>> abs(answer.value / (3.141592653589793 * 1.67066478) - 1.0) < 1e-5
    True
    """
    return solve_together(solid, punch, law, (quantity,), accuracy)[quantity]


def solve_together(
    solid: Solid | CustomSolid,
    punch: Punch,
    law: LennardJones,
    quantities: Sequence[str],
    accuracy: str = "default",
) -> dict[str, Solution]:
    """Compute several quantities on the meshes that suit the first of them, walking each path once.

    Parameters
    ----------
    solid, punch, law, accuracy
        As for `solve`.
    quantities : sequence of str
        Of `QUANTITIES` and `LOSSES`.  The mesh of a solid that is no power law is finest at the edge of the first:
        others whose edge is elsewhere are less certain, and say so.

    Returns
    -------
    dict of str to Solution
        `seconds` are those of all together.

    Raises
    ------
    ValueError, NoSuchEvent, NotConverged
        As `solve`, if one of them fails.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch, Solid
    >>> stiff = Solid(E0=50.0, c0=1.0, k=0.0, nu=0.3)
    >>> wanted = ("pull_off_force", "pull_off_displacement")
    >>> found = solve_together(stiff, PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0), wanted, accuracy="quick")
    >>> round(found["pull_off_force"].value, 3)  # Bradley's 2 pi for a rigid solid
    6.226
    >>> found["pull_off_force"].u_num < 1e-4
    True
    """
    with one_thread:
        begin = time.perf_counter()
        choice, spec, size = chosen(solid, punch, law, quantities, accuracy)
        level = choice.level
        walks = [choice.walked(replace(spec, density=density), size) for density in level.densities]
        found = {quantity: [locate(points, quantity) for points in walks] for quantity in quantities}
        ratio = math.sqrt(level.densities[0] / level.densities[2])
        solutions = {}
        for quantity, events in found.items():
            coarse, medium, fine = (value for value, _ in events)
            order = GAP_ORDER if quantity == "jump_out_gap" else level.order
            outcome = three_meshes((coarse, medium, fine), ratio, order, _scale(quantity, fine, law.z0))
            point = events[-1][1]
            solutions[quantity] = Solution(
                outcome.value,
                outcome.u_num,
                point.leg.contact.compliance.unknowns,
                sum(p.state.iterations for p in walks[-1]),
                point.state.residual,
                time.perf_counter() - begin,
                outcome.observed_order,
                level.densities,
                (coarse, medium, fine),
            )
        return solutions


def _scale(quantity: str, value: float, z0: float) -> float:
    """Size of a quantity, for the floor of its uncertainty: a length near zero is measured by z0."""
    return abs(value) if "force" in quantity or "energy" in quantity else max(abs(value), z0)
