"""Tests of the paper's numerical scheme and of its parameters: segments, size of the domain, Poisson's ratio."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.data.paper_statements import PaperStatement
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fem_model import FiniteElements
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import REFERENCES, Evidence, Number
from comparisons.paper.statements.sources import StatementTest, case_label, grid, number, reading, tasks_of, witnesses
from comparisons.paper.values.scheme_ingredients import SEGMENTS, exact_force, scheme_force
from comparisons.runs.cases import Case as ProblemCase

__all__ = ["TESTS", "force_at"]

_FORCE = "pull_off_force"


def force_at(n: float, k: float, mu: float, nu: float) -> dict[str, float]:
    """Return the pull-off force of the finite elements for one Poisson's ratio, ``value`` and ``u_num``.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the finite elements refuse or fail.
    """
    try:
        found = FiniteElements(nu).evaluate(ProblemCase(n, k, mu).problem(), _FORCE)
    except NotApplicable as refusal:
        raise ComputationFailed(str(refusal)) from refusal
    return {"value": found.value, "u_num": found.u_num}


def _mesh_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(function, *case) for case in grid(statement) for function in (scheme_force, exact_force)]


def _segments(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The segments change the force by less than the limit, compared on the same finite domain."""
    rows = []
    for case in grid(statement):
        coarse, full = (results[CachedCall.of(function, *case)] for function in (scheme_force, exact_force))
        same_domain = full["force"] - full["beyond"][0]
        share = abs(coarse["force"] - same_domain) / full["force"]
        u = (coarse["u_num"] + full["u_num"]) / full["force"]
        what = f"change of the pull-off force by N = {SEGMENTS} segments, {case_label(case)}"
        rows.append(Evidence(case_label(case), "fscm-stieltjes", Number(share, u, what), "<", reading(statement)))
    return rows


def _domain_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    cases = grid(statement)
    calls = [CachedCall.of(scheme_force, *case) for case in cases]
    models = [call for case in cases for call in tasks_of("fscm", _FORCE, case)]
    return [*calls, *models, *(call for case in witnesses(statement) for call in tasks_of("fem", _FORCE, case))]


def _domain(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The force of the scheme, which ends at f = 50, against that of each reference."""
    rows = []
    for case in grid(statement):
        scheme = results[CachedCall.of(scheme_force, *case)]
        for model in REFERENCES:
            if model == "fem" and case not in witnesses(statement):
                continue
            exact = number(results, model, _FORCE, case)
            share = 1.0 - scheme["force"] / exact.value
            u = (scheme["u_num"] + exact.u) / exact.value
            what = f"share of the pull-off force that the scheme with f(r_max) = 50 lacks, {case_label(case)}"
            rows.append(Evidence(case_label(case), model, Number(abs(share), u, what), "<", reading(statement)))
    return rows


def _poisson_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(force_at, *case, nu) for case in grid(statement) for nu in statement.numbers("nu")]


def _poisson(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """At fixed n, k and mu the force of the finite elements is the same for every Poisson's ratio."""
    rows = []
    for case in grid(statement):
        first, second = (results[CachedCall.of(force_at, *case, nu)] for nu in statement.numbers("nu"))
        apart = abs(first["value"] - second["value"])
        values = " and ".join(f"{nu:g}" for nu in statement.numbers("nu"))
        what = f"difference of the pull-off forces for nu = {values}, {case_label(case)}"
        value = Number(apart, first["u_num"] + second["u_num"], what)
        rows.append(Evidence(case_label(case), "fem", value, "<", reading(statement)))
    return rows


#: Tests of statements on the Stieltjes scheme, by name.
TESTS = {
    "segments_suffice": StatementTest(_mesh_tasks, _segments),
    "domain_suffices": StatementTest(_domain_tasks, _domain),
    "no_poisson_ratio": StatementTest(_poisson_tasks, _poisson),
}
