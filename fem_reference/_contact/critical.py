"""Search for the modulus below which the contact jumps: a problem just stiffer than it.

On the mesh of one estimate of the modulus the path is traced at moduli that grow, or fall, by a factor until the
displacement falls somewhere along one path and along its neighbour nowhere.  Newton's method for the cusp
(`fem_reference._contact.cusp`) begins between both.  A little above the modulus it finds, paths have no fold, which the
complete path there verifies.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.cusp import cusp_from, slowest
from fem_reference._contact.event_kinds import CUSP
from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.path import traced
from fem_reference._contact.states import Point
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._wells import scale_of_energy
from fem_reference.errors import Failure, NoSuchEvent, NotConverged
from fem_reference.problem import Problem
from fem_reference.punch import radius_at_height
from fem_reference.solid import PowerLaw, ScaledSolid
from fem_reference.solids import OffsetPowerLaw

__all__ = ["NearCritical", "stiffer_than_critical"]

#: Displacement of the solid, in lengths of the law, under its work of adhesion over that length, spread over the radius
#: where the punch is as high, at the critical modulus (0.4 to 0.7 for powers n = 1 ... 5 and k = 0 ... 0.6).
SHARE = 0.68

#: Ratio of neighbouring moduli of the search.
FACTOR = 1.25

#: Largest ratio of a modulus of the search to its estimate, either way.
WIDEST = 1e3

#: Largest number of halvings of an interval in which Newton's method does not find the cusp.
HALVINGS = 8

#: Modulus of the problem that is returned, relative to the critical one of the coarse mesh.
MARGIN = 1.01


@dataclass(frozen=True, slots=True)
class NearCritical:
    """A problem slightly stiffer than the critical one.

    Attributes
    ----------
    problem : Problem
    E0 : float
        Modulus of its solid.
    start : tuple of MeshSpec and float
        The mesh and the size of the search, from which those of the problem are found.
    """

    problem: Problem
    E0: float
    start: tuple[MeshSpec, float]


@dataclass(frozen=True, slots=True)
class _Trial:
    """The slowest point of the path at one modulus."""

    log_ratio: float
    point: Point

    @property
    def rate(self) -> float:
        """Change of the displacement along the path: negative if there are jumps."""
        return self.point.displacement_rate


def stiffer_than_critical(problem: Problem, accuracy: float | str) -> NearCritical:
    """Return the problem with a modulus slightly above the critical one, below which the contact jumps.

    Parameters
    ----------
    problem : Problem
        The modulus E0 of its solid is not used.
    accuracy : float or str
        As for `fem_reference.solve`.

    Returns
    -------
    NearCritical

    Raises
    ------
    ValueError
        If the solid has no reference modulus.
    NoSuchEvent
        If no jump begins within a factor `WIDEST` of the estimate.
    NotConverged
        If a path cannot be traced, or the cusp is not found.
    """
    bonded = problem.solid if isinstance(problem.solid, ScaledSolid) else None
    solid = problem.solid if bonded is None else bonded.solid
    if not isinstance(solid, PowerLaw | OffsetPowerLaw):
        raise ValueError(
            f"solid = {solid!r} has no reference modulus E0, which the critical modulus is a value of; take a PowerLaw"
        )
    if len(problem.solids) > 1 or solid.surface_tension:
        raise ValueError(
            "the critical modulus is known for one solid without surface tension, whose whole stiffness is in "
            "proportion to E0; leave out punch_solid and surface_tension"
        )

    def with_modulus(E0: float) -> Problem:
        changed = replace(solid, E0=E0)
        return replace(problem, solid=changed if bonded is None else replace(bonded, solid=changed))

    E0 = _estimate(problem, solid)
    estimate = with_modulus(E0)
    mesh = chosen(estimate, (CUSP,), accuracy)
    contact = mesh.contact

    def trial(log_ratio: float) -> _Trial:
        stiffer = replace(contact, compliance=contact.compliance.stiffened(math.exp(log_ratio)))
        return _Trial(log_ratio, slowest(traced(stiffer)))

    E0 *= MARGIN * _stiffness(_cusp_between(*_bracket(trial), trial).branch.contact)
    return NearCritical(with_modulus(E0), E0, (mesh.spec, mesh.size))


def _estimate(problem: Problem, solid: PowerLaw | OffsetPowerLaw) -> float:
    """Estimate the critical modulus: there the tension of the law moves the solid by `SHARE` lengths of the law."""
    law = problem.law
    radius = radius_at_height(problem.punch, law.z0)
    relative = float(replace(solid, E0=1.0).modulus(np.array(radius))) / (1.0 - solid.nu**2)
    return scale_of_energy(law) * radius / (SHARE * law.z0**2 * relative)


def _bracket(trial: Callable[[float], _Trial]) -> tuple[_Trial, _Trial]:
    """Two neighbouring moduli, the lower of which has jumps."""
    trial_before = trial(0.0)
    step = math.log(FACTOR) * (-1.0 if trial_before.rate > 0.0 else 1.0)
    while abs(trial_before.log_ratio) < math.log(WIDEST):
        trial_after = trial(trial_before.log_ratio + step)
        if (trial_after.rate > 0.0) != (trial_before.rate > 0.0):
            return (
                (trial_after, trial_before)
                if trial_after.log_ratio < trial_before.log_ratio
                else (trial_before, trial_after)
            )
        trial_before = trial_after
    have = "no path has jumps" if step < 0.0 else "every path has jumps"
    raise NoSuchEvent(f"{have} at the moduli up to a factor {WIDEST:g} from the one where jumps are expected to begin")


def _cusp_between(soft: _Trial, stiff: _Trial, trial: Callable[[float], _Trial]) -> Point:
    """Find the cusp between a modulus with jumps and one without."""
    for _ in range(HALVINGS):
        start = soft if abs(soft.rate) < abs(stiff.rate) else stiff
        try:
            cusp = cusp_from(start.point)
        except NotConverged:
            pass
        else:
            if soft.log_ratio <= math.log(_stiffness(cusp.branch.contact)) <= stiff.log_ratio:
                return cusp
        middle = trial(0.5 * (soft.log_ratio + stiff.log_ratio))
        soft, stiff = (soft, middle) if middle.rate > 0.0 else (middle, stiff)
    raise NotConverged("the modulus at which jumps begin was not found", Failure.EVENT)


def _stiffness(contact: Contact) -> float:
    return contact.compliance.stiffness
