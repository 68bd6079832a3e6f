"""Verdicts on the numbers that the paper prints: on the converged numbers, and on those of one scheme a figure."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.polynomial import chebyshev

from comparisons.data.paper_values import PaperValue
from comparisons.data.paper_values import paper_values as printed_values
from comparisons.model import Array
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import CohesiveEvents
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.numerics.number_text import LEAST_SHOWN, case_text, value_text
from comparisons.paper.figures.functions import LAST_K, insensitive_regions, largest_chi
from comparisons.paper.paper_figure import Reading, Tables, paper_figure
from comparisons.paper.plan import Plan, cases, result_of, rows_of, together
from comparisons.paper.scheme_forces import HEIGHT, exact_force
from comparisons.paper.statements.measures import Number, case_of, measured
from comparisons.paper.tasks import SHAPES

_K = 0.4
#: Rounding of chi in percent, and of the ends of its regions, which are roots to 1e-10.
_CHI_ROUNDING, _REGION_ROUNDING = 1e-11, 1e-9
#: Degrees of the series in log(mu); the closed forms cost little.
_EXACT_DEGREE, _COHESIVE_DEGREE = 40, 96
#: The paper shows mu from 0.01 to a few; beyond 10 the differences vanish.
RANGE = (0.01, 10.0)
#: The last coefficients estimate the error of the series: measured at random mu, it is at most 3 times the largest of
#: the last five.
_LAST, _SAFETY = 5, 3.0
#: Points of the search; the largest is refined by a parabola, whose error is then below 1e-8 of the maximum.
_SEARCH = 4001
#: Step of the shape index with which, and with `LAST_K`, all eight numbers of Fig. 11 have the printed digits; the
#: paper does not state it.  A largest value depends on the points at which it was searched: here the ends of the
#: regions of Fig. 11(b) are the first and the last multiple of 0.001.
N_STEP = 0.001
_GRID = f"k up to {LAST_K:g}, n in steps of {N_STEP:g}"


class Computed(NamedTuple):
    """A paper value computed again: signed, with its bound and place, and by the scheme of its figure if it has one."""

    computed: float
    u: float
    at_mu: float = math.nan
    scheme: str = ""
    by_scheme: float = math.nan
    u_scheme: float = math.nan


def _measured(printed: PaperValue) -> Plan[Computed]:
    """Plan its term at a case without Tabor number; of all shapes, if the limit is the same, what is farthest off."""
    k = 0.0 if math.isnan(printed.k) else printed.k
    shapes = SHAPES if math.isnan(printed.n) else (printed.n,)

    def farthest(numbers: dict[float, Number]) -> Computed:
        number = max(numbers.values(), key=lambda number: abs(number.value - printed.value))
        return Computed(number.value, number.u)

    return together({n: measured(printed.term, "fscm", case_of({"n": n, "k": k, "mu": 1.0})) for n in shapes}).then(
        farthest
    )


def tabor_numbers(degree: int) -> tuple[float, ...]:
    """Return the Chebyshev points of log(mu) on `RANGE`, `degree` + 1 of them, increasing.

    Examples
    --------
    >>> [round(mu, 6) for mu in tabor_numbers(2)]
    [0.01, 0.316228, 10.0]
    """
    low, high = np.log(RANGE)
    points = low + 0.5 * (chebyshev.chebpts2(degree + 1) + 1.0) * (high - low)
    return tuple(float(mu) for mu in np.exp(points))


class TaborCurve(NamedTuple):
    """A positive force over mu, as a series for its logarithm, and the bound on its relative error."""

    coefficients: Array
    error: float

    @classmethod
    def through(cls, forces: Array, relative_error: float = 0.0) -> TaborCurve:
        """Return the curve through forces, of this error, at `tabor_numbers` of the degree that fits their number.

        Examples
        --------
        >>> curve = TaborCurve.through(np.array(tabor_numbers(8)) ** 0.5)
        >>> bool(np.isclose(curve(np.array([0.04]))[0], 0.2, rtol=1e-12))
        True
        """
        degree = len(forces) - 1
        coefficients = np.asarray(chebyshev.chebfit(chebyshev.chebpts2(degree + 1), np.log(forces), degree), float)
        return cls(coefficients, _SAFETY * float(np.max(np.abs(coefficients[-_LAST:]))) + relative_error)

    def __call__(self, mu: Array) -> Array:
        """The force, shape of `mu`."""
        low, high = np.log(RANGE)
        return np.asarray(np.exp(chebyshev.chebval(2.0 * (np.log(mu) - low) / (high - low) - 1.0, self.coefficients)))


def largest_error(model: TaborCurve, exact: TaborCurve) -> tuple[float, float, float]:
    """Return the relative error of a model that is largest in size over `RANGE`, its bound, and its Tabor number.

    Examples
    --------
    >>> mu = np.array(tabor_numbers(20))
    >>> hump = TaborCurve.through(1.0 + 0.1 / (1.0 + np.log(mu) ** 2 / 10.0))
    >>> kappa, u, at_mu = largest_error(hump, TaborCurve.through(np.ones(21)))
    >>> round(kappa, 6), round(at_mu, 4)
    (0.1, 1.0)
    """
    mu = np.geomspace(*RANGE, _SEARCH)
    kappa = model(mu) / exact(mu) - 1.0
    at = int(np.argmax(np.abs(kappa)))
    value, at_mu = float(kappa[at]), float(mu[at])
    if 0 < at < _SEARCH - 1:
        # The extreme of the parabola through three points.
        x, y = np.log(mu[at - 1 : at + 2]), kappa[at - 1 : at + 2]
        rise, bend = 0.5 * (y[2] - y[0]), y[2] - 2.0 * y[1] + y[0]
        value, at_mu = float(y[1] - 0.5 * rise**2 / bend), float(np.exp(x[1] - (x[1] - x[0]) * rise / bend))
    return value, (1.0 + abs(value)) * (model.error + exact.error), at_mu


def cohesive_forces(n: float, k: float, stress: float) -> list[float]:
    """Return the Maugis-Dugdale pull-off force for a cohesive stress, at `tabor_numbers` of the closed forms.

    Examples
    --------
    >>> forces = cohesive_forces(2, 0.4, 1.0)
    >>> bool(forces[0] > forces[-1] > 1.7)
    True
    """
    punch = GradedPunch(n, k)
    return [
        -CohesiveEvents.scan(CohesiveContact(punch, stress * mu)).pull_off().load * punch.scales(mu).load
        for mu in tabor_numbers(_COHESIVE_DEGREE)
    ]


def _stresses(paper_value: PaperValue) -> tuple[float, float]:
    """Return the cohesive stress of a model, and as it is printed."""
    if paper_value.model == "md-original":
        return THEORETICAL_STRENGTH, printed_values("theoretical_strength")[0].value
    return eta(paper_value.n), next(number.value for number in printed_values("eta") if number.n == paper_value.n)


def _largest_relative_error(paper_value: PaperValue) -> Plan[Computed]:
    """The scheme is the paper's own: nothing beyond f(r_max), and sigma_0 as printed."""
    n, (exact_stress, printed_stress) = paper_value.n, _stresses(paper_value)
    exact = rows_of(exact_force, cases(mu=tabor_numbers(_EXACT_DEGREE)), n=n, k=_K)
    cohesive = {stress: result_of(cohesive_forces, n, _K, stress) for stress in (exact_stress, printed_stress)}

    def largest(results: dict[Any, Any]) -> Computed:
        force, beyond, u_num = results["exact"][["force", "beyond", "u_num"]].to_numpy().T
        u = float((u_num / force).max())
        model, printed = (TaborCurve.through(np.array(results[stress])) for stress in cohesive)
        kappa, u_kappa, at_mu = largest_error(model, TaborCurve.through(force, u))
        by_scheme, u_scheme, _ = largest_error(printed, TaborCurve.through(force - beyond, u))
        scheme = f"f(r_max) = {HEIGHT:g}, nothing beyond; sigma_0 = {printed_stress:g} as printed"
        return Computed(100.0 * kappa, 100.0 * u_kappa, at_mu, scheme, 100.0 * by_scheme, 100.0 * u_scheme)

    return together({"exact": exact, **cohesive}).then(largest)


