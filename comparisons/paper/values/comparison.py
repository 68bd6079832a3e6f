"""Every number the paper prints, computed again: a verdict on each, and for each difference its cause."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from rich.table import Table

from comparisons.data.paper_values import REPRODUCED, PaperValue, paper_values
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import eta
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.numerics.number_text import short
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.tables import rich_table
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity
from comparisons.paper.values.causes import Repeated, frame, repeated, tasks
from comparisons.runs.cases import Case
from fscm.laws import LennardJones93

__all__ = ["PAPER_VALUES", "cause", "judged"]

Number = tuple[float, float]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS
#: Uncertainties below this are shown as this: nobody reads sixteen digits.
_LEAST_SHOWN = 5e-10


def _critical(claim: PaperValue) -> CachedCall:
    # The Tabor number of the case is not used.
    return CachedCall.of(quantity, "fscm", "critical_tabor_number", claim.n, claim.k, 1.0)


def _tasks() -> Sequence[CachedCall]:
    return [*map(_critical, paper_values("critical_tabor_number")), *tasks()]


def _closed(value: float) -> Number:
    return value, _ROUNDING * abs(value)


def _strength(claim: PaperValue) -> Number:
    law = LennardJones93()
    return _closed(-float(law.traction(np.array(law.peak_gap))))


def _bradley(claim: PaperValue) -> Number:
    answer = quantity("bradley", "pull_off_force", claim.n, 0.0, 1.0)
    return answer["value"], answer["u_num"]


def _farthest(values: Sequence[float], claim: PaperValue) -> Number:
    """Return the value that is farthest from the published: the limit is the same for all shape indices."""
    return _closed(max(values, key=lambda value: abs(value - claim.value)))


def _jump_out(claim: PaperValue) -> Number:
    cases = [Case(n, 1.0, 1.0).problem() for n in _SHAPES]
    return _farthest([-JKR().evaluate(case, "jump_out_displacement").value for case in cases], claim)


def _exponent(claim: PaperValue) -> Number:
    """Slope of log(1 - displacement) over log(mu); the difference of two logarithms loses a digit."""
    low, high = (
        math.log(1.0 - SemiRigid().evaluate(Case(claim.n, claim.k, mu).problem(), "jump_in_displacement").value)
        for mu in (1.0, math.e**7)
    )
    return _closed((high - low) / 7.0)


#: How each number is computed that needs no long computation and has no rows of causes.
_DIRECT: dict[str, Callable[[PaperValue], Number]] = {
    "theoretical_strength": _strength,
    "bradley_pull_off": _bradley,
    "eta": lambda claim: _closed(eta(claim.n)),
    "jump_in_limit": lambda claim: _farthest([jump_in_coefficient(n, 1.0) for n in _SHAPES], claim),
    "jump_out_limit": _jump_out,
    "jump_in_prefactor": lambda claim: _closed(jump_in_coefficient(claim.n, claim.k)),
    "jump_in_exponent": _exponent,
}


def cause(rows: Sequence[Repeated]) -> str:
    """Return in a sentence which ingredient gives the published digits; empty if the first row has them.

    Parameters
    ----------
    rows : sequence of Repeated
        Of one number, the converged one first, then simple ingredients before combined ones.
    """
    converged, *others = rows
    if converged.verdict != "differs":
        return ""
    stated = [row for row in others if row.stated]
    reproducing = [row for row in stated if row.verdict in REPRODUCED]
    if reproducing:
        words = f"reproduced by {_said(reproducing[0])}"
        against = stated[0]
        # What the paper states most plainly, the size of the domain, may lead away from its number.
        return words if against.verdict in REPRODUCED or against.ingredient in words else f"{words}; {_alone(against)}"
    elsewhere = " or ".join(_said(row) for row in others if row.verdict in REPRODUCED)
    plain = f"; {_alone(stated[0])}" if stated else ""
    if not elsewhere:
        nearest = min(others, key=lambda row: abs(abs(row.value) - converged.claim.value))
        return f"not reproduced; nearest is {_said(nearest)}{plain}"
    return f"nothing the paper states gives it; these do: {elsewhere}{plain}"


def _said(row: Repeated) -> str:
    shortened = ", cut off" if row.verdict == "cut off" else ""
    return f"{row.ingredient} ({abs(row.value):.5g}{shortened})"


def _alone(row: Repeated) -> str:
    return f"{row.ingredient} alone gives {abs(row.value):.5g}"


def _tables(answers: Results) -> Tables:
    again = repeated(answers)
    return {"": pd.DataFrame([judged(claim, answers, again) for claim in paper_values()]), "causes": frame(again)}


def judged(claim: PaperValue, answers: Results, again: Sequence[Repeated]) -> dict[str, str | float]:
    """Return the row of a published number, from the answers and the repetitions of those that have any."""
    rows = [row for row in again if row.claim == claim]
    mu = math.nan
    if rows:
        computed, u, mu = rows[0].value, rows[0].u, rows[0].mu
    elif claim.name in _DIRECT:
        computed, u = _DIRECT[claim.name](claim)
    else:
        answer = answers[_critical(claim)]
        computed, u = answer["value"], answer["u_num"]
    # The paper prints the largest errors without their sign.
    size = abs(computed)
    return {
        "where": claim.source,
        "quantity": claim.quantity,
        "model": claim.model,
        "n": claim.n,
        "k": claim.k,
        "unit": claim.unit,
        "published": claim.text,
        "computed": computed,
        "u": u,
        "at_mu": mu,
        "verdict": claim.verdict(size, u),
        "difference": size - claim.value,
        "cause": cause(rows) if rows else "",
    }


def readable(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table as texts: the case in words, the computed number to the digit its uncertainty leaves it."""

    def case(row: pd.Series) -> str:
        parts = [f"{name} = {row[name]:g}" for name in ("n", "k") if not math.isnan(row[name])]
        return ", ".join([*parts, *([row["model"]] if row["model"] else [])])

    def computed(row: pd.Series) -> str:
        return in_unit(short(row["computed"], max(row["u"], _LEAST_SHOWN)), row["unit"])

    def difference(row: pd.Series) -> str:
        small = abs(row["difference"]) <= _LEAST_SHOWN
        return "0" if small else in_unit(f"{row['difference']:+.2g}", row["unit"])

    def in_unit(text: str, unit: str) -> str:
        return f"{text} {unit}" if unit else text

    return pd.DataFrame(
        {
            "where": table["where"],
            "quantity": table["quantity"],
            "case": table.apply(case, axis=1),
            "published": table.apply(lambda row: in_unit(row["published"], row["unit"]), axis=1),
            "computed": table.apply(computed, axis=1),
            "verdict": table["verdict"],
            "difference": table.apply(difference, axis=1),
            "cause": table["cause"],
        }
    )


_TITLE = "Numbers published in the paper, computed again"
_NOTES = (
    "In brackets: a bound on the error in units of the last digit, at least 5e-10. Difference: of the sizes. Cut off: "
    "the digits agree if further ones are dropped. In the causes f(r_max) is the height of the punch, in z0, where the "
    "paper's integration ends, and sigma_0 the cohesive stress."
)


def _texts(tables: Tables) -> dict[str, str]:
    shown = readable(tables[""])
    return {".md": f"{markdown(shown, _TITLE)}\n{_NOTES}\n", ".tex": latex(shown, f"{_TITLE}. {_NOTES}")}


def _shown(tables: Tables) -> Table:
    return rich_table(readable(tables[""]), _TITLE)


PAPER_VALUES = PaperFigure(
    name="numbers",
    stem="paper_values",
    title="Every published number with a verdict, and the ingredients that move those that differ",
    tasks=_tasks,
    tables=_tables,
    draw=None,
    texts=_texts,
    shown=_shown,
)
