"""Reference values of 500 random problems, from paths with 8 times smaller steps and from finer meshes.

``python -m tests.fscm.random_problems`` adds the problems that `random_problems.csv` lacks.  A row is a problem and a
quantity; its status is "value", the name of the exception that the finer path raised, or "timeout".  The bound of the
finer value is stored where it was computed: without it, rounding is what is left of its error.
"""

from __future__ import annotations

import csv
import math
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

import numpy as np

from fscm import QUANTITIES, Analysis, NoSuchEvent, NotConverged, Problem
from fscm import _continuation as continuation
from fscm._arc_length import Point
from fscm._completeness import completed
from fscm._equilibrium import State
from fscm._threads import one_thread
from fscm._whole_path import path_end
from tests.fscm.equilibria_on_finer_meshes import FINER

SEED, COUNT = 20261122, 500
TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = ("n", "k", "mu", "quantity", "status", "value", "points", "u_num")
# Steps of an eighth in arc length.
STEPS = 8
# Seconds of CPU after which the finer path of a problem is given up; its rows then say so.
PATIENCE = 60
# The critical Tabor number does not belong to a path.
NAMES = tuple(name for name in QUANTITIES if name != "critical_tabor_number")


def problems(count: int = COUNT) -> list[Problem]:
    """Problems of the box 0.8 <= n <= 10, 0 <= k <= 0.9, 0.005 <= mu <= 20, an eighth of them homogeneous."""
    rng = np.random.default_rng(SEED)
    problems = []
    for _ in range(count):
        n = math.exp(rng.uniform(math.log(0.8), math.log(10.0)))
        k = rng.uniform(0.0, 0.9) * (rng.random() < 0.875)
        mu = math.exp(rng.uniform(math.log(0.005), math.log(20.0)))
        problems.append(Problem(round(n, 4), round(k, 4), float(f"{mu:.4g}")))
    return problems


@one_thread()
def finer(problem: Problem) -> Analysis:
    """The model on the finer meshes, with a path of small steps."""
    model = Analysis(problem, FINER)
    end = path_end(problem, FINER.end_height)
    longest = 0.5 / STEPS
    path = continuation.equilibrium_path(problem, *FINER.path, longest, end_height=FINER.end_height)
    points = completed(_thinned(path, end), FINER.path.tolerance)
    model.__dict__.update(_traced=points, points=points)
    return model


def _thinned(path: Iterator[Point], end: Callable[[State], bool]) -> list[Point]:
    """The points of a path next to turning points and zero load, and one of `STEPS` of the others: each takes 2 MB."""
    points: list[Point] = []
    before = None
    for count, point in enumerate(path):
        if before is not None and _signs(before) != _signs(point) and points[-1] is not before:
            points.append(before)
        ended = end(point.state)
        if before is None or ended or count % STEPS == 0 or _signs(before) != _signs(point):
            points.append(point)
        if ended:
            return points
        before = point
    raise AssertionError("the path has no end of its own")


def _signs(point: Point) -> tuple[object, ...]:
    return point.segment, point.rates.load < 0.0, point.rates.displacement < 0.0, point.state.load < 0.0


def rows_of(problem: Problem) -> Iterator[tuple[object, ...]]:
    """The rows of one problem."""
    case = problem.n, problem.k, problem.mu
    try:
        model = finer(problem)
    except NotConverged:
        yield from ((*case, name, "NotConverged", "", "", "") for name in NAMES)
        return
    for name in NAMES:
        try:
            solution = model.solution(name)
            yield *case, name, "value", repr(float(solution.value)), len(model.points), f"{solution.u_num:.2g}"
        except (NoSuchEvent, NotConverged) as error:
            yield *case, name, type(error).__name__, "", len(model.points), ""


def stored_values() -> dict[Problem, dict[str, tuple[str, float, float]]]:
    """Status, value and its bound (0 where it is not stored) of each quantity of each problem in the table."""
    values: dict[Problem, dict[str, tuple[str, float, float]]] = {}
    with TABLE.open(newline="") as file:
        for row in csv.DictReader(file):
            problem = Problem(float(row["n"]), float(row["k"]), float(row["mu"]))
            value = row["status"], float(row["value"] or math.nan), float(row["u_num"] or 0.0)
            values.setdefault(problem, {})[row["quantity"]] = value
    return values


def _computed(problem: Problem) -> list[tuple[object, ...]]:
    signal.setitimer(signal.ITIMER_VIRTUAL, PATIENCE)
    try:
        return list(rows_of(problem))
    except TimeoutError:
        return [(problem.n, problem.k, problem.mu, name, "timeout", "", "", "") for name in NAMES]
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)


def _late(number: int, frame: FrameType | None) -> None:
    raise TimeoutError


def main() -> None:
    """Compute the problems that the table lacks, and append them."""
    signal.signal(signal.SIGVTALRM, _late)
    done = stored_values() if TABLE.exists() else {}
    with TABLE.open("a", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        if not done:
            table.writerow(COLUMNS)
        for problem in problems():
            if problem not in done:
                table.writerows(_computed(problem))
                file.flush()


if __name__ == "__main__":
    main()
