r"""End of the equilibrium path: where no later state can carry tension.

A power-law punch has one minimum of the load on its contact branch, and its path ends at the first compressive load.
Any other punch may have asperities: the path goes on until the edge has passed the radius from which on

    P_H(c) - P_a(c) - 2 T(c) > 0       for every edge radius c.

P_H is the load without adhesion on the full disc of radius c, P_a the load that Griffith's balance at its edge takes
off (the two of the soft limit, JKR), and T the tension of the gap region outside c, in which the gap is that of the
undeformed punch (the rigid limit, Bradley).  Between the limits the sum of both is taken, with the factor 2 for the
deformation of the gap region.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm._equilibrium import State
from fscm._typing import Array
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["PathEnd", "least_later_loads", "radius_of_compression"]

# Radii at which the shape is evaluated, and every so many of them an edge.
_RADII, _EVERY = 6000, 12
# The first radius, in units of the last: features below it carry less than 1e-9 of any load.
_FIRST_RADIUS = 1e-7
# The last edge, in the same unit: the gap region outside it has to be seen as well.
_LAST_EDGE = 1e-2
# The factor of the tension in the gap region.
_MARGIN = 2.0


@dataclass
class PathEnd:
    """Condition that ends a path: compressed, beyond all asperities, and at the largest displacement so far.

    Attributes
    ----------
    radius : float
        Edge radius from which on the load stays compressive (see `radius_of_compression`).
    load : float
        The load has to exceed this as well.
    farthest : float
        Largest displacement of the states so far.
    """

    radius: float
    load: float = 0.0
    farthest: float = -math.inf

    def __call__(self, state: State) -> bool:
        self.farthest = max(self.farthest, state.displacement)
        deepest = state.displacement >= self.farthest
        return state.follows_edge and state.load > self.load and state.scale >= self.radius and deepest


def radius_of_compression(problem: Problem, end: float) -> float:
    """Edge radius beyond which no state carries tension; 0 for a power law, where any compressive load is the end.

    Parameters
    ----------
    problem : Problem
    end : float
        Largest radius that is examined.
    """
    if isinstance(problem.punch, PowerPunch):
        return 0.0
    radii, loads = least_later_loads(problem, end)
    tense = np.flatnonzero(loads <= 0.0)
    if not tense.size:
        return 0.0
    return float(radii[tense[-1] + 1]) if tense[-1] + 1 < len(radii) else math.inf


def least_later_loads(problem: Problem, end: float) -> tuple[Array, Array]:
    """Edge radii, and a load below which no state with this edge can be; arrays of shape (m,)."""
    k = problem.k
    r = np.concatenate([[0.0], np.geomspace(_FIRST_RADIUS * end, end, _RADII)])
    f = problem.punch.height(r)
    c = r[_EVERY::_EVERY]
    c = c[c < _LAST_EDGE * end]
    # P of a flat punch of radius a pressed in by d is d a^(1+k) C / (1+k).
    C = 4.0 * math.cos(0.5 * math.pi * k) / (math.pi * problem.compliance * (1.0 - k))
    transform = _transform(r, f, c, k)
    middle = 0.5 * (c + np.append(0.0, c[:-1]))
    hertz = C / (1.0 + k) * np.cumsum(middle ** (1.0 + k) * np.diff(transform, prepend=0.0))
    griffith = 2.0 * math.sqrt(C) * c ** (0.5 * (3.0 + k)) / (1.0 + k)
    return c, hertz - griffith - _MARGIN * _tension(problem, r, f, len(c))


def _transform(r: Array, f: Array, x: Array, k: float) -> Array:
    """x^(1-k) int_0^x f'(r) (x^2 - r^2)^((k-1)/2) dr, exact where f is linear in r^2 between the radii."""
    squares = r * r
    slopes = np.diff(f) / np.diff(squares)
    found = np.empty_like(x)
    for i, radius in enumerate(x):
        left = np.maximum(radius * radius - squares, 0.0) ** (0.5 * (1.0 + k))
        found[i] = radius ** (1.0 - k) * float(slopes @ -np.diff(left)) * 2.0 / (1.0 + k)
    return found


def _tension(problem: Problem, r: Array, f: Array, edges: int) -> Array:
    """Tension of the undeformed gap region outside each of the edges, the gap at the edge being 0."""
    law = problem.law
    squares = r * r
    C, m = law.decay
    found = []
    for i in range(_EVERY, (edges + 1) * _EVERY, _EVERY):
        gap = np.maximum(f[i:] - f[i], law.peak_gap)
        pressure = -law.traction(gap)
        outside = C * gap[-1] ** -m * squares[-1] * 2.0 / (m * problem.punch.growth - 2.0) if C else 0.0
        found.append(float(np.sum(0.5 * (pressure[1:] + pressure[:-1]) * np.diff(squares[i:]))) + outside)
    return np.array(found)
