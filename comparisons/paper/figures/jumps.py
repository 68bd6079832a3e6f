"""Figs. 8 and 9: displacement and central gap at the two jumps over mu, their onset, and their asymptotes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES
from comparisons.paper.drawing import LABELS, beside_fem, case, dashed, legend_below, level, lines_by, of_model, panels
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, result_of, rows_of, together
from comparisons.paper.statements.measures import table_of_terms
from comparisons.paper.tasks import GRADIENTS, SHAPES, jumps, near_critical, quantity

#: Shape index and gradient exponent of the figures of jumps.
_N, _K = 2.0, 0.4
#: Above the critical Tabor numbers, which are between 0.69 and 0.79.
TABOR_NUMBERS = (0.85, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
#: Quantity -> the model whose asymptote it has: Eqs. 47 and 54.
_ASYMPTOTES = {"jump_in_displacement": "semi-rigid", "jump_out_displacement": "jkr"}
#: A Tabor number at which the gradient exponent decides whether there are jumps, and the cases shown.
_ONSET = cases(model=["fscm", "fem"], n=[_N], k=[0.0, 0.4], mu=[0.74])
#: Cases in which the deformation is shown.
_DEFORMED = cases(reference=["fscm"], n=SHAPES, k=[_K], mu=[1.25, 1.5, 2.0, 3.0, 5.0])
_DEFORMED += cases(reference=["fem"], n=SHAPES, k=[_K], mu=[3.0])


def _onsets(*names: str) -> Plan[pd.DataFrame]:
    """Plan the table of `near_critical`, by default the critical Tabor number, over the gradient exponent."""
    return rows_of(near_critical, cases(n=[_N], k=GRADIENTS), *(names or ("mu", "u_mu")))


def _branches(figure: Figure, table: pd.DataFrame, critical: pd.DataFrame) -> None:
    lattice = panels(figure, (case(n=_N),) * 2, "mu")
    for axes, kind in zip(lattice, ("displacement", "gap"), strict=True):
        names = [f"jump_{name}_{kind}" for name in ("in", "out")]
        for index, (onset, (k, branches)) in enumerate(zip(critical["mu"], table.groupby("k"), strict=True)):
            # Both branches begin in one point, at the critical Tabor number, between their first points.
            meeting = branches[names].iloc[0].mean()
            label = rf"{case(k=k)}, $\mu_c$ = {onset:.5f}"
            for name in names:
                axes.plot([onset, *branches["mu"]], [meeting, *branches[name]], label=label, **dashed(index))
                label = "_"
        axes.set(xscale="log", xlim=(0.6, 5.0))
        axes.set_xticks([0.7, 1, 2, 3, 5], ["0.7", "1", "2", "3", "5"])
        axes.minorticks_off()
    lattice[0].set_ylabel(r"displacement at the jumps $\delta/z_0$ (out: lower)")
    lattice[1].set_ylabel(r"central gap at the jumps $H_0/z_0$ (out: lower)")
    legend_below(figure, 4)


@paper_figure(_branches, size=(7.2, 3.8))
def fig08_jumps() -> Plan[Tables]:
    """Displacement and central gap at the jumps for n = 2, over the Tabor number."""
    beyond = rows_of(jumps, cases(n=[_N], k=GRADIENTS, mu=TABOR_NUMBERS))
    return together({"critical": _onsets(), "near": _onsets("jumps"), "beyond": beyond}).then(_from_the_onset)


def _from_the_onset(tables: Tables) -> Tables:
    near = tables["near"].drop(columns="jumps").join(pd.DataFrame(tables["near"]["jumps"].tolist()))
    table = pd.concat([near, tables["beyond"]]).sort_values(["k", "mu"], ignore_index=True)
    return {"": table, "critical": tables["critical"]}


def asymptotes(n: float, k: float) -> dict[str, list[float | None]]:
    """Return mu and the displacements at the jumps by Eqs. 47 and 54; None where Eq. 46 has no jump.

    Examples
    --------
    >>> round(asymptotes(2, 0.4)["jump_out_displacement"][-1], 2)
    -7.98
    """
    columns = {"mu": np.linspace(0.05, 5.0, 100).tolist()}
    for name, model in _ASYMPTOTES.items():
        values = [quantity(model, name, n, k, mu) for mu in columns["mu"]]
        columns |= {name: [row["value"] for row in values], f"u_{name}": [row["u_num"] for row in values]}
    return columns


def coefficients(n: float) -> dict[str, list[float]]:
    """Return k, C_in (Eq. 48) and C_out (Eq. 55), from k = 0 to the Gibson limit.

    Examples
    --------
    >>> columns = coefficients(5)
    >>> round(columns["C_in"][-1], 12), round(columns["C_out"][-1], 12)
    (2.666666666667, 2.0)
    """
    gradients = np.linspace(0.0, 1.0, 101).tolist()
    return {
        "k": gradients,
        "C_in": [jump_in_coefficient(n, k) for k in gradients],
        "C_out": [-quantity("jkr", "jump_out_displacement", n, k, 1.0)["value"] for k in gradients],
    }


def _beside_asymptotes(figure: Figure, displacements: pd.DataFrame, coefficients: pd.DataFrame) -> None:
    left, right = panels(figure, (case(n=_N, k=_K), ""))
    fscm, closed = of_model(displacements, "fscm", "asymptote")
    for index, (column, words) in enumerate(zip(_ASYMPTOTES, ("jump in, Eq. 47", "jump out, Eq. 54"), strict=True)):
        left.plot(closed["mu"], closed[column], label=words, color=COLOURS[index], ls=("-", "--")[index])
        broad = MODEL_LINES["fscm"] | {"color": COLOURS[index]}
        left.plot(fscm["mu"], fscm[column], label=words.partition(",")[0] + ", fscm", **broad)
    left.set(xlim=(0.0, 5.1), xlabel=LABELS["mu"], ylabel=r"displacement at the jumps $\delta/z_0$")
    left.legend()
    lines_by(right, coefficients, "n", "k", "C_in")
    lines_by(right, coefficients, "n", "k", "C_out", lw=0.8, label="_")
    right.set(xlim=(0.0, 1.0), xlabel=LABELS["k"], ylabel=r"$C^{\mathrm{in}}$ (thick), $C^{\mathrm{out}}$ (thin)")
    right.legend(loc="center", bbox_to_anchor=(0.45, 0.7), ncols=2)


@paper_figure(_beside_asymptotes, size=(7.2, 3.5))
def fig09_jump_asymptotes() -> Plan[Tables]:
    """Asymptotes of the jumps beside the FSCM, and their coefficients."""
    plans: dict[str, Plan[Any]] = {
        "onset": result_of(near_critical, _N, _K),
        "beyond": rows_of(jumps, cases(mu=TABOR_NUMBERS), n=_N, k=_K),
        "asymptote": rows_of(asymptotes, cases(n=[_N], k=[_K])),
        "coefficients": rows_of(coefficients, cases(n=SHAPES)),
    }
    return together(plans).then(_displacements_and_coefficients)


def _displacements_and_coefficients(tables: dict[str, Any]) -> Tables:
    # Where the two jumps part, then evenly.
    fscm = pd.concat([pd.DataFrame(tables["onset"]["jumps"][:1]), tables["beyond"]])
    by_model = pd.concat({"fscm": fscm, "asymptote": tables["asymptote"]}, names=["model"]).reset_index("model")
    columns = ["model", "mu", *(f"{u}{name}" for name in _ASYMPTOTES for u in ("", "u_"))]
    displacements = by_model[columns].assign(n=_N, k=_K)
    return {"displacements": displacements, "coefficients": tables["coefficients"]}


def _onset(figure: Figure, table: pd.DataFrame, energies: pd.DataFrame) -> None:
    axes = figure.subplots()
    axes.plot(table["k"], table["mu"], color=COLOURS[0], marker="o", ms=4, label="critical Tabor number")
    low, high = table["mu"].min(), table["mu"].max()
    axes.axhspan(low, high, color=COLOURS[1], alpha=0.15, lw=0, label="the gradient exponent decides")
    for mu in (0.5, 1.0):
        level(axes, mu, ls=":")
        axes.annotate(f"Fig. 6: μ = {mu:g}", (0.6, mu), (0, 3), textcoords="offset points", ha="right", fontsize=8)
    (fem,) = of_model(energies, "fem")
    for status, face, label in (("ok", COLOURS[2], "jumps"), ("not-applicable", "white", "no jump")):
        squares = fem[fem["status"] == status]
        square: Any = {"ls": "none", "marker": "s", "ms": 7, "color": COLOURS[2], "mfc": face}
        axes.plot(squares["k"], squares["mu"], label=f"{label} (both references)", **square)
    axes.set(xlabel=LABELS["k"], ylabel=LABELS["mu"], ylim=(0.2, 1.1), xlim=(-0.03, 0.63))
    axes.legend(loc="lower left", fontsize=8)


@paper_figure(_onset, size=(5.0, 3.6))
def finding_onset() -> Plan[Tables]:
    """Onset of hysteresis over the gradient exponent at n = 2."""
    return together({"": _onsets(), "energies": rows_of(quantity, _ONSET, quantity="hysteresis_energy")})


def _semi_rigid(figure: Figure, table: pd.DataFrame) -> None:
    lattice = panels(figure, (case(k=_K),) * 2, "mu")
    for axes, column, scale in zip(lattice, ("deformation", "error"), (1.0, 100.0), strict=True):
        for index, (n, line) in enumerate(table.groupby("n")):
            style: Any = {"marker": MARKERS[index], "ms": 3.5, "label": f"{case(n=n)}, crosses: fem", **dashed(index)}
            beside_fem(axes, line, "mu", column, scale, **style)
        axes.set(ylim=(0.0, None))
    lattice[0].set_ylabel(r"deformation over gap at jump-in, $|w(0)|/H_0$")
    lattice[1].set_ylabel("error of the asymptote of jump-in (%)")
    legend_below(figure, 5)


@paper_figure(_semi_rigid)
def finding_semi_rigid() -> Plan[Tables]:
    """Deformation at jump-in, and the error of the asymptote that neglects it."""
    error = "relative_error jump_in_displacement semi-rigid"
    return together({"": table_of_terms(_DEFORMED, deformation="jump_in_deformation", error=error)})
