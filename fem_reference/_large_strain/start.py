"""States from which Newton's method begins: the equilibria of small strain, on the elements of finite strain."""

from __future__ import annotations

import numpy as np

from fem_reference._contact.states import Point
from fem_reference._large_strain.block import Block, linear_response
from fem_reference._large_strain.equilibrium import State
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.surface import Surface

__all__ = ["small_strain_state"]


def small_strain_state(point: Point, block: Block, surface: Surface) -> State:
    """Return the linear state of a block under the traction of an equilibrium of small strain.

    Parameters
    ----------
    point : Point
        The equilibrium, of a solid whose Poisson ratio may be another one.
    block : Block
    surface : Surface
        The pressure is stretched with the radius of the edge, if that of the surface is another one.
    """
    y, compliance = point.state.y, point.branch.contact.compliance
    edge = point.edge_radius if point.branch.touching else surface.size
    s = block.trace.s * edge / y[-1]
    inside = s < compliance.trace.extent
    w = np.zeros_like(s)
    w[inside] = compliance.trace.evaluate(s[inside]) @ y[:-2]
    gap = w - y[-2] + surface.punch.height(edge * block.trace.s)
    pressure = np.asarray(surface.law.traction(gap)) / surface.modulus
    undeformed = Faces(block.trace.s, np.ones_like(s), np.zeros_like(s), gap)
    u, pressures = linear_response(block, pressure, surface.stiffness(undeformed))
    return State(block, surface, u, pressures, float(y[-2]) / surface.size)
