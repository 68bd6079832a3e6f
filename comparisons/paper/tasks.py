"""Functions that the figures of the paper call: the result of a model as JSON, or its refusal or failure.

A refusal is a result here: a figure leaves the point out or writes its status, and the other points are not lost.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.model import ComputationFailed, HasCurve, HasProfile, NotApplicable
from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.problem import Problem
from comparisons.quantities.points import FARTHEST_GAP
from comparisons.registry import create
from comparisons.runs.tasks import evaluate

__all__ = ["COHESIVE", "cohesive_surface", "curve", "profile", "quantity"]

Json = dict[str, Any]

#: The Maugis-Dugdale models, by name.
COHESIVE = {model.name: model for model in (MaugisDugdaleOriginal(), MaugisDugdaleImproved())}


def quantity(model: str, name: str, n: float, k: float, mu: float) -> Json:
    """Evaluate a quantity by a model.

    Parameters
    ----------
    model, name : str
        As in `comparisons.registry.MODELS` and `comparisons.quantities.QUANTITIES`.
    n, k, mu : float
        The case, dimensionless.

    Returns
    -------
    dict
        ``value`` and ``u_num`` (float, or None without a result), ``status`` ("ok", "not-applicable" or "failed")
        and ``reason`` (a sentence, empty if ok).

    Examples
    --------
    >>> quantity("bradley", "pull_off_force", 2, 0.4, 1)["value"]
    2.0
    >>> quantity("bradley", "jump_in_gap", 2, 0.4, 1)["status"]
    'not-applicable'
    """

    def evaluated() -> Json:
        row = evaluate(create(model), name, Problem.dimensionless(n, k, mu))
        return {name: getattr(row, name) for name in ("value", "u_num", "status", "reason")}

    return {"value": None, "u_num": None} | _with_status(evaluated)


def curve(model: str, n: float, k: float, mu: float) -> Json:
    """Trace the force-displacement curve of a model, from far away into contact.

    Returns
    -------
    dict
        ``status`` and ``reason`` as of `quantity`; if ok also ``displacement`` and ``load`` (lists of floats),
        ``u_displacement`` and ``u_load`` (bounds on the numerical error of each), and ``columns``: what else
        the model has at each point, by name, as ``central_gap`` (lists, None where it is not defined).

    Examples
    --------
    >>> path = curve("jkr", 2, 0.4, 1)
    >>> path["status"], path["displacement"][0], sorted(path["columns"])
    ('ok', 0.0, ['contact_radius'])
    """

    def traced() -> Json:
        tracing = create(model)
        if not isinstance(tracing, HasCurve):
            raise NotApplicable(f"{model} has no force-displacement curve")
        path = tracing.curve(Problem.dimensionless(n, k, mu))
        return {
            "displacement": _numbers(path.displacement),
            "load": _numbers(path.load),
            "u_displacement": path.u_distance * float(np.ptp(path.displacement)),
            "u_load": path.u_distance * float(np.ptp(path.load)),
            "columns": {name: _numbers(values) for name, values in path.columns.items()},
        }

    return _with_status(traced)


def profile(model: str, n: float, k: float, mu: float) -> Json:
    """Return the surface of a model where P is smallest, out to the gap `FARTHEST_GAP`.

    Returns
    -------
    dict
        ``status`` and ``reason`` as of `quantity`; if ok also ``radius``, ``pressure`` and ``gap`` (lists of floats,
        radii increasing) and ``u_distance``, a bound on the distance of the pressure curve from the exact one as a
        fraction of its ranges.

    Examples
    --------
    >>> profile("bradley", 2, 0.4, 1)["reason"]
    'bradley has no profile at pull-off'
    """

    def traced() -> Json:
        tracing = create(model)
        if not isinstance(tracing, HasProfile):
            raise NotApplicable(f"{model} has no profile at pull-off")
        surface = tracing.pull_off_profile(Problem.dimensionless(n, k, mu))
        inside = surface.gap <= FARTHEST_GAP
        columns = {name: _numbers(getattr(surface, name)[inside]) for name in ("radius", "pressure", "gap")}
        return columns | {"u_distance": float(surface.u_distance)}

    return _with_status(traced)


def cohesive_surface(model: str, n: float, k: float, mu: float) -> Json:
    """Return the surface of a Maugis-Dugdale model at pull-off.

    Returns
    -------
    dict
        ``contact_radius`` and ``cohesive_radius`` (a and c), ``displacement``; ``radius``, ``pressure``, ``gap`` as
        lists, in barred variables.

    Raises
    ------
    NotApplicable
        Where the cohesive zone has no width.

    Examples
    --------
    >>> zone = cohesive_surface("md-improved", 2, 0.4, 1)
    >>> round(zone["contact_radius"], 3), round(zone["cohesive_radius"], 3)
    (1.264, 2.054)
    """
    zone = COHESIVE[model].profiles(Problem.dimensionless(n, k, mu))
    numbers = {name: getattr(zone, name) for name in ("contact_radius", "cohesive_radius", "displacement")}
    return numbers | {name: getattr(zone, name).tolist() for name in ("radius", "pressure", "gap")}


def _with_status(function: Callable[[], Json]) -> Json:
    try:
        return {"status": "ok", "reason": "", **function()}
    except NotApplicable as refusal:
        return {"status": "not-applicable", "reason": str(refusal)}
    except (ComputationFailed, ValueError) as failure:
        return {"status": "failed", "reason": str(failure)}


def _numbers(values: NDArray[np.float64]) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
