"""Figs. 3, 4, 6 and 13: force-displacement curves, their named points and hysteresis, and a path that folds often."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES
from comparisons.paper.drawing import LABELS, beside_fem, by_model, case, legend_below, level, of_model, panels
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, result_of, rows_of, together
from comparisons.paper.statements.equilibria import turning_points
from comparisons.paper.tasks import GRADIENTS, curve, named_points, quantity

#: Ranges of displacement and load of each panel, by the value of its parameter.
Ranges = dict[float, tuple[tuple[float, float], tuple[float, float]]]

#: Fig. 3: the case, and the ranges of the axes: the approach continues beyond them.
_CASE = {"n": 2.0, "k": 0.4, "mu": 3.0}
_S_RANGES = {"central_gap": (-0.04, 7.0), "displacement": (-7.2, 7.6), "load": (-2.05, 0.55)}
_S_AXES = (("central_gap", "displacement"), ("central_gap", "load"), ("displacement", "load"))
#: In contact the central gap hardly moves: its scale is linear near 0 and logarithmic beyond, without a kink between.
_LINEAR_GAP, _GAP_TICKS = 0.015, (0.0, 0.05, 0.2, 1.0, 5.0)
#: Where the letter of a point stands, in points of text from it, by panel: above, on the right, or beside a curve.
_BESIDE = {
    "displacement": {"A": (-4, 5), "B": (0, -11), "A'": (5, 1), "B'": (-14, -6)},
    "load": {"A": (-9, 5), "B": (5, -4), "A'": (6, -4), "B'": (-12, 4), "C": (-3, -12), "D": (6, -10)},
    "forces": {"A": (5, 1), "B": (-10, -4), "A'": (5, 3), "B'": (-5, 6), "C": (-3, -12), "D": (-10, 4)},
}

#: Figs. 4 and 13, by shape index.
_SHAPES: Ranges = {
    1.0: ((-5.0, 13.0), (-17.5, 2.5)),
    1.5: ((-5.0, 6.0), (-3.6, 1.0)),
    2.0: ((-6.0, 6.0), (-2.15, 0.6)),
    5.0: ((-7.0, 4.0), (-1.75, 0.5)),
}
#: Fig. 6, by Tabor number.
_TABOR_PANELS: Ranges = {0.5: ((-4.0, 1.5), (-2.15, 0.8)), 1.0: ((-4.0, 2.5), (-2.15, 0.8))}
_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0)
_K, _MU = 0.4, 1.0
#: Fig. 13 ends to the left where the FSCM's load has faded to this share of the pull-off force.
_FAINT = 0.04

_COLUMNS = ("displacement", "u_displacement", "load", "u_load")
#: Gradient exponents of the additional folds, and the displacements of the part that has them.
_FOLDS = {0.4: (-3.36, -3.22), 0.6: (-3.36, -3.32)}


def _s_curve(figure: Figure, curves: pd.DataFrame, points: pd.DataFrame, hysteresis: pd.DataFrame) -> None:
    points = points.set_index("name")
    path, jkr = of_model(curves, "fscm", "jkr")
    lattice = panels(figure, ("", "", case(**_CASE)))
    for axes, (x, y), beside in zip(lattice, _S_AXES, _BESIDE.values(), strict=True):
        level(axes)
        axes.plot(path[x], path[y], color=COLOURS[0], label="fscm")
        axes.plot(points[x], points[y], ls="none", marker="o", ms=4, color=COLOURS[2])
        for name, point in points.iterrows():
            axes.annotate(
                str(name), (point[x], point[y]), beside.get(str(name), (4, 4)), textcoords="offset points", fontsize=8
            )
        if x == "central_gap":
            axes.set_xscale("asinh", linear_width=_LINEAR_GAP)
            axes.set_xticks(_GAP_TICKS, [f"{gap:g}" for gap in _GAP_TICKS])
        axes.set(xlabel=LABELS[x], ylabel=LABELS[y], xlim=_S_RANGES[x], ylim=_S_RANGES[y])
    forces = lattice[2]
    forces.plot(jkr["displacement"], jkr["load"], color=COLOURS[2], ls="--", label="jkr")
    for name in ("A", "B"):
        forces.plot(*points.loc[[name, f"{name}'"], ["displacement", "load"]].to_numpy().T, color=COLOURS[1], ls=":")
    loss = f"loss $\\oint\\,\\bar P\\,d\\delta/z_0$ = {hysteresis['value'].item():.4f}"
    forces.fill(*loop(path, points), color=COLOURS[6], alpha=0.35, lw=0, zorder=0, label=loss)
    figure.legend(*forces.get_legend_handles_labels(), loc="outside lower center", ncols=3)


def loop(path: pd.DataFrame, points: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Outline B'-A-A'-B-B' of the energy that a cycle of displacement control loses."""
    gap, displacement = path["central_gap"], path["displacement"]
    approach = path[(gap >= points.loc["A", "central_gap"]) & (displacement >= points.loc["B'", "displacement"])]
    contact = path[(gap <= points.loc["B", "central_gap"]) & (displacement <= points.loc["A'", "displacement"])]
    sides = [points.loc[["B'"]], approach, points.loc[["A", "A'"]], contact[::-1], points.loc[["B"]]]
    outline = pd.concat(sides)[["displacement", "load"]].to_numpy(float)
    return outline[:, 0], outline[:, 1]


