"""CPU time of kinds of problems: Tabor numbers, layers, rows of a measured punch, a ball, finite strain, and curves."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.bead import bead, record
from comparisons.bench.floor import draw_floor, floor_seconds
from comparisons.bench.part import Numbers, Part
from comparisons.bench.work_precision import LONG, NEIGHBOUR, peak_memory
from comparisons.fitting.fit import fit_record
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.record import Record
from comparisons.output.style import COLOURS, MARKERS, new_figure, styled
from comparisons.paper.drawing import panels
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate

_LAW = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
_SPHERE = Section("sphere", {"R": 0.5e-6})
#: Not a quantity of a model: a fit; the key that is fitted, and its value at the start over the right one.
FIT, _MODULUS, _OFF = "fit", "solid.E", 1.3
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


def _bead(count: float, factor: float) -> Problem:
    """A bead on rubber, whatever the number of its records."""
    return bead(work_of_adhesion=0.05 * factor)


def _start_of_fit(count: float, factor: float) -> Problem:
    """A bead on rubber whose modulus is wrong."""
    return bead(_OFF * 1.5e6, 0.05 * factor)


def _evaluated(quantity: str, model: str, problem: Problem) -> Numbers:
    """Return a value with its bound, unknowns and Newton steps; of a curve only that it is there."""
    row = evaluate(model, quantity, problem)
    if row.status != "ok":
        raise RuntimeError(row.reason)
    return {"value": row.value, "u_num": row.u_num, "unknowns": row.size, "iterations": row.iterations}


def _fitted(problem: Problem, records: Sequence[Record]) -> Numbers:
    """Fit the modulus to each record, and return the mean."""
    keys = free_keys(problem, [_MODULUS])
    values = [fit_record(record, problem, keys, model="fscm").parameters[_MODULUS].value for record in records]
    return {"value": float(np.mean(values)), "u_num": None, "unknowns": None, "iterations": None}


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
    quantity : str
        A quantity, or `FIT`: the modulus of the problem is fitted to as many records as the size.
    """

    size: str
    problem: Callable[[float, float], Problem]
    sizes: dict[str, tuple[float, ...]]
    full: dict[str, tuple[float, ...]]
    quantity: str = "pull_off_force"

    def computation(self, model: str, size: float, factor: float) -> Callable[[], Numbers]:
        """Return what is measured: a function that computes the quantity of the problem of a size and a factor."""
        problem = self.problem(size, factor)
        if self.quantity == FIT:
            return partial(_fitted, problem, [record(_bead(size, factor), seed) for seed in range(int(size))])
        return partial(_evaluated, self.quantity, model, problem)


KINDS = {
    "sphere": Kind("mu", partial(_of_numbers, 2.0, 0.0), {"fscm": (1, 10, 100), "fem": (1, 10)}, {"fem": (100,)}),
    "n = 2, k = 0.4": Kind("mu", partial(_of_numbers, 2.0, 0.4), {"fscm": (1,), "fem": (1,)}, {}),
    "n = 1, k = 0": Kind("mu", partial(_of_numbers, 1.0, 0.0), {"fscm": (0.3,), "fem": (0.3,)}, {}),
    "n = 5, k = 0.6": Kind("mu", partial(_of_numbers, 5.0, 0.6), {"fscm": (2,), "fem": (2,)}, {}),
    "coating": Kind("nm", _coating, {"fscm": (20,), "fem": (20,)}, {}),
    "layers": Kind("films", _layers, {"fscm": (1, 2, 4)}, {"fscm": (8,), "fem": (1, 2, 4)}),
    "measured punch": Kind("rows", _measured, {"fscm": (20, 50)}, {"fscm": (100, 200), "fem": (10, 20)}),
    "ball": Kind("um", _ball, {"fscm": (5,), "fem-large-strain": (5,)}, {}),
    "force curve": Kind("mu", partial(_of_numbers, 2.0, 0.0), {"fscm": (1, 10, 100)}, {"fem": (1, 10)}, "force_curve"),
    "fit of curves": Kind("curves", _start_of_fit, {"fscm": (1, 2, 4)}, {"fscm": (8,)}, FIT),
}

#: More panels are in two rows.
_MOST_BESIDE = 4

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
    """Return the value of a problem, with its bound, CPU times of the first and of a further one, memory and floor.

    Raises
    ------
    RuntimeError
        If the model has no value.
    """
    kind, seconds, peak = KINDS[problem], [], None
    for factor in (NEIGHBOUR, 1.0, 1.0 + _APART):
        compute = kind.computation(model, size, factor)
        begin = time.process_time()
        computed = compute()
        seconds.append(time.process_time() - begin)
        if factor == 1.0:
            numbers = computed
        if peak is None:
            peak = peak_memory()
        elif seconds[-1] > LONG:
            break
    times = {"cpu_seconds": min(seconds[1:]), "cold_seconds": seconds[0], "megabytes": peak}
    return {**numbers, **times, "floor_seconds": floor_seconds(model, numbers["unknowns"], numbers["iterations"])}


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
    """Draw CPU time and floor over the size, one panel for each kind of problem with several sizes."""
    names: Sequence[str] = [name for name in rows["problem"].unique() if _sizes(rows, name) > 1] or [
        rows["problem"].iloc[0]
    ]
    models = list(rows["model"].unique())
    lines = 1 + (len(names) > _MOST_BESIDE)
    with styled():
        columns = -(-len(names) // lines)
        figure = new_figure(3.4 * columns, 3.2 * lines)
        words = [*names, *[""] * (lines * columns - len(names))]
        lattice = panels(figure, words, "", "CPU time (s)", lines, sharey=True)
        for axes in lattice[len(names) :]:
            axes.remove()
        for axes, name in zip(lattice, names, strict=False):
            for model, line in rows[rows["problem"] == name].groupby("model", sort=False):
                index = models.index(model)
                style = {"color": COLOURS[index], "marker": MARKERS[index]}
                axes.loglog("size", "cpu_seconds", data=line, label=model, **style)
                draw_floor(axes, line, "size", style)
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
