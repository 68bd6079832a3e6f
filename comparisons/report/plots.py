"""What the plots of a page draw: series of stored numbers, and the choices by which they are shown."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, field
from typing import Any, cast

import numpy as np
import pandas as pd

from comparisons.outputs.verdicts import parameter_text
from comparisons.report.folder import Stored
from comparisons.report.table import kappa_cell, words

__all__ = ["Control", "Plot", "Series", "convergence", "curve_group", "curves", "kappa", "kappa_group"]

# Where the load is below this share of the pull-off force, a curve approaches the axis and ends the first view.
_FAINT = 0.02

#: The model whose curve is drawn below the others.
_REFERENCE = "fscm"


@dataclass(frozen=True, slots=True)
class Control:
    """A choice: its label, its options as (key, text), and the one that is shown first (else the first)."""

    label: str
    options: tuple[tuple[str, str], ...]
    first: str = ""


@dataclass(frozen=True, slots=True)
class Series:
    """The points of one model under one choice; `low` and `high` bound a band, `says` is read off a point."""

    group: str
    model: str
    label: str
    x: list[float]
    y: list[float]
    says: list[str]
    low: list[float] | None = None
    high: list[float] | None = None


@dataclass(frozen=True, slots=True)
class Plot:
    """One plot: axes, choices, series; `views` holds the first view [x0, x1, y0, y1] of a group if not all of it.

    `mark` is "both" for a line with markers, "line" or "points"; `table` the id of the table with the numbers.
    """

    id: str
    title: str
    x_label: str
    y_label: str
    x_scale: str
    y_scale: str
    mark: str
    controls: tuple[Control, ...]
    series: list[Series]
    table: str
    caption: str
    views: dict[str, list[float]] = field(default_factory=dict)

    @property
    def models(self) -> list[str]:
        """Names of what can be switched on and off, in the order of the series."""
        return list(dict.fromkeys(series.model for series in self.series))

    def data(self) -> dict[str, Any]:
        """Return what the page's script draws, ready for JSON."""
        wanted = ("id", "x_label", "y_label", "x_scale", "y_scale", "mark", "table", "views")
        return {name: getattr(self, name) for name in wanted} | {"series": [asdict(series) for series in self.series]}


def _key(*parts: str | float) -> str:
    return "|".join(part if isinstance(part, str) else parameter_text(part) for part in parts)


def _options(values: Iterable[float]) -> tuple[tuple[str, str], ...]:
    return tuple((parameter_text(value), parameter_text(value)) for value in sorted(set(values)))


def _grouped(table: pd.DataFrame, names: list[str]) -> Iterator[tuple[tuple[Any, ...], pd.DataFrame]]:
    """Return the rows of each combination, sorted; without Poisson's ratio, that is one of its own."""
    for key, rows in table.groupby(names, dropna=False):
        yield cast(tuple[Any, ...], key), rows


def kappa_group(row: pd.Series) -> str:
    """Return the choice that shows a relative error."""
    return _key(row["quantity"], row["reference"], row["n"], row["k"])


def kappa(stored: Stored) -> Plot:
    """Relative errors over the Tabor number, one picture for each n and k."""
    table = stored.kappa.sort_values(["model", "mu"], kind="stable")
    series = []
    for (model, quantity, reference, n, k, nu), rows in _grouped(
        table, ["model", "quantity", "reference", "n", "k", "nu"]
    ):
        percent, band = 100 * rows["kappa"], 100 * rows["u_kappa"]
        series.append(
            Series(
                group=_key(quantity, reference, n, k),
                model=model,
                label=model if math.isnan(nu) else f"{model}, ν = {nu:g}",
                x=rows["mu"].tolist(),
                y=percent.tolist(),
                says=[
                    f"μ = {parameter_text(mu)}, κ = {kappa_cell(value, u).text} %"
                    for mu, value, u in zip(rows["mu"], rows["kappa"], rows["u_kappa"], strict=True)
                ],
                low=(percent - band).tolist(),
                high=(percent + band).tolist(),
            )
        )
    pairs = table[["quantity", "reference"]].drop_duplicates().sort_values(["quantity", "reference"])
    controls = (
        Control("quantity", tuple((q, words(q)) for q in dict.fromkeys(pairs["quantity"]))),
        Control("reference", tuple((r, r) for r in dict.fromkeys(pairs["reference"]))),
        Control("shape index n", _options(table["n"]), first="2"),
        Control("gradient exponent k", _options(table["k"])),
    )
    return Plot(
        id="plot-kappa",
        title="Relative error against the Tabor number",
        x_label="generalised Tabor number μ",
        y_label="relative error κ (%)",
        x_scale="log",
        y_scale="linear",
        mark="both",
        controls=controls,
        series=series,
        table="kappa",
        caption="κ = (model − reference) / reference. A band shows what the numerical uncertainties of model and "
        "reference allow together; where none is seen it is narrower than the line.",
    )


def curve_group(row: pd.Series) -> str:
    """Return the choice that shows a point of a curve."""
    return _key(*(row[name] for name in ("n", "k", "mu")))


