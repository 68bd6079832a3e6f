"""The plots of a page: axes, choices, and points of stored numbers by which a script draws them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from comparisons.numerics.number_text import case_text, exact, percent_text
from comparisons.output.figures.curves import tension_view
from comparisons.output.style import first_shown, model_styles
from comparisons.output.table import Record
from comparisons.output.varied_keys import key_text, physical_text
from comparisons.problem.problem import split_name
from comparisons.problem.units import prefixed_unit
from comparisons.quantities import ALL_QUANTITIES, CURVES, CurveQuantity, Kind, title_of
from comparisons.runs.case_columns import unit_in, varied_of

__all__ = ["Plot", "curve_group", "curves", "in_registry", "kappa", "kappa_group", "value_group", "values_over_keys"]

#: Ratio of the largest and the smallest value of a key from which its axis is logarithmic.
_LOG = 30.0

#: Label of a control, and its options as (key, text).
Control = tuple[str, list[tuple[str, str]]]


@dataclass(frozen=True)
class Plot:
    """One plot of a page.

    Attributes
    ----------
    id, title, x_label, y_label, caption : str
    controls : list of Control
        The choices; the keys of the chosen options make the group that is shown.
    points : DataFrame
        One row for each point: choice, model, label, x, y, ends of the band, and the text at the point.
    table : str
        The id of the table with the numbers.
    x_scale : str
        "linear" or "log".
    mark : str
        "both" for a line with markers, or "line".
    views : dict
        The first view [x0, x1, y0, y1] of a group, if not all of it.
    y_labels : dict
        The label of the second axis of a group, if it is another.
    """

    id: str
    title: str
    x_label: str
    y_label: str
    controls: list[Control]
    points: pd.DataFrame
    table: str
    caption: str
    x_scale: str = "linear"
    mark: str = "both"
    views: dict[str, list[float]] = field(default_factory=dict)
    y_labels: dict[str, str] = field(default_factory=dict)

    @property
    def models(self) -> list[str]:
        """Names of what can be switched on and off; the broad line is drawn first, below the others."""
        styles = model_styles(self.points["model"])
        return sorted(dict.fromkeys(self.points["model"]), key=lambda name: not styles[name].broad)

    @property
    def first_models(self) -> list[str]:
        """Those of them that are switched on at first."""
        return first_shown(self.models)

    def data(self) -> dict[str, Any]:
        """Return what the script of the page draws, ready for JSON."""
        names = ("id", "x_label", "y_label", "x_scale", "mark", "table", "views", "y_labels")
        ranked = self.points.assign(rank=self.points["model"].map(self.models.index))
        series = [
            {"group": group, "model": model, "label": label, **rows[["x", "y", "low", "high", "hover"]].to_dict("list")}
            for (_, group, model, label), rows in ranked.groupby(["rank", "group", "model", "label"], sort=False)
        ]
        series.sort(key=lambda one: self.models.index(one["model"]))
        return {name: getattr(self, name) for name in names} | {"series": series}


def _choice(*parts: Any) -> str:
    """Return the key of several options, by which the script finds the points of a choice."""
    return "|".join(part if isinstance(part, str) else exact(part) for part in parts)


def _points(
    rows: pd.DataFrame,
    group: Callable[[Record], str],
    hover: Callable[[Record], str],
    x: pd.Series,
    y: pd.Series,
    u: pd.Series | float = 0.0,
) -> pd.DataFrame:
    """Return the points of stored rows: choice, model, label, x, y, ends of the band, and the text at the point."""
    records = rows.to_dict("records")
    nu = rows["nu"] if "nu" in rows else pd.Series(math.nan, rows.index)
    labels = [
        model if math.isnan(own) else f"{model}, ν = {own:g}" for model, own in zip(rows["model"], nu, strict=True)
    ]
    made = pd.DataFrame({"model": rows["model"], "label": labels, "x": x, "y": y, "low": y - u, "high": y + u})
    made["group"], made["hover"] = list(map(group, records)), list(map(hover, records))
    # An absurd value overflows in percent; it is in the tables, but there is no place for it in a picture.
    return made[np.isfinite(made[["x", "y", "low", "high"]].astype(float)).all(axis="columns")]


def _options(values: Iterable[float]) -> list[tuple[str, str]]:
    return [(exact(value), exact(value)) for value in sorted(set(values))]


def _quantities(names: Iterable[str]) -> list[tuple[str, str]]:
    return [(name, title_of(name)) for name in sorted(set(names), key=in_registry)]


def in_registry(quantity: str) -> tuple[int, str]:
    """Return the order of a quantity; one that is not in the registry comes last."""
    names = list(ALL_QUANTITIES)
    return names.index(quantity) if quantity in names else len(names), quantity


def kappa_group(row: Record) -> str:
    """Return the choice that shows a relative error."""
    return _choice(row["quantity"], row["reference"], row["n"], row["k"])


def kappa(table: pd.DataFrame) -> Plot:
    """Relative errors over the Tabor number, one picture for each n and k."""
    rows = table[table["mu"].notna()].sort_values(["model", "mu"], kind="stable")
    shapes = _options(rows["n"])
    # The paraboloid is shown first.
    shapes.sort(key=lambda option: option[0] != "2")
    references = sorted(set(rows["reference"]))
    return Plot(
        id="plot-kappa",
        title="Relative error against the Tabor number",
        x_label="generalised Tabor number μ",
        y_label="relative error κ (%)",
        x_scale="log",
        controls=[
            ("quantity", _quantities(rows["quantity"])),
            ("reference", list(zip(references, references, strict=True))),
            ("shape index n", shapes),
            ("gradient exponent k", _options(rows["k"])),
        ],
        points=_points(
            rows,
            kappa_group,
            lambda row: f"μ = {exact(row['mu'])}, κ = {percent_text(row['kappa'], row['u_kappa'])} %",
            *(rows["mu"], 100 * rows["kappa"], 100 * rows["u_kappa"]),
        ),
        table="kappa",
        caption="κ = (model − reference) / reference. A band shows what the numerical uncertainties of model and "
        "reference allow together; where none is seen it is narrower than the line.",
    )


def curve_group(row: Record) -> str:
    """Return the choice that shows a point of a curve."""
    return _choice(row["n"], row["k"], row["mu"])


def curves(table: pd.DataFrame) -> list[Plot]:
    """One plot for each kind of curve that is stored."""
    usable = table[(table["status"] == "ok") & table["mu"].notna()].sort_values("point", kind="stable")
    return [
        _curve(quantity, rows)
        for quantity in CURVES.values()
        if not (rows := usable[usable["quantity"] == quantity.name]).empty
    ]


def _curve(quantity: CurveQuantity, rows: pd.DataFrame) -> Plot:
    x, y = quantity.x.symbol, quantity.y.symbol
    drawn = _points(rows, curve_group, lambda row: f"{x} = {row['x']:.6g}, {y} = {row['y']:.6g}", rows["x"], rows["y"])
    cases = rows[["n", "k", "mu"]].drop_duplicates().sort_values(["n", "k", "mu"]).to_dict("records")
    options = [(curve_group(row), case_text({"n": row["n"], "k": row["k"], "μ": row["mu"]})) for row in cases]
    views = {
        group: tension_view((part["x"].tolist(), part["y"].tolist()) for _, part in shown.groupby("label"))
        for group, shown in (drawn.groupby("group") if quantity.kind is Kind.CURVE else ())
    }
    return Plot(
        id=f"plot-{quantity.name.replace('_', '-')}",
        title=quantity.title.capitalize(),
        x_label=quantity.x.label,
        y_label=quantity.y.label,
        mark="line",
        controls=[("case", options)],
        points=drawn,
        table=quantity.name,
        caption=quantity.caption,
        views={group: view for group, view in views.items() if view},
    )


def values_over_keys(results: pd.DataFrame) -> Iterator[tuple[Plot, list[str]]]:
    """Yield a plot for each varied key of a problem file that has two numbers or more, and the names of all its keys.

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
                keys = [name, *(other for other in varied if other != name)]
                yield _over_key(rows.sort_values(name, kind="stable"), keys, str(file), f"plot-{count}"), keys


