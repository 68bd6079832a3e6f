"""The tables of numbers: relative errors, their largest, convergence, models, and every stored row."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import pandas as pd

from comparisons.output.report.plots import curve_group, kappa_group
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.table import (
    CASE_COLUMNS,
    Cell,
    Column,
    Row,
    Table,
    case_cells,
    kappa_cell,
    number,
    parameter,
    value,
    without_empty,
)
from comparisons.quantities import title_of
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = ["convergence", "curve_points", "kappa", "largest", "models", "results"]


def kappa(stored: Stored) -> Table:
    """Return every relative error; a row's group is the choice of n and k of the plot beside it."""
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(title_of(row["quantity"])),
                *case_cells(row),
                value(row["value"], row["u_num"]),
                Cell(row["reference"]),
                value(row["reference_value"], row["u_reference"]),
                kappa_cell(row["kappa"], row["u_kappa"]),
                number(row["u_kappa"], ".1e"),
            ),
            kappa_group(row),
        )
        for _, row in stored.kappa.iterrows()
    ]
    columns = (
        Column("model", "head"),
        Column("quantity"),
        *CASE_COLUMNS,
        Column("value", "number"),
        Column("reference"),
        Column("reference's value", "number"),
        Column("κ (%)", "number"),
        Column("u of κ", "number"),
    )
    return without_empty(Table("kappa", "Relative errors against the reference", columns, rows, "kappa.csv"))


def largest(stored: Stored) -> Table:
    """Return the largest error of each model for each n and k, beside that of the paper where it prints one."""
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(title_of(row["quantity"])),
                parameter(row["n"]),
                parameter(row["k"]),
                kappa_cell(row["kappa"], row["u_kappa"]),
                parameter(row["mu"]),
                Cell("an end of the range" if row["at_end"] else "inside"),
                number(row["cases"], ".0f"),
                Cell(row["paper_percent"] or ""),
                Cell(row["verdict"] or ""),
            )
        )
        for _, row in stored.largest.iterrows()
    ]
    columns = (
        Column("model", "head"),
        Column("quantity"),
        Column("n", "number"),
        Column("k", "number"),
        Column("largest κ (%)", "number"),
        Column("at μ", "number"),
        Column("where"),
        Column("cases", "number"),
        Column("paper (%)", "number"),
        Column("digits of the paper"),
    )
    caption = "Largest relative error over the computed Tabor numbers, by size, with its sign"
    return without_empty(Table("largest", caption, columns, rows, "largest_kappa.csv"))


def convergence(stored: Stored) -> Table:
    """Return every number that came from a discretisation: observed order, uncertainty, size."""
    numbered = stored.results.assign(line=range(len(stored.results)))
    discrete = numbered[(numbered["size"] > 0) & (numbered["status"] == "ok")]
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(title_of(row["quantity"])),
                *case_cells(row),
                value(row["value"], row["u_num"]),
                number(row["u_num"], ".1e"),
                number(row["observed_order"], ".2f"),
                number(row["size"], ".0f"),
                number(row["iterations"], ".0f"),
                number(row["residual"], ".1e"),
            ),
            row["quantity"],
        )
        for _, row in discrete.iterrows()
    ]
    columns = (
        Column("model", "head"),
        Column("quantity"),
        *CASE_COLUMNS,
        Column("value", "number"),
        Column("u_num", "number"),
        Column("observed order", "number"),
        Column("unknowns", "number"),
        Column("iterations", "number"),
        Column("residual", "number"),
    )
    caption, lines = "Numbers from a discretisation", tuple(discrete["line"].tolist())
    return without_empty(Table("convergence", caption, columns, rows, "results.csv", lines=lines))


def results(stored: Stored) -> Table:
    """Return every stored row, those without a value with their reason."""
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(row["model_version"]),
                Cell(title_of(row["quantity"])),
                *case_cells(row),
                value(row["value"], row["u_num"]),
                number(row["u_num"], ".1e"),
                Cell(row["unit"]),
                Cell(row["status"]),
                Cell(row["reason"] or ""),
            )
        )
        for _, row in stored.results.iterrows()
    ]
    columns = (
        Column("model", "head"),
        Column("version"),
        Column("quantity"),
        *CASE_COLUMNS,
        Column("value", "number"),
        Column("u_num", "number"),
        Column("unit"),
        Column("status"),
        Column("reason", "prose"),
    )
    return without_empty(Table("results", "Every computed number", columns, rows, "results.csv"))


def curve_points(stored: Stored, quantity: str, columns: tuple[str, str]) -> Table:
    """Return the stored points of one kind of curve."""
    numbered = stored.curves.assign(line=range(len(stored.curves)))
    chosen = numbered[(numbered["quantity"] == quantity) & (numbered["status"] == "ok")]
    rows = [
        Row(
            (
                Cell(row["model"]),
                *case_cells(row),
                number(row["point"], ".0f"),
                number(row["x"], ".8g"),
                number(row["y"], ".8g"),
                number(row["u_distance"], ".1e"),
            ),
            curve_group(row),
        )
        for _, row in chosen.iterrows()
    ]
    headings = (
        Column("model", "head"),
        *CASE_COLUMNS,
        Column("point", "number"),
        *(Column(name, "number") for name in columns),
        Column("u, share of the picture", "number"),
    )
    caption, lines = f"Stored points: {title_of(quantity)}", tuple(chosen["line"].tolist())
    return without_empty(Table(quantity, caption, headings, rows, "curves.csv", lines=lines))


def models(stored: Stored, specs: Mapping[str, str]) -> Table:
    """Return what was run: each model with its own description, and how its computations ended."""
    every = pd.concat(
        [stored.results[["model", "model_version", "status"]], _whole_curves(stored.curves)], ignore_index=True
    )
    described = stored.record.get("models", {})
    seconds = stored.record["seconds"]["by_model"]
    rows = []
    for key, of_model in every.groupby(["model", "model_version"]):
        name, version = map(str, cast(tuple[Any, Any], key))
        ended = of_model["status"].value_counts()
        rows.append(
            Row(
                (
                    Cell(name),
                    Cell(version),
                    *(number(ended.get(status, 0), ".0f") for status in ("ok", "not-applicable", "failed")),
                    number(seconds.get(name, float("nan")), ".3g"),
                    Cell(specs.get(name, "")),
                    Cell(described.get(name, {}).get("domain", "")),
                    Cell(described.get(name, {}).get("citation", "")),
                )
            )
        )
    columns = (
        Column("model", "head"),
        Column("version"),
        Column("ok", "number"),
        Column("not applicable", "number"),
        Column("failed", "number"),
        Column("seconds", "number"),
        Column("SPEC, if external", "code"),
        Column("domain", "prose"),
        Column("citation", "prose"),
    )
    return without_empty(Table("models", "Models, and how their computations ended", columns, rows, "models.csv"))


def _whole_curves(curves: pd.DataFrame) -> pd.DataFrame:
    key = ["model", "model_version", "quantity", *CASE]
    return with_problem(curves).drop_duplicates(key)[["model", "model_version", "status"]]
