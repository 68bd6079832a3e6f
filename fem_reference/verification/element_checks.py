"""Checks of the elements: their order, patch tests, symmetry, energy balance and scaling."""

from __future__ import annotations

import math

import numpy as np

from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import Grid, edge_grid, uniform_grid
from fem_reference._linear.linear_solver import solve_cg
from fem_reference.solid import PowerLaw
from fem_reference.solids import OffsetPowerLaw
from fem_reference.verification.check import Check
from fem_reference.verification.manufactured import BIAXIAL, SMOOTH, column, manufactured_error

__all__ = ["element_checks", "manufactured_checks"]

#: Elements a side, coarse and fine, by the order of the element.
MESHES = {3: (4, 8), 4: (6, 12), 6: (5, 8)}

#: How far the observed order may be below the element's p + 1 (measured: never below, on these coarse meshes).
ORDER_LIMIT = 0.25

#: Condition number times rounding: measured 2e-12.
PATCH_LIMIT = 1e-9

#: Of a matrix, relative to its largest entry: measured 1e-15 and, for sums of a column, 2e-14.
ROUNDING_LIMIT = 1e-12

#: Residual 1e-10 of the conjugate gradients times what the preconditioner leaves of the condition number.
SOLVER_LIMIT = 1e-8

#: Material of the checks whose case does not name another.
K, NU = 0.4, 0.3

#: Factor on every length in the scaling test: millimetres for metres.
UNIT = 1e3


def manufactured_checks() -> list[Check]:
    """(a) The error of a manufactured solution with graded modulus falls as h^(p+1): shortfall of the order.

    Examples
    --------
    >>> [check.passed for check in manufactured_checks()]
    [True, True, True]
    """
    solid, side = OffsetPowerLaw(1.0, 1.0, K, 0.5, NU), 1.5
    rows = []
    for order, (coarse, fine) in MESHES.items():
        errors = [manufactured_error(uniform_grid(side, n), solid, order, SMOOTH) for n in (coarse, fine)]
        observed = math.log(errors[0] / errors[1]) / math.log(fine / coarse)
        case = f"degree {order}: order {observed:.2f} of {order + 1}"
        shortfall = max(0.0, order + 1 - observed)
        rows.append(Check("manufactured solution, graded", case, shortfall, ORDER_LIMIT, 2 * (order * fine + 1) ** 2))
    return rows


def element_checks() -> list[Check]:
    """(g) Patch tests, symmetry, energy balance, unit scaling.

    Examples
    --------
    >>> [check.name for check in element_checks() if not check.passed]
    []
    """
    rows = []
    patch = edge_grid(extent=3.0, density=1.0)
    for name, grid, solid, field in (
        ("biaxial strain, k = 0", patch, PowerLaw(1.0, 1.0, 0.0, NU), BIAXIAL),
        (f"confined column, k = {K}", uniform_grid(1.0, 1), PowerLaw(1.0, 1.0, K, NU), column(K)),
    ):
        error = manufactured_error(grid, solid, 3, field)
        size = 2 * (3 * grid.r.size - 2) * (3 * grid.z.size - 2)
        rows.append(Check("patch test", name, error, PATCH_LIMIT, size))

    grid, case = edge_grid(edge_width=0.05, extent=16.0, density=0.9), f"k = {K}, nu = {NU}"
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, K, NU))
    matrix, unknowns = half_space.matrix, half_space.unknowns
    asymmetry = float(abs(matrix - matrix.T).max() / abs(matrix).max())
    rows.append(Check("stiffness is symmetric", case, asymmetry, ROUNDING_LIMIT, unknowns))

    S = surface_stiffness(half_space)
    load = np.zeros(matrix.shape[0])
    load[half_space.surface[:5]] = 1.0
    u = solve_cg(half_space, load).solution
    work = float(load[half_space.surface] @ np.linalg.solve(S, load[half_space.surface]))
    balance = abs(float(u @ (matrix @ u)) / work - 1.0)
    rows.append(Check("strain energy is the work of the load", case, balance, SOLVER_LIMIT, unknowns))

    # The same body in other units of length: E is that of the same depth, a stiffness per radian a modulus times
    # a length.
    scaled = Grid(UNIT * grid.r, UNIT * grid.z)
    scaled_stiffness = surface_stiffness(assemble_half_space(scaled, PowerLaw(1.0, UNIT, K, NU)))
    apart = float(np.abs(scaled_stiffness / UNIT - S).max() / np.abs(S).max())
    rows.append(Check("units of length do not matter", case, apart, SOLVER_LIMIT, unknowns))
    return rows
