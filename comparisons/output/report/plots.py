"""The plots of a page: series of stored numbers, and the choices by which they are shown."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from comparisons.numerics.number_text import case_text, exact, percent_text
from comparisons.output.figures.curves import tension_view
from comparisons.output.report.plot import Control, Plot, Series, grouped, key, options
from comparisons.output.report.stored_run import Stored
from comparisons.output.style import model_styles
from comparisons.quantities import ALL_QUANTITIES, CURVES, Kind, title_of

__all__ = ["convergence", "curve_group", "curves", "kappa", "kappa_group"]


def kappa_group(row: pd.Series) -> str:
    """Return the choice that shows a relative error."""
    return key(row["quantity"], row["reference"], row["n"], row["k"])


def kappa(stored: Stored) -> Plot:
    """Relative errors over the Tabor number, one picture for each n and k."""
    table = stored.kappa[stored.kappa["mu"].notna()].sort_values(["model", "mu"], kind="stable")
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
                hover=[
                    f"μ = {exact(mu)}, κ = {percent_text(value, u)} %"
                    for mu, value, u in zip(rows["mu"], rows["kappa"], rows["u_kappa"], strict=True)
                ],
                low=(percent - band).tolist(),
                high=(percent + band).tolist(),
            )
        )
    pairs = table[["quantity", "reference"]].drop_duplicates().sort_values(["quantity", "reference"])
    controls = (
        Control("quantity", tuple((q, title_of(q)) for q in dict.fromkeys(pairs["quantity"]))),
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
        controls=controls,
        series=series,
        table="kappa",
        caption="κ = (model − reference) / reference. A band shows what the numerical uncertainties of model and "
        "reference allow together; where none is seen it is narrower than the line.",
    )


def curve_group(row: pd.Series) -> str:
    """Return the choice that shows a point of a curve."""
    return key(*(row[name] for name in ("n", "k", "mu")))


def curves(stored: Stored) -> list[Plot]:
    """One plot a kind of curve that is stored."""
    usable = stored.curves[(stored.curves["status"] == "ok") & stored.curves["mu"].notna()].sort_values(
        "point", kind="stable"
    )
    plots = []
    for row in CURVES.values():
        chosen = usable[usable["quantity"] == row.name]
        if chosen.empty:
            continue
        series = [
            Series(
                group=key(n, k, mu),
                model=model,
                label=model if math.isnan(nu) else f"{model}, ν = {nu:g}",
                x=rows["x"].tolist(),
                y=rows["y"].tolist(),
                hover=[
                    f"{row.x.symbol} = {x:.6g}, {row.y.symbol} = {y:.6g}"
                    for x, y in zip(rows["x"], rows["y"], strict=True)
                ],
            )
            for (model, n, k, mu, nu), rows in grouped(chosen, ["model", "n", "k", "mu", "nu"])
        ]
        # The broad line lies below: where the others are right, they cover it with their dashes.
        styles = model_styles(one.model for one in series)
        series.sort(key=lambda one: not styles[one.model].broad)
        cases = chosen[["n", "k", "mu"]].drop_duplicates().sort_values(["n", "k", "mu"])
        choices = tuple(
            (key(n, k, mu), case_text({"n": n, "k": k, "μ": mu})) for n, k, mu in cases.itertuples(index=False)
        )
        views = {
            case: view
            for case, _ in choices
            if row.kind is Kind.CURVE and (view := tension_view((s.x, s.y) for s in series if s.group == case))
        }
        plots.append(
            Plot(
                id=f"plot-{row.name.replace('_', '-')}",
                title=row.title.capitalize(),
                x_label=row.x.label,
                y_label=row.y.label,
                mark="line",
                controls=(Control("case", choices),),
                series=series,
                table=row.name,
                caption=row.caption,
                views=views,
            )
        )
    return plots


def convergence(stored: Stored) -> list[Plot]:
    """Uncertainty and observed order of convergence of discretisations, over their size."""
    rows = stored.results[(stored.results["size"] > 0) & (stored.results["status"] == "ok")]
    of_value = _over_size(
        rows[rows["u_num"] > 0],
        "u_num",
        id="plot-uncertainty",
        title="Numerical uncertainty against size",
        y_label="u_num, in the unit of the quantity",
        y_scale="log",
        caption="Each point is one number of a discretisation: the bound on its numerical error, against its "
        "number of unknowns.",
    )
    of_order = _over_size(
        rows[rows["observed_order"].notna()],
        "observed_order",
        id="plot-order",
        title="Observed order of convergence",
        y_label="observed order",
        y_scale="linear",
        caption="The order of convergence that a model observed over its meshes, where it measured one.",
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
            hover=[
                f"n = {row['n']:g}, k = {row['k']:g}, μ = {row['mu']:g}: {row['size']:.0f} unknowns, "
                f"u_num = {row['u_num']:.1e}"
                + ("" if math.isnan(row["observed_order"]) else f", order {row['observed_order']:.2f}")
                for _, row in of_model.iterrows()
            ],
        )
        for (quantity, model), of_model in grouped(rows, ["quantity", "model"])
    ]
    choices = tuple((name, title_of(name)) for name in sorted(set(rows["quantity"]), key=_in_registry))
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


def _in_registry(quantity: str) -> tuple[int, str]:
    """The order of the registry; a quantity that is not in it comes last."""
    names = list(ALL_QUANTITIES)
    return names.index(quantity) if quantity in names else len(names), quantity
