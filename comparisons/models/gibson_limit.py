"""Force-displacement curve and surface of the full self-consistent model at k = 1, in closed form.

The surface moves only where it is pressed, w = M p, so that every radius has a gap of its own at the level
u = f(r) - delta: a far one, or inside the front of a contact a near one (`fscm.gibson`).
"""

from __future__ import annotations

import numpy as np

from comparisons.model import FARTHEST_GAP, Array, Curve, RadialField
from fscm.gibson import GibsonSolid, LocalEquilibrium, root
from fscm.problem import Problem

#: Points of each part of a curve and of each side of the front of a profile.
_POINTS = 120
#: Curves begin at the central gap 10 + 5 mu as those for k < 1; profiles end at a gap of 10.
_START_PER_MU = 5.0
#: Step inwards, as a factor of the gap less that of the singularity, in search of the end of a curve.
_INWARDS = 0.97
#: Bound on the error of a load as a fraction of the range of the curve; the quadrature has tolerance 1e-13 (measured
#: worst 1e-15 for n = 2 and mu up to 3, against the closed form P = 2 e of the energy e at the axis).
_U_DISTANCE = 1e-12


def gibson_curve(problem: Problem) -> Curve:
    """Return the equilibrium path at k = 1; columns ``central_gap`` and the marks of stability.

    It leads from far away to the fold A, back from A to B on the same line (the unstable germ of a contact carries
    no load, and its central gap has no limit: NaN), and on the contact branch from B to where the load is as
    compressive as it was tensile.

    Examples
    --------
    >>> curve = gibson_curve(Problem(n=2, k=1, mu=1.0))
    >>> bool(abs(curve.load.min() + 2.0) < 1e-3)
    True
    """
    solid = GibsonSolid(problem)
    local = LocalEquilibrium(problem.law, problem.compliance)
    start = FARTHEST_GAP + _START_PER_MU * problem.mu
    if local.folds and local.front:
        approach = [*_between(start, local.folds[1]), *_between(local.folds[1], local.front.far)]
        entry = local.front.near
    else:
        approach = [*_between(start, local.law.peak_gap)]
        entry = local.law.peak_gap
    contact = _between(entry, _end(solid, entry))
    gaps = np.array([*approach, *contact])
    load = np.array([solid.load(float(gap)) for gap in gaps])
    central_gap = gaps.copy()
    held = np.ones(len(gaps), bool)
    if local.folds:
        central_gap[_POINTS : 2 * _POINTS] = np.nan
        # Both folds are stable to one side only.
        held[_POINTS - 1 : 2 * _POINTS + 1] = False
    rises = np.diff(load, prepend=load[0]) > 0.0
    return Curve(
        np.array([-local.level(float(gap)) for gap in gaps]),
        load,
        {
            "central_gap": central_gap,
            "stable_under_displacement": held.astype(float),
            "stable_under_load": (held & rises).astype(float),
        },
        u_distance=_U_DISTANCE,
    )


def _between(start: float, end: float) -> list[float]:
    """Gaps from `start` to `end`, both exactly, closer where the gap is smaller."""
    gaps = np.geomspace(1.0 + start, 1.0 + end, _POINTS) - 1.0
    return [start, *map(float, gaps[1:-1]), end]


def _end(solid: GibsonSolid, entry: float) -> float:
    """Central gap on the contact branch where the load is as compressive as the pull-off is tensile."""
    force = solid.solution("pull_off_force").value
    gap = entry
    while solid.load(gap) <= force:
        gap = _INWARDS * (1.0 + gap) - 1.0
    return root(lambda H: solid.load(H) - force, gap, entry)


def gibson_profile(problem: Problem) -> RadialField:
    """Return the surface at k = 1 where P is smallest; two points share the radius of the front.

    Examples
    --------
    >>> surface = gibson_profile(Problem(n=2, k=1, mu=1.0))
    >>> bool(abs(surface.pressure[0]) < 1e-6)          # the pull-off of a paraboloid has p(0) = 0
    True
    """
    solid = GibsonSolid(problem)
    local = LocalEquilibrium(problem.law, problem.compliance)
    delta = solid.solution("pull_off_displacement").value
    inner, outer = local.near(-delta), local.far(-delta)
    in_contact = local.front is not None and -delta < local.front.level and solid.load(inner) <= solid.load(outer)
    if local.front and in_contact:
        gap = np.concatenate([_towards(inner, local.front.near), _towards(local.front.far, FARTHEST_GAP)])
    else:
        gap = _towards(outer, FARTHEST_GAP)
    level = np.array([local.level(float(H)) for H in gap])
    radius = (problem.n * np.maximum(level + delta, 0.0)) ** (1.0 / problem.n)
    # The two levels of the front are one, but for rounding.
    return RadialField(np.maximum.accumulate(radius), problem.law.traction(gap), gap, _U_DISTANCE, _U_DISTANCE)


def _towards(start: float, end: float) -> Array:
    """Gaps from `start` to `end`, closer at the start, where the radius rises steeply with the gap."""
    return start + (end - start) * np.linspace(0.0, 1.0, _POINTS) ** 2