def _largest_chi(paper_value: PaperValue) -> Plan[Computed]:
    def largest(_: object) -> Computed:
        converged, by_scheme = (100.0 * largest_chi(paper_value.n, last_k)["chi_max"] for last_k in (1.0, LAST_K))
        return Computed(converged, _CHI_ROUNDING, math.nan, _GRID, by_scheme, _CHI_ROUNDING)

    return Plan({}, largest)


def first_or_last_step(end: float, *, first: bool) -> float:
    """Return the first multiple of `N_STEP` from a least n on, or the last up to a largest n.

    Examples
    --------
    >>> first_or_last_step(0.97395, first=True), first_or_last_step(6.21961, first=False)
    (0.974, 6.219)
    """
    steps = math.ceil(end / N_STEP) if first else math.floor(end / N_STEP)
    return round(steps * N_STEP, 3)


def _insensitive_region(paper_value: PaperValue) -> Plan[Computed]:
    index = paper_value.index

    def end(ends: dict[float, list[float]]) -> Computed:
        # Ends of even index are where a region begins.
        step = first_or_last_step(ends[LAST_K][index], first=index % 2 == 0)
        return Computed(ends[1.0][index], _REGION_ROUNDING, math.nan, _GRID, step, 0.0)

    return together({last_k: result_of(insensitive_regions, last_k) for last_k in (1.0, LAST_K)}).then(end)


