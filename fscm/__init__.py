"""The full self-consistent model of adhesive contact of power-law graded materials.

>>> from fscm import Problem, solve
>>> solution = solve(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
>>> round(solution.value, 8)
1.78848171
"""

from fscm._kernel import Phi, Psi, ring_response
from fscm._meshes import ACCURACIES
from fscm.analysis import EVENTS, Analysis
from fscm.custom_punch import CustomPunch
from fscm.errors import NoSuchEvent, NotConverged
from fscm.experiment import Cycle, displacement_cycle, load_controlled_retreat
from fscm.laws import LennardJones93, Mie, SurfaceLaw
from fscm.measured_punch import MeasuredPunch
from fscm.path import EquilibriumPath, trace
from fscm.physical import PhysicalProblem
from fscm.problem import Problem
from fscm.punch import PowerPunch, PowerSum, PunchShape, RoundedCone
from fscm.solution import Solution
from fscm.solve import QUANTITIES, solve, solve_together
from fscm.stability import Stability
from fscm.states import EquilibriumState, RadialField, equilibria, profile
from fscm.tabulated_law import TabulatedLaw

#: Modules and folders, from the first layer to the last; `tests/test_independence.py` checks every import.
LAYERS = (
    ("errors", "_typing", "_threads", "_validation", "_response_factor", "_smoothed_table"),
    ("laws", "tabulated_law", "punch", "custom_punch", "measured_punch"),
    ("problem", "physical"),
    ("_meshes", "_kernel", "_azimuthal_kernel", "_panels", "_deformation", "_tail"),
    ("_equilibrium", "_defect", "solution"),
    ("_newton", "_arc_length", "_path_end", "_adaptivity", "_branches", "_continuation"),
    ("_events", "_bounds", "_completeness", "_whole_path", "folds", "stability"),
    ("path", "critical", "quantities", "analysis"),
    ("gibson", "stieltjes"),
    ("experiment", "states", "solve"),
)

__all__ = [
    "ACCURACIES",
    "EVENTS",
    "QUANTITIES",
    "Analysis",
    "CustomPunch",
    "Cycle",
    "EquilibriumPath",
    "EquilibriumState",
    "LennardJones93",
    "MeasuredPunch",
    "Mie",
    "NoSuchEvent",
    "NotConverged",
    "Phi",
    "PhysicalProblem",
    "PowerPunch",
    "PowerSum",
    "Problem",
    "Psi",
    "PunchShape",
    "RadialField",
    "RoundedCone",
    "Solution",
    "Stability",
    "SurfaceLaw",
    "TabulatedLaw",
    "displacement_cycle",
    "equilibria",
    "load_controlled_retreat",
    "profile",
    "ring_response",
    "solve",
    "solve_together",
    "trace",
]
