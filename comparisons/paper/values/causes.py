"""Paper values computed again with one ingredient of the computation changed at a time, and with one scheme for all.

The largest relative errors kappa (Fig. 16(b)) are repeated with what the paper states of its computation (Sec. 2.4)
and with what it leaves open; the numbers of Fig. 11 with a gradient exponent that ends below 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from comparisons.data.paper_values import PaperValue, paper_values
from comparisons.models.cohesive_contact import CohesiveContact
from comparisons.models.cohesive_events import CohesiveEvents
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.paper_figure import Plan
from comparisons.paper.studies.tabor_curve import Extreme, TaborCurve, largest_error, tabor_numbers
from comparisons.paper.values import scheme_ingredients as scheme

__all__ = ["GRID", "LAST_K", "Repeated", "cohesive_forces", "first_or_last_step", "frame", "repeated"]

#: Name of the converged computation, without any ingredient changed.
CONVERGED = "converged: mu from 0.01 to 10, tail carried, sigma_0 exact"
#: Rounding of chi in percent, and of the ends of its regions, which are roots to 1e-10.
CHI_ROUNDING, REGION_ROUNDING = 1e-11, 1e-9

_K = 0.4
#: Degrees of the series in log(mu); the closed forms cost little.
_EXACT_DEGREE, _COHESIVE_DEGREE = 40, 96
#: (model, n) -> the Tabor number of the largest kappa, to three digits: kappa is stationary there or it is the end
#: of the range.
_PLACES = {
    ("md-original", 1.0): 0.01,
    ("md-original", 1.5): 0.01,
    ("md-original", 2.0): 0.668,
    ("md-original", 5.0): 0.246,
    ("md-improved", 1.0): 0.236,
    ("md-improved", 1.5): 1.56,
    ("md-improved", 2.0): 2.14,
    ("md-improved", 5.0): 0.836,
}
_CONE = 1.0
#: Jin et al. (2021) left out the decimals of 1.026 (Sec. 4.2).
_JIN_STRESS = 1.0
#: Last gradient exponent and step of the shape index with which all eight numbers of Fig. 11 have the printed digits;
#: the paper states neither.  A largest value depends on the points at which it was searched: here the ends of the
#: regions of Fig. 11(b) are the first and the last multiple of 0.001.
LAST_K, N_STEP = 0.999, 0.001
#: Name of the scheme of Fig. 11.
GRID = f"k up to {LAST_K:g}, n in steps of {N_STEP:g}"
#: Gradient exponents near 1: the last ones of a computation that does not take the limit k = 1.
_SHORT_OF_GIBSON = (0.9995, LAST_K)
_SPARSE = np.array([step * 10.0**power for power in (-2, -1, 0) for step in (1, 2, 5)] + [10.0])


def first_or_last_step(end: float, *, first: bool) -> float:
    """Return the first multiple of `N_STEP` from a least n on, or the last up to a largest n.

    Examples
    --------
    >>> first_or_last_step(0.97395, first=True), first_or_last_step(6.21961, first=False)
    (0.974, 6.219)
    """
    steps = math.ceil(end / N_STEP) if first else math.floor(end / N_STEP)
    return round(steps * N_STEP, 3)


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


def _exact_stress(paper_value: PaperValue) -> float:
    return THEORETICAL_STRENGTH if paper_value.model == "md-original" else eta(paper_value.n)


def _printed_stress(paper_value: PaperValue) -> float:
    if paper_value.model == "md-original":
        return paper_values("theoretical_strength")[0].value
    return next(number.value for number in paper_values("eta") if number.n == paper_value.n)


def _forces(paper_value: PaperValue, stress: float) -> CachedCall:
    return CachedCall.of(cohesive_forces, paper_value.n, _K, stress)


@dataclass(frozen=True)
class Repeated:
    """A paper value computed again.

    Attributes
    ----------
    paper_value : PaperValue
    ingredient : str
        What was changed.
    value, u : float
        The number, signed, and its bound, in the unit of the paper value.
    mu : float
        Where it is, NaN if it has no Tabor number.
    stated : bool
        Whether the ingredient is in the paper, or was fitted here.
    scheme : bool
        Whether it is the one scheme with which all numbers of a figure are compared.
    """

    paper_value: PaperValue
    ingredient: str
    value: float
    u: float
    mu: float = math.nan
    stated: bool = True
    scheme: bool = False

    @property
    def verdict(self) -> str:
        """Whether it has the printed digits."""
        return self.paper_value.verdict(abs(self.value), self.u)


def repeated() -> Plan[list[Repeated]]:
    """Plan every repetition, those of one number together and the converged one first."""
    errors = paper_values("largest_relative_error")
    places = [(n, _K, mu) for (_, n), mu in _PLACES.items()]
    regions = {up_to: CachedCall.of(insensitive_regions, up_to) for up_to in (1.0, *_SHORT_OF_GIBSON)}
    results = yield [
        *(CachedCall.of(scheme.scheme_force, *place) for place in places),
        *(CachedCall.of(scheme.sampled_force, *place) for place in places),
        *regions.values(),
        *(call for n in sorted({error.n for error in errors}) for call in _exact_forces(n)),
        *(CachedCall.of(scheme.exact_force, *place) for place in places),
        *(_forces(error, stress) for error in errors for stress in (_exact_stress(error), _printed_stress(error))),
        *(_forces(error, _JIN_STRESS) for error in errors if error.model == "md-original"),
    ]
    rows = [row for error in errors for row in _errors(error, results)]
    rows += [row for number in paper_values("largest_chi") for row in _chi(number)]
    for number in paper_values("insensitive_region"):
        rows += _region(number, {up_to: results[call][number.index] for up_to, call in regions.items()})
    return rows


def _up_to(last_k: float) -> str:
    return f"k up to {last_k:g}" if last_k < 1.0 else "k up to 1, the Gibson limit"


def _chi(number: PaperValue) -> Iterator[Repeated]:
    for last_k in (1.0, *_SHORT_OF_GIBSON):
        largest = 100.0 * largest_chi(number.n, last_k)[0]
        yield Repeated(number, _up_to(last_k), largest, CHI_ROUNDING, stated=last_k == 1.0)
    yield Repeated(number, GRID, largest, CHI_ROUNDING, stated=False, scheme=True)


def _region(number: PaperValue, ends: dict[float, float]) -> Iterator[Repeated]:
    for last_k, end in ends.items():
        yield Repeated(number, _up_to(last_k), end, REGION_ROUNDING, stated=last_k == 1.0)
    # Ends of even index are where a region begins.
    step = first_or_last_step(ends[LAST_K], first=number.index % 2 == 0)
    yield Repeated(number, GRID, step, 0.0, stated=False, scheme=True)


def _errors(paper_value: PaperValue, results: Results) -> Iterator[Repeated]:
    """Repeat a largest relative error with every ingredient."""

    def row(ingredient: str, found: Extreme, stated: bool = True, scheme: bool = False) -> Repeated:
        return Repeated(paper_value, ingredient, 100.0 * found.kappa, 100.0 * found.u, found.mu, stated, scheme)

    def model_of(stress: float) -> TaborCurve:
        return TaborCurve.through(np.array(results[_forces(paper_value, stress)]))

    exact, cut = _exact_curves(paper_value.n, results)
    stress = _printed_stress(paper_value)
    model, printed = model_of(_exact_stress(paper_value)), model_of(stress)
    nothing_beyond, rounded = f"f(r_max) = {scheme.HEIGHTS[0]:g}, nothing beyond", f"sigma_0 = {stress:g} as printed"

    yield row(CONVERGED, largest_error(model, exact))
    yield row(nothing_beyond, largest_error(model, cut[0]))
    if paper_value.n == _CONE:
        for height, curve in zip(scheme.HEIGHTS[1:], cut[1:], strict=True):
            yield row(f"f(r_max) = {height:g}, nothing beyond", largest_error(model, curve), stated=False)
    yield row(rounded, largest_error(printed, exact))
    yield row(f"{nothing_beyond}; {rounded}", largest_error(printed, cut[0]), scheme=True)

    # The rest needs one Tabor number only: kappa is stationary there, or it is the end of the range.
    mu = _PLACES[paper_value.model, paper_value.n]
    full, coarse, steps = (
        results[CachedCall.of(function, paper_value.n, _K, mu)]
        for function in (scheme.exact_force, scheme.scheme_force, scheme.sampled_force)
    )

    def single(model: TaborCurve, force: float, u: float) -> Extreme:
        kappa = float(model(np.array([mu]))[0]) / force - 1.0
        return Extreme(kappa, (1.0 + abs(kappa)) * (model.error + u / force), mu)

    segments = f"N = {scheme.SEGMENTS} segments"
    mesh = coarse["force"] - (full["force"] - full["beyond"][0])
    yield row(segments, single(model, full["force"] + mesh, coarse["u_num"]))
    yield row(f"{nothing_beyond}; {segments}", single(model, coarse["force"], coarse["u_num"]))
    yield row(f"{nothing_beyond}; {segments}; {rounded}", single(printed, coarse["force"], coarse["u_num"]))
    yield row(f"central gap not below {scheme.LAST_GAP:g}", single(model, steps["at_last_gap"], steps["u_num"]))
    for step, force in zip(scheme.GAP_STEPS, steps["sampled"], strict=True):
        found = single(model, force, steps["u_num"])
        yield row(f"largest load among central gaps {step:g} apart", found, stated=False)

    if paper_value.model == "md-original":
        jin = model_of(_JIN_STRESS)
        yield row("sigma_0 = 1, without its decimals", largest_error(jin, exact), stated=False)
    yield row("mu from 0.02 to 10", largest_error(model, exact, low=0.02), stated=False)
    yield row("mu from 0.01 to 2", largest_error(model, exact, high=2.0), stated=False)
    yield row("mu = 1, 2, 5, 10, ... of 0.01 to 10 only", largest_error(model, exact, sampled=_SPARSE), stated=False)


def _exact_forces(n: float) -> list[CachedCall]:
    return [CachedCall.of(scheme.exact_force, n, _K, mu) for mu in tabor_numbers(_EXACT_DEGREE)]


def _exact_curves(n: float, results: Results) -> tuple[TaborCurve, list[TaborCurve]]:
    """Return the converged force over mu, and those without what is beyond each height."""
    found = [results[call] for call in _exact_forces(n)]
    force = np.array([point["force"] for point in found])
    beyond = np.array([point["beyond"] for point in found])
    numerical = max(point["u_num"] / point["force"] for point in found)
    curves = [TaborCurve.through(force - lost) for lost in (np.zeros_like(force), *beyond.T)]
    exact, *cut = [replace(curve, error=curve.error + numerical) for curve in curves]
    return exact, cut


def frame(rows: Sequence[Repeated]) -> pd.DataFrame:
    """Return one row a repetition; ``shift`` is what the ingredient changes, in the unit of the number."""
    table = pd.DataFrame(
        {name: getattr(row.paper_value, name) for name in ("quantity", "model", "n", "k", "unit")}
        | {
            "printed": row.paper_value.text,
            "ingredient": row.ingredient,
            "stated_in_paper": row.stated,
            "scheme": row.scheme,
            "mu": row.mu,
            "computed": row.value,
            "u": row.u,
            "verdict": row.verdict,
        }
        for row in rows
    )
    first = table.groupby(["quantity", "model", "n"], dropna=False)["computed"].transform("first")
    table.insert(12, "shift", table["computed"] - first)
    return table
