"""Problem of a file for the finite elements, in SI units."""

from __future__ import annotations

from functools import lru_cache

import fem_reference
from comparisons.model import NotApplicable, Result
from comparisons.models.solver import result_of, translated
from comparisons.numerics.curve_distance import mesh_difference
from comparisons.numerics.grid_convergence import three_grids
from comparisons.problem_file.description import ProblemFile
from comparisons.problem_file.kinds import SECTIONS, kind_of
from comparisons.quantities import Points

__all__ = ["body_of", "curve_of", "field_of", "value_of"]

#: Meshes of a curve, as in `comparisons.models.fem_model`.
_LEVELS = ("quick", "default")


def body_of(problem: ProblemFile) -> fem_reference.Problem:
    """Return the problem for the finite elements.

    Raises
    ------
    NotApplicable
        If they do not take it, as an incompressible solid.
    """
    try:
        parts = ((name, getattr(problem, name)) for name in SECTIONS)
        return fem_reference.Problem(*(kind_of(name, part.kind).build(fem_reference, part) for name, part in parts))
    except ValueError as error:
        raise NotApplicable(f"the finite elements do not take this problem: {error}") from None


def value_of(problem: ProblemFile, quantity: str) -> Result:
    """Return a quantity in SI, or raise `NotApplicable` or `ComputationFailed`."""
    if quantity not in fem_reference.QUANTITIES:
        raise NotApplicable(f"the finite elements do not compute {quantity} of a problem file")
    with translated(fem_reference.NoSuchEvent, fem_reference.NotConverged):
        solution = fem_reference.solve(body_of(problem), quantity)
    # The larger of two bounds, as for the dimensionless problem: the solver's own, and that of the three grids.
    family = three_grids(solution.densities, solution.values, solution.declared_order)
    return result_of(solution.with_part("mesh", max(family.u_num - solution.u_num, 0.0)))


def curve_of(problem: ProblemFile) -> Points:
    """Return the equilibrium path in SI."""
    body = body_of(problem)
    with translated(fem_reference.NoSuchEvent, fem_reference.NotConverged):
        coarse, path = (fem_reference.trace(body, level) for level in _LEVELS)
    distance = mesh_difference(coarse.displacement, coarse.load, path.displacement, path.load)
    columns = {"central_gap": path.central_gap, "edge_radius": path.edge_radius}
    return Points(path.displacement.tolist(), path.load.tolist(), distance, columns)


@lru_cache(maxsize=1)
def _fields(body: fem_reference.Problem) -> list[fem_reference.RadialField]:
    with translated(fem_reference.NoSuchEvent, fem_reference.NotConverged):
        return [fem_reference.profile(body, accuracy=level) for level in _LEVELS]


def field_of(problem: ProblemFile, name: str, farthest_gap: float) -> Points:
    """Return the "pressure" or the "gap" over the radius at pull-off, out to a gap, in SI."""
    near = []
    for profile in _fields(body_of(problem)):
        inside = profile.gap <= farthest_gap
        near += [profile.radius[inside], getattr(profile, name)[inside]]
    return Points(near[2].tolist(), near[3].tolist(), mesh_difference(*near))
