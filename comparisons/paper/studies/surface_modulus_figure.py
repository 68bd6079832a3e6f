"""Picture of the study of the surface modulus."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.output.style import COLOURS, MARKERS, lettered, styled

__all__ = ["draw"]

_PANELS = (
    ("pull-off force", r"$-P_c\,/\,\pi Q\Delta\gamma$", ("pull_off_force",)),
    ("displacement at pull-off", r"$\delta_c\,/\,z_0$", ("pull_off_displacement",)),
    (
        "jump-in (open) and jump-out (filled)",
        r"$\delta\,/\,z_0$",
        ("jump_in_displacement", "jump_out_displacement"),
    ),
    (
        "energy lost in a cycle",
        r"$W\,/\,\pi Q\Delta\gamma z_0$",
        ("hysteresis_energy",),
    ),
)


def draw(tables: dict[str, pd.DataFrame]) -> Figure:
    """Draw the four quantities over z_s / L, the limits dashed and dotted."""
    table = tables[""]
    with styled():
        figure = Figure(figsize=(7.2, 6.0), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True).flat
        for letter, axes, (title, label, names) in zip("abcd", panels, _PANELS, strict=True):
            lettered(axes, letter, title)
            for name in names:
                _curves(axes, table[table["quantity"] == name], hollow=name == "jump_in_displacement")
            axes.set(ylabel=label, xscale="log")
        for axes in figure.axes[2:]:
            axes.set_xlabel(r"offset $z_s\,/\,(Qz_0)^{1/n}$")
        # The displacements of the softest solids are far below those of interest.
        figure.axes[1].set(ylim=(-1.15, 0.05))
        figure.axes[2].set(ylim=(-3.4, -1.2))
        figure.axes[3].set(yscale="log")
        figure.suptitle(r"$E=E_0((z+z_s)/c_0)^k$, $n=2$, $\nu=0.3$; $\mu$ of the limit $z_s=0$", fontsize=9)
        handles = [
            Line2D([], [], color=COLOURS[i], marker=MARKERS[i], ms=4, label=rf"$k$ = {k:g}, $\mu$ = {mu:g}")
            for i, (k, mu) in enumerate(table[["k", "mu"]].drop_duplicates().to_numpy(float))
        ]
        handles.append(Line2D([], [], color="0.3", ls=":", label=r"graded limit, $z_s=0$"))
        handles.append(Line2D([], [], color="0.3", ls="--", lw=0.9, label=r"uniform solid of modulus $E(0)$"))
        figure.legend(handles=handles, loc="outside lower center", ncol=3)
    return figure


def _curves(axes: Axes, table: pd.DataFrame, hollow: bool) -> None:
    for index, (_, part) in enumerate(table.groupby(["k", "mu"], sort=False)):
        colour = COLOURS[index]
        depth = part["depth"].to_numpy()
        axes.plot(
            depth,
            part["value"],
            color=colour,
            marker=MARKERS[index],
            ms=4,
            lw=1.1,
            mfc="white" if hollow else colour,
        )
        # The limit of thin skins, as far as it is one.
        thin = depth[depth <= max(1.0, depth[0])]
        axes.plot(thin, np.full(thin.size, part["graded_value"].iloc[0]), color=colour, ls=":", lw=0.9)
        axes.plot(depth, part["homogeneous_value"], color=colour, ls="--", lw=0.9)
