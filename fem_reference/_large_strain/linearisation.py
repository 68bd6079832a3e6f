"""A half-space and its surface force, linearised and factorised at one place: it solves the steps of Newton's method.

From a place nearby, or on elements that differ a little, it solves those of a chord: the forces are those of that
place, and no other factors are needed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import SuperLU

from fem_reference._large_strain.block import Block, factorised, summed
from fem_reference._large_strain.core import Condensed
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.surface import Surface
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["Gap", "Linearisation", "Step", "linearised"]

INSIDE_OUT = "an element is turned inside out: the strains are too large for this mesh"


@dataclass(frozen=True, slots=True)
class Gap:
    """Condition for the gap at a point of the surface, in units of the size.

    Attributes
    ----------
    row : int
        That of u_r at the point.
    slope : float
        Of the punch there, times the factor of the strains.
    lack : float
        By which the gap is to rise.
    """

    row: int
    slope: float
    lack: float

    def change(self, u: Array) -> float:
        """Return the change of the gap with a displacement at a fixed approach."""
        return self.slope * float(u[self.row]) + float(u[self.row + 1])


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """Changes of displacement, pressures and approach that bring a half-space into balance, by a linearisation.

    Attributes
    ----------
    u, pressures : ndarray
    delta : float
    imbalance : float
        Norm of the forces that are out of balance before, relative to those of the surface.
    """

    u: Array
    pressures: Array
    delta: float
    imbalance: float


@dataclass(frozen=True, slots=True, eq=False)
class Linearisation:
    """A half-space linearised at one place.

    Attributes
    ----------
    block : Block
    elements : Condensed
    factors : SuperLU
        Of the tangent on the free rows.
    approach : ndarray
        Derivative of the forces by the approach.
    response : ndarray
        Change of the displacement with the approach; only that of the sides of the elements.
    """

    block: Block
    elements: Condensed
    factors: SuperLU
    approach: Array
    response: Array

    def serves(self, block: Block) -> bool:
        """Whether rows and elements are those of another block."""
        return self.block.core.has_places_of(block.core) and self.block.free.size == block.free.size

    def step(self, block: Block, surface: Surface, u: Array, pressures: Array, faces: Faces, gap: Gap) -> Step:
        """Return the step into balance with a gap, from any place of a block that this serves.

        Raises
        ------
        NotConverged
            If an element is turned inside out.
        """
        core, free = block.core, block.free
        forces = core.forces(u, pressures, surface.finiteness)
        if forces is None:
            raise NotConverged(INSIDE_OUT)
        on_sides, own = core.eliminated(self.elements, forces)
        of_surface = np.stack(surface.residual(faces), axis=2).reshape(block.surface_rows.shape)
        residual = summed(core.sides, on_sides, core.size) + summed(block.surface_rows, of_surface, core.size)
        residual[block.boundary] += block.exterior @ u[block.boundary]
        step = np.zeros(core.size)
        step[free] = self.factors.solve(-residual[free])
        delta = (gap.lack - gap.change(step)) / (gap.change(self.response) - 1.0)
        step += delta * self.response
        imbalance = float(np.linalg.norm(residual[free]) / np.linalg.norm(of_surface))
        return Step(step, core.recover(self.elements, forces, own, step), delta, imbalance)


def linearised(block: Block, surface: Surface, u: Array, pressures: Array, faces: Faces) -> Linearisation:
    """Linearise a half-space.

    Raises
    ------
    NotConverged
        If an element is turned inside out, or the tangent is singular.
    """
    core, free = block.core, block.free
    elements = core.condensed(u, pressures, surface.finiteness)
    if elements is None:
        raise NotConverged(INSIDE_OUT)
    tangent, condensed = elements
    of_surface, by_delta = surface.tangent(faces)
    factors = factorised(block.matrix(tangent, of_surface))
    approach, response = summed(block.surface_rows, by_delta, core.size), np.zeros(core.size)
    response[free] = factors.solve(-approach[free])
    return Linearisation(block, condensed, factors, approach, response)
