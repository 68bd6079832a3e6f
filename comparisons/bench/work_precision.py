"""Error against CPU time: pull-off force of a sphere on a homogeneous half-space by both references and other schemes.

A measurement has the CPU time of the first pull-off force of a process and of a further one, and memory.  The error is
that against the certified pull-off force.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import fem_reference
import fscm
from comparisons.bench import adhesion_fft, greenwood
from comparisons.bench.floor import draw_floor, floor_seconds
from comparisons.bench.part import Numbers, Part
from comparisons.models.fem_model import FiniteElements
from comparisons.output.style import COLOURS, MARKERS, new_figure, styled
from comparisons.paper.drawing import case, of_model, panels
from comparisons.problem import Problem
from fscm.stieltjes import StieltjesScheme, find_event

#: Tabor number -> centre and radius of an interval that contains the pull-off force for n = 2, k = 0, from
#: docs/certified_value.md; the proof is tests/certified.
CERTIFIED = {
    0.1: (1.96895637932829, 1e-11),
    0.5: (1.78748293102689, 6e-13),
    1.0: (1.6706647764763, 1.6e-12),
}

#: Settings of each solver: accuracies, segments of the scheme of the paper, which has 2500, rings of Greenwood's, and
#: points along a side of the grid of Adhesion.
_SETTINGS = {
    "fscm": ("1e-04", "1e-05", "1e-06", "1e-07", "1e-08", "1e-09", "1e-10"),
    "fem": ("quick", "default", "fine"),
    "fscm-stieltjes": ("250", "500", "1000", "2500"),
    "greenwood": ("50", "100", "200"),
    "adhesion": ("64", "128", "256"),
}
#: Measured with `full` only.
_FULL = {("fscm-stieltjes", "2500"), ("adhesion", "256")}

#: Computations of one measurement: the least CPU time of them counts, because other programs only add to it.
_REPEATS = 3
#: A computation that takes so many seconds of CPU is not repeated: a disturbance is then a small part of it.
LONG = 1.0

#: The first problem of a process is a neighbouring one: its Tabor number differs by this factor.
NEIGHBOUR = 1.1
#: Repetitions have Tabor numbers that differ by this much, so that no stored solution serves them.
_APART = 1e-6


def plan(full: bool) -> list[Numbers]:
    """Return the solvers with all their settings; Adhesion only where it is installed."""
    left_out = set() if adhesion_fft.is_installed() else {"adhesion"}
    return [
        {"n": 2.0, "k": 0.0, "mu": mu, "model": model, "setting": setting}
        for mu in CERTIFIED
        for model, settings in _SETTINGS.items()
        for setting in settings
        if model not in left_out and (full or (model, setting) not in _FULL)
    ]


def _by_fscm(problem: fscm.Problem, accuracy: str) -> Numbers:
    solution = fscm.solve(problem, "pull_off_force", float(accuracy))
    return {"value": solution.value, "u_num": solution.u_num, **_effort(solution)}


def _by_elements(problem: fscm.Problem, accuracy: str) -> Numbers:
    """Solve the physical problem; its load is in the unit of the pull-off force."""
    units, body = FiniteElements().physical(Problem.dimensionless(problem.n, problem.k, problem.mu))
    solution, unit = fem_reference.solve(body, "pull_off_force", accuracy), units["load"]
    return {"value": solution.value / unit, "u_num": solution.u_num / unit, **_effort(solution)}


def _effort(solution: fscm.Solution | fem_reference.Solution) -> Numbers:
    return {"unknowns": solution.size, "iterations": solution.iterations}


def _by_stieltjes(problem: fscm.Problem, segments: str) -> Numbers:
    event = find_event(StieltjesScheme(problem, int(segments)), "pull_off")
    return {"value": -event.load, "u_num": None, "unknowns": int(segments), "iterations": None}


def _by_greenwood(problem: fscm.Problem, rings: str) -> Numbers:
    return {
        "value": greenwood.pull_off_force(problem.mu, int(rings)),
        "u_num": None,
        "unknowns": int(rings),
        "iterations": None,
    }


def _by_adhesion(problem: fscm.Problem, points: str) -> Numbers:
    force = adhesion_fft.pull_off_force(problem.mu, int(points))
    return {"value": force, "u_num": None, "unknowns": int(points) ** 2, "iterations": None}


_SOLVERS = {
    "fscm": _by_fscm,
    "fem": _by_elements,
    "fscm-stieltjes": _by_stieltjes,
    "greenwood": _by_greenwood,
    "adhesion": _by_adhesion,
}


def cost_of_pull_off(n: float, k: float, mu: float, model: str, setting: str) -> Numbers:
    """Return the pull-off force of a problem by a solver, with its bound, unknowns, CPU times, memory and floor.

    ``cold_seconds`` is the CPU time of the first pull-off force of the process, with the imports that it needs, and
    ``megabytes`` the peak of the memory of the process after it; ``cpu_seconds`` is the CPU time of a further one.

    Parameters
    ----------
    n, k, mu : float
    model : str
        fscm, fem, fscm-stieltjes, greenwood or adhesion.
    setting : str
        An accuracy (fscm, fem), how many segments (fscm-stieltjes), rings (greenwood), or points (adhesion).
    """
    solved: list[Numbers] = []
    seconds: list[float] = []
    peak = None
    for factor in (NEIGHBOUR, *(1.0 + _APART * repetition for repetition in range(_REPEATS))):
        begin = time.process_time()
        solved.append(_SOLVERS[model](fscm.Problem(n, k, factor * mu), setting))
        seconds.append(time.process_time() - begin)
        if len(solved) == 1:
            peak = peak_memory()
        elif seconds[-1] > LONG:
            break
    times = {"cpu_seconds": min(seconds[1:]), "cold_seconds": seconds[0], "megabytes": peak}
    return {**solved[1], **times, "floor_seconds": floor_seconds(model, solved[1]["unknowns"], solved[1]["iterations"])}


def peak_memory() -> float | None:
    """Return the peak of the resident memory of this process in MB (1e6 bytes); None where no /proc tells it."""
    # Not getrusage: its maximum is inherited from the parent across exec.
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
    except OSError:
        return None
    fields = dict(line.split(":", 1) for line in status.splitlines())
    return 1024e-6 * float(fields["VmHWM"].split()[0])


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add to every row its error, how well it is known, and the ratio to `fscm`.

    ``error`` is the distance from the certified value relative to it; it is only known to within ``u_error``.
    ``ratio`` is CPU time over that of the fastest `fscm` whose error is certainly smaller; missing where there is none.
    """
    centre, radius = (rows["mu"].map({mu: interval[i] for mu, interval in CERTIFIED.items()}) for i in (0, 1))
    rows = rows.assign(error=(rows["value"] - centre).abs() / centre, u_error=radius / centre)
    return rows.assign(ratio=time_ratios(rows))


