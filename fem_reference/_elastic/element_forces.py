"""Forces of the elements of a tensor-product mesh under a displacement, right to the rounding of the forces.

The stiffness across a thin element is larger than that along it by many powers of ten, and a product of its matrix with
the displacement is a small difference of large numbers: rounding leaves a force on the whole element, which moves it.
Here the functions along a side are 1, x and those that vanish at both ends.  What both ends have in common meets the
derivative of 1, which is exactly zero, and the rest is subtracted before anything is multiplied with it.
"""

from __future__ import annotations

import numpy as np
from skfem import Dofs

from fem_reference._elastic.dof_ordering import both_components
from fem_reference._elastic.elasticity import element_places
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.tensor_elements import BLOCKS, along_from_start, depth_integrals, factors, radial_integrals
from fem_reference._typing import Array
from fem_reference.solid import Solid

__all__ = ["ElementForces"]


class ElementForces:
    """Elements of a tensor-product mesh, ready to give their forces.

    Parameters
    ----------
    grid : Grid
        The mesh; its first layer has a chart.
    dofs : skfem.Dofs
        Numbering of its functions of `ElementQuadP`.
    solid : Solid
        In units of the grid.
    """

    def __init__(self, grid: Grid, dofs: Dofs, solid: Solid) -> None:
        mesh, self._order = dofs.topo, int(dofs.element.p)
        self._along_r, self._along_z = factors(mesh, self._order)
        self._radial = radial_integrals(grid.r, self._order, along_from_start)
        self._depth = depth_integrals(grid.z, solid, self._order, along_from_start)
        self._rows = both_components(np.asarray(dofs.element_dofs)).T
        self._columns, self._layers = element_places(mesh)

    def under(self, u: Array) -> Array:
        """Sum of the forces of all elements under a displacement of all their functions, both of shape (2 N, q)."""
        columns, layers, n = self._columns, self._layers, self._order + 1
        a = np.zeros((2, columns.size, n, n, u.shape[1]))
        for component in (0, 1):
            a[component][:, self._along_r, self._along_z] = u[self._rows[:, component::2]]
        # What both ends of a side have in common is the part of the function 1.
        a[:, :, 1] -= a[:, :, 0]
        a[:, :, :, 1] -= a[:, :, :, 0]
        forces = np.zeros_like(a)
        for (i, j), pairs in BLOCKS.items():
            for name_r, name_z in pairs:
                R, Z = self._radial[name_r][columns], self._depth[name_z][layers]
                forces[i] += _product(R, Z, a[j])
                if i != j:
                    forces[j] += _product(np.swapaxes(R, 1, 2), np.swapaxes(Z, 1, 2), a[i])
        forces[:, :, 0] -= forces[:, :, 1]
        forces[:, :, :, 0] -= forces[:, :, :, 1]
        total = np.zeros_like(u)
        for component in (0, 1):
            rows = self._rows[:, component::2].ravel()
            on_functions = forces[component][:, self._along_r, self._along_z].reshape(rows.size, -1)
            for column, values in enumerate(on_functions.T):
                total[:, column] += np.bincount(rows, values, minlength=u.shape[0])
        return total


def _product(R: Array, Z: Array, a: Array) -> Array:
    """R along r and Z along z of each element, times its coefficients, shape (e, r, z, q)."""
    along_z = Z[:, None] @ a
    return np.asarray((R @ along_z.reshape(*along_z.shape[:2], -1)).reshape(a.shape))
