"""Tests of the onset of hysteresis: which parameter decides it, and how the jumps meet there."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import near_critical
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import (
    Case,
    StatementTest,
    family_label,
    grid,
    missing_in,
    number,
    reading,
    tasks_of,
    witnesses,
)

__all__ = ["TESTS"]

_ENERGY = "hysteresis_energy"
#: Excess of the Tabor number over the critical one, of which the distance of the gaps is compared.
_NEAR, _LESS_NEAR = 1e-4, 1e-2


def _alike_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    cases = [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]
    return [call for model, case in cases for call in tasks_of(model, _ENERGY, case)]


def _alike(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Every gradient exponent has hysteresis at one Tabor number, or none has."""
    rows = []
    for model, cases in (("fscm", grid(statement)), ("fem", witnesses(statement))):
        of_label: dict[str, list[Case]] = {}
        for case in cases:
            of_label.setdefault(family_label(case, "k"), []).append(case)
        for label, family in of_label.items():
            lacking = [case for case in family if missing_in(results, model, _ENERGY, case)]
            having = [case for case in family if case not in lacking]
            if lacking and having:
                value = number(results, model, _ENERGY, having[0])
                limit = Number(0.0, 0.0, f"no jump at k = {', '.join(f'{k:g}' for _, k, _ in lacking)}")
            else:
                what = f"gradient exponents unlike the others, {label}: {len(having)} of {len(family)} have jumps"
                value, limit = Number(0.0, 0.0, what), Number(1.0, 0.0, "one of them")
            rows.append(Evidence(label, model, value, "<", limit))
    return rows


def _critical_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [call for _, case in _printed(statement) for call in tasks_of("fscm", "critical_tabor_number", case)]


def _printed(statement: PaperStatement) -> list[tuple[float, Case]]:
    # The Tabor number of the case is not used.
    return [(float(mu), (float(n), float(k), 1.0)) for n, k, mu in statement.arguments["printed"]]


def _critical(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Each critical Tabor number rounds to the printed one."""
    rows = []
    for mu, case in _printed(statement):
        critical = number(results, "fscm", "critical_tabor_number", case)
        what = f"difference of the critical Tabor number {critical.value:.6f} from {mu:g}"
        value = Number(abs(critical.value - mu), critical.u, what)
        rows.append(Evidence(f"n = {case[0]:g}, k = {case[1]:g}", "fscm", value, "<", reading(statement)))
    return rows


def _meeting_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(near_critical, *case) for case in _onsets(statement)]


def _onsets(statement: PaperStatement) -> list[tuple[float, float]]:
    return [(n, k) for n in statement.numbers("n") for k in statement.numbers("k")]


def _meeting(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The distance of the two gaps falls like the square root of the excess, to zero."""
    rows = []
    for n, k in _onsets(statement):
        onset = results[CachedCall.of(near_critical, n, k)]
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


#: Tests of statements on critical Tabor numbers and hysteresis, by name.
TESTS = {
    "hysteresis_alike": StatementTest(_alike_tasks, _alike),
    "critical_numbers": StatementTest(_critical_tasks, _critical),
    "gaps_meet": StatementTest(_meeting_tasks, _meeting),
}
