"""Plots of values of problem files: each quantity over each varied number, in SI and in the unit of the paper."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from comparisons.numerics.number_text import value_text
from comparisons.output.report.plots import Plot, choice, in_registry, points
from comparisons.output.table import Column, Record, Table, columns, numbers, words
from comparisons.output.varied_keys import key_columns, key_text, physical_text
from comparisons.problem.problem import split_name
from comparisons.problem.units import prefixed_unit
from comparisons.quantities import title_of
from comparisons.runs.case_columns import unit_in, varied_of

__all__ = ["values_over_keys"]

#: Ratio of the largest and the smallest value of a key from which its axis is logarithmic.
_LOG = 30.0

_CAPTION = (
    "A band shows the bound on the numerical error; where none is seen it is narrower than the line. Dimensionless "
    "values are in the units of the paper, which depend on the varied keys, too."
)


def values_over_keys(results: pd.DataFrame) -> Iterator[tuple[Plot, Table]]:
    """Yield a plot and its numbers for each varied key of a problem file that has two numbers or more.

    The other keys are choices of the plot.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.
    """
    if "problem" not in results:
        return
    solved = results[(results["status"] == "ok") & (results["problem"] != "")]
    count = 0
    for file, rows in solved.groupby(solved["problem"].map(lambda label: split_name(label)[0])):
        varied = [name for name in varied_of(rows) if rows[name].notna().any()]
        for name in varied:
            if pd.api.types.is_numeric_dtype(rows[name]) and rows[name].nunique() > 1:
                count += 1
                others = [other for other in varied if other != name]
                yield _over_key(_in_both_units(rows), name, others, str(file), f"plot-{count}")


def _in_both_units(rows: pd.DataFrame) -> pd.DataFrame:
    """The values in SI, and again in the unit of the paper, as far as there are such ones."""
    units = [rows.assign(form="si", text=[physical_text(row) for row in rows.to_dict("records")])]
    paper = rows[rows["dimensionless_value"].notna()]
    if len(paper):
        names = {f"dimensionless_{name}": name for name in ("value", "u_num", "unit")}
        paper = paper.drop(columns=list(names.values())).rename(columns=names)
        texts = [value_text(value, u) for value, u in zip(paper["value"], paper["u_num"], strict=True)]
        units.append(paper.assign(form="paper", text=texts))
    return pd.concat(units)


def _over_key(rows: pd.DataFrame, over: str, others: list[str], file: str, id: str) -> tuple[Plot, Table]:
    label, unit = unit_in(over)
    power, prefixed = prefixed_unit(float(rows[over].abs().max()), unit)

    def group(row: Record) -> str:
        return choice(row["quantity"], row["form"], *(row[name] for name in others))

    def hover(row: Record) -> str:
        return f"{label} = {key_text(row[over], unit)}, {title_of(row['quantity'])} = {row['text']}"

    rows = rows.sort_values(over, kind="stable")
    rows = rows.assign(group=[group(row) for row in rows.to_dict("records")])
    axes = {str(key): _axis(part) for key, part in rows.groupby("group")}
    scale = 10.0 ** -rows["group"].map(lambda key: axes[key][0]).astype(float)
    forms = [option for option in (("si", "SI"), ("paper", "dimensionless")) if option[0] in set(rows["form"])]
    controls = [
        ("quantity", [(name, title_of(name)) for name in sorted(set(rows["quantity"]), key=in_registry)]),
        ("unit", forms),
    ]
    for name in others:
        key, of = unit_in(name)
        controls.append((key, [(choice(v), key_text(v, of)) for v in rows[name].drop_duplicates().sort_values()]))
    drawn = points(rows, group, hover, rows[over] * 10.0**-power, rows["value"] * scale, rows["u_num"] * scale)
    title = f"Values over {label} of {file}"
    wide = rows[over].min() > 0.0 and rows[over].max() / rows[over].min() >= _LOG
    plot = Plot(
        id=id,
        title=title,
        x_label=label if prefixed == "1" else f"{label} ({prefixed})",
        y_label="value",
        x_scale="log" if wide else "linear",
        controls=controls,
        points=drawn,
        table=f"{id}-numbers",
        caption=_CAPTION,
        y_labels={key: text for key, (_, text) in axes.items()},
    )
    shown = [*columns("model"), *key_columns([over, *others]), Column("value", lambda row: row["text"], "value")]
    shown += [numbers("u_num", "u_num", ".1e"), words("unit", "unit")]
    return plot, Table(
        plot.table,
        title,
        shown,
        rows.sort_index(kind="stable"),
        "results.csv",
        fold="Numbers of this plot",
        group=group,
    )


def _axis(rows: pd.DataFrame) -> tuple[int, str]:
    """Power of ten of the unit of an axis, and its label."""
    power, unit = 0, str(rows["unit"].iloc[0])
    if rows["form"].iloc[0] == "si":
        power, unit = prefixed_unit(float(rows["value"].abs().max()), unit)
    title = title_of(rows["quantity"].iloc[0])
    return power, title if unit == "1" else f"{title} ({unit})"
