"""CPU time of kinds of problems: Tabor numbers, layers, rows of a measured punch, a ball and finite strain."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.part import Numbers, Part
from comparisons.bench.work_precision import LONG, NEIGHBOUR, peak_memory
from comparisons.output.style import COLOURS, MARKERS, new_figure, styled
from comparisons.paper.drawing import panels
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate

_LAW = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
_SPHERE = Section("sphere", {"R": 0.5e-6})
_PAD = Section("homogeneous", {"E": 1e9, "nu": 0.4})

#: Largest radius of a measured punch, in m.
_PROFILE = 0.2e-6

#: Repetitions differ by so much in the work of adhesion or the Tabor number.
_APART = 1e-6


def _of_numbers(n: float, k: float, mu: float, factor: float) -> Problem:
    return Problem.dimensionless(n=n, k=k, mu=factor * mu)


def _on_solid(solid: Section, factor: float, punch: Section = _SPHERE) -> Problem:
    law = Section(_LAW.kind, {**_LAW.values, "work_of_adhesion": factor * _LAW["work_of_adhesion"]})
    return Problem(solid, punch, law)


def _coating(size: float, factor: float) -> Problem:
    """A film whose thickness is of some nanometres."""
    moduli = {"E_coating": 1e9, "E_substrate": 3e9, "nu_coating": 0.42, "nu_substrate": 0.36}
    return _on_solid(Section("coating", {**moduli, "thickness": size * 1e-9, "transition": 5e-9}), factor)


def _layers(count: float, factor: float) -> Problem:
    """Films of 20 nm, soft and stiff in turn."""
    films = int(count)
    moduli = tuple(3e9 if i % 2 else 1e9 for i in range(films + 1))
    values = {"E": moduli, "nu": (0.4,) * (films + 1), "thickness": (2e-8,) * films}
    return _on_solid(Section("layers", values), factor)


def _measured(rows: float, factor: float) -> Problem:
    """A sphere that was measured at some radii, between which segments join its rows."""
    r = np.linspace(0.0, _PROFILE, int(rows))
    height = r**2 / (2.0 * _SPHERE["R"])
    columns = {"r": tuple(map(float, r)), "height": tuple(map(float, height))}
    return _on_solid(_PAD, factor, Section("table", {"file": "profile.csv"}, columns))


def _ball(radius: float, factor: float) -> Problem:
    """A ball on a soft solid; its radius in micrometres."""
    solid = Section("homogeneous", {"E": 1.5e6, "nu": 0.45})
    law = Section(_LAW.kind, {"work_of_adhesion": factor * 0.05, "z0": 1e-6})
    return Problem(solid, Section("ball", {"R": radius * 1e-6}), law)


@dataclass(frozen=True)
class Kind:
    """Problems of one kind, of several sizes.

    Attributes
    ----------
    size : str
        What the size is.
    problem : callable
        Returns the problem of a size; its second argument is a factor of the Tabor number or the work of adhesion.
    sizes : dict of str to tuple of float
        By the name of the model.
    full : dict of str to tuple of float
        Those that take long.
    """

    size: str
    problem: Callable[[float, float], Problem]
    sizes: dict[str, tuple[float, ...]]
    full: dict[str, tuple[float, ...]]


KINDS = {
    "sphere": Kind("mu", partial(_of_numbers, 2.0, 0.0), {"fscm": (1, 10, 100), "fem": (1, 10)}, {"fem": (100,)}),
    "n = 2, k = 0.4": Kind("mu", partial(_of_numbers, 2.0, 0.4), {"fscm": (1,), "fem": (1,)}, {}),
    "n = 1, k = 0": Kind("mu", partial(_of_numbers, 1.0, 0.0), {"fscm": (0.3,), "fem": (0.3,)}, {}),
    "n = 5, k = 0.6": Kind("mu", partial(_of_numbers, 5.0, 0.6), {"fscm": (2,), "fem": (2,)}, {}),
    "coating": Kind("nm", _coating, {"fscm": (20,), "fem": (20,)}, {}),
    "layers": Kind("films", _layers, {"fscm": (1, 2, 4)}, {"fscm": (8,), "fem": (1, 2, 4)}),
    "measured punch": Kind("rows", _measured, {"fscm": (20, 50)}, {"fscm": (100, 200), "fem": (10, 20)}),
    "ball": Kind("um", _ball, {"fscm": (5,), "fem-large-strain": (5,)}, {}),
}

#: The time to which the others are compared.
_UNIT = ("n = 2, k = 0.4", "fscm")


def plan(full: bool) -> list[Numbers]:
    """Return the kinds of problems with their sizes and models."""
    return [
        {"problem": name, "size": float(size), "model": model}
        for name, kind in KINDS.items()
        for model in dict.fromkeys((*kind.sizes, *(kind.full if full else ())))
        for size in (*kind.sizes.get(model, ()), *(kind.full.get(model, ()) if full else ()))
    ]


def cost_of_kind(problem: str, size: float, model: str) -> Numbers:
    """Return the pull-off force of a problem, with its bound, CPU times of the first and of a further one, and memory.

    Raises
    ------
    RuntimeError
        If the model has no value.
    """
    kind, seconds, peak = KINDS[problem], [], None
    for factor in (NEIGHBOUR, 1.0, 1.0 + _APART):
        begin = time.process_time()
        row = evaluate(model, "pull_off_force", kind.problem(size, factor))
        seconds.append(time.process_time() - begin)
        if row.status != "ok":
            raise RuntimeError(row.reason)
        if factor == 1.0:
            value, u_num = row.value, row.u_num
        if peak is None:
            peak = peak_memory()
        elif seconds[-1] > LONG:
            break
    times = {"cpu_seconds": min(seconds[1:]), "cold_seconds": seconds[0], "megabytes": peak}
    return {"value": value, "u_num": u_num, **times}


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the CPU time over that of `fscm` for a power law, and the exponent of the CPU time over the size.

    Examples
    --------
    >>> rows = pd.DataFrame({"problem": ["layers"] * 2, "size": [1.0, 2.0], "model": "fscm", "cpu_seconds": [1.0, 4.0]})
    >>> ratios(rows)["exponent"].tolist()
    [nan, 2.0]
    """
    unit = rows.loc[(rows["problem"] == _UNIT[0]) & (rows["model"] == _UNIT[1]), "cpu_seconds"].min()
    exponents = pd.Series(np.nan, index=rows.index)
    for _, alike in rows.groupby(["problem", "model"], sort=False):
        for (_, before), (label, row) in pairwise(alike.iterrows()):
            growth = np.log(row["cpu_seconds"] / before["cpu_seconds"])
            exponents[label] = growth / np.log(row["size"] / before["size"])
    return rows.assign(ratio=rows["cpu_seconds"] / unit, exponent=exponents)


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the times of all problems, with the unit of the size."""
    sizes = [f"{row['size']:g} {KINDS[row['problem']].size}" for row in rows.to_dict("records")]
    names = {"cpu_seconds": "CPU (s)", "cold_seconds": "cold (s)", "megabytes": "MB"}
    columns = ["problem", "size", "model", "ratio", "exponent", "cpu_seconds", "cold_seconds", "megabytes"]
    return rows.assign(size=sizes)[columns].rename(columns=names)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the CPU time over the size, one panel for each kind of problem with several sizes."""
    names: Sequence[str] = [name for name in rows["problem"].unique() if _sizes(rows, name) > 1] or [
        rows["problem"].iloc[0]
    ]
    models = list(rows["model"].unique())
    with styled():
        figure = new_figure(3.4 * len(names), 3.2)
        lattice = panels(figure, list(names), "size", "CPU time (s)", sharey=True)
        for axes, name in zip(lattice, names, strict=True):
            for model, line in rows[rows["problem"] == name].groupby("model", sort=False):
                index = models.index(model)
                axes.loglog("size", "cpu_seconds", data=line, color=COLOURS[index], marker=MARKERS[index], label=model)
            axes.set_xlabel(KINDS[name].size)
            sizes = sorted(rows.loc[rows["problem"] == name, "size"].unique())
            axes.set_xticks(sizes, [f"{size:g}" for size in sizes])
            axes.minorticks_off()
            axes.legend()
    return figure


def _sizes(rows: pd.DataFrame, name: str) -> int:
    return int(rows.loc[rows["problem"] == name, "size"].nunique())


_TITLE = "kinds of problems; ratio: to fscm for a power law, exponent: over the size"
KINDS_OF_PROBLEMS = Part("kinds", _TITLE, plan, cost_of_kind, ratios, summary, draw)
