"""Tests of relative errors: how near a model is to the reference, and which of two models is nearer."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from comparisons.data.paper_statements import PaperStatement
from comparisons.numerics.curve_distance import curve_distance
from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import Plan, results_by
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.numbers import (
    Case,
    Comparisons,
    both,
    case_label,
    clause_of,
    families,
    grid,
    models_of,
    numbers,
    quantity_of,
    reading,
    relative_error,
)
from comparisons.paper.tasks import curve

__all__ = ["TESTS"]

_FORCE = "pull_off_force"


def _errors(statement: PaperStatement) -> Plan[dict[tuple[str, Case], list[Number]]]:
    """Plan the errors of each model, by reference and case."""
    models = models_of(statement)
    places = [(model, case) for reference, case in both(statement) for model in (reference, *models)]
    found = yield from numbers(quantity_of(statement), places)
    return {
        (reference, case): [
            relative_error(model, found[model, case], reference, found[reference, case]) for model in models
        ]
        for reference, case in both(statement)
    }


def near(statement: PaperStatement) -> Comparisons:
    """Every error is below a limit, or above it if the statement is that the model fails."""
    relation = str(statement.arguments.get("relation", "<"))
    errors = yield from _errors(statement)
    return [
        Evidence(clause_of(statement, model, case_label(case)), reference, error, relation, reading(statement))
        for (reference, case), of_case in errors.items()
        for model, error in zip(models_of(statement), of_case, strict=True)
    ]


def near_quantity(statement: PaperStatement) -> Comparisons:
    """The size of a quantity of the references is below a limit."""
    found = yield from numbers(quantity_of(statement), both(statement))
    return [
        Evidence(case_label(case), reference, Number(abs(size.value), size.u, size.what), "<", reading(statement))
        for (reference, case), size in found.items()
    ]


def nearer(statement: PaperStatement) -> Comparisons:
    """The error of the first model is smaller than that of the second, in every case."""
    errors = yield from _errors(statement)
    return [
        Evidence(case_label(case), reference, first, "<", second)
        for (reference, case), (first, second) in errors.items()
    ]


def force_above(statement: PaperStatement) -> Comparisons:
    """The force of the improved Maugis-Dugdale model is above that of the reference."""
    model = "md-improved"
    force = yield from numbers(_FORCE, [(one, case) for case in grid(statement) for one in ("fscm", model)])
    return [
        Evidence(case_label(case), "fscm", force[model, case], ">", force["fscm", case]) for case in grid(statement)
    ]


def curve_distances(statement: PaperStatement) -> Comparisons:
    """The curve of the first model is nearer than that of the second; with a limit, the first is within it."""
    models = models_of(statement)
    paths = yield from results_by(
        {(model, case): CachedCall.of(curve, model, *case) for case in grid(statement) for model in ("fscm", *models)}
    )
    rows = []
    for case in grid(statement):
        exact = paths["fscm", case]
        x, y = (np.array(exact[name]) for name in ("displacement", "load"))
        # Both bounds as shares of the picture, in which the distance is measured.
        bound = exact["u_displacement"] / np.ptp(x) + exact["u_load"] / np.ptp(y)
        distances = []
        for model in models:
            their_x, their_y = (np.array(paths[model, case][name]) for name in ("displacement", "load"))
            distance = curve_distance(their_x, their_y, x, y)
            what = f"distance of the curves, {model} from fscm, {case_label(case)}"
            distances.append(Number(distance.value, distance.u_interpolation + 2.0 * bound, what))
        limit = reading(statement) if "within" in statement.arguments else distances[1]
        rows.append(Evidence(case_label(case), "fscm", distances[0], "<", limit))
    return rows


def sensitivity_to_k(statement: PaperStatement) -> Comparisons:
    """Largest deviation from the homogeneous solid: below the limit for some shapes, above it for the others."""
    homogeneous = [(n, 0.0, mu) for n in statement.numbers("n") for mu in statement.numbers("mu")]
    force = yield from numbers(_FORCE, [("fscm", case) for case in (*grid(statement), *homogeneous)])
    rows = []
    for n in statement.numbers("n"):
        errors = [
            relative_error("the graded solid", force["fscm", case], "k = 0", force["fscm", (n, 0.0, case[2])])
            for case in grid(statement)
            if case[0] == n
        ]
        largest = max(errors, key=lambda error: error.value)
        relation = "<" if n in statement.numbers("small_for") else ">"
        rows.append(Evidence(f"n = {n:g}", "fscm", largest, relation, reading(statement), comparisons=len(errors)))
    return rows


def jkr_earlier_with_k(statement: PaperStatement) -> Comparisons:
    """The relative distance of the force from JKR's falls with k at every Tabor number."""
    force = yield from numbers(_FORCE, [(model, case) for case in grid(statement) for model in ("fscm", "jkr")])
    rows = []
    for label, cases in families(grid(statement), "k").items():
        errors = [relative_error("fscm", force["fscm", case], "jkr", force["jkr", case]) for case in cases]
        rows += [Evidence(label, "fscm", later, "<", earlier) for earlier, later in pairwise(errors)]
    return rows


#: Tests of statements on how near a model is to a reference, by name.
TESTS = {
    "near": near,
    "near_quantity": near_quantity,
    "nearer": nearer,
    "force_above": force_above,
    "curve_distance": curve_distances,
    "sensitivity_to_k": sensitivity_to_k,
    "jkr_earlier_with_k": jkr_earlier_with_k,
}
