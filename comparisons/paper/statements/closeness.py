"""Tests of relative errors: how near a model is to the reference, and which of two models is nearer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from comparisons.data.paper_statements import PaperStatement
from comparisons.numerics.curve_distance import curve_distance
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import (
    Case,
    StatementTest,
    case_label,
    grid,
    number,
    reading,
    tasks_of,
    witnesses,
)
from comparisons.paper.tasks import curve

__all__ = ["TESTS", "clause_of", "models_of", "relative_error", "signed_error"]


def signed_error(model: str, value: Number, reference: str, exact: Number) -> Number:
    """Return the relative error of a value, with the bound that both bounds give it.

    Examples
    --------
    >>> error = signed_error("jkr", Number(0.9, 0.0, "force"), "fscm", Number(1.0, 0.01, "force"))
    >>> round(error.value, 12), round(error.u, 12)
    (-0.1, 0.011111111111)
    """
    kappa = value.value / exact.value - 1.0
    u = (value.u + (1.0 + abs(kappa)) * exact.u) / (abs(exact.value) - exact.u)
    return Number(kappa, u, f"relative error of {model} against {reference}: {value.what}")


def relative_error(model: str, value: Number, reference: str, exact: Number) -> Number:
    """Return the size of the relative error of a value, with the bound that both bounds give it.

    Examples
    --------
    >>> error = relative_error("jkr", Number(1.1, 0.0, "force"), "fscm", Number(1.0, 0.01, "force"))
    >>> round(error.value, 12), round(error.u, 12)
    (0.1, 0.011111111111)
    """
    error = signed_error(model, value, reference, exact)
    return Number(abs(error.value), error.u, error.what)


def models_of(statement: PaperStatement) -> list[str]:
    """Return the models that a statement is about, besides the references."""
    return [str(model) for model in statement.arguments.get("models", ())]


def clause_of(statement: PaperStatement, model: str, label: str) -> str:
    """Return the clause of a case: with the model, if the statement is about several of them."""
    return f"{model}: {label}" if len(models_of(statement)) > 1 else label


def _referred(statement: PaperStatement) -> list[tuple[str, Case]]:
    """Every case with each reference that computes it."""
    return [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    calls = [
        call
        for reference, case in _referred(statement)
        for model in (reference, *models_of(statement))
        for call in tasks_of(model, name, case)
    ]
    return list(dict.fromkeys(calls))


def _error(results: Results, model: str, reference: str, name: str, case: Case) -> Number:
    value, exact = (number(results, one, name, case) for one in (model, reference))
    return relative_error(model, value, reference, exact)


def _near(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Every error is below a limit, or above it if the statement is that the model fails."""
    name = str(statement.arguments["quantity"])
    relation = str(statement.arguments.get("relation", "<"))
    return [
        Evidence(
            clause_of(statement, model, case_label(case)),
            reference,
            _error(results, model, reference, name, case),
            relation,
            reading(statement),
        )
        for reference, case in _referred(statement)
        for model in models_of(statement)
    ]


def _small(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The size of a quantity of the references is below a limit."""
    name = str(statement.arguments["quantity"])
    rows = []
    for reference, case in _referred(statement):
        value = number(results, reference, name, case)
        size = Number(abs(value.value), value.u, value.what)
        rows.append(Evidence(case_label(case), reference, size, "<", reading(statement)))
    return rows


def _nearer(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The error of the first model is smaller than that of the second, in every case."""
    name = str(statement.arguments["quantity"])
    first, second = models_of(statement)
    return [
        Evidence(
            case_label(case),
            reference,
            _error(results, first, reference, name, case),
            "<",
            _error(results, second, reference, name, case),
        )
        for reference, case in _referred(statement)
    ]


def _curve_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [CachedCall.of(curve, model, *case) for case in grid(statement) for model in ("fscm", *models_of(statement))]


def _curve_distances(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The curve of the first model is nearer than that of the second; with a limit, the first is within it."""
    rows = []
    for case in grid(statement):
        exact = results[CachedCall.of(curve, "fscm", *case)]
        x, y = (np.array(exact[name]) for name in ("displacement", "load"))
        # Both bounds as shares of the picture, in which the distance is measured.
        own = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
        distances = []
        for model in models_of(statement):
            path = results[CachedCall.of(curve, model, *case)]
            distance = curve_distance(np.array(path["displacement"]), np.array(path["load"]), x, y)
            u = distance.u_interpolation + 2.0 * own
            what = f"distance of the curves, {model} from fscm, {case_label(case)}"
            distances.append(Number(distance.value, u, what))
        limit = reading(statement) if "within" in statement.arguments else distances[1]
        rows.append(Evidence(case_label(case), "fscm", distances[0], "<", limit))
    return rows


#: Tests of statements on how near a model is to a reference, by name.
TESTS = {
    "near": StatementTest(_tasks, _near),
    "near_quantity": StatementTest(_tasks, _small),
    "nearer": StatementTest(_tasks, _nearer),
    "curve_distance": StatementTest(_curve_tasks, _curve_distances),
}
