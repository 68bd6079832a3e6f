"""Tests of the onset of hysteresis: which parameter decides it, and how the jumps meet there."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import near_critical
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number, decisive
from comparisons.paper.statements.sources import Case, StatementTest, missing_in, number, shape, tasks_of

__all__ = ["TESTS"]

_ENERGY = "hysteresis_energy"
#: Excess of the Tabor number over the critical one, of which the distance of the gaps is compared.
_NEAR, _LESS_NEAR = 1e-4, 1e-2


def _pairs(statement: PaperStatement) -> list[tuple[Case, Case]]:
    """Two cases of one shape and one Tabor number."""
    return [
        ((float(n), float(first), float(mu)), (float(n), float(second), float(mu)))
        for n, mu, first, second in statement.arguments["pairs"]
    ]


def _alike_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [
        call
        for pair in _pairs(statement)
        for case in pair
        for model in REFERENCES
        for call in tasks_of(model, _ENERGY, case)
    ]


def _alike(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Both gradient exponents have hysteresis at one Tabor number, or neither."""
    rows = []
    for first, second in _pairs(statement):
        for model in REFERENCES:
            lacking = [case for case in (first, second) if missing_in(results, model, _ENERGY, case)]
            if len(lacking) == 1:
                (other,) = (case for case in (first, second) if case not in lacking)
                value = number(results, model, _ENERGY, other)
                limit = Number(0.0, 0.0, f"no jump at k = {lacking[0][1]:g}")
            else:
                value = Number(0.0, 0.0, f"cases without a jump at mu = {first[2]:g}: {len(lacking)} of 2")
                limit = Number(1.0, 0.0, "one of two")
            rows.append(Evidence(shape(first[0]), model, value, "<", limit, statement.beyond(first[0])))
    return rows


def _critical_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [call for _, case in _printed(statement) for call in tasks_of("fscm", "critical_tabor_number", case)]


def _printed(statement: PaperStatement) -> list[tuple[float, Case]]:
    # The Tabor number of the case is not used.
    return [(float(mu), (float(n), float(k), 1.0)) for n, k, mu in statement.arguments["printed"]]


def _critical(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Each critical Tabor number rounds to the printed one."""
    half = Number(0.5 * float(statement.arguments["digit"]), 0.0, "half of the last printed digit")
    rows = []
    for mu, case in _printed(statement):
        found = number(results, "fscm", "critical_tabor_number", case)
        value = Number(abs(found.value - mu), found.u, f"difference of the critical Tabor number {found.value:.6f}")
        rows.append(Evidence(f"n = {case[0]:g}, k = {case[1]:g}", "fscm", value, "<", half))
    return rows


def _meeting_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(near_critical, *case) for case in _onsets(statement)]


def _onsets(statement: PaperStatement) -> list[tuple[float, float]]:
    return [(n, k) for n in statement.numbers("n") for k in statement.numbers("k")]


def _meeting(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The distance of the two gaps falls like the square root of the excess, to zero."""
    limit = Number(float(statement.arguments["within"]), 0.0, "limit")
    rows: dict[float, list[Evidence]] = {}
    for n, k in _onsets(statement):
        found = results[CachedCall.of(near_critical, n, k)]
        near, less_near = (
            next(jump for jump in found["jumps"] if abs(jump["mu"] / found["mu"] - 1.0 - excess) < 1e-9)
            for excess in (_NEAR, _LESS_NEAR)
        )
        distances = [jump["jump_in_gap"] - jump["jump_out_gap"] for jump in (near, less_near)]
        u = sum(jump[f"u_{name}"] for jump in (near, less_near) for name in ("jump_in_gap", "jump_out_gap"))
        expected = (_NEAR / _LESS_NEAR) ** 0.5
        ratio = distances[0] / distances[1] / expected
        what = f"distance of the gaps against the square root of the excess, n = {n:g}, k = {k:g}"
        value = Number(abs(ratio - 1.0), ratio * u * (1.0 / distances[0] + 1.0 / distances[1]), what)
        rows.setdefault(n, []).append(Evidence(shape(n), "fscm", value, "<", limit))
    return [decisive(found) for found in rows.values()]


#: Tests of statements on critical Tabor numbers and hysteresis, by name.
TESTS = {
    "hysteresis_alike": StatementTest(_alike_tasks, _alike),
    "critical_numbers": StatementTest(_critical_tasks, _critical),
    "gaps_meet": StatementTest(_meeting_tasks, _meeting),
}
