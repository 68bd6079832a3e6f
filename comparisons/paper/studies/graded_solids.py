"""Pull-off, jumps and hysteresis on solids that are no power law, by both references; not in the paper.

A sphere (n = 2, Poisson's ratio 0.3) on three kinds of solids, each over the depth that belongs to it:

* offset power law E0 ((z + z_s)/c0)^k, k = 0.4 and Tabor number 2 at z_s = 0,
* exponential, four times as stiff at depth as at the surface (Tabor number 2 with the modulus of the surface),
* sharp coating on a substrate of a quarter of its modulus (Tabor number 0.8 with the modulus of the coating).

Beside each value stand those of three simpler solids (see `graded_routes`) and their errors against the FSCM.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.numerics.kappa import relative_difference
from comparisons.output.style import COLOURS
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.studies.graded_routes import (
    EVENTS,
    QUANTITIES,
    by_elements,
    by_fscm,
    case_of,
    number_of,
    of_equivalent,
    of_power_law,
)

__all__ = ["SERIES", "graded_solids"]

#: Depths of each kind in L, the finite elements have the pull-off of all; and those at which they have the jumps, too.
SERIES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "offset power law": ((0.01, 0.1, 1.0, 10.0), (0.1, 10.0)),
    "exponential": ((0.1, 0.5, 2.0, 10.0), (0.5, 2.0)),
    "coating": ((0.1, 0.3, 1.0, 3.0), (0.3, 1.0)),
}
_DEPTHS = (r"offset $z_s\,/\,L$", r"length of the decay $/\,L$", r"thickness $/\,L$")
_ROWS = (
    (r"$-P_c\,/\,\pi Q\Delta\gamma$", ("pull_off_force",)),
    (r"$\delta\,/\,z_0$ at the jumps", ("jump_out_displacement", "jump_in_displacement")),
    (r"$W\,/\,\pi Q\Delta\gamma z_0$", ("hysteresis_energy",)),
)
#: Label, line and colour of each simpler solid, by its column.
_STYLES = {
    "surface": ("homogeneous, modulus of the surface", "--", COLOURS[1]),
    "depth": ("solid of great depth", ":", COLOURS[2]),
    "power_law": ("equivalent power law", "-.", COLOURS[3]),
}


def _picture(figure: Figure, tables: Tables) -> None:
    lattice = panels(figure, 3, 3, (*SERIES, *[""] * 6), sharex="col", sharey="row")
    fscm: Any = {"color": COLOURS[0], "ms": 4, "lw": 1.1}
    fem: Any = {"color": COLOURS[5], "ms": 8, "mfc": "none", "ls": "none"}
    for axes, ((_, names), kind) in zip(lattice, product(_ROWS, SERIES), strict=True):
        for name, marker in zip(names, "o^", strict=False):
            rows = tables[""][(tables[""]["solid"] == kind) & (tables[""]["quantity"] == name)]
            for column, (_, line, colour) in _STYLES.items():
                axes.plot(rows["parameter"], rows[column], color=colour, ls=line, lw=1.1)
            axes.plot(rows["parameter"], rows["fscm"], marker=marker, **fscm)
            axes.plot(rows["parameter"], rows["fem"], marker=marker, **fem)
        axes.set_xscale("log")
    for axes, depth in zip(lattice[6:], _DEPTHS, strict=True):
        axes.set(xlabel=depth, yscale="log")
    for axes, (label, _) in zip(lattice[::3], _ROWS, strict=True):
        axes.set_ylabel(label)
    # The softest surfaces jump far below.
    lattice[3].set(ylim=(-5.2, -1.0))
    lattice[6].set(ylim=(3e-4, 5.0))
    figure.suptitle(r"sphere, $\nu=0.3$, $L=(Qz_0)^{1/2}$", fontsize=9)
    handles = [
        Line2D([], [], marker="o", label="FSCM (jump-in: triangles)", **fscm),
        Line2D([], [], marker="o", label="finite elements", **fem),
        *(Line2D([], [], color=colour, ls=line, label=label) for label, line, colour in _STYLES.values()),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncol=3)


@paper_figure(_picture, size=(7.2, 7.0))
def graded_solids() -> Plan[Tables]:
    """Solids that are no power law: pull-off, jumps and hysteresis, and what simpler solids get wrong."""
    calls: dict[Any, CachedCall] = {}
    places = [(kind, parameter) for kind, (parameters, _) in SERIES.items() for parameter in parameters]
    for solid in places:
        with_jumps = solid[1] in SERIES[solid[0]][1]
        calls |= {
            (solid, of): CachedCall.of(by_elements, of, *solid) for of in EVENTS if with_jumps or of == "pull-off"
        }
        calls[solid, "fscm"] = CachedCall.of(by_fscm, *solid)
        case = case_of(*solid)
        calls[solid, "surface"] = CachedCall.of(of_power_law, 0.0, case.mu)
        calls[solid, "depth"] = CachedCall.of(of_power_law, *case.depth)
        calls[solid, "power_law"] = CachedCall.of(of_equivalent, *solid)
    results = yield calls
    rows = []
    for solid, name in product(places, QUANTITIES):
        reference = results[solid, "fscm"]
        elements = {k: v for event in EVENTS for k, v in results.get((solid, event), {}).items()}
        row: dict[str, Any] = {"solid": solid[0], "parameter": solid[1], "quantity": name}
        row["fscm"], row["u_fscm"] = number_of(reference, name)
        row["fem"], row["u_fem"] = number_of(elements, name)
        for column in _STYLES:
            solved = results[solid, column]
            k, mu = (solved["k"], solved["mu"]) if column == "power_law" else calls[solid, column].arguments
            value, u_num = number_of(solved, name)
            error = relative_difference(value, row["fscm"])
            row |= {
                f"{column}_k": k,
                f"{column}_mu": mu,
                column: value,
                f"u_{column}": u_num,
                f"{column}_error": error,
            }
        rows.append(row | {"reason": reference[name] if isinstance(reference[name], str) else ""})
    return {"": pd.DataFrame(rows)}
