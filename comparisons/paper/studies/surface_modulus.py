"""Effect of a non-zero surface modulus, E = E0 ((z + z_s) / c0)^k, by both references; not in the paper.

E0, c0, k, Poisson's ratio, the sphere (n = 2) and the surface law are fixed, so that only the modulus of the skin
changes: it is E0 (z_s / c0)^k at the surface instead of zero, and hardly changes at depths z >> z_s.  The material is
stated by mu, the Tabor number (Eq. 29) of the limit z_s = 0, and z_s is measured in the transverse length
L = (Q z0)^(1/n) (Eq. 25).  The finite elements and the FSCM, which share no code, solve every case.  Both limits are
power laws:

* z_s -> 0, the graded solid, FSCM at (k, mu).  The skin stiffens a share of about z_s^(1-k) of the compliance.
* z_s -> infinity, the uniform solid of the modulus E(0) = E0 (z_s / c0)^k, FSCM at k = 0 and its own Tabor number
  mu_0(z_s), which falls as z_s^(-2k/3): a thick skin is a stiff solid, on the way to Bradley's.

The elements resolve z_s together with the contact edge; their exact exterior takes over at least 64 z_s below the
surface, and the results do not depend on where.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import fem_reference
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.studies.surface_modulus_figure import draw
from comparisons.paper.studies.surface_modulus_tables import Sample, limits, samples, thresholds
from comparisons.paper.tasks import quantity
from comparisons.quantities import QUANTITIES
from fscm import NoSuchEvent, NotConverged, OffsetPowerLaw, PowerLaw, solve_together
from fscm.problem import Problem

__all__ = ["SURFACE_MODULUS", "homogeneous_tabor_number", "with_skin", "with_skin_by_fscm"]

_N, _POISSON = 2.0, 0.3

#: (k, mu) of the graded limit and the depths z_s / L.  A skin of 1e-4 under a sharp edge (mu = 2) costs a minute.
_SERIES: dict[tuple[float, float], tuple[float, ...]] = {
    (0.4, 1.0): (1e-4, 1e-3, 1e-2, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
    (0.4, 2.0): (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
    (0.6, 1.0): (1e-3, 1e-2, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
}
#: The uniform limit is shown from here on; far below, its Tabor number does not describe the solid.
_THICK = 0.3

#: Quantities that share a family of meshes: their contact edge is at one radius, that of the first.
_EVENTS = {
    "pull-off": ("pull_off_force", "pull_off_displacement"),
    "jump-out": ("jump_out_displacement", "jump_in_displacement", "jump_out_energy"),
    "landing": ("jump_in_energy",),
}
#: Quantities of the tables; the hysteresis is the sum of the losses of both jumps.
_REPORTED = (
    "pull_off_force",
    "pull_off_displacement",
    "jump_in_displacement",
    "jump_out_displacement",
    "hysteresis_energy",
)

# No scale is 1, so that a wrong power of one shows.
_SCALES = {"c0": 3.0, "Q": 2.0, "work_of_adhesion": 0.7, "z0": 0.25}


def _graded(k: float, mu: float) -> tuple[PowerLaw, Problem]:
    """The graded limit in units, and its solid."""
    physical = Problem(_N, k, mu).in_units(nu=_POISSON, **_SCALES)
    return physical.solid, physical  # type: ignore[return-value]


def homogeneous_tabor_number(k: float, mu: float, depth: float) -> float:
    """Tabor number of the uniform solid with the surface modulus E0 (z_s / c0)^k, dimensionless.

    Parameters
    ----------
    k, mu : float
        The graded solid, z_s = 0.
    depth : float
        z_s / L, > 0.

    Examples
    --------
    >>> thin, thick = (homogeneous_tabor_number(0.4, 1.0, depth) for depth in (1.0, 1000.0))
    >>> round(thin / thick, 6) == round(1000 ** (2 * 0.4 / 3), 6)
    True
    """
    solid, graded = _graded(k, mu)
    modulus = solid.E0 * (depth * graded.units["radius"] / solid.c0) ** k
    return Problem(PowerLaw(modulus, solid.c0, 0.0, _POISSON), graded.punch, graded.law).mu


def with_skin(event: str, k: float, mu: float, depth: float) -> dict[str, Any]:
    """Return the quantities of an event of the solid with a surface modulus, dimensionless, with their uncertainty.

    Parameters
    ----------
    event : {"pull-off", "jump-out", "landing"}
        Which family of meshes; see `_EVENTS`.
    k, mu, depth : float
        As for `homogeneous_tabor_number`.

    Returns
    -------
    dict
        ``reason`` (empty, or why there is no such event) and by quantity ``[value, u_num]``, in the units of the
        graded problem (Eqs. 25 and 31), which do not contain z_s.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.

    Examples
    --------
    >>> with_skin("jump-out", 0.4, 0.1, 100.0)["reason"]
    'the displacement rises all along the path: this solid is too stiff for jumps'
    """
    solid, graded = _graded(k, mu)
    try:
        found = fem_reference.solve_together(
            fem_reference.Problem(
                fem_reference.OffsetPowerLaw(solid.E0, solid.c0, k, depth * graded.units["radius"], _POISSON),
                fem_reference.PowerPunch(n=_N, Q=_SCALES["Q"]),
                fem_reference.LennardJones(work_of_adhesion=_SCALES["work_of_adhesion"], z0=_SCALES["z0"]),
            ),
            _EVENTS[event],
            "quick",
        )
    except fem_reference.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    by_quantity: dict[str, Any] = {"reason": ""}
    for name, solution in found.items():
        if isinstance(solution, fem_reference.NoSuchEvent):
            return {"reason": str(solution)}
        unit = graded.units[_kind(name)]
        by_quantity[name] = [solution.value / unit, solution.u_num / unit]
    return by_quantity


def with_skin_by_fscm(k: float, mu: float, depth: float) -> dict[str, Any]:
    """Return the quantities of the tables by the FSCM, in the same units as `with_skin`.

    Parameters
    ----------
    k, mu, depth : float
        As for `homogeneous_tabor_number`.

    Returns
    -------
    dict
        By quantity ``[value, u_num]``, or the reason why there is no such event.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.

    Examples
    --------
    >>> round(with_skin_by_fscm(0.4, 1.0, 1000.0)["pull_off_force"][0], 6)
    1.947256
    """
    solid, graded = _graded(k, mu)
    skin = OffsetPowerLaw(solid.E0, solid.c0, k, depth * graded.units["radius"], _POISSON)
    problem = Problem(skin, graded.punch, graded.law)
    try:
        found = solve_together(problem.dimensionless, _REPORTED)
    except NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    return {
        name: str(event) if isinstance(event, NoSuchEvent) else [event.value, event.u_num]
        for name, event in found.items()
    }


def _kind(name: str) -> str:
    return QUANTITIES[name].scale if name in QUANTITIES else "energy"


def _reference(name: str, k: float, mu: float) -> CachedCall:
    return CachedCall.of(quantity, "fscm", name, _N, k, mu)


def _uniform(name: str, k: float, mu: float, depth: float) -> CachedCall:
    return _reference(name, 0.0, homogeneous_tabor_number(k, mu, depth))


def _tasks() -> Sequence[CachedCall]:
    cases = [(k, mu, depth) for (k, mu), depths in _SERIES.items() for depth in depths]
    # The sharper the edge and the thinner the skin, the longer it takes.
    cases.sort(key=lambda case: (-case[1], case[2], -case[0]))
    elements = [CachedCall.of(with_skin, event, *case) for case in cases for event in _EVENTS]
    second = [CachedCall.of(with_skin_by_fscm, *case) for case in cases]
    graded = [_reference(name, k, mu) for k, mu in _SERIES for name in _REPORTED]
    uniform = [_uniform(name, *case) for case in cases if case[2] >= _THICK for name in _REPORTED]
    return elements + second + graded + uniform


def _sample(results: Results, k: float, mu: float, depth: float, name: str) -> Sample:
    parts = {event: results[CachedCall.of(with_skin, event, k, mu, depth)] for event in _EVENTS}
    known = {key: value for part in parts.values() for key, value in part.items() if key != "reason"}
    pieces = ("jump_in_energy", "jump_out_energy") if name == "hysteresis_energy" else (name,)
    reason = (
        "" if all(piece in known for piece in pieces) else parts["jump-out"]["reason"] or parts["landing"]["reason"]
    )
    fscm = results[CachedCall.of(with_skin_by_fscm, k, mu, depth)][name]
    return Sample(
        k=k,
        mu=mu,
        depth=depth,
        mu_homogeneous=homogeneous_tabor_number(k, mu, depth),
        quantity=name,
        elements=None if reason else (sum(known[p][0] for p in pieces), sum(known[p][1] for p in pieces)),
        fscm=None if isinstance(fscm, str) else (fscm[0], fscm[1]),
        reason=reason,
        graded=_number(results[_reference(name, k, mu)]),
        homogeneous=_number(results[_uniform(name, k, mu, depth)]) if depth >= _THICK else None,
    )


def _number(found: dict[str, Any]) -> tuple[float, float] | None:
    return (found["value"], found["u_num"]) if found["status"] == "ok" else None


def _tables(results: Results) -> Tables:
    found = [
        _sample(results, k, mu, depth, name)
        for (k, mu), depths in _SERIES.items()
        for name in _REPORTED
        for depth in depths
    ]
    return {"": samples(found), "limits": limits(found), "thresholds": thresholds(found)}


SURFACE_MODULUS = PaperFigure(
    name="surface-modulus",
    stem="surface_modulus",
    title="A non-zero surface modulus, from graded to uniform: pull-off, jumps and hysteresis",
    tasks=_tasks,
    tables=_tables,
    draw=draw,
)
