"""Tests of equilibrium paths: turning points, jumps, the JKR curve beside them, and the onset of hysteresis."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall
from comparisons.paper.figures.fig08_jumps import near_critical
from comparisons.paper.paper_figure import Plan, results_by
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number
from comparisons.paper.statements.numbers import (
    Case,
    Comparisons,
    both,
    case_label,
    families,
    grid,
    models_of,
    number,
    numbers,
    reading,
)
from comparisons.paper.tasks import curve, quantity

__all__ = ["TESTS", "jumps", "turning_points"]

Array = NDArray[np.float64]
Json = dict[str, Any]

#: Central gap from which the two bodies count as far apart: the paper begins there (Sec. 2.4).
_FAR = 10.0
#: Excess of the Tabor number over the critical one, of which the distance of the gaps is compared.
_NEAR, _LESS_NEAR = 1e-4, 1e-2


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


def _curves(places: Iterable[tuple[str, Case]]) -> Plan[dict[tuple[str, Case], Json]]:
    found = yield from results_by({(model, case): CachedCall.of(curve, model, *case) for model, case in places})
    return found


def single_valued(statement: PaperStatement) -> Comparisons:
    """The central gap falls at every step along the path."""
    paths = yield from _curves(both(statement))
    rows = []
    for (model, case), path in paths.items():
        gap = np.array(path["columns"]["central_gap"], float)
        # The gap is as certain as the displacement: delta = -H_0 + w(0) (Eq. 33).
        what = f"largest step of the central gap along the path, {case_label(case)}"
        step = Number(float(np.diff(gap).max()), 2.0 * path["u_displacement"], what)
        rows.append(Evidence(case_label(case), model, step, "<", Number(0.0, 0.0, "falls at every step")))
    return rows


def two_turning_points(statement: PaperStatement) -> Comparisons:
    """The displacement turns back twice at most."""
    paths = yield from _curves(both(statement))
    rows = []
    for (model, case), path in paths.items():
        displacement, u = np.array(path["displacement"]), path["u_displacement"]
        turns = turning_points(displacement, u)
        rise = max(
            (displacement[b] - displacement[a] for a, b in zip(turns[1:-1:2], turns[2:-1:2], strict=True)), default=0
        )
        again = f", between them the displacement rises again by at least {rise:.5f} (bound {2 * u:.1g})"
        what = f"turning points of the displacement, {case_label(case)}{again if rise else ''}"
        count = Number(len(turns), 0.0, what)
        rows.append(Evidence(case_label(case), model, count, "<", Number(3, 0.0, "one fold pair")))
    return rows


def two_jumps(statement: PaperStatement) -> Comparisons:
    """A machine that controls the displacement sees one jump each way."""
    paths = yield from _curves(both(statement))
    limits = (("<", Number(3, 0.0, "one jump each way")), (">", Number(1, 0.0, "no jump back")))
    rows = []
    for (model, case), path in paths.items():
        count = jumps(np.array(path["displacement"]), path["u_displacement"])
        value = Number(count, 0.0, f"jumps under displacement control, {case_label(case)}")
        rows += [Evidence(case_label(case), model, value, relation, limit) for relation, limit in limits]
    return rows


def far_apart(statement: PaperStatement) -> Comparisons:
    """Far apart the deformation and the load are small."""
    paths = yield from _curves(both(statement))
    rows = []
    for (model, case), path in paths.items():
        gap, displacement, load = (
            np.array(values, float) for values in (path["columns"]["central_gap"], path["displacement"], path["load"])
        )
        far, depth = gap >= _FAR, -load.min()
        share = float(np.max(np.abs(gap + displacement)[far] / gap[far]))
        force = float(np.max(np.abs(load)[far]) / depth)
        for value, u, what in (
            (share, path["u_displacement"] / _FAR, "largest |delta + H_0| / H_0"),
            (force, 2.0 * path["u_load"] / depth, "largest |P| over the pull-off force"),
        ):
            found = Number(value, u, f"{what} from H_0 = 10 on, {case_label(case)}")
            rows.append(Evidence(case_label(case), model, found, "<", reading(statement)))
    return rows


def high_load_branch(statement: PaperStatement) -> Comparisons:
    """Difference of JKR's load at one displacement, from the pull-off to the end of the path, over the pull-off."""
    models = ("fscm", *models_of(statement))
    paths = yield from _curves((model, case) for case in grid(statement) for model in models)
    rows = []
    for case in grid(statement):
        (x, y), (jkr_x, jkr_y) = (_branch(paths[model, case]) for model in models)
        inside = (x >= jkr_x[0]) & (x <= jkr_x[-1])
        depth = -float(y.min())
        linear = np.interp(x[inside], jkr_x, jkr_y)
        spline = CubicSpline(jkr_x, jkr_y)(x[inside])
        error = float(np.abs(spline - y[inside]).max()) / depth
        u = (float(np.abs(spline - linear).max()) + paths["fscm", case]["u_load"]) / depth
        what = f"largest difference of the loads of jkr and fscm over the pull-off force, {case_label(case)}"
        rows.append(Evidence(case_label(case), "fscm", Number(error, u, what), "<", reading(statement)))
    return rows


