"""Error against CPU time: the pull-off force of a sphere on a homogeneous half-space by four solvers.

The reference is `fscm` at its tightest accuracy.  Where the pull-off force is certified, the reference must be in the
certified interval.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.bench import adhesion_package
from comparisons.bench.part import Item, Part
from comparisons.bench.pull_off import FSCM_ACCURACIES, measure, setting_text
from comparisons.bench.references import CERTIFIED
from comparisons.output.style import COLOURS, MARKERS, lettered, model_label, styled

__all__ = ["WORK_PRECISION", "draw", "items", "ratios", "summary", "table"]

TABOR_NUMBERS = (0.1, 0.5, 1.0)
_CASE = {"n": 2.0, "k": 0.0}
_FINEST = min(FSCM_ACCURACIES)

#: Segments of the Stieltjes scheme with the seconds they take; 2500, those of the paper, at one Tabor number only.
_SEGMENTS = {250: 0.3, 500: 1.3, 1000: 9.0, 2500: 170.0}
#: Half width of the square and pixels along a side of `adhesion`: what is left out and the size of a pixel have errors
#: of about the same size.  The largest one at one Tabor number only, the last one with `full`.
_SQUARES = {(6.0, 32): 0.6, (8.0, 64): 1.5, (12.0, 128): 9.0, (16.0, 256): 70.0}
_LARGE_SQUARES = {(24.0, 512): 600.0}
_ELEMENTS = {"quick": 8.0, "default": 15.0, "fine": 40.0}
_WHERE_LONG = 1.0
_LONG = 20.0

_STYLES = {"fscm": 0, "fscm-stieltjes": 1, "adhesion": 2, "fem": 3}
#: Place of the names of the settings above their points, in printer's points.
_HEIGHTS = {"fscm-stieltjes": -13, "adhesion": 7, "fem": 7}


def items(full: bool) -> list[Item]:
    """Return the solvers with all their settings; the long ones at one Tabor number, with `full` at all three."""
    found = []
    for mu in TABOR_NUMBERS:

        def add(seconds: float, mu: float = mu, **settings: object) -> None:
            if full or seconds < _LONG or mu == _WHERE_LONG:
                found.append(Item({**_CASE, "mu": mu, **settings}, seconds))

        for accuracy in FSCM_ACCURACIES:
            add(1.0, model="fscm", accuracy=accuracy)
        for name, seconds in _ELEMENTS.items():
            if full or mu == _WHERE_LONG:
                add(seconds, model="fem", accuracy=name)
        for segments, seconds in _SEGMENTS.items():
            add(seconds, model="fscm-stieltjes", segments=segments)
        if adhesion_package.installed():
            for (half_width, points), seconds in {**_SQUARES, **(_LARGE_SQUARES if full else {})}.items():
                add(seconds, model="adhesion", half_width=half_width, points=points)
    return found


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add to every row its setting in words, its error, the bound of the reference, and the ratio to `fscm`.

    ``error`` is the distance from the reference relative to it; it is only known to within ``u_reference``.  ``ratio``
    is CPU time over that of the fastest `fscm` whose error is certainly smaller; missing where there is none.
    """
    rows = rows.copy()
    rows.insert(rows.columns.get_loc("model") + 1, "setting", [setting_text(row) for row in rows.to_dict("records")])
    is_reference = (rows["model"] == "fscm") & (rows.get("accuracy") == _FINEST) & (rows["status"] == "ok")
    references = rows[is_reference].set_index("mu")
    if "value" not in rows:
        return rows
    value, bound = (rows["mu"].map(references[name]) for name in ("value", "u_num"))
    rows["error"] = (rows["value"] - value).abs() / value
    rows["u_reference"] = bound / value
    rows["reference_is_certified"] = [_certified(mu, v, u) for mu, v, u in zip(rows["mu"], value, bound, strict=True)]
    rows["ratio"] = ratios(rows)
    return rows


def _certified(mu: float, value: float, bound: float) -> bool:
    return mu in CERTIFIED and CERTIFIED[mu].overlaps(value, bound)


