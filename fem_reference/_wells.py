"""Wells of a surface law: the gaps at which it holds two faces, and the work of its tension alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fem_reference._roots import root_between
from fem_reference._typing import Array
from fem_reference.laws import LennardJones, Mie, SurfaceLaw

__all__ = ["has_one_well", "outermost_turn", "scale_of_energy", "stable_gaps", "work_of_tension"]

#: Gaps at which the sign of a traction is looked at: distances from the singular gap in units of that of the largest
#: tension, 0.5 % apart.
DISTANCES = np.geomspace(1e-2, 1e6, 4000)

#: Change of the traction, relative to the largest tension, below which it does not count as a turn.
SMALLEST_TURN = 1e-9


def stable_gaps(traction: Callable[[Array], Array], gaps: Array) -> list[float]:
    """Return the gaps where a repulsion turns into a tension, between rising samples.

    Examples
    --------
    >>> [round(gap, 12) for gap in stable_gaps(np.cos, np.linspace(0.0, 9.0, 100))]
    [1.570796326795, 7.853981633974]
    """
    p = traction(gaps)
    falls = np.flatnonzero((p[:-1] > 0) & (p[1:] <= 0))
    return [
        root_between(lambda gap: float(traction(np.array(gap))), gaps[i], gaps[i + 1], 1e-15 * abs(gaps[i]), 1e-15)
        for i in falls
    ]


def work_of_tension(law: SurfaceLaw) -> float:
    """Return the energy per area that the tension takes on separation, without what a repulsion farther out returns.

    It is the work of adhesion of a law with one well, to 1e-4, and more than it with a barrier.

    Examples
    --------
    >>> work_of_tension(LennardJones(work_of_adhesion=2.0, z0=0.5))
    2.0
    """
    if isinstance(law, LennardJones | Mie):
        return law.work_of_adhesion
    gaps = law.singular_gap + (law.peak_gap - law.singular_gap) * DISTANCES
    energy, p = law.energy(gaps), law.traction(gaps)
    under_tension = 0.5 * (p[:-1] + p[1:]) < 0
    return float(np.sum(np.diff(energy)[under_tension]) - energy[-1])


def scale_of_energy(law: SurfaceLaw) -> float:
    """Return the work of adhesion, or that of the tension alone where no well adheres: a scale of lengths.

    Examples
    --------
    >>> scale_of_energy(LennardJones(work_of_adhesion=2.0, z0=0.5))
    2.0
    """
    return law.work_of_adhesion if law.work_of_adhesion > 0.0 else work_of_tension(law)


def outermost_turn(law: SurfaceLaw) -> float:
    """Return the gap beyond which the tension only falls.

    Examples
    --------
    >>> law = LennardJones(work_of_adhesion=2.0, z0=0.5)
    >>> outermost_turn(law) == law.peak_gap
    True
    """
    if isinstance(law, LennardJones | Mie):
        return law.peak_gap
    gaps = law.peak_gap + (law.peak_gap - law.singular_gap) * DISTANCES
    tension = -law.traction(gaps)
    beyond = np.maximum.accumulate(tension[::-1])[::-1]
    growing = np.flatnonzero(beyond - tension > SMALLEST_TURN * beyond[0])
    return float(gaps[growing[-1] + 1]) if growing.size else law.peak_gap


def has_one_well(law: SurfaceLaw) -> bool:
    """Return whether the tension only falls beyond its largest.

    Examples
    --------
    >>> has_one_well(LennardJones(work_of_adhesion=2.0, z0=0.5))
    True
    """
    return outermost_turn(law) == law.peak_gap