#: Quantity -> (title, symbol on x, symbol on y, label of x, label of y, caption).
_CURVES = {
    "force_curve": (
        "Force-displacement curves",
        "δ",
        "P",
        "displacement δ / z₀",
        "load P / (π Q^(2/n) Δγ z₀^(2/n−1))",
        "The whole equilibrium path, its unstable part included, from far away (left) into contact. A machine that "
        "controls the displacement jumps where the path turns back. Tension is negative.",
    ),
    "pull_off_pressure": (
        "Pressure under the punch at pull-off",
        "r",
        "p",
        "radius r / (Q z₀)^(1/n)",
        "pressure p z₀ / Δγ",
        "The pressure where the load is smallest, out to a gap of 10 z₀; tension is negative.",
    ),
}


def curves(stored: Stored) -> list[Plot]:
    """One plot a kind of curve that is stored."""
    usable = stored.curves[stored.curves["status"] == "ok"].sort_values("point", kind="stable")
    plots = []
    for quantity, (title, x_symbol, y_symbol, x_label, y_label, caption) in _CURVES.items():
        chosen = usable[usable["quantity"] == quantity]
        if chosen.empty:
            continue
        series = [
            Series(
                group=_key(n, k, mu),
                model=model,
                label=model if math.isnan(nu) else f"{model}, ν = {nu:g}",
                x=rows["x"].tolist(),
                y=rows["y"].tolist(),
                says=[f"{x_symbol} = {x:.6g}, {y_symbol} = {y:.6g}" for x, y in zip(rows["x"], rows["y"], strict=True)],
            )
            for (model, n, k, mu, nu), rows in _grouped(chosen, ["model", "n", "k", "mu", "nu"])
        ]
        # The reference lies below: where the others are right, they cover it with their dashes.
        series.sort(key=lambda one: one.model != _REFERENCE)
        cases = chosen[["n", "k", "mu"]].drop_duplicates().sort_values(["n", "k", "mu"])
        options = tuple(
            (_key(n, k, mu), f"n = {n:g}, k = {k:g}, μ = {mu:g}") for n, k, mu in cases.itertuples(index=False)
        )
        views = {key: _view([s for s in series if s.group == key]) for key, _ in options}
        plots.append(
            Plot(
                id=f"plot-{quantity.replace('_', '-')}",
                title=title,
                x_label=x_label,
                y_label=y_label,
                x_scale="linear",
                y_scale="linear",
                mark="line",
                controls=(Control("case", options),),
                series=series,
                table=quantity,
                caption=caption,
                views={key: view for key, view in views.items() if view and quantity == "force_curve"},
            )
        )
    return plots


def _view(series: list[Series]) -> list[float] | None:
    """Where the surfaces pull, and as much compression: some curves go on far beyond."""
    deepest = min((min(one.y) for one in series), default=0.0)
    if deepest >= 0.0:
        return None
    x, y = (np.concatenate([getattr(one, name) for one in series]) for name in ("x", "y"))
    shown = x[(abs(y) > -_FAINT * deepest) & (y < -deepest)]
    margin = 0.05 * float(np.ptp(shown))
    return [float(shown.min()) - margin, float(shown.max()) + margin, 1.15 * deepest, -deepest]


def convergence(stored: Stored) -> list[Plot]:
    """How sure a discretisation is of its numbers, and how fast it was seen to converge, over its size."""
    rows = stored.results[(stored.results["size"] > 0) & (stored.results["status"] == "ok")]
    of_value = _over_size(
        rows[rows["u_num"] > 0],
        "u_num",
        id="plot-uncertainty",
        title="Numerical uncertainty against size",
        y_label="u_num, in the unit of the quantity",
        y_scale="log",
        caption="Each point is one number that a discretisation gave: what bounds its numerical error, against the "
        "number of unknowns it took.",
    )
    of_order = _over_size(
        rows[rows["observed_order"].notna()],
        "observed_order",
        id="plot-order",
        title="Observed order of convergence",
        y_label="observed order",
        y_scale="linear",
        caption="The order of convergence that a model saw over the meshes of an answer, where it measured one.",
    )
    return [plot for plot in (of_value, of_order) if plot.series]


def _over_size(
    rows: pd.DataFrame, column: str, *, id: str, title: str, y_label: str, y_scale: str, caption: str
) -> Plot:
    series = [
        Series(
            group=quantity,
            model=model,
            label=model,
            x=of_model["size"].tolist(),
            y=of_model[column].tolist(),
            says=[
                f"n = {row['n']:g}, k = {row['k']:g}, μ = {row['mu']:g}: {row['size']:.0f} unknowns, "
                f"u_num = {row['u_num']:.1e}"
                + ("" if math.isnan(row["observed_order"]) else f", order {row['observed_order']:.2f}")
                for _, row in of_model.iterrows()
            ],
        )
        for (quantity, model), of_model in _grouped(rows, ["quantity", "model"])
    ]
    options = tuple((name, words(name)) for name in sorted(set(rows["quantity"]), key=_by_use))
    return Plot(
        id=id,
        title=title,
        x_label="number of unknowns",
        y_label=y_label,
        x_scale="log",
        y_scale=y_scale,
        mark="points",
        controls=(Control("quantity", options),),
        series=series,
        table="convergence",
        caption=caption,
    )


def _by_use(quantity: str) -> tuple[bool, str]:
    """The pull-off force is what most people look for."""
    return quantity != "pull_off_force", quantity