@paper_figure(_s_curve, size=(9.6, 3.8), follows_path=True)
def fig03_s_curve() -> Plan[Tables]:
    """The S-shaped curve at n = 2, k = 0.4, mu = 3."""
    plans: dict[str, Plan[Any]] = {
        # The coordinate along the path, at which displacement and load are uncertain; JKR has none.
        "curves": rows_of(curve, cases(model=["fscm", "jkr"]), "central_gap", *_COLUMNS, **_CASE),
        "points": result_of(named_points, **_CASE),
        "hysteresis": rows_of(quantity, [{"quantity": "hysteresis_energy"}], model="fscm", **_CASE),
    }
    return together(plans).then(
        lambda tables: tables | {"points": pd.DataFrame(tables["points"]).T.rename_axis("name").reset_index()}
    )


def curves(keys: list[dict[str, Any]]) -> Plan[Tables]:
    """Plan the table of the curves of the FSCM in these cases."""
    return together({"": rows_of(curve, keys, "status", *_COLUMNS, model="fscm")})


def _families(figure: Figure, table: pd.DataFrame, ranges: Ranges, across: str, along: str, **fixed: float) -> None:
    """Draw a panel for each value of one parameter, with a curve for each of another."""
    words = [case(**{across: value}, **fixed) for value in ranges]
    lattice = panels(figure, words, "displacement", "load", rows=len(ranges) // 2)
    for axes, (of_panel, limits) in zip(lattice, ranges.items(), strict=True):
        for index, (value, path) in enumerate(table[table[across] == of_panel].groupby(along)):
            # Dashes would hide folds; markers at equal distances tell the curves apart in grey.
            marked: Any = {"color": COLOURS[index], "marker": MARKERS[index], "markevery": (0.03 * (1 + index), 0.24)}
            marked |= {"ms": 3.0, "mfc": "white", "lw": 1.0, "label": case(**{along: value})}
            axes.plot(path["displacement"], path["load"], **marked)
        level(axes)
        axes.set(xlim=limits[0], ylim=limits[1])
    legend_below(figure, len(_TABOR_NUMBERS))


_over_tabor_numbers = partial(_families, ranges=_SHAPES, across="n", along="mu", k=_K)
_over_gradients = partial(_families, ranges=_TABOR_PANELS, across="mu", along="k", n=2.0)


@paper_figure(_over_tabor_numbers, size=(7.2, 6.0), follows_path=True)
def fig04_force_curves_over_tabor_numbers() -> Plan[Tables]:
    """Force-displacement curves for k = 0.4 and four shapes, over the Tabor number."""
    return curves(cases(n=_SHAPES, k=[_K], mu=_TABOR_NUMBERS))


@paper_figure(_over_gradients, size=(7.2, 3.6), follows_path=True)
def fig06_force_curves_over_gradients() -> Plan[Tables]:
    """Force-displacement curves for n = 2, mu = 0.5 and 1, over the gradient exponent."""
    over_gradients = [cases(n=[2.0], k=(*GRADIENTS, 1.0), mu=[mu]) for mu in _TABOR_PANELS]
    return curves([*over_gradients[0], *over_gradients[1]])


def _over_models(figure: Figure, table: pd.DataFrame) -> None:
    lattice = panels(figure, [case(n=n, k=_K, mu=_MU) for n in _SHAPES], "displacement", "load", rows=2)
    for axes, (_, of_shape) in zip(lattice, table.groupby("n"), strict=True):
        by_model(axes, of_shape, "displacement", "load")
        level(axes)
        (exact,) = of_model(of_shape, "fscm")
        depth = -of_shape["load"].min()
        seen = exact.loc[exact["load"].between(-depth, 0.35 * depth) & (exact["load"].abs() > _FAINT * depth)]
        axes.set(ylim=(-1.12 * depth, 0.35 * depth))
        axes.set_xlim(seen["displacement"].min() - 0.5, seen["displacement"].max() + 0.5)
    # Eqs. 66-69 hold in contact only; there both curves end.
    legend_below(figure, 3, title="md-original and md-improved as far as there is contact, $a > 0$", title_fontsize=8)


@paper_figure(_over_models, size=(7.2, 5.6), follows_path=True)
def fig13_force_curve_models() -> Plan[Tables]:
    """Force-displacement curves of both Maugis-Dugdale models, which end at first contact, and the FSCM."""
    columns = ("displacement", "load", "u_displacement", "u_load", "status", "reason")
    return together({"": rows_of(curve, cases(n=_SHAPES, k=[_K], mu=[_MU], model=MODEL_LINES), *columns)})


def _fold_pairs(figure: Figure, table: pd.DataFrame) -> None:
    lattice = panels(figure, [case(**_CASE | {"k": k}) for k in _FOLDS], "central_gap", "displacement")
    for axes, (k, limits) in zip(lattice, _FOLDS.items(), strict=True):
        rows = table[table["k"] == k]
        style: Any = {"color": COLOURS[0], "label": "fscm, crosses: fem"}
        beside_fem(axes, rows, "central_gap", "displacement", column="model", **style)
        turns = rows[rows["turning_point"] & (rows["model"] == "fscm")]
        open_circle: Any = {"ls": "none", "marker": "o", "ms": 6, "mfc": "white", "color": COLOURS[2]}
        axes.plot(turns["central_gap"], turns["displacement"], label="turning points", **open_circle)
        axes.set(xlim=(0.0, 2.6), ylim=limits)
    legend_below(figure, 3)


@paper_figure(_fold_pairs, follows_path=True)
def finding_fold_pairs() -> Plan[Tables]:
    """Additional turning points of the displacement at mu = 3."""
    keys = [key for k in _FOLDS for key in cases(model=["fscm", "fem"], n=[2.0], k=[k], mu=[3.0])]
    return together({"": rows_of(curve, keys, "central_gap", "displacement", "u_displacement").then(_turns_marked)})


def _turns_marked(table: pd.DataFrame) -> pd.DataFrame:
    turns: list[int] = []
    for _, path in table.groupby(["k", "model"]):
        points = turning_points(path["displacement"].to_numpy(), path["u_displacement"].iloc[0])
        turns.extend(path.index[points])
    return table.assign(turning_point=table.index.isin(turns))
