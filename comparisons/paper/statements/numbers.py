"""Numbers that statements are about: cases, quantities of the models, and what is derived from them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import product
from typing import Any

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import QUANTITIES as JUMPS
from comparisons.paper.figures.fig08_jumps import jumps
from comparisons.paper.paper_figure import Plan
from comparisons.paper.statements.evidence import READING, Evidence, Number
from comparisons.paper.tasks import quantity
from comparisons.quantities import title_of

__all__ = ["Case", "Comparisons", "StatementTest", "number", "numbers", "relative_error", "tasks_of"]

#: Shape index, gradient exponent and Tabor number.
Case = tuple[float, float, float]
#: Their names, in this order.
PARAMETERS = ("n", "k", "mu")

#: The comparisons of a statement.
Comparisons = Plan[list[Evidence]]
#: A test: it plans the comparisons of a statement.
StatementTest = Callable[[PaperStatement], Comparisons]


def grid(statement: PaperStatement) -> list[Case]:
    """Return the statement's ``cases`` and every combination of its n, k and mu."""
    n, k, mu = (statement.numbers(name) for name in PARAMETERS)
    return [*_cases(statement, "cases"), *product(n, k, mu)]


def witnesses(statement: PaperStatement) -> list[Case]:
    """Return the cases that the finite elements compute, too."""
    return _cases(statement, "witness")


def _cases(statement: PaperStatement, name: str) -> list[Case]:
    return [(float(n), float(k), float(mu)) for n, k, mu in statement.arguments.get(name, ())]


def both(statement: PaperStatement) -> list[tuple[str, Case]]:
    """Return every case with each reference that computes it."""
    return [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]


def case_keys(case: Case) -> dict[str, float]:
    """Return the parameters of a case by their names."""
    return dict(zip(PARAMETERS, case, strict=True))


def case_label(case: Case) -> str:
    """Return e.g. ``n = 2, k = 0.4, mu = 1``."""
    return "n = {:g}, k = {:g}, mu = {:g}".format(*case)


def family_label(case: Case, along: str) -> str:
    """Return the label of the cases that differ in one parameter.

    Examples
    --------
    >>> family_label((2.0, 0.4, 1.0), "mu")
    'n = 2, k = 0.4'
    """
    return ", ".join(f"{name} = {value:g}" for name, value in case_keys(case).items() if name != along)


def families(cases: Iterable[Case], along: str) -> dict[str, list[Case]]:
    """Return the cases that differ in one parameter only, in its order, by their label."""
    of_label: dict[str, list[Case]] = {}
    for case in cases:
        of_label.setdefault(family_label(case, along), []).append(case)
    return {label: sorted(family, key=lambda case: case_keys(case)[along]) for label, family in of_label.items()}


def quantity_of(statement: PaperStatement) -> str:
    """Return the quantity that a statement is about."""
    return str(statement.arguments["quantity"])


def models_of(statement: PaperStatement) -> list[str]:
    """Return the models that a statement is about, besides the references."""
    return [str(model) for model in statement.arguments.get("models", ())]


def clause_of(statement: PaperStatement, model: str, label: str) -> str:
    """Return the clause of a case: with the model, if the statement is about several of them."""
    return f"{model}: {label}" if len(models_of(statement)) > 1 else label


def reading(statement: PaperStatement) -> Number:
    """Return the number as which a word of the statement is read."""
    return Number(float(statement.arguments["within"]), 0.0, READING)


def _difference(first: Number, second: Number) -> tuple[float, float]:
    return first.value - second.value, first.u + second.u


def _share(gap: Number, displacement: Number) -> tuple[float, float]:
    """Deformation at the centre, w(0) = H_0 + delta (Eq. 4), over the gap there."""
    share = abs(gap.value + displacement.value) / abs(gap.value)
    return share, (gap.u + displacement.u + share * gap.u) / abs(gap.value)


#: Quantity -> its name, the two quantities that it is of, and how.
_DERIVED: Mapping[str, tuple[str, str, str, Callable[[Number, Number], tuple[float, float]]]] = {
    "jump_distance": (
        "displacement at jump-in minus that at jump-out",
        "jump_in_displacement",
        "jump_out_displacement",
        _difference,
    ),
    "jump_in_deformation": (
        "deformation at the centre over the gap there, at jump-in",
        "jump_in_gap",
        "jump_in_displacement",
        _share,
    ),
}


def tasks_of(model: str, name: str, case: Case) -> list[CachedCall]:
    """Return the calls for a quantity of a model."""
    if name in _DERIVED:
        _, first, second, _ = _DERIVED[name]
        return [*tasks_of(model, first, case), *tasks_of(model, second, case)]
    if model == "fscm" and name in JUMPS:
        return [CachedCall.of(jumps, *case)]
    return [CachedCall.of(quantity, model, name, *case)]


def number(results: Results, model: str, name: str, case: Case) -> Number:
    """Return a quantity of a model.

    Raises
    ------
    comparisons.model.ComputationFailed
        If it was not computed.
    """
    if name in _DERIVED:
        title, first, second, of = _DERIVED[name]
        value, u = of(number(results, model, first, case), number(results, model, second, case))
        return Number(value, u, f"{title}, {case_label(case)}")
    (call,) = tasks_of(model, name, case)
    result: dict[str, Any] = results[call]
    what = f"{title_of(name)}, {case_label(case)}"
    if model == "fscm" and name in JUMPS:
        return Number(result[name], result[f"u_{name}"], what)
    if result["status"] != "ok":
        return Number(float("nan"), float("nan"), f"{what}: {result['reason']}")
    return Number(result["value"], result["u_num"], what)


def numbers(name: str, places: Iterable[tuple[str, Case]]) -> Plan[dict[tuple[str, Case], Number]]:
    """Plan a quantity by models in cases."""
    known = list(dict.fromkeys(places))
    results = yield [call for model, case in known for call in tasks_of(model, name, case)]
    return {(model, case): number(results, model, name, case) for model, case in known}


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
    """Return the size of the relative error of a value, with its bound."""
    error = signed_error(model, value, reference, exact)
    return Number(abs(error.value), error.u, error.what)


def lacking(scheme: Mapping[str, float], exact: Number) -> Number:
    """Return the share of a pull-off force that a scheme lacks."""
    what = f"share of the pull-off force that the scheme with f(r_max) = 50 lacks, {exact.what.partition(', ')[2]}"
    return Number(abs(1.0 - scheme["force"] / exact.value), (scheme["u_num"] + exact.u) / exact.value, what)
