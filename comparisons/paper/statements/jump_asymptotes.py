"""Tests of the jumps against their asymptotes: powers of the Tabor number, and the branch that JKR lacks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import log

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number, decisive
from comparisons.paper.statements.sources import StatementTest, grid, number, shape, tasks_of

__all__ = ["TESTS"]

_IN, _OUT = "jump_in_displacement", "jump_out_displacement"


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [call for case in grid(statement) for call in tasks_of("fscm", _IN, case)]


def _power_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    return [call for case in grid(statement) for model in REFERENCES for call in tasks_of(model, name, case)]


def _power(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The power of mu between two Tabor numbers is that of the asymptote within the limit."""
    limit = Number(float(statement.arguments["within"]), 0.0, "limit")
    name = str(statement.arguments["quantity"])
    low, high = statement.numbers("mu")
    rows = []
    for n, model in product(statement.numbers("n"), REFERENCES):
        found = []
        for k in statement.numbers("k"):
            first, second = (number(results, model, name, (n, k, mu)) for mu in (low, high))
            # Eq. 47 is 1 - C mu^p; Eq. 54 is -C mu.
            shift, expected = (1.0, (2 * n + k - 1) / (4 * n + k - 1)) if name == _IN else (0.0, 1.0)
            sizes = [shift - value.value for value in (first, second)]
            power = log(sizes[1] / sizes[0]) / log(high / low)
            u = (first.u / sizes[0] + second.u / sizes[1]) / log(high / low)
            what = f"difference of the power {power:.4f} of mu from {expected:.4f}, n = {n:g}, k = {k:g}"
            found.append(Evidence(shape(n), model, Number(abs(power - expected), u, what), "<", limit))
        rows.append(replace(decisive(found), beyond=statement.beyond(n)))
    return rows


def _jkr_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [*_tasks(statement), *(call for case in grid(statement) for call in tasks_of("jkr", _OUT, case))]


def _one_jump(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """JKR, which begins contact at zero displacement, misses the jump-in by more than the jump-out."""
    rows = []
    for n in statement.numbers("n"):
        found = []
        for case in (case for case in grid(statement) if case[0] == n):
            inward, outward, jkr = (
                number(results, model, name, case) for model, name in (("fscm", _IN), ("fscm", _OUT), ("jkr", _OUT))
            )
            missed = Number(abs(inward.value), inward.u, f"error of jkr at jump-in: {inward.what}")
            kept = Number(abs(jkr.value - outward.value), jkr.u + outward.u, f"error of jkr at jump-out: {jkr.what}")
            found.append(Evidence(shape(n), "fscm", missed, ">", kept))
        rows.append(replace(decisive(found), beyond=statement.beyond(n)))
    return rows


#: Tests of statements on the asymptotes of the jumps, by name.
TESTS = {"power_of_mu": StatementTest(_power_tasks, _power), "jkr_one_jump": StatementTest(_jkr_tasks, _one_jump)}