#: How numbers that are no measures are computed, by their names.
_COMPUTED: dict[str, Callable[[PaperValue], Plan[Computed]]] = {
    "largest_relative_error": _largest_relative_error,
    "largest_chi": _largest_chi,
    "insensitive_region": _insensitive_region,
}


def computed_again(printed: PaperValue) -> Plan[Computed]:
    """Plan a number that the paper prints."""
    return _measured(printed) if printed.term else _COMPUTED[printed.name](printed)


def judged(paper_value: PaperValue, computed: Computed) -> dict[str, str | float]:
    """Return the row of a paper value, which is printed without its sign."""
    numbers, by_scheme = list(computed._asdict().items()), (abs(computed.by_scheme), computed.u_scheme)
    return {
        "where": paper_value.source,
        **{name: getattr(paper_value, name) for name in ("quantity", "model", "n", "k", "unit")},
        "printed": paper_value.text,
        **dict(numbers[:3]),
        "verdict": paper_value.verdict(abs(computed.computed), computed.u),
        "difference": abs(computed.computed) - paper_value.value,
        **dict(numbers[3:]),
        "scheme_verdict": paper_value.verdict(*by_scheme) if computed.scheme else "",
    }


def readable(table: pd.DataFrame) -> Reading:
    """Return the table as texts, the computed number with the digits that its uncertainty leaves."""
    rows = []
    for row in table.to_dict("records"):
        unit = f" {row['unit']}" if row["unit"] else ""
        small = abs(row["difference"]) <= LEAST_SHOWN
        texts = {name: row[name] for name in ("where", "quantity")}
        texts["case"] = ", ".join(filter(None, [case_text({name: row[name] for name in ("n", "k")}), row["model"]]))
        texts["printed"] = row["printed"] + unit
        texts["computed"] = value_text(row["computed"], row["u"]) + unit
        texts |= {"verdict": row["verdict"], "difference": "0" if small else f"{row['difference']:+.2g}{unit}"}
        by_scheme = value_text(row["by_scheme"], row["u_scheme"]) + unit if row["scheme"] else ""
        rows.append(
            texts | {"scheme": row["scheme"], "by scheme": by_scheme, "verdict by scheme": row["scheme_verdict"]}
        )
    texts = pd.DataFrame(rows)
    return texts, texts, texts


@paper_figure(name="numbers", reading=readable)
def paper_values() -> Plan[Tables]:
    """Numbers printed in the paper, computed again."""
    printed = printed_values()
    again = together(dict(enumerate(map(computed_again, printed))))
    return together({"": again.then(lambda computed: pd.DataFrame(map(judged, printed, computed.values())))})
