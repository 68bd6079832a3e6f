"""Pull-off, jumps and hysteresis on solids that are no power law, by both references; not in the paper.

A sphere (n = 2, Poisson's ratio 0.3) on three kinds of solids, each over the depth that belongs to it:

* offset power law E0 ((z + z_s)/c0)^k, k = 0.4 and Tabor number 2 at z_s = 0,
* exponential, four times as stiff at depth as at the surface (Tabor number 2 with the modulus of the surface),
* sharp coating on a substrate of a quarter of its modulus (Tabor number 0.8 with the modulus of the coating).

Beside each value stand those of three simpler solids (see `graded_routes`) and their errors against the FSCM.
"""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.numerics.kappa import relative_difference
from comparisons.output.style import COLOURS, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
from comparisons.paper.studies.graded_equivalent import of_equivalent
from comparisons.paper.studies.graded_routes import (
    EVENTS,
    QUANTITIES,
    by_elements,
    by_fscm,
    case_of,
    number_of,
    of_power_law,
)

__all__ = ["GRADED_SOLIDS", "SERIES"]

#: Depths of each kind in L, the finite elements have the pull-off of all; and those at which they have the jumps, too.
SERIES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "offset power law": ((0.01, 0.1, 1.0, 10.0), (0.1, 10.0)),
    "exponential": ((0.1, 0.5, 2.0, 10.0), (0.5, 2.0)),
    "coating": ((0.1, 0.3, 1.0, 3.0), (0.3, 1.0)),
}
_LABELS = {
    "offset power law": r"offset $z_s\,/\,L$",
    "exponential": r"length of the decay $/\,L$",
    "coating": r"thickness $/\,L$",
}
_ROWS = (
    (r"$-P_c\,/\,\pi Q\Delta\gamma$", ("pull_off_force",)),
    (r"$\delta\,/\,z_0$ at the jumps", ("jump_in_displacement", "jump_out_displacement")),
    (r"$W\,/\,\pi Q\Delta\gamma z_0$", ("hysteresis_energy",)),
)
#: Label, line and colour of each simpler solid, by its column.
_STYLES = {
    "surface": ("homogeneous, modulus of the surface", "--", COLOURS[1]),
    "depth": ("solid of great depth", ":", COLOURS[2]),
    "power_law": ("equivalent power law", "-.", COLOURS[3]),
}


def _cases() -> Iterator[tuple[str, float, bool]]:
    for kind, (parameters, with_jumps) in SERIES.items():
        for parameter in parameters:
            yield kind, parameter, parameter in with_jumps


def _simpler(kind: str, parameter: float) -> dict[str, CachedCall]:
    """Computations of the simpler solids; those of known k and mu have them as arguments."""
    case = case_of(kind, parameter)
    return {
        "surface": CachedCall.of(of_power_law, 0.0, case.mu),
        "depth": CachedCall.of(of_power_law, *case.depth),
        "power_law": CachedCall.of(of_equivalent, kind, parameter),
    }


def _elements(kind: str, parameter: float, jumps: bool) -> list[CachedCall]:
    return [CachedCall.of(by_elements, event, kind, parameter) for event in EVENTS if jumps or event == "pull-off"]


def _plan() -> Plan[Tables]:
    calls: list[CachedCall] = []
    for kind, parameter, jumps in _cases():
        calls += [*_elements(kind, parameter, jumps), CachedCall.of(by_fscm, kind, parameter)]
    simpler = {(kind, parameter): _simpler(kind, parameter) for kind, parameter, _ in _cases()}
    results = yield [*calls, *(call for of_case in simpler.values() for call in of_case.values())]
    rows = []
    for kind, parameter, jumps in _cases():
        reference = results[CachedCall.of(by_fscm, kind, parameter)]
        elements = {k: v for call in _elements(kind, parameter, jumps) for k, v in results[call].items()}
        for name in QUANTITIES:
            row = {"solid": kind, "parameter": parameter, "quantity": name}
            row["fscm"], row["u_fscm"] = number_of(reference, name)
            row["fem"], row["u_fem"] = number_of(elements, name)
            for other, call in simpler[kind, parameter].items():
                solved = results[call]
                k, mu = (solved["k"], solved["mu"]) if other == "power_law" else call.arguments
                found, u_num = number_of(solved, name)
                error = relative_difference(found, row["fscm"])
                row |= {f"{other}_k": k, f"{other}_mu": mu, other: found, f"u_{other}": u_num, f"{other}_error": error}
            rows.append(row | {"reason": reference[name] if isinstance(reference[name], str) else ""})
    return {"": pd.DataFrame(rows)}


def _picture(figure: Figure, tables: Tables) -> None:
    table = tables[""]
    panels = figure.subplots(3, 3, sharex="col", sharey="row")
    letters = iter("abcdefghi")
    for index, (label, names) in enumerate(_ROWS):
        for axes, kind in zip(panels[index], _LABELS, strict=True):
            lettered(axes, next(letters), "" if index else kind)
            for name in names:
                part = table[(table["solid"] == kind) & (table["quantity"] == name)]
                _curves(axes, part, "^" if name == "jump_in_displacement" else "o")
            axes.set(xscale="log")
        panels[index][0].set_ylabel(label)
    for axes, depth in zip(panels[-1], _LABELS.values(), strict=True):
        axes.set(xlabel=depth, yscale="log")
    # The softest surfaces jump far below.
    panels[1][0].set(ylim=(-5.2, -1.0))
    panels[2][0].set(ylim=(3e-4, 5.0))
    figure.suptitle(r"sphere, $\nu=0.3$, $L=(Qz_0)^{1/2}$", fontsize=9)
    handles = [
        Line2D([], [], color=COLOURS[0], marker="o", ms=4, label="FSCM (jump-in: triangles)"),
        Line2D([], [], color=COLOURS[5], marker="o", ms=8, mfc="none", ls="none", label="finite elements"),
        *(Line2D([], [], color=colour, ls=line, label=label) for label, line, colour in _STYLES.values()),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncol=3)


def _curves(axes: Axes, table: pd.DataFrame, marker: str) -> None:
    depth = table["parameter"]
    for column, (_, line, colour) in _STYLES.items():
        axes.plot(depth, table[column], color=colour, ls=line, lw=1.1)
    axes.plot(depth, table["fscm"], color=COLOURS[0], marker=marker, ms=4, lw=1.1)
    axes.plot(depth, table["fem"], color=COLOURS[5], marker=marker, ms=8, mfc="none", ls="none")


GRADED_SOLIDS = PaperFigure(
    name="graded-solids",
    stem="graded_solids",
    title="Solids that are no power law: pull-off, jumps and hysteresis, and what simpler solids get wrong",
    plan=_plan,
    picture=_picture,
    size=(7.2, 7.0),
)
