r"""Rings on a soft film: a surface that comes into contact ring by ring, whose path is not traced.

A wave of the surface with the wave number q meets the stiffness K(q) = q / (M (1-k) S(q)) (`SurfaceResponse.spectrum`).
On a half-space K rises with q: the longest wave is the softest, and contact begins at one radius.  A film that moves
sideways (nu > 1/4) on a stiffer substrate is softest to waves of two to three times its thickness.  If the
tension falls with the gap more steeply than that K, a flat surface is unstable to them (V. Shenoy and A. Sharma,
Phys. Rev. Lett. 86, 119 (2001)): it comes into contact in rings at about that distance.

The rings belong to the exact solution, not to the mesh.  Measured on a film of nu = 0.46, 1.07 z0 thick (mu = 32,
limit 24.8): at one displacement a contact without rings, with one and with two of them outside has the load -1.83805,
-1.83776 and -1.83708, the same to 1e-6 on meshes of tolerances 1e-4 and 1e-6.  The path visits such states through
folds for each ring, and each ring has two edges, so that it needs too many points on too many panels; without it
nothing proves which of these states carries the least load.

K is proportional to mu^-((2n-1)/n), so that there is a largest Tabor number below which no surface is unstable.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fscm._surface.response import response_of
from fscm._surface.state import State
from fscm.errors import Failure, RingsForm
from fscm.problem import Problem

__all__ = ["RingLimit", "check_rings", "ring_limit"]

#: Gaps at which the slope of the law is evaluated: distances from the gap of largest tension, in units of its distance
#: to the singular gap.
_GAPS = np.concatenate([[0.0], np.geomspace(1e-3, 1e2, 2000)])
#: Stiffness of the softest wave over that of a longer one, above which contact begins at one radius nevertheless.
#: Measured: sharp films of nu = 0.3 and 0.35 have 0.991 and 0.929 and are, and are not, traced (mu = 100).
_SOFTER = 0.97
#: Rings need a wave of at most this share of the radius at which the height of the punch is the range of the unstable
#: gaps.  Measured: 0.04 and less on films that are not traced, 0.7 on one that is.
_ROOM = 0.25
#: Decrease of the gap outwards, in z0, that indicates a ring.  Measured: up to 0.09, the dent of the surface beside the
#: contact, on paths that were traced to their end; 0.1 to 0.8 on those that were not.
_FALL = 0.2


@dataclass(frozen=True)
class RingLimit:
    """Instability of a surface to waves.

    Attributes
    ----------
    length : float
        Length of the softest wave, in the unit of the radii.
    stiffness, steepest : float
        K of that wave and the steepest fall of the tension, in dgamma / z0^2.
    farthest : float
        Gap up to which the surface is unstable, in z0.
    mu : float
        Largest Tabor number at which it is stable.
    """

    length: float
    stiffness: float
    steepest: float
    farthest: float
    mu: float

    def refusal(self, problem: Problem) -> RingsForm:
        """The exception to raise for a problem."""
        return RingsForm(
            f"the surface of {problem} comes into contact in rings, whose path has too many folds: waves of the length "
            f"{self.length:.3g} (Q z0)^(1/n) are softer than longer ones, and their stiffness {self.stiffness:.3g} "
            f"dgamma/z0^2 is below the steepest fall of the tension, {self.steepest:.3g}; the largest Tabor number at "
            f"which no rings form on this solid is mu = {self.mu:.4g}",
            Failure.RINGS,
        )


def ring_limit(problem: Problem) -> RingLimit | None:
    """The instability of the surface to rings; None where it is stable to them, as any power-law solid is.

    Parameters
    ----------
    problem : Problem
        With 0 <= k < 1.
    """
    # The stiffness of a sum of power laws rises with the wave number.
    if problem.graded is None or response_of(problem.graded).kernel is None:
        return None
    law, (waves, softness) = problem.law, response_of(problem.graded).spectrum
    stiffness = waves / (problem.compliance * (1.0 - problem.k) * softness)
    longer = np.maximum.accumulate(stiffness)
    softest = _SOFTER * longer > stiffness
    if not softest.any():
        return None
    i = int(np.flatnonzero(softest)[np.argmin(stiffness[softest])])
    gaps = law.peak_gap + (law.peak_gap - law.singular_gap) * _GAPS
    slopes = law.slope(gaps)
    unstable = gaps[slopes > stiffness[i]]
    if not unstable.size:
        return None
    length, steepest, farthest = 2.0 * np.pi / float(waves[i]), float(np.max(slopes)), float(unstable[-1])
    # Room for rings: see _ROOM.
    if float(problem.punch.height(np.array([length / _ROOM]))[0]) > farthest - law.singular_gap:
        return None
    mu = problem.mu * (float(stiffness[i]) / steepest) ** (problem.n / (2.0 * problem.n + problem.k - 1.0))
    return RingLimit(length, float(stiffness[i]), steepest, farthest, mu)


def check_rings(state: State, limit: RingLimit) -> None:
    """Raise `RingsForm` if the gap decreases outwards from above the gap of largest tension to an unstable one."""
    least_outside = np.minimum.accumulate(state.gap[::-1])[::-1]
    ring = (state.gap > state.disc.problem.force.peak_gap(state.radius)) & (least_outside <= limit.farthest)
    if np.any(state.gap[ring] - least_outside[ring] > _FALL):
        raise limit.refusal(state.disc.problem)
