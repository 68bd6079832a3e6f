"""Problem of a file for the FSCM and the closed forms: dimensionless, with the unit of every scale."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from comparisons.problem_file.description import ProblemFile, Section
from comparisons.problem_file.punch_shapes import RoundedFlat, SmoothedProfile
from fscm.laws import Mie, SurfaceLaw
from fscm.measured_punch import MeasuredPunch
from fscm.physical import PhysicalProblem
from fscm.problem import Problem
from fscm.punch import PunchShape, RoundedCone
from fscm.tabulated_law import TabulatedLaw

if TYPE_CHECKING:
    from fscm.graded import GradedHalfSpace

__all__ = ["adhesion", "dimensionless_problem", "shape_parameters"]


def dimensionless_problem(problem: ProblemFile) -> tuple[Problem, Mapping[str, float]]:
    """Return the problem of a file for the FSCM, and the units of its results in SI.

    Returns
    -------
    problem : Problem
    units : mapping of str to float
        As `PhysicalProblem.scales`.

    Raises
    ------
    ValueError
        If it is outside of what the FSCM admits.

    Examples
    --------
    >>> from pathlib import Path
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> found, units = dimensionless_problem(ProblemFile(Path("a"), solid, Section("sphere", {"R": 1e-6}), law))
    >>> round(found.mu, 6), units["displacement"]
    (0.259204, 3e-10)
    """
    work, z0, law = adhesion(problem.law)
    n, Q = shape_parameters(problem.punch, z0)
    if (solid := problem.power_law) is not None:
        physical = PhysicalProblem(solid["E0"], solid["c0"], solid["k"], solid["nu"], Q, n, work, z0)
        return physical.problem(_punch(problem.punch, physical.length_r, z0), law), physical.scales
    # Imported here: the power law does not need it.
    from fscm.graded import graded_problem

    unit = (Q * z0) ** (1.0 / n)
    shape = _punch(problem.punch, unit, z0)
    found, surface = graded_problem(_solid(problem.solid), Q=Q, n=n, work_of_adhesion=work, z0=z0, punch=shape, law=law)
    return found, surface.scales


def adhesion(law: Section) -> tuple[float, float, SurfaceLaw | None]:
    """Return work of adhesion, range z0 and dimensionless law (None: the 9-3 law) of a section.

    The range of a table that does not state it is its work of adhesion over its largest tension.
    """
    if law.kind == "lennard-jones-9-3":
        return law["work_of_adhesion"], law["z0"], None
    if law.kind == "mie":
        return law["work_of_adhesion"], law["z0"], Mie(law["m"], law["n"])
    gaps, tractions = law.columns["gap"], law.columns["traction"]
    exponent = law.get("tail_exponent")
    z0 = law.get("z0")
    if z0 is None:
        length = gaps[-1] - gaps[0]
        table = TabulatedLaw([gap / length for gap in gaps], tractions, exponent)
        z0 = table.work_of_adhesion * length / -min(tractions)
    table = TabulatedLaw([gap / z0 for gap in gaps], tractions, exponent)
    return table.work_of_adhesion * z0, z0, table


def shape_parameters(punch: Section, z0: float) -> tuple[float, float]:
    """Return n and Q of the power law r^n / (n Q) that gives the unit of the radii.

    That is the punch itself, the paraboloid or the cone that a rounded one resembles at heights of z0, or the power
    beyond a profile.

    Examples
    --------
    >>> shape_parameters(Section("rounded-cone", {"R": 1e-6, "slope": 2.0}), 3e-10)
    (2.0, 1e-06)
    """
    if punch.kind == "power-law":
        return punch["n"], punch["Q"]
    if punch.kind == "cone":
        return 1.0, math.tan(punch["half_angle"])
    if punch.kind == "rounded-cone" and punch["slope"] ** 2 * punch["R"] < z0:
        return 1.0, 1.0 / punch["slope"]
    if punch.kind == "table":
        n, r, height = punch.get("growth", 2.0), punch.columns["r"], punch.columns["height"]
        return n, r[-1] ** n / (n * (height[-1] - height[0]))
    return 2.0, punch["R"]


def _punch(punch: Section, length: float, z0: float) -> PunchShape | None:
    """The shape with radii in `length` and heights in z0; None for the power law."""
    if punch.kind in ("sphere", "cone", "power-law"):
        return None
    if punch.kind == "rounded-cone":
        return RoundedCone(punch["R"] * punch["slope"] / length, punch["slope"] * length / z0)
    if punch.kind == "rounded-flat":
        return RoundedFlat(punch["flat_radius"] / length, punch["R"] * z0 / length**2)
    radii = tuple(r / length for r in punch.columns["r"])
    heights = tuple(height / z0 for height in punch.columns["height"])
    if "smoothing" in punch.values:
        return SmoothedProfile(radii, heights, punch["smoothing"] / z0, punch.get("growth", 2.0))
    return MeasuredPunch(radii, heights, punch.get("growth", 2.0))


def _solid(solid: Section) -> GradedHalfSpace:
    """The solid for the FSCM, in SI."""
    from fscm import graded

    if solid.kind == "offset-power-law":
        return graded.OffsetPowerLaw(solid["E0"], solid["c0"], solid["k"], solid["z_s"], solid["nu"])
    if solid.kind == "exponential":
        return graded.Exponential(solid["E_surface"], solid["E_depth"], solid["length"], solid["nu"])
    if solid.kind == "coating":
        ratios = solid.get("nu_coating", solid.get("nu")), solid.get("nu_substrate", solid.get("nu"))
        return graded.Coating(
            solid["E_coating"], solid["E_substrate"], solid["thickness"], solid["transition"], *ratios
        )
    columns = solid.columns
    return graded.TabulatedModulus(columns["z"], columns["E"], columns.get("nu", solid.get("nu")))
