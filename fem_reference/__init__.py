"""An independent axisymmetric finite-element model of adhesive contact of graded materials.

Physical quantities in any consistent units: a half-space with Young's modulus E(z) and Poisson ratio nu, a
rigid punch f(r), a surface law p(H).  The solid is meshed with high-order elements and closed by the exact
stiffness of the infinite exterior.  Condensed to its surface it follows the path of equilibria; at an event every
displacement of the mesh is solved with pyamg.
"""

from fem_reference.accuracy import ACCURACIES
from fem_reference.coating import CoatingModulus
from fem_reference.errors import NoSuchEvent, NotConverged
from fem_reference.laws import LennardJones, SurfaceLaw
from fem_reference.modulus import CustomModulus, Interface, Modulus, OffsetPowerLawModulus, PowerLawModulus
from fem_reference.problem import Problem
from fem_reference.punch import CustomPunch, PowerPunch, Punch
from fem_reference.quantities import LOSSES, QUANTITIES
from fem_reference.solid import CustomSolid, Solid
from fem_reference.solution import Solution, solve, solve_together
from fem_reference.states import EVENTS, EquilibriumPath, RadialField, event_state, profile, trace

#: Modules and folders, from the first layer to the last; `tests/test_independence.py` checks every import.
LAYERS = (
    ("_typing", "_threads", "errors"),
    ("modulus", "coating", "modulus_checks", "punch", "laws", "solid", "problem", "accuracy"),
    ("_elastic",),
    ("_linear",),
    ("_contact",),
    ("quantities", "solution", "states", "export"),
    ("verification",),
)

__all__ = [
    "ACCURACIES",
    "EVENTS",
    "LOSSES",
    "QUANTITIES",
    "CoatingModulus",
    "CustomModulus",
    "CustomPunch",
    "CustomSolid",
    "EquilibriumPath",
    "Interface",
    "LennardJones",
    "Modulus",
    "NoSuchEvent",
    "NotConverged",
    "OffsetPowerLawModulus",
    "PowerLawModulus",
    "PowerPunch",
    "Problem",
    "Punch",
    "RadialField",
    "Solid",
    "Solution",
    "SurfaceLaw",
    "event_state",
    "profile",
    "solve",
    "solve_together",
    "trace",
]
