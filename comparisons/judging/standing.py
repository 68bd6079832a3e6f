"""The standing of models beside each other: the range in which a model is judged, shared ranks, the model to use."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import pandas as pd

from comparisons.description.choice import LIMITS, simplest_within
from comparisons.domain import NO_LIMITS, Domain, Range
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS, create


@cache
def _validity(model: str) -> Domain | None:
    """Return the range for which a model of this package is meant; None without limits, or of another model."""
    limits = getattr(create(model), "validity", {}) if model in MODELS else {}
    return Domain((Range(tuple(ALL_QUANTITIES), dict(limits)),)) if limits else None


def stated_range(model: str, domains: Mapping[str, Any]) -> Domain | None:
    """Return the range that a model declares; None if it declares none.

    Parameters
    ----------
    model : str
    domains : mapping
        Name of an external model -> its domain, as the record of a run has it.
    """
    return Domain.of_json(domains[model]) if model in domains else _validity(model)


def range_text(domain: Domain | None) -> str:
    """Return the limits of a range without its quantities; empty where it has none.

    Examples
    --------
    >>> range_text(stated_range("jkr", {})), range_text(stated_range("md-improved", {}))
    ('μ ≥ 5', '')
    """
    if domain is None:
        return ""
    texts = (", ".join(_limit(name, *ends) for name, ends in table.limits.items()) for table in domain.tables)
    return "; ".join(dict.fromkeys(filter(None, texts)))


def _limit(name: str, low: float, high: float) -> str:
    symbol = {"mu": "μ", "nu": "ν"}.get(name, name)
    if low == high:
        return f"{symbol} = {low:g}"
    if math.isinf(high):
        return f"{symbol} ≥ {low:g}" if (low, high) != NO_LIMITS else f"any {symbol}"
    return f"{symbol} ≤ {high:g}" if low <= 0.0 else f"{low:g} ≤ {symbol} ≤ {high:g}"


def inside(rows: pd.DataFrame, models: pd.Series, domains: Mapping[str, Any]) -> pd.Series:
    """Return whether each row is within the range that its model declares.

    Parameters
    ----------
    rows : DataFrame
        With the columns quantity, n, k, mu and nu; a parameter that is missing in a row does not restrict it.
    models : Series
        The model of each row.
    domains : mapping
        As of `stated_range`.

    Examples
    --------
    >>> rows = pd.DataFrame({"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": [0.1, 5.0], "nu": None})
    >>> inside(rows, pd.Series("jkr", rows.index), {}).tolist()
    [False, True]
    """
    ranges = {name: stated_range(name, domains) for name in models.unique()}
    cases = rows[["quantity", "n", "k", "mu", "nu"]].to_dict("records")
    within = [
        (domain := ranges[model]) is None
        or domain.contains(case["quantity"], {name: number for name, number in case.items() if number == number})
        for model, case in zip(models, cases, strict=True)
    ]
    return pd.Series(within, rows.index, dtype=bool)


def shared_ranks(sizes: Sequence[float], bounds: Sequence[float]) -> list[int | None]:
    """Return the rank of each error by its size; errors whose order their bounds do not decide share a rank.

    Parameters
    ----------
    sizes, bounds : sequence of float
        Absolute errors and the bounds on their numerical errors; an error that is not known has no rank.

    Examples
    --------
    >>> shared_ranks([0.3, 0.10, 0.11, math.nan], [0.01, 0.01, 0.01, math.nan])
    [3, 1, 1, None]
    """
    ranks: list[int | None] = [None] * len(sizes)
    known = sorted((index for index, size in enumerate(sizes) if size == size), key=lambda index: sizes[index])
    rank, reach = 1, -math.inf
    for before, index in enumerate(known):
        # All that stand before it are certainly smaller.
        if sizes[index] - bounds[index] > reach:
            rank = before + 1
        ranks[index] = rank
        reach = max(reach, sizes[index] + bounds[index])
    return ranks


def model_to_use(errors: Mapping[str, tuple[float, float]]) -> tuple[str, float | None]:
    """Return the simplest model certainly within 1 %, or else 5 %, with this limit; else the nearest one with None.

    Parameters
    ----------
    errors : mapping
        Model -> its relative error and the bound on it; no model, no name.

    Examples
    --------
    >>> model_to_use({"schwarz": (1e-4, 0.0), "jkr": (0.02, 0.0)}), model_to_use({"jkr": (-0.2, 0.0)}), model_to_use({})
    (('schwarz', 0.01), ('jkr', None), ('', None))
    """
    ordered = sorted(errors, key=lambda model: abs(errors[model][0]))
    rows = [{"model": model, "error": errors[model][0], "u_num": errors[model][1]} for model in ordered]
    for limit in LIMITS:
        if model := simplest_within(rows, limit):
            return model, limit
    return (ordered[0] if ordered else ""), None
