"""The errors of models by regions of their cases."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pandas as pd

from comparisons.numerics.number_text import short_percent
from comparisons.output.errors import worst_rows
from comparisons.output.table import LAYOUT, Record, Table, column, columns


def region_table(kappa: pd.DataFrame, ordered: pd.DataFrame) -> Table:
    """Return the largest and the mean error of each model and quantity in each region.

    Parameters
    ----------
    kappa : DataFrame
        Relative errors, as of `comparisons.output.errors.relative_error`.
    ordered : DataFrame
        The models and quantities in the order of the rows, with the number of cases.
    """
    keys = ["model", "quantity"]
    table = ordered.loc[ordered["cases"] > 0, keys]
    known = kappa[kappa["kappa"].notna()]
    for heading, condition in LAYOUT["regions"].items():
        rows = known.query(condition)
        worst = worst_rows(rows, keys)[[*keys, "kappa", "u_kappa"]]
        names = {"kappa": f"kappa {heading}", "u_kappa": f"u {heading}"}
        table = table.merge(worst.rename(columns=names), on=keys, how="left")
        mean = rows.groupby(keys)["kappa"].mean().rename(f"mean {heading}").reset_index()
        table = table.merge(mean, on=keys, how="left")
    layout = [
        replace(column(name, f"kappa {name}", "short percent", f"u {name}"), small=partial(_mean_text, name))
        for name in LAYOUT["regions"]
    ]
    caption = "Largest |κ| in percent with its sign, by region"
    return Table("regions", caption, [*columns("model"), *layout, *columns("quantity")], table)


def _mean_text(region: str, row: Record) -> str:
    mean = row[f"mean {region}"]
    return "" if pd.isna(mean) else f"mean {short_percent(mean)}"
