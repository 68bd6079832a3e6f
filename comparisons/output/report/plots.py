"""What the plots of a page draw: series of stored numbers, and the choices by which they are shown."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from comparisons.output.report.plot import Control, Plot, Series, grouped, key, options
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.table import kappa_cell, words
from comparisons.output.verdicts import parameter_text

__all__ = ["convergence", "curve_group", "curves", "kappa", "kappa_group"]

# Where the load is below this share of the pull-off force, a curve approaches the axis and ends the first view.
_FAINT = 0.02

#: The model whose curve is drawn below the others.
_REFERENCE = "fscm"


def kappa_group(row: pd.Series) -> str:
    """Return the choice that shows a relative error."""
    return key(row["quantity"], row["reference"], row["n"], row["k"])


def kappa(stored: Stored) -> Plot:
    """Relative errors over the Tabor number, one picture for each n and k."""
    table = stored.kappa.sort_values(["model", "mu"], kind="stable")
    # An absurd value overflows in percent; it is in the tables, but there is no place for it in a picture.
    finite = table[np.isfinite(100 * table["kappa"]) & np.isfinite(100 * table["u_kappa"])]
    series = []
    for (model, quantity, reference, n, k, nu), rows in grouped(
        finite, ["model", "quantity", "reference", "n", "k", "nu"]
    ):
        percent, band = 100 * rows["kappa"], 100 * rows["u_kappa"]
        series.append(
            Series(
                group=key(quantity, reference, n, k),
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
        Control("shape index n", options(table["n"]), first="2"),
        Control("gradient exponent k", options(table["k"])),
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
    return key(*(row[name] for name in ("n", "k", "mu")))


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
    "pull_off_gap": (
        "Gap under the punch at pull-off",
        "r",
        "H",
        "radius r / (Q z₀)^(1/n)",
        "gap H / z₀",
        "The gap where the load is smallest, out to 10 z₀. Zero is the equilibrium distance of two flat surfaces, "
        "where the pressure is zero.",
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
                group=key(n, k, mu),
                model=model,
                label=model if math.isnan(nu) else f"{model}, ν = {nu:g}",
                x=rows["x"].tolist(),
                y=rows["y"].tolist(),
                says=[f"{x_symbol} = {x:.6g}, {y_symbol} = {y:.6g}" for x, y in zip(rows["x"], rows["y"], strict=True)],
            )
            for (model, n, k, mu, nu), rows in grouped(chosen, ["model", "n", "k", "mu", "nu"])
        ]
        # The reference lies below: where the others are right, they cover it with their dashes.
        series.sort(key=lambda one: one.model != _REFERENCE)
        cases = chosen[["n", "k", "mu"]].drop_duplicates().sort_values(["n", "k", "mu"])
        choices = tuple(
            (key(n, k, mu), f"n = {n:g}, k = {k:g}, μ = {mu:g}") for n, k, mu in cases.itertuples(index=False)
        )
        views = {case: _view([s for s in series if s.group == case]) for case, _ in choices}
        plots.append(
            Plot(
                id=f"plot-{quantity.replace('_', '-')}",
                title=title,
                x_label=x_label,
                y_label=y_label,
                x_scale="linear",
                y_scale="linear",
                mark="line",
                controls=(Control("case", choices),),
                series=series,
                table=quantity,
                caption=caption,
                views={case: view for case, view in views.items() if view and quantity == "force_curve"},
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
        for (quantity, model), of_model in grouped(rows, ["quantity", "model"])
    ]
    choices = tuple((name, words(name)) for name in sorted(set(rows["quantity"]), key=_by_use))
    return Plot(
        id=id,
        title=title,
        x_label="number of unknowns",
        y_label=y_label,
        x_scale="log",
        y_scale=y_scale,
        mark="points",
        controls=(Control("quantity", choices),),
        series=series,
        table="convergence",
        caption=caption,
    )


def _by_use(quantity: str) -> tuple[bool, str]:
    """The pull-off force is what most people look for."""
    return quantity != "pull_off_force", quantity
