"""Tables of the page of a sweep over a problem file: errors, values, computations without one, and models."""

from __future__ import annotations

import pandas as pd

from comparisons.output.problem_sweep_text import unit_in
from comparisons.output.report.problem_plots import key_cell, value_cell
from comparisons.output.report.stored_problem_sweep import StoredProblemSweep
from comparisons.output.report.table import Cell, Column, Row, Table, kappa_cell, number, value, without_empty
from comparisons.quantities import title_of

__all__ = ["counted", "errors", "models", "results", "without_value"]


def _key_columns(stored: StoredProblemSweep) -> list[Column]:
    return [Column(unit_in(name)[0], "number") for name in stored.varied]


def errors(stored: StoredProblemSweep) -> Table:
    """Return every relative error against the reference."""
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(title_of(row["quantity"])),
                *(key_cell(row, name) for name in stored.varied),
                value_cell(row),
                Cell(row["reference"]),
                value_cell(row, "reference_value", "u_reference"),
                kappa_cell(row["kappa"], row["u_kappa"]),
                number(row["u_kappa"], ".1e"),
            )
        )
        for row in stored.errors.to_dict("records")
    ]
    columns = (
        *(Column("model", "head"), Column("quantity")),
        *_key_columns(stored),
        *(Column("value", "number"), Column("reference"), Column("reference's value", "number")),
        *(Column("κ (%)", "number"), Column("u of κ", "number")),
    )
    return Table("kappa", "Relative errors against the reference", columns, rows, "kappa.csv")


def results(stored: StoredProblemSweep) -> Table:
    """Return every value, in SI and in the unit of the paper."""
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(row["model_version"]),
                Cell(title_of(row["quantity"])),
                *(key_cell(row, name) for name in stored.varied),
                value_cell(row),
                number(row["u_num"], ".1e"),
                value(row["dimensionless_value"], row["dimensionless_u_num"]),
                Cell(row["dimensionless_unit"]),
                Cell(row["status"]),
            )
        )
        for row in stored.results.to_dict("records")
    ]
    columns = (
        *(Column("model", "head"), Column("version"), Column("quantity")),
        *_key_columns(stored),
        *(Column("value", "number"), Column("u_num (SI)", "number")),
        *(Column("dimensionless value", "number"), Column("its unit"), Column("status")),
    )
    return without_empty(Table("results", "Every computed number", columns, rows, "results.csv"))


def without_value(stored: StoredProblemSweep) -> Table:
    """Return the computations that failed, then those that are not applicable, each with its reason."""
    numbered = stored.results.assign(line=range(len(stored.results)))
    lacking = numbered[numbered["status"] != "ok"].sort_values("status", kind="stable")
    rows = [
        Row(
            (
                Cell(row["model"]),
                Cell(title_of(row["quantity"])),
                *(key_cell(row, name) for name in stored.varied),
                Cell(row["status"]),
                Cell(row["reason"]),
            )
        )
        for row in lacking.to_dict("records")
    ]
    columns = (
        *(Column("model", "head"), Column("quantity")),
        *_key_columns(stored),
        *(Column("status"), Column("reason", "prose")),
    )
    caption, lines = "Computations without a value", tuple(lacking["line"].tolist())
    return Table("lacking", caption, columns, rows, "results.csv", lines=lines)


def counted(stored: StoredProblemSweep) -> pd.DataFrame:
    """Return each model with its version, how its computations ended, and what it states of itself."""
    described, seconds = stored.record["models"], stored.record["seconds"]["by_model"]
    rows = []
    for (model, version), of_model in stored.results.groupby(["model", "model_version"]):
        ended = of_model["status"].value_counts()
        counts = {status: int(ended.get(status, 0)) for status in ("ok", "not-applicable", "failed")}
        texts = {name: described.get(model, {}).get(name, "") for name in ("domain", "citation")}
        spec = stored.record["arguments"]["external"].get(model, "")
        rows.append({"model": model, "version": version, **counts, "seconds": seconds[model], "spec": spec, **texts})
    return pd.DataFrame(rows)


def models(stored: StoredProblemSweep) -> Table:
    """Return what `counted` does as a table of the page."""
    rows = [
        Row(
            (
                *(Cell(row["model"]), Cell(row["version"])),
                *(number(row[status], ".0f") for status in ("ok", "not-applicable", "failed")),
                number(row["seconds"], ".3g"),
                *(Cell(row[name]) for name in ("spec", "domain", "citation")),
            )
        )
        for row in counted(stored).to_dict("records")
    ]
    columns = (
        *(Column("model", "head"), Column("version")),
        *(Column(status, "number") for status in ("ok", "not applicable", "failed", "seconds")),
        *(Column("SPEC, if external", "code"), Column("domain", "prose"), Column("citation", "prose")),
    )
    return without_empty(Table("models", "Models, and how their computations ended", columns, rows, "models.csv"))
