"""Reference values of 500 random problems, from paths with 8 times smaller steps and from finer meshes.

``python -m tests.fscm.random_problems`` adds the problems that `random_problems.csv` lacks.  A row is a problem and a
quantity; its status is "value", or the name of the exception that the finer path raised.  The bound of the finer value
is stored where it was computed: without it, rounding is what is left of its error.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fscm import QUANTITIES, Analysis, NoSuchEvent, NotConverged, Problem
from fscm._path import continuation as continuation
from fscm._path.arc_length import Point
from fscm._path.completeness import completed
from fscm._path.whole_path import path_end
from fscm._surface.state import State
from fscm._threads import one_thread
from tests.fscm.equilibria_on_finer_meshes import FINER
from tests.random_tables import complete, stored

SEED, COUNT = 20261122, 500
TABLE = Path(__file__).with_suffix(".csv")
# Steps of an eighth in arc length.
STEPS = 8
# Numbers of problems whose finer path takes more than a minute.
UNFINISHED = {30, 39, 489}
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


def rows(number: int) -> Iterator[dict[str, object]]:
    """The rows of one problem."""
    problem = problems()[number]
    head = {"number": number, "n": problem.n, "k": problem.k, "mu": problem.mu}
    try:
        model = finer(problem)
    except NotConverged:
        yield from ({**head, "quantity": name, "status": "NotConverged"} for name in NAMES)
        return
    for name in NAMES:
        row = {**head, "quantity": name}
        try:
            solution = model.solution(name)
            yield row | {"status": "value", "value": repr(float(solution.value)), "u_num": f"{solution.u_num:.2g}"}
        except (NoSuchEvent, NotConverged) as error:
            yield row | {"status": type(error).__name__}


class Stored(NamedTuple):
    """Row of a quantity: NaN for no value, and 0 for a bound that is not stored."""

    status: str
    value: float
    u_num: float


def stored_values() -> dict[int, dict[str, Stored]]:
    """Rows of the table, by number and quantity."""
    values: dict[int, dict[str, Stored]] = {}
    for row in stored(TABLE):
        value = Stored(row["status"], float(row["value"] or math.nan), float(row["u_num"] or 0.0))
        values.setdefault(int(row["number"]), {})[row["quantity"]] = value
    return values


if __name__ == "__main__":
    complete(TABLE, (number for number in range(COUNT) if number not in UNFINISHED), rows)
