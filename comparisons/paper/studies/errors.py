"""Errors of the closed forms against the full self-consistent model, at points of a grid and along lines of the atlas.

The error is relative, kappa = (model - FSCM) / |FSCM|, also for the jumps: wherever a jump exists its displacement is
beyond -z0, so no divisor is small, and an experiment measures this displacement.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.paper.tasks import quantity
from fscm.interpolation.atlas import atlas

__all__ = ["CANDIDATES", "TABOR_RANGE", "compared", "errors_at", "line_errors", "with_kappa"]

#: Closed forms, by quantity.  DMT has Bradley's pull-off force by the choice of its cohesive stress (Eq. 74).
CANDIDATES = {
    "pull_off_force": ("md-improved", "md-original", "jkr", "bradley"),
    "jump_in_displacement": ("semi-rigid",),
    "jump_out_displacement": ("jkr", "md-improved", "md-original"),
}
#: The same of the lines: one closed form for each jump.
_MAPPED = CANDIDATES | {"jump_out_displacement": ("jkr",)}

#: Tabor numbers of a line, from nearly rigid to nearly JKR; jumps begin at the critical one, where they merge.
TABOR_RANGE, _ONSET_EXCESS = (0.01, 5.0), 1e-3
#: So many points that straight lines between them look like curves in a panel of 3 inches.
_TABOR_NUMBERS, _AT_JUMPS = 28, 18


def errors_at(n: float, k: float, mu: float) -> dict[str, dict[str, Any]]:
    """Return the results of the FSCM and the closed forms by quantity, each as of `comparisons.paper.tasks.quantity`.

    Examples
    --------
    >>> results = errors_at(2.0, 0.4, 0.1)
    >>> round(results["pull_off_force"]["fscm"]["value"], 6), results["jump_in_displacement"]["fscm"]["status"]
    (1.983795, 'not-applicable')
    """
    return {
        name: {model: quantity(model, name, n, k, mu) for model in ("fscm", *models)}
        for name, models in CANDIDATES.items()
    }


def line_errors(n: float, k: float) -> dict[str, Any]:
    """Return reference values of the atlas and those of the closed forms over the Tabor number.

    Returns
    -------
    dict
        ``critical`` and ``u_critical``, the critical Tabor number; ``points``, for each quantity a list of dicts with
        ``mu``, ``fscm`` and each closed form, as of `comparisons.paper.tasks.quantity`.

    Examples
    --------
    >>> line = line_errors(2.0, 0.4)
    >>> round(line["critical"], 4), round(line["points"]["pull_off_force"][0]["bradley"]["value"], 9)
    (0.7825, 2.0)
    """
    critical = atlas(n, k, TABOR_RANGE[1], "critical_tabor_number")
    above = np.geomspace(critical.value * (1.0 + _ONSET_EXCESS), TABOR_RANGE[1], _AT_JUMPS)
    points = {}
    for name, models in _MAPPED.items():
        numbers = np.geomspace(*TABOR_RANGE, _TABOR_NUMBERS) if name == "pull_off_force" else above
        reference = atlas(n, k, numbers, name)
        points[name] = [
            {"mu": mu, "fscm": {"value": value, "u_num": bound, "reason": ""}}
            | {model: quantity(model, name, n, k, mu) for model in models}
            for mu, value, bound in np.column_stack([numbers, *reference]).tolist()
        ]
    return {"critical": critical.value, "u_critical": critical.bound, "points": points}


def compared(results: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return a row for each closed form of a point, the reason where its value or that of the FSCM is missing."""
    fscm = results["fscm"]
    return [
        {
            "model": model,
            "value": closed["value"],
            "u_num": closed["u_num"],
            "fscm": fscm["value"],
            "u_fscm": fscm["u_num"],
            "reason": fscm["reason"] or closed["reason"],
        }
        for model, closed in results.items()
        if model not in ("fscm", "mu")
    ]


def with_kappa(rows: Iterable[dict[str, Any]]) -> pd.DataFrame:
    """Return rows of `compared` as a table with kappa and its uncertainty, NaN where a value is missing."""
    table = pd.DataFrame(rows).astype(dict.fromkeys(("value", "u_num", "fscm", "u_fscm"), float))
    reason = table.pop("reason")
    kappa = relative_difference(table["value"], table["fscm"])
    u_kappa = relative_uncertainty(table["value"], table["u_num"], table["fscm"], table["u_fscm"])
    return table.assign(kappa=kappa, u_kappa=u_kappa, reason=reason)
