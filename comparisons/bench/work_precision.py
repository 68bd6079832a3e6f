"""Error against CPU time: the pull-off force of a sphere on a homogeneous half-space by both references and the scheme.

The error is that against the certified pull-off force.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.part import Numbers, Part
from comparisons.bench.pull_off import cost_of_pull_off
from comparisons.output.style import COLOURS, MARKERS, new_figure, styled
from comparisons.paper.drawing import panels

#: Tabor number -> centre and radius of an interval that contains the pull-off force for n = 2, k = 0, from
#: docs/certified_value.md; the proof is tests/certified.
CERTIFIED = {
    0.1: (1.96895637932829, 1e-11),
    0.5: (1.78748293102689, 6e-13),
    1.0: (1.6706647764763, 1.6e-12),
}

#: Settings of each solver: accuracies, and segments of the scheme of the paper, which has 2500.
_SETTINGS = {
    "fscm": ("1e-04", "1e-05", "1e-06", "1e-07", "1e-08", "1e-09", "1e-10"),
    "fem": ("quick", "default", "fine"),
    "fscm-stieltjes": ("250", "500", "1000", "2500"),
}
#: Measured with `full` only.
_LONG = "2500"


def plan(full: bool) -> list[Numbers]:
    """Return the solvers with all their settings."""
    return [
        {"n": 2.0, "k": 0.0, "mu": mu, "model": model, "setting": setting}
        for mu in CERTIFIED
        for model, settings in _SETTINGS.items()
        for setting in settings
        if full or setting != _LONG
    ]


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add to every row its error, how well it is known, and the ratio to `fscm`.

    ``error`` is the distance from the certified value relative to it; it is only known to within ``u_error``.
    ``ratio`` is CPU time over that of the fastest `fscm` whose error is certainly smaller; missing where there is none.
    """
    centre, radius = (rows["mu"].map({mu: interval[i] for mu, interval in CERTIFIED.items()}) for i in (0, 1))
    rows = rows.assign(error=(rows["value"] - centre).abs() / centre, u_error=radius / centre)
    return rows.assign(ratio=time_ratios(rows))


def time_ratios(rows: pd.DataFrame) -> list[float]:
    """Return CPU time over that of the fastest `fscm` whose error is smaller by more than both doubts.

    Examples
    --------
    >>> pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1e-6], "u_error": [1e-12, 1e-12]}
    >>> time_ratios(pd.DataFrame({**pair, "cpu_seconds": [0.1, 5.0]}))
    [nan, 50.0]
    """
    quotients = []
    for row in rows.to_dict("records"):
        ours = rows[(rows["model"] == "fscm") & (rows["mu"] == row["mu"])]
        smaller = ours["error"] + ours["u_error"] < row["error"] - row["u_error"]
        fastest = ours.loc[smaller, "cpu_seconds"].min()
        quotients.append(float(row["cpu_seconds"] / fastest) if row["model"] != "fscm" else float("nan"))
    return quotients


def draw(rows: pd.DataFrame) -> Figure:
    """Draw error against CPU time, one panel a Tabor number."""
    # A smaller error is drawn where it is known to be.
    drawn = rows.assign(error=np.maximum(rows["error"], rows["u_error"]))
    tabor_numbers = drawn["mu"].unique()
    with styled():
        figure = new_figure(3.4 * len(tabor_numbers), 3.2)
        words = [rf"$\mu$ = {mu:g}" for mu in tabor_numbers]
        lattice = panels(figure, 1, len(words), words, "CPU time (s)", "relative error of the pull-off force")
        for axes, mu in zip(lattice, tabor_numbers, strict=True):
            for index, model in enumerate(_SETTINGS):
                line = drawn[(drawn["mu"] == mu) & (drawn["model"] == model)].sort_values("cpu_seconds")
                axes.loglog("cpu_seconds", "error", data=line, color=COLOURS[index], marker=MARKERS[index], label=model)
            axes.legend()
    return figure


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the finest `fscm`, and the other solvers with their CPU time over that of `fscm` at a smaller error."""
    columns = ["model", "setting", "mu", "ratio", "cpu_seconds", "cold_seconds", "megabytes", "error"]
    is_finest = ~rows.duplicated(["mu", "model"], keep="last")
    return rows.loc[is_finest | (rows["model"] != "fscm"), columns]


WORK_PRECISION = Part(
    "work-precision",
    "error against CPU time; ratio: to fscm of smaller error",
    plan,
    cost_of_pull_off,
    ratios,
    summary,
    draw,
)
