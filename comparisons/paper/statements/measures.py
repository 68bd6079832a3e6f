"""Numbers that statements are about, each with the bound on its error and the words of what it is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from comparisons.models.closed_form import EPS
from comparisons.paper.paper_figure import Plan, result_of, together
from comparisons.paper.solver_tasks import JUMPS, jumps
from comparisons.paper.statements.evidence import Number
from comparisons.paper.tasks import quantity
from comparisons.quantities import title_of

__all__ = [
    "MEASURES",
    "ROUNDING",
    "Case",
    "Made",
    "label",
    "measure",
    "measured",
    "model_of",
    "named",
    "of_case",
    "table_of",
    "two",
]

#: Parameters of a case with their names, in order.
Case = tuple[tuple[str, float], ...]


#: What a measure makes: value and bound, and what it is of if that is not the measure's title with the case.
Made = Plan[Any]


class Measure(NamedTuple):
    """A number of a case.

    Attributes
    ----------
    title : str
        What it is of; `{0}`, ... are the arguments of the term, `{reference}` is the model.
    model : str
        Whose number it is if not of a reference: "formula" or a model.
    plan : callable
        Of the reference, the parameters and the arguments of the term.
    """

    title: str
    model: str
    plan: Callable[..., Made]


#: Measures by name; every other name is that of a quantity.
MEASURES: dict[str, Measure] = {}

#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
ROUNDING = 64.0 * EPS


def label(case: Case, without: str = "") -> str:
    """Return the parameters of a case as a text.

    Examples
    --------
    >>> label((("n", 2.0), ("k", 0.4)))
    'n = 2, k = 0.4'
    """
    return ", ".join(f"{name} = {value:g}" for name, value in case if name != without)


def measure(title: str, model: str = "") -> Callable[[Callable[..., Made]], Callable[..., Made]]:
    """Register a measure by the name of its function."""

    def register(plan: Callable[..., Made]) -> Callable[..., Made]:
        MEASURES[plan.__name__] = Measure(title, model, plan)
        return plan

    return register


def _measure_of(term: str) -> tuple[Measure, list[str]]:
    name, *arguments = term.split()
    return (MEASURES[name], arguments) if name in MEASURES else (MEASURES["quantity_of"], [name, *arguments])


def model_of(term: str) -> str:
    """Return the model of a term that is not of a reference, else nothing."""
    return _measure_of(term)[0].model


def measured(term: str, reference: str, case: Case) -> Plan[Number]:
    """Plan the number of a term, as ``relative_error pull_off_force jkr``, by a reference in a case."""
    (title, _, plan), arguments = _measure_of(term)
    value, u, *what = yield from plan(reference, dict(case), *arguments)
    title = title.format(*arguments, reference=reference)
    return Number(float(value), float(u), what[0] if what else f"{title}, {label(case)}")


def of_case(case: dict[str, float]) -> tuple[float, float, float]:
    """Return n, k and mu of a case."""
    return case["n"], case["k"], case["mu"]


def named(n: float, k: float, mu: float) -> Case:
    """Return a case of three parameters."""
    return (("n", n), ("k", k), ("mu", mu))


def table_of(places: list[tuple[str, dict[str, str], Case]], **terms: str) -> Plan[pd.DataFrame]:
    """Plan a table of references in cases: what else the row says, and a column and its ``u_`` for each term."""
    columns = [f"{u}{name}" for name in terms for u in ("", "u_")]
    numbers = yield from together(
        {
            (index, name): measured(term.format(**keys), reference, case)
            for index, (reference, keys, case) in enumerate(places)
            for name, term in terms.items()
        }
    )
    rows = [
        {"reference": reference, **keys, **dict(case)}
        | dict(zip(columns, (number for name in terms for number in numbers[index, name][:2]), strict=True))
        for index, (reference, keys, case) in enumerate(places)
    ]
    return pd.DataFrame(rows)


@measure("")
def quantity_of(reference: str, case: dict[str, float], name: str, model: str = "") -> Made:
    """A quantity of the reference, or of another model."""
    what = f"{title_of(name)}, {label(tuple(case.items()))}"
    model = model or reference
    if model == "fscm" and name in JUMPS:
        both = yield from result_of(jumps, *of_case(case))
        return both[name], both[f"u_{name}"], what
    result = yield from result_of(quantity, model, name, *of_case(case))
    if result["status"] != "ok":
        return np.nan, np.nan, f"{what}: {result['reason']}"
    return result["value"], result["u_num"], what


def two(reference: str, case: dict[str, float], term: str, against: str) -> Plan[tuple[Number, Number]]:
    """Plan two terms of the same case."""
    both = yield from together({name: measured(name, reference, tuple(case.items())) for name in (term, against)})
    return both[term], both[against]


@measure("displacement at jump-in minus that at jump-out")
def jump_distance(reference: str, case: dict[str, float]) -> Made:
    inward, outward = yield from two(reference, case, "jump_in_displacement", "jump_out_displacement")
    return inward.value - outward.value, inward.u + outward.u


@measure("deformation at the centre over the gap there, at jump-in")
def jump_in_deformation(reference: str, case: dict[str, float]) -> Made:
    """w(0) = H_0 + delta (Eq. 4)."""
    gap, displacement = yield from two(reference, case, "jump_in_gap", "jump_in_displacement")
    share = abs(gap.value + displacement.value) / abs(gap.value)
    return share, (gap.u + displacement.u + share * gap.u) / abs(gap.value)


@measure("")
def size(reference: str, case: dict[str, float], name: str) -> Made:
    number = yield from measured(name, reference, tuple(case.items()))
    return abs(number.value), number.u, f"size of {number.what}"


def signed(value: Number, exact: Number) -> tuple[float, float]:
    """Return the relative error of a value, with the bound that both bounds give it.

    Examples
    --------
    >>> signed(Number(0.75, 0.0, "force"), Number(1.0, 0.0, "force"))
    (-0.25, 0.0)
    """
    kappa = value.value / exact.value - 1.0
    return kappa, (value.u + (1.0 + abs(kappa)) * exact.u) / (abs(exact.value) - exact.u)


@measure("")
def signed_error(reference: str, case: dict[str, float], name: str, model: str, against: str = "") -> Made:
    against = against or reference
    value, exact = yield from two(reference, case, f"{name} {model}", f"{name} {against}")
    return *signed(value, exact), f"relative error of {model} against {against}: {value.what}"


@measure("")
def relative_error(reference: str, case: dict[str, float], *of: str) -> Made:
    kappa, u, what = yield from signed_error(reference, case, *of)
    return abs(kappa), u, what


@measure("")
def difference(reference: str, case: dict[str, float], name: str, model: str) -> Made:
    value, exact = yield from two(reference, case, f"{name} {model}", name)
    return exact.value - value.value, exact.u + value.u, f"difference of {model} from {reference}: {value.what}"


@measure("")
def gradient_error(reference: str, case: dict[str, float], name: str) -> Made:
    """Deviation from the homogeneous solid of the same Tabor number."""
    cases = [tuple(of.items()) for of in (case, case | {"k": 0.0})]
    graded, homogeneous = (yield from together({of: measured(name, reference, of) for of in cases})).values()
    kappa, u = signed(graded, homogeneous)
    return abs(kappa), u, f"relative error of the graded solid against k = 0: {graded.what}"


@measure("")
def power_of_mu(reference: str, case: dict[str, float], name: str) -> Made:
    """Difference of the power of mu, between it and its double, from that of the asymptote."""
    n, k, mu = of_case(case)
    cases = [named(n, k, at) for at in (mu, 2.0 * mu)]
    small, large = (yield from together({of: measured(name, reference, of) for of in cases})).values()
    # Eq. 47 is 1 - C mu^p; Eq. 54 is -C mu.
    is_jump_in = name == "jump_in_displacement"
    shift, expected = (1.0, (2 * n + k - 1) / (4 * n + k - 1)) if is_jump_in else (0.0, 1.0)
    steps = np.log(2.0)
    power = np.log((shift - large.value) / (shift - small.value)) / steps
    u = (small.u / (shift - small.value) + large.u / (shift - large.value)) / steps
    where = f"n = {n:g}, k = {k:g}, mu from {mu:g} to {2.0 * mu:g}"
    return power - expected, u, f"difference of the power {power:.4f} of mu from {expected:.4f}, {where}"


@measure("")
def critical_difference(reference: str, case: dict[str, float], printed: str) -> Made:
    # The Tabor number of the case is not used.
    critical = yield from result_of(quantity, reference, "critical_tabor_number", case["n"], case["k"], 1.0)
    what = f"difference of the critical Tabor number {critical['value']:.6f} from {float(printed):g}"
    return abs(critical["value"] - float(printed)), critical["u_num"], what
