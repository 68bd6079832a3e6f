"""The table of the fits of many curves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import lazy_loader
import numpy as np

from comparisons.output.table import Column, Record, Table
from comparisons.problem.units import si_text

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

__all__ = ["CAPTION", "fit_columns", "fit_rows", "fit_table"]

CAPTION = "Fitted values, and changes by the errors of model and assumptions (%)"

#: A smaller change in percent is that of rounding.
_NOTHING = 1e-3


def fit_table(items: Sequence[Mapping[str, Any]]) -> Table:
    """Return the rows of fits as a table."""
    rows = fit_rows(items)
    return Table("fits", CAPTION, fit_columns(rows), pd.DataFrame(rows))


def fit_rows(items: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return one row for each value of each curve, or one with the reason why a curve has none.

    Rows of a map have its positions ``x`` and ``y`` in m, and ``column`` and ``row`` of its grid.
    """
    are_placed = any(number is not None for item in items for number in item["position"].values())
    rows = []
    for item in items:
        head = {"curve": item["curve"], **(_filled(item["position"]) if are_placed else {})}
        for of_curve in item["fits"]:
            of_fit = {"model": of_curve["model"], "mu": of_curve["mu"]}
            quality = {"residual_over_noise": of_curve["residual"] / of_curve["noise"], "reason": ""}
            for key, row in of_curve["parameters"].items():
                rows.append(head | of_fit | {"key": key} | _filled(row) | quality)
        if item["failure"]:
            rows.append(head | _NO_FIT | {"reason": item["failure"]})
    return rows


def fit_columns(rows: Sequence[Record]) -> list[Column]:
    """Return the columns of such rows."""
    return [
        *([Column("curve", lambda row: str(row["curve"]))] if len({row["curve"] for row in rows}) > 1 else []),
        Column("model", lambda row: str(row["model"])),
        Column("mu", lambda row: "" if row["mu"] is None or np.isnan(row["mu"]) else f"{row['mu']:.3g}", "mu"),
        Column("key", lambda row: str(row["key"])),
        Column("value", _value_text, "value"),
        Column("by model", partial(_shift_text, "model"), "shift_by_model"),
        Column("assumed", partial(_shift_text, "assumptions"), "shift_by_assumptions"),
    ]


def _shift_text(name: str, row: Record) -> str:
    if row["reason"]:
        return ""
    size = row[f"shift_by_{name}"]
    share = math.nan if size is None else 100.0 * size / row["value"]
    return "unknown" if math.isnan(share) else f"{share:+.2g}" if abs(share) > _NOTHING else "+0"


def _filled(row: Mapping[str, Any]) -> dict[str, Any]:
    """The row with NaN for what is not known, but the start and the prior, which most curves lack."""
    return {name: np.nan if cell is None and name not in ("start", "prior") else cell for name, cell in row.items()}


#: The row of a curve without a fit, but its name and the reason.
_NO_FIT = {
    **dict.fromkeys(("model", "key", "unit"), ""),
    **dict.fromkeys(("mu", "value", "u", "shift_by_model", "shift_by_assumptions", "residual_over_noise"), np.nan),
    "determined": False,
}


def _value_text(row: Record) -> str:
    if row["reason"]:
        return "no fit"
    text = si_text(row["value"], row["u"], row["unit"]) if row["determined"] else "not determined"
    return text.replace("^2", "²")
