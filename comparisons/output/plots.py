"""Plots of stored numbers: axes, choices and points, which a page draws by a script and a figure by Matplotlib."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.style import BROAD
from comparisons.output.table import LAYOUT, Column, Record, column, columns, key_columns, key_text, physical_text
from comparisons.problem.problem import split_name
from comparisons.problem.units import prefixed_unit
from comparisons.quantities import ALL_QUANTITIES, CURVES, Axis, CurveQuantity, Kind, title_of
from comparisons.registry import MODELS
from comparisons.runs.frames import unit_in, varied_keys, varied_of, with_problem
from comparisons.runs.rows import CASE

#: Ratio of the largest and the smallest abscissa above which an axis is logarithmic.
_LOG = 10.0

#: Where the load is below this share of the pull-off force, a curve approaches the axis and ends the picture.
_FAINT = 0.02

#: Models that a page shows at first: more lines hide each other.
_SHOWN_AT_FIRST = 5

#: Parameters over which errors are drawn, with the headings of their columns and the labels of their axes.
_HEADINGS = {"mu": "μ", "k": "k", "n": "n"}
_LABELS = {"mu": "generalised Tabor number μ", "k": "gradient exponent k", "n": "shape index n", "case": "case"}


@dataclass(frozen=True)
class Plot:
    """One plot.

    Attributes
    ----------
    id, x_label, y_label : str
    choices : sequence of Column
        Columns by whose texts the points are grouped.
    points : DataFrame
        One row for each point: group, options (the texts), model, branch (of a cycle, else empty), label, x, y, ends of
        the band, and the text at it.
    title, table, caption : str
        Its title, the id of the table with the numbers, and its caption; empty where no page shows it.
    x_scale : str
        "linear" or "log".
    mark : str
        "both" for a line with markers, "line", or "points" beside the line on which y is x.
    views : dict
        The first view [x0, x1, y0, y1] of a group, if not all of it.
    y_labels : dict
        The label of the second axis of a group, if it is another.
    unit : str
        What follows a number of the second axis.
    """

    id: str
    x_label: str
    y_label: str
    choices: Sequence[Column]
    points: pd.DataFrame
    title: str = ""
    table: str = ""
    caption: str = ""
    x_scale: str = "linear"
    mark: str = "both"
    views: dict[str, list[float]] = field(default_factory=dict)
    y_labels: dict[str, str] = field(default_factory=dict)
    unit: str = ""

    @property
    def controls(self) -> list[tuple[str, list[str]]]:
        """Label and options of each choice, in the order of the points."""
        chosen = zip(self.choices, zip(*self.points["options"], strict=True), strict=False)
        return [(choice.heading, list(dict.fromkeys(texts))) for choice, texts in chosen]

    def group(self, row: Record) -> str:
        """Return the group of a row."""
        return "|".join(choice.text(row) for choice in self.choices)

    @property
    def models(self) -> list[str]:
        """Names of what can be switched on and off: the broad line below the others, external models, then ours."""
        return sorted(dict.fromkeys(self.points["model"]), key=lambda name: (name != BROAD, name in MODELS))

    @property
    def first_models(self) -> list[str]:
        """Those of them that are switched on at first: external ones, then ours in the order of their names."""
        order = list(MODELS)
        return sorted(self.models, key=lambda name: order.index(name) if name in order else -1)[:_SHOWN_AT_FIRST]

    def data(self) -> dict[str, Any]:
        """Return what the script of the page draws, ready for JSON."""
        names = ("id", "x_label", "y_label", "x_scale", "mark", "table", "views", "y_labels")
        ranked = self.points.assign(rank=self.points["model"].map(self.models.index))
        series = [
            {"group": group, "model": model, "label": label, **rows[["x", "y", "low", "high", "hover"]].to_dict("list")}
            for (_, group, model, label), rows in ranked.groupby(["rank", "group", "model", "label"])
        ]
        return {name: getattr(self, name) for name in names} | {"series": series}


def _points(
    rows: pd.DataFrame, choices: Sequence[Column], hover: Callable[[Record], str], x: Any, y: Any, u: Any = 0.0
) -> pd.DataFrame:
    """Return the points of stored rows."""
    records = rows.to_dict("records")
    table = pd.DataFrame({"model": rows["model"], "x": x, "y": y, "low": y - u, "high": y + u}, index=rows.index)
    table["branch"] = rows.get("branch", "")
    table["label"] = [
        row["model"] if math.isnan(row.get("nu", math.nan)) else f"{row['model']}, ν = {row['nu']:g}" for row in records
    ]
    table["options"] = [tuple(choice.text(row) for choice in choices) for row in records]
    table["group"], table["hover"] = list(map("|".join, table["options"])), list(map(hover, records))
    # An absurd value overflows in percent; it is in the tables, but there is no place for it in a picture.
    return table[np.isfinite(table[["x", "y", "low", "high"]].astype(float)).all(axis="columns")]


def kappa(table: pd.DataFrame, over: str = "") -> Plot:
    """Relative errors over the parameter that varies most, one picture for each pair of the others.

    Parameters
    ----------
    table : DataFrame
        With the columns of `comparisons.output.errors.relative_error`.
    over : str
        "mu", "k" or "n" in place of the one with most values (the first of those with equally many); "case" for the
        number of the case.  Of a problem file it is the varied number with most values, or the case without one.
    """
    rows = with_problem(table[table["kappa"].notna()])
    rows = rows.assign(problem=rows["problem"].fillna(""))
    rows = rows.assign(case=1.0 + rows.groupby([*CASE], sort=False, dropna=False).ngroup())
    keys = varied_keys(rows)
    numbers = [name for name in keys if pd.api.types.is_numeric_dtype(rows[name]) and rows[name].nunique() > 1]
    if not over and rows["n"].isna().any():
        over = max(numbers, key=lambda name: rows[name].nunique(), default="case")
    over = over or max(_HEADINGS, key=lambda name: rows[name].nunique())
    parameters = [heading for name, heading in reversed(_HEADINGS.items()) if over not in (name, "case", *keys)]
    rows = _by_quantity(rows, "n", "k", "mu", "model", over)
    label, abscissas = _abscissas(rows[over], over)
    is_logarithmic = _is_wide(rows[over]) if over in keys else over == "mu" and rows["mu"].nunique() > 1
    several = ("reference",) if rows["reference"].nunique() > 1 else ()
    of_keys = [name for name in keys if name != over] if over in keys else []
    choices = [*columns("quantity", *several, *parameters), *key_columns(of_keys)]

    def hover(row: Record) -> str:
        where = case_text({name: row.get(name) for name in CASE})
        return f"{where}, κ = {percent_text(row['kappa'], row['u_kappa'])} %"

    return Plot(
        id="plot-kappa",
        title=f"Relative error against the {label}",
        x_label=label,
        y_label="relative error κ (%)",
        x_scale="log" if is_logarithmic else "linear",
        choices=choices,
        points=_points(rows, choices, hover, abscissas, 100 * rows["kappa"], 100 * rows["u_kappa"]),
        table="kappa",
        caption=LAYOUT["caption"]["kappa"],
        unit=" %",
    )


def _abscissas(values: pd.Series, over: str) -> tuple[str, pd.Series]:
    """Label of an axis and its values; a varied key has the prefix of its size."""
    if over in _LABELS:
        return _LABELS[over], values
    key, unit = unit_in(over)
    power, prefixed = prefixed_unit(float(values.abs().max()), unit)
    return (key if prefixed == "1" else f"{key} ({prefixed})"), values * 10.0**-power


def _is_wide(values: pd.Series) -> bool:
    """Whether an axis of these values is logarithmic."""
    return bool(values.min() > 0.0 and values.max() / values.min() > _LOG)


def predicted(table: pd.DataFrame) -> Plot:
    """Values of the models over those of the reference, for each quantity and reference.

    Parameters
    ----------
    table : DataFrame
        With the columns of `comparisons.output.errors.relative_error`.
    """
    rows = _by_quantity(with_problem(table[table["kappa"].notna()]), "n", "k", "mu", "model")
    choices = columns("quantity", *(("reference",) if rows["reference"].nunique() > 1 else ()))

    def hover(row: Record) -> str:
        where = case_text({name: row.get(name) for name in CASE})
        return f"{where}, κ = {percent_text(row['kappa'], row['u_kappa'])} %"

    return Plot(
        id="plot-predicted",
        title="Predicted against reference values",
        x_label="value of the reference",
        y_label="value of the model",
        mark="points",
        choices=choices,
        points=_points(rows, choices, hover, rows["reference_value"], rows["value"], rows["u_num"]),
        caption=LAYOUT["caption"]["predicted"],
    )


def agreement(table: pd.DataFrame) -> Plot:
    """Difference of two models over the sum of their bounds, for each quantity over the number of the case.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.agreement`.
    """
    rows = _by_quantity(table, "n", "k", "mu")
    cases = 1.0 + rows.groupby("quantity").cumcount()
    choices = columns("quantity")
    return Plot(
        id="plot-agreement",
        x_label="case, by n, k and μ",
        y_label="difference / sum of bounds",
        choices=choices,
        points=_points(rows, choices, lambda row: "", cases, rows["en"]),
    )


def _by_quantity(rows: pd.DataFrame, *columns: str) -> pd.DataFrame:
    """Return rows in the order of the quantities, then of some columns; a quantity that is not known comes last."""
    ranks = {name: rank for rank, name in enumerate(ALL_QUANTITIES)}
    place = rows["quantity"].map(lambda name: (ranks.get(name, len(ranks)), name))
    return rows.assign(place=place).sort_values(["place", *columns], kind="stable").drop(columns="place")


def curves(table: pd.DataFrame) -> list[Plot]:
    """One plot for each kind of curve that is stored."""
    usable = table[(table["status"] == "ok") & table["mu"].notna()]
    usable = usable.sort_values(["n", "k", "mu", "point"], kind="stable")
    cases = usable[["n", "k", "mu"]].to_dict("records")
    usable = usable.assign(case=[case_text(case) for case in cases])
    of_quantities = ((quantity, usable[usable["quantity"] == name]) for name, quantity in CURVES.items())
    return [curve(quantity, rows) for quantity, rows in of_quantities if len(rows)]


def curve(quantity: CurveQuantity, rows: pd.DataFrame) -> Plot:
    """Plot of one kind of curve.

    Parameters
    ----------
    quantity : CurveQuantity
    rows : DataFrame
        The points: model, the text of the case, x and y, and perhaps nu; of a cycle its branch.
    """
    x, y = quantity.x.symbol, quantity.y.symbol
    choices = [column("case")]
    (x_label, abscissas), (y_label, ordinates) = (_scaled(quantity.x, rows["x"]), _scaled(quantity.y, rows["y"]))
    points = _points(rows, choices, lambda row: f"{x} = {row['x']:.6g}, {y} = {row['y']:.6g}", abscissas, ordinates)
    groups = points.groupby("group") if quantity.kind is Kind.CURVE else ()
    views = {group: view for group, of_group in groups if (view := _tension_view(of_group))}
    return Plot(
        id=f"plot-{quantity.name.replace('_', '-')}",
        title=quantity.title.capitalize(),
        x_label=x_label,
        y_label=y_label,
        mark="line",
        choices=choices,
        points=points,
        table=quantity.name,
        caption=quantity.caption,
        views=views,
    )


def _scaled(axis: Axis, values: pd.Series) -> tuple[str, pd.Series]:
    """The label of an axis and its values; in SI with the prefix of their size."""
    if not axis.is_in_si:
        return axis.label, values
    power, unit = prefixed_unit(float(values.abs().max()), axis.unit)
    return f"{axis.title} {axis.symbol} ({unit})", values * 10.0**-power


def _tension_view(points: pd.DataFrame) -> list[float] | None:
    """Return the limits [x0, x1, y0, y1] of the tension, and of as much compression; None without tension."""
    x, load = points["x"], points["y"]
    deepest = float(load.min())
    if deepest >= 0.0:
        return None
    visible = x[(load.abs() > -_FAINT * deepest) & (load < -deepest)]
    margin = 0.05 * float(np.ptp(visible))
    return [float(visible.min()) - margin, float(visible.max()) + margin, 1.15 * deepest, -deepest]


def values_over_keys(results: pd.DataFrame) -> Iterator[tuple[Plot, list[str]]]:
    """Yield a plot for each varied key of a problem file that has two numbers or more, and the names of all its keys.

    The other keys are choices of the plot.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.
    """
    labelled = with_problem(results)
    solved = labelled[(labelled["status"] == "ok") & (labelled["problem"] != "")]
    count = 0
    for file, rows in solved.groupby(solved["problem"].map(lambda label: split_name(label)[0])):
        varied = [name for name in varied_of(rows) if rows[name].notna().any()]
        for name in varied:
            if pd.api.types.is_numeric_dtype(rows[name]) and rows[name].nunique() > 1:
                count += 1
                keys = [name, *(key for key in varied if key != name)]
                yield _over_key(rows, keys, str(file), f"plot-{count}"), keys


def _over_key(rows: pd.DataFrame, keys: list[str], file: str, id: str) -> Plot:
    over, (label, unit) = keys[0], unit_in(keys[0])
    rows = _by_quantity(rows, *keys[1:], over)
    choices = [*columns("quantity"), *key_columns(keys[1:])]
    x_label, abscissas = _abscissas(rows[over], over)

    def hover(row: Record) -> str:
        return f"{label} = {key_text(row[over], unit)}, {title_of(row['quantity'])} = {physical_text(row)}"

    points = _points(rows, choices, hover, abscissas, rows["value"], rows["u_num"])
    labels = {}
    for group, of_group in points.groupby("group"):
        stored = rows.loc[of_group.index]
        y_power, y_unit = prefixed_unit(float(stored["value"].abs().max()), str(stored["unit"].iloc[0]))
        labels[str(group)] = of_group["options"].iloc[0][0] + ("" if y_unit == "1" else f" ({y_unit})")
        points.loc[of_group.index, ["y", "low", "high"]] *= 10.0**-y_power
    return Plot(
        id=id,
        title=f"Values against {label} of {file}",
        x_label=x_label,
        y_label="value",
        x_scale="log" if _is_wide(rows[over]) else "linear",
        choices=choices,
        points=points,
        table=f"{id}-numbers",
        caption=LAYOUT["caption"]["over_key"],
        y_labels=labels,
    )
