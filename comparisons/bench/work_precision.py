"""Error against CPU time: the pull-off force of a sphere on a homogeneous half-space by four solvers.

The reference is `fscm` at its tightest accuracy.  Where the pull-off force is certified, the reference must be in the
certified interval.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench import adhesion_package
from comparisons.bench.drawing import Panel, lines
from comparisons.bench.part import Part, Settings
from comparisons.bench.pull_off import FSCM_ACCURACIES, measure

__all__ = ["CERTIFIED", "WORK_PRECISION", "time_ratios"]

#: Tabor number -> centre and radius of an interval that contains the pull-off force for n = 2, k = 0, from
#: docs/certified_value.md; the proof is tests/certified.
CERTIFIED = {
    0.1: (1.96895637932829, 1e-11),
    0.5: (1.78748293102689, 6e-13),
    1.0: (1.6706647764763, 1.6e-12),
}

#: Segments of the Stieltjes scheme; 2500 are those of the paper.
_SEGMENTS = (250, 500, 1000, 2500)
#: Half width of the square and pixels along a side of `adhesion`: what is left out and the size of a pixel have errors
#: of about the same size.  The last with `full` only.
_SQUARES = ((6.0, 32), (8.0, 64), (12.0, 128), (16.0, 256), (24.0, 512))
_ELEMENTS = ("quick", "default", "fine")
#: Settings that take long are measured at this Tabor number only, with `full` at all three.
_LONG, _WHERE_LONG = (2500, 256, *_ELEMENTS), 1.0


def plan(full: bool) -> list[Settings]:
    """Return the solvers with all their settings."""
    squares = _SQUARES if adhesion_package.installed() else ()
    solvers: list[Settings] = [
        *({"model": "fscm", "setting": f"{accuracy:.0e}", "accuracy": accuracy} for accuracy in FSCM_ACCURACIES),
        *({"model": "fem", "setting": name, "accuracy": name} for name in _ELEMENTS),
        *({"model": "fscm-stieltjes", "setting": f"N = {segments}", "segments": segments} for segments in _SEGMENTS),
        *(
            {"model": "adhesion", "setting": f"{points} x {points}", "half_width": half_width, "points": points}
            for half_width, points in (squares if full else squares[:-1])
        ),
    ]
    return [
        {"n": 2.0, "k": 0.0, "mu": mu, **solver}
        for mu in CERTIFIED
        for solver in solvers
        if full or mu == _WHERE_LONG or not set(_LONG) & set(solver.values())
    ]


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add to every row its error, the bound of the reference, and the ratio to `fscm`.

    ``error`` is the distance from the reference relative to it; it is only known to within ``u_reference``.  ``ratio``
    is CPU time over that of the fastest `fscm` whose error is certainly smaller; missing where there is none.
    """
    rows = rows.copy()
    is_reference = (rows["model"] == "fscm") & (rows["accuracy"] == min(FSCM_ACCURACIES)) & (rows["status"] == "ok")
    references = rows[is_reference].set_index("mu")
    value, bound = (rows["mu"].map(references[name]) for name in ("value", "u_num"))
    centre, radius = (rows["mu"].map({mu: interval[i] for mu, interval in CERTIFIED.items()}) for i in (0, 1))
    rows["error"] = (rows["value"] - value).abs() / value
    rows["u_reference"] = bound / value
    # The intervals of both have a point in common.
    rows["reference_is_certified"] = (value - centre).abs() <= radius + bound
    rows["ratio"] = time_ratios(rows)
    return rows


def time_ratios(rows: pd.DataFrame) -> list[float]:
    """Return CPU time over that of the fastest `fscm` with a smaller error, the doubt about the reference included.

    Examples
    --------
    >>> pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1e-6], "u_reference": [1e-12, 1e-12]}
    >>> time_ratios(pd.DataFrame({**pair, "cpu_seconds": [0.1, 5.0]}))
    [nan, 50.0]
    """
    quotients = []
    for row in rows.to_dict("records"):
        ours = rows[(rows["model"] == "fscm") & (rows["mu"] == row["mu"])]
        smaller = ours["error"] + ours["u_reference"] < row["error"] - row["u_reference"]
        fastest = ours.loc[smaller, "cpu_seconds"].min()
        quotients.append(float(row["cpu_seconds"] / fastest) if row["model"] != "fscm" else float("nan"))
    return quotients


def draw(rows: pd.DataFrame) -> Figure:
    """Draw error against CPU time, one panel a Tabor number."""
    # The error is known to within the bound of the reference: a smaller one is drawn there.
    rows = rows.assign(error=np.maximum(rows["error"], rows["u_reference"]))
    labels = "CPU time (s)", "relative error of the pull-off force"
    panels = [
        Panel(panel_rows, "cpu_seconds", "error", "model", labels, "xy", rf"$\mu$ = {mu:g}")
        for mu, panel_rows in rows.groupby("mu")
    ]
    return lines(panels, "Pull-off force for $n$ = 2, $k$ = 0: error against CPU time, one thread", len(panels))


def summary(rows: pd.DataFrame) -> list[str]:
    """Return the finest setting of each other solver: its CPU time over that of `fscm` at a smaller error."""
    ours, other_solvers = rows[rows["model"] == "fscm"], rows[rows["model"] != "fscm"]
    text = ["CPU time / CPU time of fscm whose error is smaller (pull-off, n = 2, k = 0):"]
    if len(other_solvers):
        finest = other_solvers.sort_values(["model", "mu", "unknowns"]).groupby(["model", "mu"]).tail(1)
        columns = ["model", "setting", "mu", "ratio", "cpu_seconds", "error"]
        text += finest[columns].to_string(index=False, float_format="%.2g").splitlines()
    if not adhesion_package.installed() and "adhesion" not in set(rows["model"]):
        text.append(f"  {adhesion_package.INSTALL}")
    largest = float((ours["error"] + ours["u_reference"]).max())
    proved = ", ".join(f"{mu:g}" for mu in sorted(ours.loc[ours["reference_is_certified"], "mu"].unique()))
    times = f"{ours['cpu_seconds'].min():.2g} to {ours['cpu_seconds'].max():.2g} s"
    text.append(f"  fscm at 1e-4 ... 1e-10: {times}, error at most {largest:.0e}")
    return [*text, f"  reference in the certified interval at mu = {proved or 'none'}"]


WORK_PRECISION = Part("work-precision", "error against CPU time of four solvers", plan, measure, ratios, draw, summary)
