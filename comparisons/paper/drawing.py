"""Lines, labels and legends that the pictures of the paper share."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, MODEL_LINES, MODEL_NAMES

__all__ = ["LABELS", "by_model", "crosses", "dashed", "gradient", "legend_below", "level", "of_model", "one_a_value"]

#: Labels of axes, by what is on them.
LABELS = {
    "n": "shape index $n$",
    "k": "gradient exponent $k$",
    "mu": r"Tabor number $\mu$",
    "radius": r"radius $r/(Qz_0)^{1/n}$",
    "height": r"height of the surface $-w/z_0$",
    "pressure": r"pressure $p z_0/\Delta\gamma$",
    "displacement": r"displacement $\delta/z_0$",
    "load": r"load $\bar P$",
    "force": r"pull-off force $-\bar P_c$",
}


def dashed(index: int) -> dict[str, Any]:
    """Colour and dashes of the line of a number."""
    return {"color": COLOURS[index], "ls": LINES[index]}


def gradient(k: float) -> str:
    """Name of a gradient exponent in a legend."""
    return f"$k$ = {k:g}" + (" (Gibson)" if k == 1.0 else "")


def of_model(table: pd.DataFrame, *models: str, column: str = "model") -> list[pd.DataFrame]:
    """Rows of each of these models."""
    return [table[table[column] == model] for model in models]


def by_model(axes: Axes, table: pd.DataFrame, x: str, y: str) -> None:
    """Draw the FSCM and both Maugis-Dugdale models, each in its style."""
    for model, part in zip(MODEL_LINES, of_model(table, *MODEL_LINES), strict=True):
        axes.plot(part[x], part[y], label=MODEL_NAMES[model], **MODEL_LINES[model])


def one_a_value(axes: Axes, table: pd.DataFrame, name: str, x: str, y: str, scale: float = 1.0) -> None:
    """Draw a line for each value of a parameter."""
    for index, (value, part) in enumerate(table.groupby(name)):
        axes.plot(part[x], scale * part[y], label=f"${name}$ = {value:g}", **dashed(index))


def crosses(axes: Axes, x: Any, y: Any, **style: Any) -> None:
    """Mark points of the finite elements."""
    marked: dict[str, Any] = {"ls": "none", "marker": "x", "ms": 8, "color": "0.2"} | style
    axes.plot(x, y, **marked)


def level(axes: Axes, y: float = 0.0, **style: Any) -> None:
    """Draw a thin horizontal line."""
    thin: dict[str, Any] = {"color": "0.4", "lw": 0.8} | style
    axes.axhline(y, **thin)


def legend_below(figure: Figure, columns: int, **style: Any) -> None:
    """Add one legend below all panels, with what the first of them shows."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=columns, **style)
