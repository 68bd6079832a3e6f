"""Errors of the closed forms against the full self-consistent model over (n, mu) and (k, mu).

The error is relative, kappa = (model - FSCM) / |FSCM|, also for the jumps: wherever a jump exists its displacement is
beyond -z0, so no divisor is small, and an experiment measures this displacement.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pandas as pd

from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.tasks import quantity

__all__ = ["CANDIDATES", "ONSET_EXCESS", "all_cases", "compared", "errors", "errors_at", "tasks", "with_kappa"]

#: Closed forms, by quantity.  DMT has Bradley's pull-off force by the choice of its cohesive stress (Eq. 74).
CANDIDATES = {
    "pull_off_force": ("md-improved", "md-original", "jkr", "bradley"),
    "jump_in_displacement": ("semi-rigid",),
    "jump_out_displacement": ("jkr", "md-improved", "md-original"),
}

#: Tabor numbers, from nearly rigid to nearly JKR; jumps begin between 0.64 and 1.32, by shape and gradient.
TABOR = (0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 0.8, 1.0, 1.4, 2.0, 3.2, 5.0)

#: Maps over the shape index (the attraction of the 9-3 law has no finite sum for n <= 2/3), at these gradients.
SHAPES = (0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.5, 5.0, 8.0)
#: Gradient exponents of the maps over the shape index.
SHAPE_SLICES = (0.0, 0.4)

#: Maps over the gradient exponent (beyond 0.8 the cohesive edge is too narrow at large mu), at these shapes.
GRADIENTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8)
#: Shape indices of the maps over the gradient exponent.
GRADIENT_SLICES = (1.5, 2.0)

#: The first errors of the jumps are this fraction above the critical Tabor number, where the jumps merge.
ONSET_EXCESS = 1e-3

Case = tuple[float, float, float]


def all_cases() -> list[Case]:
    """Return (n, k, mu) of the maps over the shape index and over the gradient exponent, each once."""
    over_shapes = [(n, k, mu) for k in SHAPE_SLICES for n in SHAPES for mu in TABOR]
    over_gradients = [(n, k, mu) for n in GRADIENT_SLICES for k in GRADIENTS for mu in TABOR]
    return list(dict.fromkeys(over_shapes + over_gradients))


def errors_at(n: float, k: float, mu: float) -> dict[str, dict[str, Any]]:
    """Return the results of the FSCM and the closed forms by quantity, each as of `comparisons.paper.tasks.quantity`.

    Examples
    --------
    >>> found = errors_at(2.0, 0.4, 0.1)
    >>> round(found["pull_off_force"]["fscm"]["value"], 6), found["jump_in_displacement"]["fscm"]["status"]
    (1.983795, 'not-applicable')
    """
    return {
        name: {model: quantity(model, name, n, k, mu) for model in ("fscm", *models)}
        for name, models in CANDIDATES.items()
    }


def tasks(cases: Iterable[Case]) -> list[CachedCall]:
    """Return the tasks of these cases; soft, sharp and steep ones take longest."""
    return [CachedCall.of(errors_at, *case) for case in sorted(cases, key=lambda case: (-case[2], case[0], -case[1]))]


def errors(results: Results, cases: Iterable[Case], quantities: Iterable[str]) -> pd.DataFrame:
    """Return one row a case, quantity and model.

    Returns
    -------
    DataFrame
        ``n``, ``k``, ``mu``, ``quantity``, ``model``; ``value``, ``u_num``, ``fscm``, ``u_fscm`` and ``kappa``,
        ``u_kappa`` (its numerical uncertainty), NaN where one of the two has no value; ``reason`` then has the reason.
    """
    rows = []
    for n, k, mu in cases:
        found = results[CachedCall.of(errors_at, n, k, mu)]
        for name in quantities:
            for model in CANDIDATES[name]:
                key = {"n": n, "k": k, "mu": mu, "quantity": name, "model": model}
                rows.append(key | compared(found[name]["fscm"], found[name][model]))
    return with_kappa(rows)


def compared(fscm: dict[str, Any], candidate: dict[str, Any]) -> dict[str, Any]:
    """Return the results of a closed form and of the FSCM as columns, and the reason why one of them is missing."""
    numbers = {"value": candidate["value"], "u_num": candidate["u_num"], "fscm": fscm["value"], "u_fscm": fscm["u_num"]}
    return numbers | {"reason": fscm["reason"] or candidate["reason"]}


def with_kappa(rows: list[dict[str, Any]]) -> pd.DataFrame:
    """Return rows with the columns of `compared` as a table with kappa and its uncertainty."""
    table = pd.DataFrame(rows).astype(dict.fromkeys(("value", "u_num", "fscm", "u_fscm"), float))
    reason = table.pop("reason")
    kappa = relative_difference(table["value"], table["fscm"])
    u_kappa = relative_uncertainty(table["value"], table["u_num"], table["fscm"], table["u_fscm"])
    return table.assign(kappa=kappa, u_kappa=u_kappa, reason=reason)
