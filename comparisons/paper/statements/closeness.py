"""Tests of relative errors: how near a model is to the reference, and which of two models is nearer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from comparisons.data.paper_statements import PaperStatement
from comparisons.numerics.curve_distance import curve_distance
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import Evidence, Number, decisive
from comparisons.paper.statements.sources import Case, StatementTest, case_label, grid, number, shape, tasks_of
from comparisons.paper.tasks import curve

__all__ = ["TESTS", "relative_error"]

#: Makes the comparisons of a clause with one reference in some cases.
Comparisons = Callable[[str, Sequence[Case], str], list[Evidence]]


def relative_error(model: str, value: Number, reference: str, exact: Number) -> Number:
    """Return the size of the relative error of a value, with the bound that both bounds give it.

    Examples
    --------
    >>> found = relative_error("jkr", Number(1.1, 0.0, "force"), "fscm", Number(1.0, 0.01, "force"))
    >>> round(found.value, 12), round(found.u, 12)
    (0.1, 0.011111111111)
    """
    kappa = value.value / exact.value - 1.0
    u = (value.u + (1.0 + abs(kappa)) * exact.u) / (abs(exact.value) - exact.u)
    return Number(abs(kappa), u, f"relative error of {model} against {reference}: {value.what}")


def _witnesses(statement: PaperStatement) -> list[Case]:
    return [tuple(map(float, case)) for case in statement.arguments.get("witness", ())]  # type: ignore[misc]


def _models(statement: PaperStatement) -> list[str]:
    return [str(model) for model in statement.arguments.get("models", ())]


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    cases = [(model, case) for case in grid(statement) for model in ("fscm", *_models(statement))]
    cases += [(model, case) for case in _witnesses(statement) for model in ("fem", *_models(statement))]
    return list(dict.fromkeys(call for model, case in cases for call in tasks_of(model, name, case)))


def _error(results: Results, model: str, reference: str, name: str, case: Case) -> Number:
    value, exact = (number(results, one, name, case) for one in (model, reference))
    return relative_error(model, value, reference, exact)


def _near(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Every error is below a limit, or above it if the statement is that the model fails."""
    name = str(statement.arguments["quantity"])
    within = Number(float(statement.arguments["within"]), 0.0, "limit")
    relation = str(statement.arguments.get("relation", "<"))

    def comparisons(reference: str, cases: Sequence[Case], clause: str) -> list[Evidence]:
        return [
            Evidence(clause, reference, _error(results, model, reference, name, case), relation, within)
            for case in cases
            for model in _models(statement)
        ]

    return _by_shape(statement, comparisons)


def _by_shape(statement: PaperStatement, comparisons: Comparisons) -> list[Evidence]:
    rows = []
    for n in statement.numbers("n"):
        for reference, cases in (("fscm", grid(statement)), ("fem", _witnesses(statement))):
            own = [case for case in cases if case[0] == n]
            if own:
                rows.append(replace(decisive(comparisons(reference, own, shape(n))), beyond=statement.beyond(n)))
    return rows


def _small(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The size of a quantity of the references is below a limit."""
    name = str(statement.arguments["quantity"])
    within = Number(float(statement.arguments["within"]), 0.0, "limit")

    def comparisons(reference: str, cases: Sequence[Case], clause: str) -> list[Evidence]:
        return [Evidence(clause, reference, number(results, reference, name, case), "<", within) for case in cases]

    return _by_shape(statement, comparisons)


def _nearer(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The error of the first model is smaller than that of the second, in every case."""
    name = str(statement.arguments["quantity"])
    first, second = _models(statement)

    def comparisons(reference: str, cases: Sequence[Case], clause: str) -> list[Evidence]:
        return [
            Evidence(
                clause,
                reference,
                _error(results, first, reference, name, case),
                "<",
                _error(results, second, reference, name, case),
            )
            for case in cases
        ]

    return _by_shape(statement, comparisons)


def _curve_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(curve, model, *case) for case in grid(statement) for model in ("fscm", *_models(statement))]


def _curve_distances(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The curve of the first model is nearer than that of the second; with a limit, both are within it."""
    rows = []
    for case in grid(statement):
        exact = results[CachedCall.of(curve, "fscm", *case)]
        x, y = (np.array(exact[name]) for name in ("displacement", "load"))
        # Both bounds as shares of the picture, in which the distance is measured.
        own = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
        found = []
        for model in _models(statement):
            path = results[CachedCall.of(curve, model, *case)]
            distance = curve_distance(np.array(path["displacement"]), np.array(path["load"]), x, y)
            u = distance.u_interpolation + 2.0 * own
            found.append(Number(distance.value, u, f"distance of the curves, {model} from fscm, {case_label(case)}"))
        limit = (
            Number(float(statement.arguments["within"]), 0.0, "limit") if "within" in statement.arguments else found[1]
        )
        rows.append(Evidence(shape(case[0]), "fscm", found[0], "<", limit, statement.beyond(case[0])))
    return rows


#: Tests of statements on how near a model is to a reference, by name.
TESTS = {
    "near": StatementTest(_tasks, _near),
    "near_quantity": StatementTest(_tasks, _small),
    "nearer": StatementTest(_tasks, _nearer),
    "curve_distance": StatementTest(_curve_tasks, _curve_distances),
}