def _branch(path: Json) -> tuple[Array, Array]:
    """Displacements and loads from the smallest load on, where the displacement rises."""
    displacement, load = np.array(path["displacement"]), np.array(path["load"])
    start = int(load.argmin())
    x, y = displacement[start:], load[start:]
    kept = np.concatenate([[True], np.diff(x) > 0.0])
    return x[kept], y[kept]


def hysteresis_alike(statement: PaperStatement) -> Comparisons:
    """Every gradient exponent has hysteresis at one Tabor number, or none has."""
    name = "hysteresis_energy"
    calls = {(model, case): CachedCall.of(quantity, model, name, *case) for model, case in both(statement)}
    results = yield list(calls.values())
    rows = []
    for model in REFERENCES:
        for label, family in families((case for one, case in calls if one == model), "k").items():
            # A model refuses the energy where nothing jumps.
            lacking = [case for case in family if results[calls[model, case]]["status"] == "not-applicable"]
            having = [case for case in family if case not in lacking]
            if lacking and having:
                value = number(results, model, name, having[0])
                limit = Number(0.0, 0.0, f"no jump at k = {', '.join(f'{k:g}' for _, k, _ in lacking)}")
            else:
                what = f"gradient exponents unlike the others, {label}: {len(having)} of {len(family)} have jumps"
                value, limit = Number(0.0, 0.0, what), Number(1.0, 0.0, "one of them")
            rows.append(Evidence(label, model, value, "<", limit))
    return rows


def critical_numbers(statement: PaperStatement) -> Comparisons:
    """Each critical Tabor number rounds to the printed one."""
    # The Tabor number of the case is not used.
    printed = {(float(n), float(k), 1.0): float(mu) for n, k, mu in statement.arguments["printed"]}
    found = yield from numbers("critical_tabor_number", [("fscm", case) for case in printed])
    rows = []
    for (model, case), critical in found.items():
        mu = printed[case]
        what = f"difference of the critical Tabor number {critical.value:.6f} from {mu:g}"
        value = Number(abs(critical.value - mu), critical.u, what)
        rows.append(Evidence(f"n = {case[0]:g}, k = {case[1]:g}", model, value, "<", reading(statement)))
    return rows


def gaps_meet(statement: PaperStatement) -> Comparisons:
    """The distance of the two gaps falls like the square root of the excess, to zero."""
    places = product(statement.numbers("n"), statement.numbers("k"))
    onsets = yield from results_by({place: CachedCall.of(near_critical, *place) for place in places})
    rows = []
    for (n, k), onset in onsets.items():
        near, less_near = (
            next(jump for jump in onset["jumps"] if abs(jump["mu"] / onset["mu"] - 1.0 - excess) < 1e-9)
            for excess in (_NEAR, _LESS_NEAR)
        )
        distances = [jump["jump_in_gap"] - jump["jump_out_gap"] for jump in (near, less_near)]
        u = sum(jump[f"u_{name}"] for jump in (near, less_near) for name in ("jump_in_gap", "jump_out_gap"))
        expected = (_NEAR / _LESS_NEAR) ** 0.5
        ratio = distances[0] / distances[1] / expected
        what = f"distance of the gaps against the square root of the excess, n = {n:g}, k = {k:g}"
        value = Number(abs(ratio - 1.0), ratio * u * (1.0 / distances[0] + 1.0 / distances[1]), what)
        rows.append(Evidence(f"n = {n:g}, k = {k:g}", "fscm", value, "<", reading(statement)))
    return rows


#: Tests of statements on the equilibrium path and on hysteresis, by name.
TESTS = {
    "single_valued": single_valued,
    "two_turning_points": two_turning_points,
    "two_jumps": two_jumps,
    "far_apart": far_apart,
    "high_load_branch": high_load_branch,
    "hysteresis_alike": hysteresis_alike,
    "critical_numbers": critical_numbers,
    "gaps_meet": gaps_meet,
}