def value_group(keys: Sequence[str]) -> Callable[[Record], str]:
    """Return what gives the choice that shows a value over the first of some keys."""
    return lambda row: _choice(row["quantity"], *(row[name] for name in keys[1:]))


def _over_key(rows: pd.DataFrame, keys: list[str], file: str, id: str) -> Plot:
    over, group = keys[0], value_group(keys)
    label, unit = unit_in(over)
    power, prefixed = prefixed_unit(float(rows[over].abs().max()), unit)
    labels, scales = {}, pd.Series(1.0, rows.index)
    for key, of_group in rows.groupby([group(row) for row in rows.to_dict("records")]):
        y_power, y_unit = prefixed_unit(float(of_group["value"].abs().max()), str(of_group["unit"].iloc[0]))
        title = title_of(of_group["quantity"].iloc[0])
        labels[str(key)] = title if y_unit == "1" else f"{title} ({y_unit})"
        scales[of_group.index] = 10.0**-y_power
    controls = [("quantity", _quantities(rows["quantity"]))]
    for name in keys[1:]:
        key, of = unit_in(name)
        controls.append((key, [(_choice(v), key_text(v, of)) for v in rows[name].drop_duplicates().sort_values()]))

    def hover(row: Record) -> str:
        return f"{label} = {key_text(row[over], unit)}, {title_of(row['quantity'])} = {physical_text(row)}"

    wide = rows[over].min() > 0.0 and rows[over].max() / rows[over].min() >= _LOG
    return Plot(
        id=id,
        title=f"Values over {label} of {file}",
        x_label=label if prefixed == "1" else f"{label} ({prefixed})",
        y_label="value",
        x_scale="log" if wide else "linear",
        controls=controls,
        points=_points(rows, group, hover, rows[over] * 10.0**-power, rows["value"] * scales, rows["u_num"] * scales),
        table=f"{id}-numbers",
        caption="A band shows the bound on the numerical error; where none is seen it is narrower than the line.",
        y_labels=labels,
    )
