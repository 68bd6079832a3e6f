"""Problem of a file for the finite elements, in SI units."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import fem_reference
from comparisons.model import NotApplicable, Result
from comparisons.models.solver import result_of, translated
from comparisons.numerics.curve_distance import mesh_difference
from comparisons.numerics.grid_convergence import three_grids
from comparisons.problem_file.description import ProblemFile, Section
from comparisons.problem_file.dimensionless import adhesion
from comparisons.problem_file.punch_shapes import RoundedFlat, SmoothedProfile
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
        return fem_reference.Problem(_solid(problem.solid), _punch(problem.punch), _law(problem.law))
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


def _solid(solid: Section) -> fem_reference.Solid | fem_reference.CustomSolid:
    if solid.kind == "homogeneous":
        return fem_reference.Solid(solid["E"], 1.0, 0.0, solid["nu"])  # c0 has no effect for k = 0
    if solid.kind in ("power-law", "offset-power-law"):
        return fem_reference.Solid(solid["E0"], solid["c0"], solid["k"], solid["nu"], solid.get("z_s", 0.0))
    if solid.kind == "exponential":
        modulus: Any = fem_reference.ExponentialModulus(solid["E_surface"], solid["E_depth"], solid["length"])
        return fem_reference.CustomSolid(modulus, solid["nu"])
    if solid.kind == "coating":
        interface = solid["thickness"], solid["transition"]
        modulus = fem_reference.CoatingModulus(solid["E_coating"], solid["E_substrate"], *interface)
        if "nu" in solid.values:
            return fem_reference.CustomSolid(modulus, solid["nu"])
        ratios = solid["nu_coating"], solid["nu_substrate"]
        return fem_reference.CustomSolid(modulus, fem_reference.CoatingPoisson(*ratios, *interface))
    columns = solid.columns
    modulus = fem_reference.TableModulus(columns["z"], columns["E"])
    if "nu" in columns:
        return fem_reference.CustomSolid(modulus, fem_reference.TablePoisson(columns["z"], columns["nu"]))
    return fem_reference.CustomSolid(modulus, solid["nu"])


def _punch(punch: Section) -> fem_reference.Punch:
    if punch.kind == "sphere":
        return fem_reference.PowerPunch(2.0, punch["R"])
    if punch.kind == "cone":
        return fem_reference.PowerPunch(1.0, math.tan(punch["half_angle"]))
    if punch.kind == "power-law":
        return fem_reference.PowerPunch(punch["n"], punch["Q"])
    if punch.kind == "rounded-cone":
        return fem_reference.RoundedCone(punch["R"] * punch["slope"], punch["slope"])
    if punch.kind == "rounded-flat":
        return RoundedFlat(punch["flat_radius"], punch["R"])
    columns, growth = punch.columns, punch.get("growth", 2.0)
    if "smoothing" in punch.values:
        return SmoothedProfile(columns["r"], columns["height"], punch["smoothing"], growth)
    return fem_reference.MeasuredPunch(columns["r"], columns["height"], growth)


def _law(law: Section) -> fem_reference.SurfaceLaw:
    if law.kind == "lennard-jones-9-3":
        return fem_reference.LennardJones(law["work_of_adhesion"], law["z0"])
    if law.kind == "mie":
        return fem_reference.Mie(law["work_of_adhesion"], law["z0"], law["m"], law["n"])
    # The range is a length of the data only; the law itself is the table of this solver.
    z0 = adhesion(law)[1]
    return fem_reference.TabulatedLaw(law.columns["gap"], law.columns["traction"], z0, law.get("tail_exponent"))
