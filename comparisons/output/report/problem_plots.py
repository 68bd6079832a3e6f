"""Plots of values of problem files: each quantity over each varied number, in SI and in the unit of the paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import pandas as pd

from comparisons.numerics.number_text import value_text
from comparisons.output.problem_values import key_text
from comparisons.output.report.plot import Control, Plot, Series, key
from comparisons.output.table import Cell, Column, Row, Table, number, without_empty
from comparisons.problem.problem import split_name
from comparisons.problem.units import prefixed_unit, si_text
from comparisons.quantities import QUANTITIES, title_of
from comparisons.runs.case_columns import unit_in, varied_of

__all__ = ["ValuesOverKey", "plots"]

#: The two units of a value, as options of a control.
_SI, _PAPER = ("si", "SI"), ("paper", "dimensionless")

#: Ratio of the largest and the smallest value of a key from which its axis is logarithmic.
_LOG = 30.0


@dataclass(frozen=True, slots=True)
class ValuesOverKey:
    """A plot of the values of a problem file over one varied key, and its numbers."""

    plot: Plot
    numbers: Table


def plots(results: pd.DataFrame) -> list[ValuesOverKey]:
    """Return a plot for each varied key of a problem file that has two numbers or more; the other keys are choices.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.
    """
    if "problem" not in results:
        return []
    found: list[ValuesOverKey] = []
    numbered = results.assign(line=range(len(results)), file=[split_name(label)[0] for label in results["problem"]])
    known = numbered[(numbered["status"] == "ok") & (numbered["file"] != "")]
    for file, rows in known.groupby("file"):
        varied = [name for name in varied_of(rows) if rows[name].notna().any()]
        for name in varied:
            if pd.api.types.is_numeric_dtype(rows[name]) and rows[name].nunique() > 1:
                others = [other for other in varied if other != name]
                title = f"{unit_in(name)[0]} of {file}"
                plot = _plot(rows, name, others, title, len(found) + 1)
                found.append(ValuesOverKey(plot, _numbers(rows, plot, (name, *others))))
    return found


def _plot(known: pd.DataFrame, over: str, others: list[str], title: str, place: int) -> Plot:
    label, unit = unit_in(over)
    power, prefixed = prefixed_unit(float(known[over].abs().max()), unit)
    x = known[over]
    wide = x.min() > 0.0 and x.max() / x.min() >= _LOG
    series: list[Series] = []
    labels: dict[str, str] = {}
    for form, column, bound in _forms(known):
        for _, rows in known[known[column].notna()].groupby(["quantity", *others]):
            group, quantity = _group(rows.iloc[0], others, form), str(rows["quantity"].iloc[0])
            y_power, labels[group] = _axis(rows, column, quantity)
            for model, part in rows.sort_values(over, kind="stable").groupby("model"):
                y, u = (part[name] * 10.0**-y_power for name in (column, bound))
                series.append(
                    Series(
                        group=group,
                        model=str(model),
                        label=str(model),
                        x=(part[over] * 10.0**-power).tolist(),
                        y=y.tolist(),
                        hover=[
                            f"{label} = {key_text(row[over], unit)}, {title_of(quantity)} = {_text(row, column)}"
                            for row in part.to_dict("records")
                        ],
                        low=(y - u).tolist(),
                        high=(y + u).tolist(),
                    )
                )
    controls = [
        Control("quantity", tuple((name, title_of(name)) for name in _in_order(known["quantity"]))),
        Control("unit", tuple(form for form, _, _ in _forms(known))),
    ]
    for name in others:
        words, of = unit_in(name)
        values = known[name].drop_duplicates().sort_values()
        controls.append(Control(words, tuple((key(value), key_text(value, of)) for value in values)))
    return Plot(
        id=f"plot-{place}",
        title=f"Values over {title}",
        x_label=label if prefixed == "1" else f"{label} ({prefixed})",
        y_label="value",
        x_scale="log" if wide else "linear",
        y_scale="linear",
        mark="both",
        controls=tuple(controls),
        series=series,
        table=f"plot-{place}-numbers",
        caption="A band shows the bound on the numerical error; where none is seen it is narrower than the line. "
        "Dimensionless values are in the units of the paper, which depend on the varied keys, too.",
        y_labels=labels,
    )


def _numbers(known: pd.DataFrame, plot: Plot, keys: Sequence[str]) -> Table:
    """Return the numbers of a plot; a row's group is the choice that shows it."""
    rows, lines = [], []
    for form, column, bound in _forms(known):
        for row in known[known[column].notna()].to_dict("records"):
            cells = (
                Cell(row["model"]),
                *(_key_cell(row, name) for name in keys),
                Cell(_text(row, column), float(row[column])),
                number(row[bound], ".1e"),
                Cell(row["unit"] if column == "value" else row["dimensionless_unit"]),
            )
            rows.append(Row(cells, _group(row, keys[1:], form)))
            lines.append(int(row["line"]))
    columns = (
        Column("model", "head"),
        *(Column(unit_in(name)[0], "number") for name in keys),
        Column("value", "number"),
        Column("u_num", "number"),
        Column("unit"),
    )
    return without_empty(Table(plot.table, plot.title, columns, rows, "results.csv", lines=tuple(lines)))


def _key_cell(row: dict[str, float | str], name: str) -> Cell:
    """The value of a varied key, and the number in SI behind it."""
    text = key_text(row[name], unit_in(name)[1])
    return Cell(text) if isinstance(row[name], str) else Cell(text, float(row[name]))


def _forms(known: pd.DataFrame) -> Iterator[tuple[tuple[str, str], str, str]]:
    """The units in which there are values: as an option, with the columns of value and bound."""
    yield _SI, "value", "u_num"
    if known["dimensionless_value"].notna().any():
        yield _PAPER, "dimensionless_value", "dimensionless_u_num"


def _axis(rows: pd.DataFrame, column: str, quantity: str) -> tuple[int, str]:
    """Power of ten of the unit of an axis, and its label."""
    if column == "value":
        power, unit = prefixed_unit(float(rows[column].abs().max()), str(rows["unit"].iloc[0]))
    else:
        power, unit = 0, str(rows["dimensionless_unit"].iloc[0])
    return power, title_of(quantity) if unit == "1" else f"{title_of(quantity)} ({unit})"


def _text(row: dict[str, float | str], column: str) -> str:
    if column == "value":
        return si_text(float(row["value"]), float(row["u_num"]), str(row["unit"]))
    return value_text(float(row[column]), float(row["dimensionless_u_num"]))


def _group(row: pd.Series | dict[str, float | str], others: Sequence[str], form: tuple[str, str]) -> str:
    return key(row["quantity"], form[0], *(row[name] for name in others))


def _in_order(quantities: pd.Series) -> list[str]:
    found = set(quantities)
    return [name for name in QUANTITIES if name in found]
