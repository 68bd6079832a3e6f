"""Panels, lines, labels and legends that the pictures of the paper share."""

from __future__ import annotations

from collections.abc import Sequence
from string import ascii_lowercase
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, MODEL_LINES, lettered

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
    "central_gap": r"central gap $H_0/z_0$",
}
_SYMBOLS = {"n": "$n$", "k": "$k$", "mu": r"$\mu$", "nu": r"$\nu$"}


def dashed(index: int) -> dict[str, Any]:
    """Colour and dashes of the line of a number."""
    return {"color": COLOURS[index], "ls": LINES[index]}


def case(**values: float) -> str:
    """Return parameters that a panel holds, or a line, e.g. ``$n$ = 2, $k$ = 0.4``."""
    text = ", ".join(f"{symbol} = {values[name]:g}" for name, symbol in _SYMBOLS.items() if name in values)
    return f"{text} (Gibson)" if values == {"k": 1.0} else text


def panels(figure: Figure, words: Sequence[str], x: str = "", y: str = "", rows: int = 1, **grid: Any) -> list[Axes]:
    """Return lettered panels, row by row, with what each alone shows; labels are at the left and below.

    Parameters
    ----------
    words : sequence of str
        One text a panel.
    x, y : str
        What is on the axes, as in `LABELS`, or their labels.
    rows : int
    **grid
        Of `Figure.subplots`.
    """
    lattice = figure.subplots(rows, len(words) // rows, squeeze=False, **grid)
    for letter, text, axes in zip(ascii_lowercase, words, lattice.flat, strict=False):
        lettered(axes, letter, text)
    for axes in lattice[-1]:
        axes.set_xlabel(LABELS.get(x, x))
    for axes in lattice[:, 0]:
        axes.set_ylabel(LABELS.get(y, y))
    return list(lattice.flat)


def of_model(table: pd.DataFrame, *models: str, column: str = "model") -> list[pd.DataFrame]:
    """Rows of each of these models."""
    return [table[table[column] == model] for model in models]


def by_model(axes: Axes, table: pd.DataFrame, x: str, y: str, **style: Any) -> None:
    """Draw the FSCM and both Maugis-Dugdale models, each in its style."""
    for model, rows in zip(MODEL_LINES, of_model(table, *MODEL_LINES), strict=True):
        axes.plot(rows[x], rows[y], **{"label": model} | MODEL_LINES[model] | style)


def lines_by(
    axes: Axes, table: pd.DataFrame, name: str, x: str, y: str, scale: float = 1.0, label: str = "", **style: Any
) -> None:
    """Draw a line for each value of a parameter."""
    for index, (value, rows) in enumerate(table.groupby(name)):
        axes.plot(rows[x], scale * rows[y], **{"label": label + case(**{name: value})} | dashed(index) | style)


def beside_fem(
    axes: Axes, table: pd.DataFrame, x: str, y: str, scale: float = 1.0, column: str = "reference", **style: Any
) -> None:
    """Draw a line of the FSCM, and the finite elements as crosses."""
    exact, fem = of_model(table, "fscm", "fem", column=column)
    axes.plot(exact[x], scale * exact[y], **style)
    axes.plot(fem[x], scale * fem[y], ls="none", marker="x", ms=8, color="0.2")


def banded(axes: Axes, x: pd.Series, y: pd.Series, u: pd.Series, **style: Any) -> None:
    """Draw a line in percent, and its bound as a band."""
    axes.plot(x, 100.0 * y, **style)
    axes.fill_between(x, 100.0 * (y - u), 100.0 * (y + u), color=style["color"], alpha=0.2, lw=0.0)


def level(axes: Axes, y: float = 0.0, **style: Any) -> None:
    """Draw a thin horizontal line."""
    thin: dict[str, Any] = {"color": "0.4", "lw": 0.8}
    axes.axhline(y, **thin | style)


def legend_below(figure: Figure, columns: int, **style: Any) -> None:
    """Add one legend below all panels, with what the first of them shows."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=columns, **style)
