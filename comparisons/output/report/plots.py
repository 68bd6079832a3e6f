"""The plots of a page: axes, choices, and points of stored numbers by which a script draws them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from comparisons.numerics.number_text import case_text, exact, percent_text
from comparisons.output.figures.curves import tension_view
from comparisons.output.style import first_shown, model_styles
from comparisons.output.table import Record
from comparisons.quantities import ALL_QUANTITIES, CURVES, CurveQuantity, Kind, title_of

__all__ = ["Plot", "choice", "convergence", "curve_group", "curves", "in_registry", "kappa", "kappa_group", "points"]

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
        As of `points`: one row for each point.
    table : str
        The id of the table with the numbers.
    x_scale, y_scale : str
        "linear" or "log".
    mark : str
        "both" for a line with markers, "line" or "points".
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
    y_scale: str = "linear"
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
        names = ("id", "x_label", "y_label", "x_scale", "y_scale", "mark", "table", "views", "y_labels")
        ranked = self.points.assign(rank=self.points["model"].map(self.models.index))
        series = [
            {"group": group, "model": model, "label": label, **rows[["x", "y", "low", "high", "hover"]].to_dict("list")}
            for (_, group, model, label), rows in ranked.groupby(["rank", "group", "model", "label"], sort=False)
        ]
        series.sort(key=lambda one: self.models.index(one["model"]))
        return {name: getattr(self, name) for name in names} | {"series": series}


def choice(*parts: Any) -> str:
    """Return the key of several options, by which the script finds the points of a choice."""
    return "|".join(part if isinstance(part, str) else exact(part) for part in parts)


def points(
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
    return choice(row["quantity"], row["reference"], row["n"], row["k"])


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
        points=points(
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
    return choice(row["n"], row["k"], row["mu"])


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
    drawn = points(rows, curve_group, lambda row: f"{x} = {row['x']:.6g}, {y} = {row['y']:.6g}", rows["x"], rows["y"])
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


def convergence(results: pd.DataFrame) -> list[Plot]:
    """Uncertainty and observed order of convergence of discretisations, over their size."""
    discrete = results[(results["size"] > 0) & (results["status"] == "ok")]
    bounded, ordered = discrete[discrete["u_num"] > 0], discrete[discrete["observed_order"].notna()]
    bound = "Each point is one number of a discretisation: the bound on its numerical error, against its number of "
    bound += "unknowns."
    order = "The order of convergence that a model observed over its meshes, where it measured one."
    axes = ("u_num, in the unit of the quantity", "log"), ("observed order", "linear")
    plots = (
        _over_size(bounded, "u_num", "plot-uncertainty", "Numerical uncertainty against size", *axes[0], bound),
        _over_size(ordered, "observed_order", "plot-order", "Observed order of convergence", *axes[1], order),
    )
    return [plot for plot in plots if len(plot.points)]


def _over_size(rows: pd.DataFrame, name: str, id: str, title: str, y_label: str, y_scale: str, caption: str) -> Plot:
    return Plot(
        id=id,
        title=title,
        x_label="number of unknowns",
        y_label=y_label,
        x_scale="log",
        y_scale=y_scale,
        mark="points",
        controls=[("quantity", _quantities(rows["quantity"]))],
        points=points(rows.drop(columns="nu"), lambda row: str(row["quantity"]), _size_text, rows["size"], rows[name]),
        table="convergence",
        caption=caption,
    )


def _size_text(row: Record) -> str:
    order = "" if math.isnan(row["observed_order"]) else f", order {row['observed_order']:.2f}"
    case = case_text({"n": row["n"], "k": row["k"], "μ": row["mu"], "problem": row.get("problem")})
    return f"{case}: {row['size']:.0f} unknowns, u_num = {row['u_num']:.1e}{order}"
