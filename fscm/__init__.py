"""The full self-consistent model of adhesive contact of power-law graded materials.

>>> from fscm import Problem, solve
>>> solution = solve(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
>>> round(solution.value, 8)
1.78848171

The public names are listed in `__init__.pyi`; a module is loaded when one of its names is first used.
"""

import lazy_loader

#: Modules and folders, from the first layer to the last; `tests/test_independence.py` checks every import.
LAYERS = (
    ("errors", "_typing", "_threads", "_validation", "_response_factor", "_smoothed_table"),
    ("laws", "tabulated_law", "punch", "custom_punch", "measured_punch"),
    ("solids", "layers", "tabulated_modulus", "custom_solid"),
    ("_units",),
    ("_meshes", "_kernel", "_azimuthal_kernel", "_panels", "_response_store", "_deformation"),
    ("graded",),
    ("problem",),
    ("_tail",),
    ("_bordered_factor", "_equilibrium", "_defect", "solution"),
    ("_newton", "_arc_length", "_path_end", "_adaptivity", "_branches"),
    ("_edge_width", "_contact_initiation", "_surface_rings", "_continuation"),
    (
        "_events",
        "_jumps",
        "_bounds",
        "_completeness",
        "_whole_path",
        "_pull_off_path",
        "_curve_density",
        "folds",
        "stability",
    ),
    ("path", "critical", "quantities", "analysis"),
    ("gibson", "stieltjes", "interpolation"),
    ("experiment", "states", "solver", "_event_adjoint", "_sensitivity"),
)

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
