"""Picture of the study of solids that are no power law."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.output.style import COLOURS, lettered, styled

__all__ = ["draw"]

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
#: Column, label and line of each simpler solid.
_SIMPLER = (
    ("surface", "homogeneous, modulus of the surface", "--", COLOURS[1]),
    ("depth", "solid of great depth", ":", COLOURS[2]),
    ("power_law", "equivalent power law", "-.", COLOURS[3]),
)


def draw(tables: dict[str, pd.DataFrame]) -> Figure:
    """Draw pull-off force, jumps and hysteresis energy over the depth of each kind of solid."""
    table = tables[""]
    with styled():
        figure = Figure(figsize=(7.2, 7.0), layout="constrained")
        panels = figure.subplots(3, 3, sharex="col", sharey="row")
        letters = iter("abcdefghi")
        for index, (label, names) in enumerate(_ROWS):
            for axes, (kind, depth) in zip(panels[index], _LABELS.items(), strict=True):
                lettered(axes, next(letters), kind if index == 0 else "")
                for name in names:
                    part = table[(table["solid"] == kind) & (table["quantity"] == name)]
                    _curves(axes, part, "^" if name == "jump_in_displacement" else "o")
                axes.set(xscale="log")
                if index == len(_ROWS) - 1:
                    axes.set(xlabel=depth, yscale="log")
            panels[index][0].set_ylabel(label)
        # The softest surfaces jump far below.
        panels[1][0].set(ylim=(-5.2, -1.0))
        panels[2][0].set(ylim=(3e-4, 5.0))
        figure.suptitle(r"sphere, $\nu=0.3$, $L=(Qz_0)^{1/2}$", fontsize=9)
        handles = [
            Line2D([], [], color=COLOURS[0], marker="o", ms=4, label="FSCM (jump-in: triangles)"),
            Line2D([], [], color=COLOURS[5], marker="o", ms=8, mfc="none", ls="none", label="finite elements"),
            *(Line2D([], [], color=colour, ls=line, label=label) for _, label, line, colour in _SIMPLER),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncol=3)
    return figure


def _curves(axes: Axes, table: pd.DataFrame, marker: str) -> None:
    depth = table["parameter"]
    for column, _, line, colour in _SIMPLER:
        axes.plot(depth, table[column], color=colour, ls=line, lw=1.1)
    axes.plot(depth, table["fscm"], color=COLOURS[0], marker=marker, ms=4, lw=1.1)
    axes.plot(depth, table["fem"], color=COLOURS[5], marker=marker, ms=8, mfc="none", ls="none")
