"""Tests of equilibrium paths: the central gap as a parameter, the turning points, and the JKR curve beside them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import Case, StatementTest, case_label, grid, reading, witnesses
from comparisons.paper.tasks import curve

__all__ = ["TESTS", "jumps", "turning_points"]

Array = NDArray[np.float64]
Json = dict[str, Any]

#: Central gap from which the two bodies count as far apart: the paper begins there (Sec. 2.4).
_FAR = 10.0


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    models = [str(model) for model in statement.arguments.get("models", ())]
    calls = [CachedCall.of(curve, model, *case) for case in grid(statement) for model in ("fscm", *models)]
    return [*calls, *(CachedCall.of(curve, "fem", *case) for case in witnesses(statement))]


def turning_points(displacement: Array, u: float) -> list[int]:
    """Return the points where a displacement turns back by more than twice its bound.

    Examples
    --------
    >>> turning_points(np.array([0.0, 2.0, 1.0, 1.5, 1.4999, 3.0]), 0.001)
    [1, 2]
    """
    found: list[int] = []
    extreme, rising = 0, True
    for i, value in enumerate(displacement):
        ahead = value - displacement[extreme] if rising else displacement[extreme] - value
        if ahead >= 0.0:
            extreme = i
        elif ahead < -2.0 * u:
            found.append(extreme)
            extreme, rising = i, not rising
    return found


def _evidence(of_path: Callable[[PaperStatement, str, Case, Json], list[Evidence]]) -> StatementTest:
    """Return the test that compares numbers of one path."""

    def evidence(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
        cases = [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]
        return [
            row
            for model, case in cases
            for row in of_path(statement, model, case, results[CachedCall.of(curve, model, *case)])
        ]

    return StatementTest(_tasks, evidence)


def _single_valued(statement: PaperStatement, model: str, case: Case, path: Json) -> list[Evidence]:
    gap = np.array(path["columns"]["central_gap"], float)
    # The gap is as certain as the displacement: delta = -H_0 + w(0) (Eq. 33).
    step, u = float(np.diff(gap).max()), 2.0 * float(path["u_displacement"])
    what = f"largest step of the central gap along the path, {case_label(case)}"
    return [Evidence(case_label(case), model, Number(step, u, what), "<", Number(0.0, 0.0, "falls at every step"))]


def _two_turns(statement: PaperStatement, model: str, case: Case, path: Json) -> list[Evidence]:
    displacement, u = np.array(path["displacement"]), float(path["u_displacement"])
    turns = turning_points(displacement, u)
    rise = max(
        (displacement[b] - displacement[a] for a, b in zip(turns[1:-1:2], turns[2:-1:2], strict=True)), default=0
    )
    between = f", between them the displacement rises again by at least {rise:.5f} (bound {2 * u:.1g})" if rise else ""
    what = f"turning points of the displacement, {case_label(case)}{between}"
    return [Evidence(case_label(case), model, Number(len(turns), 0.0, what), "<", Number(3, 0.0, "one fold pair"))]


def jumps(displacement: Array, u: float) -> int:
    """Return how many jumps a machine that controls the displacement sees while it approaches and while it retracts.

    A jump ends where the path rises again to the displacement at which it began; what is between is passed over.

    Examples
    --------
    >>> jumps(np.array([0.0, 3.0, 1.0, 2.0, -1.0, 4.0]), 0.001)          # the inner maximum is passed over
    2
    >>> jumps(np.array([0.0, 2.0, 1.0, 3.0, -1.0, 4.0]), 0.001)          # the first jump ends before the inner one
    3
    """
    return _jumps_one_way(displacement, u) + _jumps_one_way(-displacement[::-1], u)


def _jumps_one_way(displacement: Array, u: float) -> int:
    count, reached = 0, -np.inf
    for turn in turning_points(displacement, u)[::2]:
        # A maximum below one that was passed before it is on a part of the path that the jump leaves out.
        if displacement[turn] > reached:
            count, reached = count + 1, displacement[turn]
    return count


def _two_jumps(statement: PaperStatement, model: str, case: Case, path: Json) -> list[Evidence]:
    count = jumps(np.array(path["displacement"]), float(path["u_displacement"]))
    value = Number(count, 0.0, f"jumps under displacement control, {case_label(case)}")
    limits = (("<", Number(3, 0.0, "one jump each way")), (">", Number(1, 0.0, "no jump back")))
    return [Evidence(case_label(case), model, value, relation, limit) for relation, limit in limits]


def _far_apart(statement: PaperStatement, model: str, case: Case, path: Json) -> list[Evidence]:
    gap, displacement, load = (
        np.array(values, float) for values in (path["columns"]["central_gap"], path["displacement"], path["load"])
    )
    far, depth = gap >= _FAR, -load.min()
    share = float(np.max(np.abs(gap + displacement)[far] / gap[far]))
    force = float(np.max(np.abs(load)[far]) / depth)
    return [
        Evidence(
            case_label(case),
            model,
            Number(value, u, f"{what} from H_0 = 10 on, {case_label(case)}"),
            "<",
            reading(statement),
        )
        for value, u, what in (
            (share, path["u_displacement"] / _FAR, "largest |delta + H_0| / H_0"),
            (force, 2.0 * path["u_load"] / depth, "largest |P| over the pull-off force"),
        )
    ]


def _high_load(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Difference of JKR's load at one displacement, from the pull-off to the end of the path, over the pull-off."""
    rows = []
    for case in grid(statement):
        (x, y, u_load), (jkr_x, jkr_y, _) = (
            _branch(results[CachedCall.of(curve, model, *case)]) for model in ("fscm", "jkr")
        )
        inside = (x >= jkr_x[0]) & (x <= jkr_x[-1])
        depth = -float(y.min())
        linear = np.interp(x[inside], jkr_x, jkr_y)
        spline = CubicSpline(jkr_x, jkr_y)(x[inside])
        error = float(np.abs(spline - y[inside]).max()) / depth
        u = (float(np.abs(spline - linear).max()) + u_load) / depth
        what = f"largest difference of the loads of jkr and fscm over the pull-off force, {case_label(case)}"
        rows.append(Evidence(case_label(case), "fscm", Number(error, u, what), "<", reading(statement)))
    return rows


def _branch(path: Json) -> tuple[Array, Array, float]:
    """Displacements and loads from the smallest load on, where the displacement rises, and the bound of the loads."""
    displacement, load = np.array(path["displacement"]), np.array(path["load"])
    start = int(load.argmin())
    x, y = displacement[start:], load[start:]
    kept = np.concatenate([[True], np.diff(x) > 0.0])
    return x[kept], y[kept], float(path["u_load"])


#: Tests of statements on the equilibrium path, by name.
TESTS = {
    "single_valued": _evidence(_single_valued),
    "two_turning_points": _evidence(_two_turns),
    "two_jumps": _evidence(_two_jumps),
    "far_apart": _evidence(_far_apart),
    "high_load_branch": StatementTest(_tasks, _high_load),
}
