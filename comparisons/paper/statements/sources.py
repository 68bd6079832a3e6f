"""Numbers that statements are about: cached calls of the models, and quantities derived from their results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import QUANTITIES as JUMPS
from comparisons.paper.figures.fig08_jumps import jumps
from comparisons.paper.statements.evidence import READING, Evidence, Number
from comparisons.paper.tasks import quantity
from comparisons.quantities import title_of

__all__ = [
    "PARAMETERS",
    "Case",
    "StatementTest",
    "case_label",
    "family_label",
    "grid",
    "missing_in",
    "number",
    "reading",
    "tasks_of",
    "witnesses",
]

#: Shape index, gradient exponent and Tabor number.
Case = tuple[float, float, float]
#: Their names, in this order.
PARAMETERS = ("n", "k", "mu")


@dataclass(frozen=True, slots=True)
class StatementTest:
    """A test: the calls that it needs for a statement, and the evidence from their results."""

    tasks: Callable[[PaperStatement], Sequence[CachedCall]]
    evidence: Callable[[PaperStatement, Results], Sequence[Evidence]]


def grid(statement: PaperStatement) -> list[Case]:
    """Return the statement's ``cases`` and every combination of its n, k and mu."""
    n, k, mu = (statement.numbers(name) for name in PARAMETERS)
    return [*_cases(statement, "cases"), *((a, b, c) for a in n for b in k for c in mu)]


def witnesses(statement: PaperStatement) -> list[Case]:
    """Return the cases that the finite elements compute, too."""
    return _cases(statement, "witness")


def _cases(statement: PaperStatement, name: str) -> list[Case]:
    return [(float(n), float(k), float(mu)) for n, k, mu in statement.arguments.get(name, ())]


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
    return ", ".join(f"{name} = {value:g}" for name, value in zip(PARAMETERS, case, strict=True) if name != along)


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
_DERIVED: dict[str, tuple[str, str, str, Callable[[Number, Number], tuple[float, float]]]] = {
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
        return list(dict.fromkeys([*tasks_of(model, first, case), *tasks_of(model, second, case)]))
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
    result = results[call]
    what = f"{title_of(name)}, {case_label(case)}"
    if model == "fscm" and name in JUMPS:
        return Number(result[name], result[f"u_{name}"], what)
    if result["status"] != "ok":
        return Number(float("nan"), float("nan"), f"{what}: {result['reason']}")
    return Number(result["value"], result["u_num"], what)


def missing_in(results: Results, model: str, name: str, case: Case) -> bool:
    """Return whether a model refuses a quantity in a case: what it is of does not exist there."""
    (call,) = tasks_of(model, name, case)
    return bool(results[call]["status"] == "not-applicable")
