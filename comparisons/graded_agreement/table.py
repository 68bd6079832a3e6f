"""Table of the agreement, and the limits that each of its rows has to keep."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import pandas as pd

from comparisons.graded_agreement.cases import CASES, QUANTITIES
from comparisons.graded_agreement.solving import finite_elements, integral_equation
from comparisons.model import ComputationFailed
from comparisons.paper.cache import CachedCall, Results

__all__ = ["LARGEST", "TABLE", "compared", "worse_than_limits"]

#: Name of the table.
TABLE = "graded_agreement.csv"

#: Largest relative difference of the references: events of a sphere and a cone are compared to these digits.
LARGEST: Mapping[str, float] = MappingProxyType(
    {"pull_off_force": 1e-6, "jump_in_displacement": 1e-5, "jump_out_displacement": 1e-5}
)
_SOLVED, _ABSENT, _FAILED = "solved", "no event", "failed"


def _event(results: Results, call: CachedCall, quantity: str) -> tuple[str, float, float, str]:
    """Status, value, bound and reason."""
    try:
        event: Any = results[call][quantity]
    except ComputationFailed as failure:
        return _FAILED, math.nan, math.nan, str(failure)
    return (_ABSENT, math.nan, math.nan, event) if isinstance(event, str) else (_SOLVED, *event, "")


def compared(elements: Results, integral: Results) -> pd.DataFrame:
    """Return one row for each event of the cases that both references have tried.

    `difference` is that of the values, `claimed` the sum of both bounds.

    Examples
    --------
    >>> list(compared(Results(), Results()).columns)[:4]
    ['solid', 'punch', 'mu', 'quantity']
    """
    columns = ["solid", "punch", "mu", "quantity", "fscm", "fscm_value", "u_fscm", "fem", "fem_value", "u_fem"]
    rows = []
    for case in CASES:
        place = case.solid, case.punch, case.mu
        ours, theirs = CachedCall.of(integral_equation, *place), CachedCall.of(finite_elements, *place)
        if ours not in integral or theirs not in elements:
            continue
        for quantity in QUANTITIES:
            first, second = _event(integral, ours, quantity), _event(elements, theirs, quantity)
            values = (*place, quantity, *first[:3], *second[:3])
            rows.append((*values, second[1] - first[1], first[2] + second[2], first[3] or second[3]))
    return pd.DataFrame(rows, columns=[*columns, "difference", "claimed", "reason"])


def worse_than_limits(table: pd.DataFrame) -> list[str]:
    """Return a sentence for each row on which the references differ.

    That is by more than both bounds or by more than `LARGEST`, and where one of them has an event that the other has
    not.  Where one has failed there is nothing to compare.

    Examples
    --------
    >>> row = {"solid": "sharp-1", "punch": "cone", "mu": 1.0, "quantity": "pull_off_force", "reason": ""}
    >>> row |= {"fscm": "solved", "fscm_value": 2.0, "u_fscm": 0.0, "fem": "solved", "fem_value": 2.0, "u_fem": 1e-9}
    >>> worse_than_limits(pd.DataFrame([row | {"difference": 2e-9, "claimed": 1e-9}]))
    ['pull_off_force of sharp-1, cone, mu = 1: the difference 2e-09 is above both bounds, 1e-09']
    """
    found = []
    for row in table.to_dict("records"):
        name = f"{row['quantity']} of {row['solid']}, {row['punch']}, mu = {row['mu']:g}"
        if _FAILED in (row["fscm"], row["fem"]):
            continue
        if row["fscm"] != row["fem"]:
            found.append(f"{name}: {row['fscm']} by the FSCM, {row['fem']} by the finite elements")
        elif row["fscm"] == _SOLVED:
            difference, largest = abs(row["difference"]), LARGEST[row["quantity"]] * abs(row["fscm_value"])
            if difference > row["claimed"]:
                found.append(f"{name}: the difference {difference:.2g} is above both bounds, {row['claimed']:.2g}")
            if difference > largest:
                found.append(f"{name}: the difference {difference:.2g} is above {largest:.2g}")
    return found