def time_ratios(rows: pd.DataFrame) -> list[float]:
    """Return CPU time over that of the fastest `fscm` whose error is smaller by more than both doubts.

    Examples
    --------
    >>> pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1e-6], "u_error": [1e-12, 1e-12]}
    >>> time_ratios(pd.DataFrame({**pair, "cpu_seconds": [0.1, 5.0]}))
    [nan, 50.0]
    """
    quotients = []
    for row in rows.to_dict("records"):
        ours = rows[(rows["model"] == "fscm") & (rows["mu"] == row["mu"])]
        smaller = ours["error"] + ours["u_error"] < row["error"] - row["u_error"]
        fastest = ours.loc[smaller, "cpu_seconds"].min()
        quotients.append(float(row["cpu_seconds"] / fastest) if row["model"] != "fscm" else float("nan"))
    return quotients


def draw(rows: pd.DataFrame) -> Figure:
    """Draw error against CPU time with its floor, one panel a Tabor number."""
    drawn = rows.sort_values("cpu_seconds")
    # A smaller error is drawn where it is known to be.
    drawn = drawn.assign(error=np.maximum(drawn["error"], drawn["u_error"]))
    tabor_numbers = rows["mu"].unique()
    with styled():
        figure = new_figure(3.4 * len(tabor_numbers), 3.2)
        words = [case(mu=mu) for mu in tabor_numbers]
        lattice = panels(figure, words, "CPU time (s)", "relative error of the pull-off force")
        for axes, mu in zip(lattice, tabor_numbers, strict=True):
            models = list(_SETTINGS)
            for index, line in enumerate(of_model(drawn[drawn["mu"] == mu], *models)):
                if line.empty:
                    continue
                style = {"color": COLOURS[index], "marker": MARKERS[index]}
                axes.loglog("cpu_seconds", "error", data=line, label=models[index], **style)
                draw_floor(axes, line, "error", style, across=True)
            axes.legend()
    return figure


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the finest `fscm`, and the other solvers with their CPU time over that of `fscm` at a smaller error."""
    columns = ["model", "setting", "mu", "ratio", "cpu_seconds", "cold_seconds", "megabytes", "error"]
    is_finest = ~rows.duplicated(["mu", "model"], keep="last")
    names = {"cpu_seconds": "CPU (s)", "cold_seconds": "cold (s)", "megabytes": "MB"}
    return rows.loc[is_finest | (rows["model"] != "fscm"), columns].rename(columns=names)


_TITLE = "error against CPU time; ratio: to fscm of smaller error"
WORK_PRECISION = Part("work-precision", _TITLE, plan, cost_of_pull_off, ratios, summary, draw)