def ratios(rows: pd.DataFrame) -> list[float]:
    """Return CPU time over that of the fastest `fscm` with a smaller error, the doubt about the reference included.

    Examples
    --------
    >>> pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1e-6], "u_reference": [1e-12, 1e-12]}
    >>> ratios(pd.DataFrame({**pair, "cpu_seconds": [0.1, 5.0]}))
    [nan, 50.0]
    """
    found = []
    for row in rows.to_dict("records"):
        ours = rows[(rows["model"] == "fscm") & (rows["mu"] == row["mu"])]
        smaller = ours["error"] + ours["u_reference"] < row["error"] - row["u_reference"]
        fastest = ours.loc[smaller, "cpu_seconds"].min()
        found.append(float(row["cpu_seconds"] / fastest) if row["model"] != "fscm" else float("nan"))
    return found


def draw(table: pd.DataFrame) -> Figure:
    """Draw error against CPU time, one panel a Tabor number."""
    with styled():
        figure = Figure(figsize=(11.0, 3.9), layout="constrained")
        numbers = sorted(table["mu"].unique())
        panels = figure.subplots(1, len(numbers), sharex=True, sharey=True, squeeze=False)[0]
        for axes, mu, letter in zip(panels, numbers, "abc", strict=False):
            here = table[(table["mu"] == mu) & (table["status"] == "ok")]
            for model, place in _STYLES.items():
                rows = here[here["model"] == model].sort_values(["unknowns", "cpu_seconds"])
                # The error is known to within the bound of the reference: a smaller one is drawn there.
                shown = np.maximum(rows["error"], rows["u_reference"])
                axes.loglog(
                    rows["cpu_seconds"],
                    shown,
                    color=COLOURS[place],
                    marker=MARKERS[place],
                    ms=5,
                    ls="-" if model == "fscm" else "--",
                    label=model_label(model),
                )
                if model != "fscm":
                    _name_ends(axes, rows["cpu_seconds"], shown, rows["setting"], _HEIGHTS[model])
            lettered(axes, letter, rf"$\mu$ = {mu:g}")
            axes.set_xlabel("CPU time (s)")
            axes.margins(x=0.14, y=0.08)
        panels[0].set_ylabel("relative error of the pull-off force")
        panels[0].legend(loc="center right")
        figure.suptitle("Pull-off force for $n$ = 2, $k$ = 0: error against CPU time, one thread", fontsize=10)
    return figure


def _name_ends(axes: Axes, x: pd.Series, y: pd.Series, names: pd.Series, height: int) -> None:
    """Write the settings of the first and the last point of a line above or below them."""
    for place in sorted({0, len(x) - 1}) if len(x) else ():
        axes.annotate(
            names.iloc[place],
            (x.iloc[place], y.iloc[place]),
            xytext=(0, height),
            textcoords="offset points",
            ha="center",
            fontsize=7,
        )


def summary(table: pd.DataFrame) -> list[str]:
    """Return the finest setting of each other solver: its CPU time over that of `fscm` at a smaller error."""
    lines = [
        "CPU time / CPU time of fscm whose error is smaller (pull-off, n = 2, k = 0):",
        f"{'':18}{'setting':>10}{'mu':>6}{'ratio':>9}{'CPU (s)':>10}{'error':>10}",
    ]
    ok = table[table["status"] == "ok"]
    for model in ("fscm-stieltjes", "adhesion", "fem"):
        for mu in sorted(ok.loc[ok["model"] == model, "mu"].unique()):
            finest = ok[(ok["model"] == model) & (ok["mu"] == mu)].sort_values("unknowns").iloc[-1]
            lines.append(
                f"  {model:16}{finest['setting']:>10}{mu:>6g}{finest['ratio']:>9.0f}"
                f"{finest['cpu_seconds']:>10.3g}{finest['error']:>10.1e}"
            )
    if not adhesion_package.installed() and "adhesion" not in set(table["model"]):
        lines.append(f"  {adhesion_package.INSTALL}")
    ours = ok[ok["model"] == "fscm"]
    largest = float((ours["error"] + ours["u_reference"]).max())
    proved = sorted(ours.loc[ours["reference_is_certified"], "mu"].unique())
    lines.append(
        f"  fscm at 1e-4 ... 1e-10: {ours['cpu_seconds'].min():.2g} to {ours['cpu_seconds'].max():.2g} s, "
        f"error at most {largest:.0e}"
    )
    lines.append(f"  reference in the certified interval at mu = {_listed(proved)}")
    return lines


def _listed(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:g}" for number in numbers) or "none"


WORK_PRECISION = Part(
    "work-precision",
    "error against CPU time of fscm, the finite elements, the Stieltjes scheme and the package adhesion",
    items,
    measure,
    table,
    draw,
    summary,
)
