"""Effect of a non-zero surface modulus, E = E0 ((z + z_s) / c0)^k, by both references; not in the paper.

E0, c0, k, Poisson's ratio, the sphere (n = 2) and the surface law are fixed, so that only the modulus of the skin
changes: it is E0 (z_s / c0)^k at the surface instead of zero, and hardly changes at depths z >> z_s.  The material is
stated by mu, the Tabor number (Eq. 29) of the limit z_s = 0, and z_s is measured in the transverse length
L = (Q z0)^(1/n) (Eq. 25).  The finite elements and the FSCM, which share no code, solve every case.  Both limits are
power laws:

* z_s -> 0, the graded solid, FSCM at (k, mu).  The skin stiffens a share of about z_s^(1-k) of the compliance.
* z_s -> infinity, the uniform solid of the modulus E(0) = E0 (z_s / c0)^k, FSCM at k = 0 and its own Tabor number
  mu_0(z_s), which falls as z_s^(-2k/3): a thick skin is a stiff solid, on the way to Bradley's.

The elements resolve z_s together with the contact edge; their exact exterior takes over at least 64 z_s below the
surface, and the results do not depend on where.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.numerics.bounds import combined
from comparisons.output.style import COLOURS, MARKERS
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import held, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.studies.graded_routes import EVENTS, QUANTITIES, by_elements, by_fscm, case_of, number_of
from comparisons.paper.tasks import quantity

__all__ = ["THRESHOLDS", "limits", "surface_modulus", "thresholds"]

_KIND = "offset power law"
#: (k, mu) of the graded limit and the depths z_s / L.  A skin of 1e-4 under a sharp edge (mu = 2) costs a minute.
_SERIES: dict[tuple[float, float], tuple[float, ...]] = {
    (0.4, 1.0): (1e-4, 1e-3, 1e-2, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
    (0.4, 2.0): (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
    (0.6, 1.0): (1e-3, 1e-2, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0),
}
#: The uniform limit is shown from here on; far below, its Tabor number does not describe the solid.
_THICK = 0.3
#: Relative changes of a quantity whose depth is tabulated.
THRESHOLDS = (0.01, 0.05)
#: Greatest factor in the change over which the law of thin skins is extrapolated.
STRETCH = 5.0

#: Label, quantities, and limits of the axis, of each panel.
_PANELS: dict[str, tuple[str, tuple[str, ...], Any]] = {
    "pull-off force": (r"$-P_c\,/\,\pi Q\Delta\gamma$", ("pull_off_force",), {}),
    # The displacements of the softest solids are far below those of interest.
    "displacement at pull-off": (r"$\delta_c\,/\,z_0$", ("pull_off_displacement",), {"ylim": (-1.15, 0.05)}),
    "jump-in (open) and jump-out (filled)": (
        r"$\delta\,/\,z_0$",
        ("jump_in_displacement", "jump_out_displacement"),
        {"ylim": (-3.4, -1.2)},
    ),
    "energy lost in a cycle": (r"$W\,/\,\pi Q\Delta\gamma z_0$", ("hysteresis_energy",), {"yscale": "log"}),
}


def limits(table: pd.DataFrame) -> pd.DataFrame:
    """Return how the finite elements approach the integral equation in both limits.

    The two thinnest and the two thickest skins with a value; `difference` is elements minus limit, `u_num` bounds
    it, `rate` is the observed exponent of its decay in z_s (negative) or 1 / z_s (positive), NaN in the first row
    of each pair and where the difference is not four times its uncertainty; `expected` is 1 - k for a thin skin.  A
    thick one stiffens its solid by a share of a / z_s, a the contact radius, and as the solid becomes rigid what is
    left to change dies out too: the rate is one or more.
    """
    parts = []
    for _, series in table.groupby(["k", "mu", "quantity"], sort=False):
        for name in ("graded", "homogeneous"):
            complete = series.dropna(subset=["value", f"{name}_value"])
            # A jump that ends before its solid is uniform has no such limit.
            ended = math.isnan(series["value"].iloc[-1])
            ends = complete.iloc[1::-1] if name == "graded" else complete.iloc[len(complete) if ended else -2 :]
            difference = ends["value"] - ends[f"{name}_value"]
            u_num = combined(ends["u_num"], ends[f"{name}_u_num"])
            factor, of_depth = (column / column.shift() for column in (difference, ends["depth"]))
            rate = (np.log(factor.abs()) / np.log(of_depth)).abs()
            columns = {"depth": ends["depth"], "value": ends["value"], "limit_value": ends[f"{name}_value"]}
            table_of_limit = ends[["k", "mu", "quantity"]].assign(
                limit=name, **columns, difference=difference, u_num=u_num
            )
            expected = 1.0 - ends["k"] if name == "graded" else 1.0
            parts.append(table_of_limit.assign(rate=rate.where(difference.abs() > 4.0 * u_num), expected=expected))
    return pd.concat(parts, ignore_index=True)


def thresholds(table: pd.DataFrame) -> pd.DataFrame:
    """Return the depth of the first skin that changes a quantity by 1 % and by 5 % of its graded value.

    `below` and `above` are the computed depths that bracket it, `depth` is interpolated between them in the logarithms
    of both.  Below the thinnest computed skin, where `below` is 0, the change goes as z_s^(1-k) (see `limits`); that
    law is not extrapolated beyond a factor of `STRETCH` in the change; `depth` is then NaN.  No row where it stays
    smaller or the quantity ends first.
    """
    rows = []
    for (k, mu, name), series in table.groupby(["k", "mu", "quantity"], sort=False):
        complete = series.assign(change=series["value"] / series["graded_value"] - 1.0).dropna(subset="change")
        changes = complete[["depth", "change"]].to_numpy().tolist()
        for share in THRESHOLDS:
            if crossed := _crossed(changes, share, 1.0 - k):
                rows.append({"k": k, "mu": mu, "quantity": name} | crossed)
    return pd.DataFrame(rows)


def _crossed(changes: Sequence[list[float]], share: float, exponent: float) -> dict[str, float] | None:
    """Where the change first exceeds a share."""
    index = next((index for index, (_, change) in enumerate(changes) if abs(change) >= share), None)
    if index is None:
        return None
    above, large = changes[index]
    below, slope, within_law = 0.0, exponent, abs(large) < STRETCH * share
    if index:
        below, small = changes[index - 1]
        slope, within_law = math.log(abs(large / small)) / math.log(above / below), True
    depth = above * (share / abs(large)) ** (1.0 / slope) if within_law else math.nan
    return {"change": math.copysign(share, large), "below": below, "above": above, "depth": float(f"{depth:.2g}")}


def _picture(figure: Figure, tables: Tables) -> None:
    table = tables[""]
    lattice = panels(figure, 2, 2, _PANELS, r"offset $z_s\,/\,(Qz_0)^{1/n}$", sharex=True)
    for axes, (label, names, axis) in zip(lattice, _PANELS.values(), strict=True):
        axes.set(ylabel=label, xscale="log", **axis)
        for name in names:
            for index, (_, table_of_limit) in enumerate(
                table[table["quantity"] == name].groupby(["k", "mu"], sort=False)
            ):
                colour, depth = COLOURS[index], table_of_limit["depth"]
                face = "white" if name == "jump_in_displacement" else colour
                axes.plot(depth, table_of_limit["value"], color=colour, marker=MARKERS[index], ms=4, lw=1.1, mfc=face)
                # The limit of thin skins, as far as it is one.
                axes.plot(depth, table_of_limit["graded_value"].where(depth <= 1.0), color=colour, ls=":", lw=0.9)
                axes.plot(depth, table_of_limit["homogeneous_value"], color=colour, ls="--", lw=0.9)
    figure.suptitle(r"$E=E_0((z+z_s)/c_0)^k$, $n=2$, $\nu=0.3$; $\mu$ of the limit $z_s=0$", fontsize=9)
    handles = [
        Line2D([], [], color=COLOURS[i], marker=MARKERS[i], ms=4, label=held(k=k, mu=mu))
        for i, (k, mu) in enumerate(_SERIES)
    ]
    handles.append(Line2D([], [], color="0.3", ls=":", label=r"graded limit, $z_s=0$"))
    handles.append(Line2D([], [], color="0.3", ls="--", lw=0.9, label=r"uniform solid of modulus $E(0)$"))
    figure.legend(handles=handles, loc="outside lower center", ncol=3)


@paper_figure(_picture, size=(7.2, 6.0))
def surface_modulus() -> Plan[Tables]:
    """A non-zero surface modulus, from graded to uniform: pull-off, jumps and hysteresis."""
    cases = [(depth, k, mu) for (k, mu), depths in _SERIES.items() for depth in depths]
    mu_homogeneous = {case: case_of(_KIND, *case).mu for case in cases}
    calls: dict[Any, CachedCall] = {}
    for case in cases:
        calls |= {(case, event): CachedCall.of(by_elements, event, _KIND, *case) for event in EVENTS}
        calls[case, "fscm"] = CachedCall.of(by_fscm, _KIND, *case)
    uniform = [(0.0, mu_homogeneous[case]) for case in cases if case[0] >= _THICK]
    for power_law in (*_SERIES, *uniform):
        calls |= {(name, *power_law): CachedCall.of(quantity, "fscm", name, 2.0, *power_law) for name in QUANTITIES}
    results = yield calls

    def limit(name: str, k: float, mu: float) -> tuple[float, float]:
        result = results.get((name, k, mu), {"status": "thin"})
        return (result["value"], result["u_num"]) if result["status"] == "ok" else (math.nan, math.nan)

    rows = []
    for (k, mu), depths in _SERIES.items():
        for name in QUANTITIES:
            for depth in depths:
                case = depth, k, mu
                elements = {of: value for event in EVENTS for of, value in results[case, event].items()}
                row: dict[str, Any] = {"k": k, "mu": mu, "depth": depth}
                row |= {"mu_homogeneous": mu_homogeneous[case], "quantity": name}
                row["value"], row["u_num"] = number_of(elements, name)
                row["graded_value"], row["graded_u_num"] = limit(name, k, mu)
                row["homogeneous_value"], row["homogeneous_u_num"] = limit(name, 0.0, mu_homogeneous[case])
                row["fscm_value"], row["u_fscm"] = number_of(results[case, "fscm"], name)
                pieces = ("jump_out_energy", "jump_in_energy") if name == "hysteresis_energy" else (name,)
                row["reason"] = next((elements[piece] for piece in pieces if isinstance(elements[piece], str)), "")
                rows.append(row)
    table = pd.DataFrame(rows)
    return {"": table, "limits": limits(table), "thresholds": thresholds(table)}
