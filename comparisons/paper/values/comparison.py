"""Verdicts on the numbers that the paper prints, and the causes of the differences."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from comparisons.data.paper_values import REPRODUCED, TRUNCATED, PaperValue, paper_values
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import eta
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.numerics.number_text import LEAST_SHOWN, value_text
from comparisons.output.fitted_table import FittedTable
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.tables import rich_table
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity
from comparisons.paper.values.causes import Repeated, frame, repeated, tasks
from comparisons.runs.cases import Case
from fscm.laws import LennardJones93

__all__ = ["BY_GRID", "BY_SCHEME", "PAPER_VALUES", "cause", "explained", "judged"]

#: Verdicts on a number whose converged value has other digits, but that follows from what the paper states of its
#: computation, or from steps and ranges of n, k or mu that it does not state.
BY_SCHEME, BY_GRID = "agrees with the paper's scheme", "agrees on a grid"

Number = tuple[float, float]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS


def _critical(paper_value: PaperValue) -> CachedCall:
    # The Tabor number of the case is not used.
    return CachedCall.of(quantity, "fscm", "critical_tabor_number", paper_value.n, paper_value.k, 1.0)


def _tasks() -> Sequence[CachedCall]:
    return [*map(_critical, paper_values("critical_tabor_number")), *tasks()]


def _closed(value: float) -> Number:
    return value, _ROUNDING * abs(value)


def _strength(paper_value: PaperValue) -> Number:
    law = LennardJones93()
    return _closed(-float(law.traction(np.array(law.peak_gap))))


def _bradley(paper_value: PaperValue) -> Number:
    found = quantity("bradley", "pull_off_force", paper_value.n, 0.0, 1.0)
    return found["value"], found["u_num"]


def _farthest(values: Sequence[float], paper_value: PaperValue) -> Number:
    """Return the value that is farthest from the printed one: the limit is the same for all shape indices."""
    return _closed(max(values, key=lambda value: abs(value - paper_value.value)))


def _jump_out(paper_value: PaperValue) -> Number:
    cases = [Case(n, 1.0, 1.0).problem() for n in _SHAPES]
    return _farthest([-JKR().evaluate(case, "jump_out_displacement").value for case in cases], paper_value)


def _exponent(paper_value: PaperValue) -> Number:
    """Slope of log(1 - displacement) over log(mu); the difference of two logarithms loses a digit."""
    low, high = (
        math.log(1.0 - SemiRigid().evaluate(case.problem(), "jump_in_displacement").value)
        for case in (Case(paper_value.n, paper_value.k, mu) for mu in (1.0, math.e**7))
    )
    return _closed((high - low) / 7.0)


#: How each number is computed that needs no long computation and has no rows of causes.
_DIRECT: dict[str, Callable[[PaperValue], Number]] = {
    "theoretical_strength": _strength,
    "bradley_pull_off": _bradley,
    "eta": lambda paper_value: _closed(eta(paper_value.n)),
    "jump_in_limit": lambda paper_value: _farthest([jump_in_coefficient(n, 1.0) for n in _SHAPES], paper_value),
    "jump_out_limit": _jump_out,
    "jump_in_prefactor": lambda paper_value: _closed(jump_in_coefficient(paper_value.n, paper_value.k)),
    "jump_in_exponent": _exponent,
}


def explained(rows: Sequence[Repeated]) -> str:
    """Return the verdict on a number that has repetitions.

    Parameters
    ----------
    rows : sequence of Repeated
        Of one number, the converged one first.
    """
    converged, *others = rows
    if converged.verdict == "agrees":
        return converged.verdict
    for verdict, stated in ((BY_SCHEME, True), (BY_GRID, False)):
        if any(row.verdict == "agrees" for row in others if row.stated == stated):
            return verdict
    return converged.verdict


def cause(rows: Sequence[Repeated], companions: Sequence[Repeated] = ()) -> str:
    """Return which ingredient gives the printed digits, in a sentence; empty if the first row has them.

    Parameters
    ----------
    rows : sequence of Repeated
        Of one number, the converged one first, then simple ingredients before combined ones.
    companions : sequence of Repeated
        Of the numbers that the same computation printed: an ingredient that the paper does not state and that takes
        the printed digits from one of them is no cause.
    """
    converged, *others = rows
    if converged.verdict == "agrees":
        return ""
    stated = [row for row in others if row.stated]
    reproducing = [row for row in stated if row.verdict == "agrees"] or [
        row for row in stated if row.verdict in REPRODUCED and converged.verdict == "differs"
    ]
    if reproducing:
        sentence = f"reproduced by {_with_value(reproducing[0])}"
        against = stated[0]
        # The plainest statement of the paper, the size of the domain, may increase the difference.
        known = against.verdict in REPRODUCED or against.ingredient in sentence
        return sentence if known else f"{sentence}; {_alone(against)}"
    unstated = [row for row in others if row.verdict in (REPRODUCED if converged.verdict == "differs" else ("agrees",))]
    against_another = {row.ingredient: row for row in companions if not row.stated and row.verdict not in REPRODUCED}
    elsewhere = " or ".join(_with_value(row) for row in unstated if row.ingredient not in against_another)
    contradicted = "".join(
        f"; not {_with_value(row)}, which gives {abs(other.value):.5g} for the printed {other.paper_value.text}"
        for row in unstated
        for other in [against_another.get(row.ingredient)]
        if other is not None
    )
    plain = f"; {_alone(stated[0])}" if stated else ""
    if not elsewhere:
        nearest = min(others, key=lambda row: abs(abs(row.value) - converged.paper_value.value))
        return f"not reproduced; nearest is {_with_value(nearest)}{plain}"
    return f"nothing the paper states gives it; these do: {elsewhere}{contradicted}{plain}"


def _with_value(row: Repeated) -> str:
    truncated = f", {TRUNCATED}" if row.verdict == TRUNCATED else ""
    return f"{row.ingredient} ({abs(row.value):.5g}{truncated})"


def _alone(row: Repeated) -> str:
    return f"{row.ingredient} alone gives {abs(row.value):.5g}"


def _tables(results: Results) -> Tables:
    again = repeated(results)
    rows = [judged(paper_value, results, again) for paper_value in paper_values()]
    return {"": pd.DataFrame(rows), "causes": frame(again)}


def judged(paper_value: PaperValue, results: Results, again: Sequence[Repeated]) -> dict[str, str | float]:
    """Return the row of a paper value; `again` holds the repetitions of the values that have any."""
    rows = [row for row in again if row.paper_value == paper_value]
    companions = [row for row in again if _same_shape(row.paper_value, paper_value)]
    mu = math.nan
    if rows:
        computed, u, mu = rows[0].value, rows[0].u, rows[0].mu
    elif paper_value.name in _DIRECT:
        computed, u = _DIRECT[paper_value.name](paper_value)
    else:
        found = results[_critical(paper_value)]
        computed, u = found["value"], found["u_num"]
    # The paper prints the largest errors without their sign.
    size = abs(computed)
    return {
        "where": paper_value.source,
        "quantity": paper_value.quantity,
        "model": paper_value.model,
        "n": paper_value.n,
        "k": paper_value.k,
        "unit": paper_value.unit,
        "printed": paper_value.text,
        "computed": computed,
        "u": u,
        "at_mu": mu,
        "verdict": explained(rows) if rows else paper_value.verdict(size, u),
        "difference": size - paper_value.value,
        "cause": cause(rows, companions) if rows else "",
    }


def _same_shape(one: PaperValue, other: PaperValue) -> bool:
    """Whether two numbers are errors of two models at one shape: both came from one FSCM computation."""
    return one != other and one.quantity == other.quantity and bool(one.model) and (one.n, one.k) == (other.n, other.k)


def readable(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table as texts, the computed number with the digits that its uncertainty leaves."""

    def case(row: pd.Series) -> str:
        parts = [f"{name} = {row[name]:g}" for name in ("n", "k") if not math.isnan(row[name])]
        return ", ".join([*parts, *([row["model"]] if row["model"] else [])])

    def computed(row: pd.Series) -> str:
        return in_unit(value_text(row["computed"], row["u"]), row["unit"])

    def difference(row: pd.Series) -> str:
        small = abs(row["difference"]) <= LEAST_SHOWN
        return "0" if small else in_unit(f"{row['difference']:+.2g}", row["unit"])

    def in_unit(text: str, unit: str) -> str:
        return f"{text} {unit}" if unit else text

    return pd.DataFrame(
        {
            "where": table["where"],
            "quantity": table["quantity"],
            "case": table.apply(case, axis=1),
            "printed": table.apply(lambda row: in_unit(row["printed"], row["unit"]), axis=1),
            "computed": table.apply(computed, axis=1),
            "verdict": table["verdict"],
            "difference": table.apply(difference, axis=1),
            "cause": table["cause"],
        }
    )


_TITLE = "Numbers printed in the paper, computed again"
_NOTES = (
    "In brackets: a bound on the error in units of the last digit, at least 5e-10. Difference: of the sizes. Agrees if "
    "truncated: the digits agree if further ones are dropped. In the causes f(r_max) is the height of the punch, in "
    "z0, where the paper's integration ends, and sigma_0 the cohesive stress. Agrees with the paper's scheme: "
    "the digits follow from what the paper states of its computation. Agrees on a grid: they follow from steps or "
    "ranges of n, k or mu that the paper does not state."
)


def _texts(tables: Tables) -> dict[str, str]:
    shown = readable(tables[""])
    text = latex(shown, f"{_TITLE}. {_NOTES}", "paper-values")
    return {".md": f"{markdown(shown, _TITLE)}\n{_NOTES}\n", ".tex": text}


def _shown(tables: Tables) -> FittedTable:
    return rich_table(readable(tables[""]), _TITLE)


PAPER_VALUES = PaperFigure(
    name="numbers",
    stem="paper_values",
    title="Numbers that the paper prints, a verdict on each, and the ingredients that change those that differ",
    tasks=_tasks,
    tables=_tables,
    draw=None,
    texts=_texts,
    shown=_shown,
)
