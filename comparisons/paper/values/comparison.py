"""Verdicts on the numbers that the paper prints: on the converged numbers, and on those of one scheme a figure."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import eta
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.numerics.number_text import LEAST_SHOWN, value_text
from comparisons.output.terminal import records
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, calls_of, given, texts_of
from comparisons.paper.tasks import quantity
from comparisons.paper.values.causes import Repeated, frame, repeated
from comparisons.problem import Problem
from fscm.laws import LennardJones

__all__ = ["PAPER_VALUES", "judged"]

Number = tuple[float, float]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS


def _critical(paper_value: PaperValue) -> CachedCall:
    # The Tabor number of the case is not used.
    return CachedCall.of(quantity, "fscm", "critical_tabor_number", paper_value.n, paper_value.k, 1.0)


def _closed(value: float) -> Number:
    return value, _ROUNDING * abs(value)


def _strength(paper_value: PaperValue) -> Number:
    law = LennardJones()
    return _closed(-float(law.traction(np.array(law.peak_gap))))


def _bradley(paper_value: PaperValue) -> Number:
    found = quantity("bradley", "pull_off_force", paper_value.n, 0.0, 1.0)
    return found["value"], found["u_num"]


def _farthest(values: Sequence[float], paper_value: PaperValue) -> Number:
    """Return the value that is farthest from the printed one: the limit is the same for all shape indices."""
    return _closed(max(values, key=lambda value: abs(value - paper_value.value)))


def _jump_out(paper_value: PaperValue) -> Number:
    cases = [Problem.dimensionless(n, 1.0, 1.0) for n in _SHAPES]
    return _farthest([-JKR().evaluate(case, "jump_out_displacement").value for case in cases], paper_value)


def _exponent(paper_value: PaperValue) -> Number:
    """Slope of log(1 - displacement) over log(mu); the difference of two logarithms loses a digit."""
    low, high = (
        math.log(1.0 - SemiRigid().evaluate(case, "jump_in_displacement").value)
        for case in (Problem.dimensionless(paper_value.n, paper_value.k, mu) for mu in (1.0, math.e**7))
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


def _plan() -> Plan[Tables]:
    results = yield [*map(_critical, paper_values("critical_tabor_number")), *calls_of(repeated())]
    again = given(repeated(), results)
    rows = [judged(paper_value, results, again) for paper_value in paper_values()]
    return {"": pd.DataFrame(rows), "causes": frame(again)}


def judged(paper_value: PaperValue, results: Results, again: Sequence[Repeated]) -> dict[str, str | float]:
    """Return the row of a paper value; `again` holds the repetitions of the values that have any."""
    rows = [row for row in again if row.paper_value == paper_value]
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
        **{name: getattr(paper_value, name) for name in ("quantity", "model", "n", "k", "unit")},
        "printed": paper_value.text,
        "computed": computed,
        "u": u,
        "at_mu": mu,
        "verdict": paper_value.verdict(size, u),
        "difference": size - paper_value.value,
        **_of_scheme(rows),
    }


def _of_scheme(rows: Sequence[Repeated]) -> dict[str, str | float]:
    """Return what the scheme of the figure gives, and the verdict on that; empty for a number without a scheme."""
    for row in (row for row in rows if row.scheme):
        return {"scheme": row.ingredient, "by_scheme": row.value, "u_scheme": row.u, "scheme_verdict": row.verdict}
    return {"scheme": "", "by_scheme": math.nan, "u_scheme": math.nan, "scheme_verdict": ""}


def readable(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table as texts, the computed number with the digits that its uncertainty leaves."""

    def texts(row: pd.Series) -> dict[str, str]:
        unit = f" {row['unit']}" if row["unit"] else ""
        parts = [f"{name} = {row[name]:g}" for name in ("n", "k") if not math.isnan(row[name])]
        small = abs(row["difference"]) <= LEAST_SHOWN
        return {
            "where": row["where"],
            "quantity": row["quantity"],
            "case": ", ".join([*parts, *([row["model"]] if row["model"] else [])]),
            "printed": row["printed"] + unit,
            "computed": value_text(row["computed"], row["u"]) + unit,
            "verdict": row["verdict"],
            "difference": "0" if small else f"{row['difference']:+.2g}{unit}",
            "scheme": row["scheme"],
            "by scheme": value_text(row["by_scheme"], row["u_scheme"]) + unit if row["scheme"] else "",
            "verdict by scheme": row["scheme_verdict"],
        }

    return pd.DataFrame([texts(row) for _, row in table.iterrows()])


_TITLE = "Numbers printed in the paper, computed again"
_NOTES = (
    "In brackets: a bound on the error in units of the last digit, at least 5e-10. Difference: of the sizes. The "
    "verdict is on the converged number, as in a run. Agrees if truncated: the digits agree if further ones are "
    "dropped. "
    "Scheme: one for all numbers of a figure, with the number and the verdict that it gives. Of Fig. 16(b) it is the "
    "paper's own: f(r_max) is the height of the punch, in z0, where its integration ends, and sigma_0 the cohesive "
    "stress. Of Fig. 11 it is a grid that the paper does not state."
)


def _texts(tables: Tables) -> dict[str, str]:
    shown = readable(tables[""])
    return texts_of(shown, shown, _TITLE, _NOTES, "paper-values")


PAPER_VALUES = PaperFigure(
    name="numbers",
    stem="paper_values",
    title="Numbers that the paper prints, a verdict on each, and what one scheme for each figure gives",
    plan=_plan,
    texts=_texts,
    shown=lambda tables: records(readable(tables[""]), _TITLE),
)
