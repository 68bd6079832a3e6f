"""Functions that the figures of the paper call: the result of a model as JSON, or its refusal or failure.

A refusal is a result here: a figure leaves the point out or writes its status, and the other points are not lost.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.model import ComputationFailed, HasCurve, HasProfile, NotApplicable
from comparisons.problem import Problem
from comparisons.quantities.points import FARTHEST_GAP
from comparisons.registry import create
from comparisons.runs.tasks import evaluate

__all__ = ["curve", "profile", "quantity"]

Json = dict[str, Any]


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
    return {"value": None, "u_num": None} | _with_status(
        lambda: _quantity(model, name, Problem.dimensionless(n, k, mu))
    )


def _quantity(model: str, name: str, case: Problem) -> Json:
    row = evaluate(create(model), name, case)
    return {"value": row.value, "u_num": row.u_num, "status": row.status, "reason": row.reason}


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
    >>> found = curve("jkr", 2, 0.4, 1)
    >>> found["status"], found["displacement"][0], sorted(found["columns"])
    ('ok', 0.0, ['contact_radius'])
    """
    return _with_status(lambda: _curve(model, Problem.dimensionless(n, k, mu)))


def _curve(model: str, case: Problem) -> Json:
    tracing = create(model)
    if not isinstance(tracing, HasCurve):
        raise NotApplicable(f"{model} has no force-displacement curve")
    found = tracing.curve(case)
    return {
        "displacement": _numbers(found.displacement),
        "load": _numbers(found.load),
        "u_displacement": found.u_distance * float(np.ptp(found.displacement)),
        "u_load": found.u_distance * float(np.ptp(found.load)),
        "columns": {name: _numbers(values) for name, values in found.columns.items()},
    }


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
    return _with_status(lambda: _profile(model, Problem.dimensionless(n, k, mu)))


def _profile(model: str, case: Problem) -> Json:
    tracing = create(model)
    if not isinstance(tracing, HasProfile):
        raise NotApplicable(f"{model} has no profile at pull-off")
    found = tracing.pull_off_profile(case)
    near = found.gap <= FARTHEST_GAP
    shapes: Mapping[str, NDArray[np.float64]] = {
        "radius": found.radius,
        "pressure": found.pressure,
        "gap": found.gap,
    }
    return {name: _numbers(values[near]) for name, values in shapes.items()} | {"u_distance": float(found.u_distance)}


def _with_status(function: Callable[[], Json]) -> Json:
    try:
        return {"status": "ok", "reason": "", **function()}
    except NotApplicable as refusal:
        return {"status": "not-applicable", "reason": str(refusal)}
    except (ComputationFailed, ValueError) as failure:
        return {"status": "failed", "reason": str(failure)}


def _numbers(values: NDArray[np.float64]) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]
