"""Numbers that statements are about, each with the bound on its error and the words of what it is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from comparisons.models.closed_form import EPS
from comparisons.numerics.number_text import case_text
from comparisons.paper.plan import Plan, result_of, together
from comparisons.paper.tasks import JUMPS, jumps, quantity
from comparisons.quantities import title_of

__all__ = ["MEASURES", "PARAMETERS", "Number", "Place", "call", "case_of", "label", "measure", "measured", "refused"]

#: Parameters of a case; s is the distance from s = 1 of a ratio of radii.
PARAMETERS = ("n", "k", "mu", "s")
#: Those of one case with their names, in order.
Case = tuple[tuple[str, float], ...]

#: What a measure makes: value and bound, and what it is of if that is not the measure's title with the case.
Measured = tuple[Any, ...]


class Number(NamedTuple):
    """A value, a bound on its numerical error, and what it is of."""

    value: float
    u: float
    title: str


class Place(NamedTuple):
    """Where a number is measured: the reference, the case, and the arguments of the term."""

    reference: str
    case: Case
    arguments: tuple[str, ...]

    def __getattr__(self, name: str) -> float:
        """Return a parameter of the case, as n."""
        try:
            return dict(self.case)[name]
        except KeyError:
            raise AttributeError(name) from None

    @property
    def label(self) -> str:
        """The case as a text."""
        return label(self.case)

    def text(self, template: str) -> str:
        """Return a text whose `{0}`, ... are the arguments of the term, and `{reference}` is the model."""
        return template.format(*self.arguments, reference=self.reference)


#: What a measure is made of: a plan at a place.
Need = Callable[[Place], Plan[Any]]


class Measure(NamedTuple):
    """A number of a case.

    Attributes
    ----------
    title : str
        What it is of, as of `Place.text`.
    model : str
        Whose number it is if not of a reference: "formula" or a model.
    needs : tuple of Need
    function : callable
        Of the place, and what is made of each need.
    """

    title: str
    model: str
    needs: tuple[Need, ...]
    function: Callable[..., Measured]


#: Measures by name; every other name is that of a quantity.
MEASURES: dict[str, Measure] = {}

#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
ROUNDING = 64.0 * EPS


def case_of(row: Mapping[str, Any]) -> Case:
    """Return the parameters that a row has.

    Examples
    --------
    >>> case_of({"reference": "fem", "n": 2, "k": 0.4})
    (('n', 2.0), ('k', 0.4))
    """
    return tuple((name, float(row[name])) for name in PARAMETERS if name in row)


def label(case: Case, without: str = "") -> str:
    """Return the parameters of a case as a text.

    Examples
    --------
    >>> label((("n", 2.0), ("k", 0.4)))
    'n = 2, k = 0.4'
    """
    return case_text({name: value for name, value in case if name != without})


def measure(title: str, *needs: Need, model: str = "") -> Callable[[Callable[..., Measured]], Callable[..., Measured]]:
    """Register a measure by the name of its function."""

    def register(function: Callable[..., Measured]) -> Callable[..., Measured]:
        MEASURES[function.__name__] = Measure(title, model, needs, function)
        return function

    return register


def call(function: Callable[..., Any], *texts: str, **fixed: float) -> Need:
    """Need the result of a function of texts and of the parameters of the case, but for fixed ones; lists as arrays."""

    def need(at: Place) -> Plan[dict[str, Any]]:
        return result_of(function, *map(at.text, texts), **dict(at.case) | fixed).then(_with_arrays)

    return need


def _with_arrays(result: Mapping[str, Any]) -> dict[str, Any]:
    return {name: np.array(value, float) if isinstance(value, list) else value for name, value in result.items()}


def term(text: str, **changes: Callable[[float], float]) -> Need:
    """Need another term of the same case, or of one whose parameters are changed by functions."""

    def need(at: Place) -> Plan[Number]:
        case = tuple((name, changes[name](value) if name in changes else value) for name, value in at.case)
        return measured(at.text(text), at.reference, case)

    return need


def _measure_of(text: str) -> tuple[Measure, tuple[str, ...]]:
    name, *arguments = text.split()
    return (MEASURES[name], tuple(arguments)) if name in MEASURES else (MEASURES["quantity_of"], (name, *arguments))


def model_of(text: str) -> str:
    """Return the model of a term that is not of a reference, else nothing."""
    return _measure_of(text)[0].model


def measured(text: str, reference: str, case: Case) -> Plan[Number]:
    """Plan the number of a term, as ``relative_error pull_off_force jkr``, by a reference in a case."""
    (title, _, needs, function), arguments = _measure_of(text)
    at = Place(reference, case, arguments)

    def number(results: dict[int, Any]) -> Number:
        value, u, *titles = function(at, *results.values())
        return Number(float(value), float(u), titles[0] if titles else f"{at.text(title)}, {at.label}")

    return together({index: need(at) for index, need in enumerate(needs)}).then(number)


def table_of_terms(rows: Iterable[Mapping[str, Any]], **terms: str) -> Plan[pd.DataFrame]:
    """Plan a table of rows, each a reference in a case, with a column and its ``u_`` for each term.

    A term may name other keys of a row in braces.
    """
    keys = list(rows)
    plans = {
        (index, name): measured(text.format(**row), row["reference"], case_of(row))
        for index, row in enumerate(keys)
        for name, text in terms.items()
    }

    def make(numbers: dict[tuple[int, str], Number]) -> pd.DataFrame:
        table = pd.DataFrame(keys)
        for name in terms:
            of_rows = [numbers[index, name] for index in range(len(keys))]
            table[name], table[f"u_{name}"] = [number.value for number in of_rows], [number.u for number in of_rows]
        return table

    return together(plans).then(make)


def _quantity(at: Place) -> Plan[Any]:
    name, model = (*at.arguments, at.reference)[:2]
    if model == "fscm" and name in JUMPS:
        return call(jumps)(at)
    return call(quantity, model, name)(at)


@measure("", _quantity)
def quantity_of(at: Place, result: dict[str, Any]) -> Measured:
    """A quantity of the reference, or of another model."""
    name = at.arguments[0]
    title = f"{title_of(name)}, {at.label}"
    if name in result:
        return result[name], result[f"u_{name}"], title
    if result["status"] != "ok":
        # A refusal is certain, a failure is not.
        return np.nan, 0.0 if result["status"] == "not-applicable" else np.nan, f"{title}: {result['reason']}"
    return result["value"], result["u_num"], title


@measure("displacement at jump-in minus that at jump-out", term("jump_in_displacement"), term("jump_out_displacement"))
def jump_distance(at: Place, inward: Number, outward: Number) -> Measured:
    return inward.value - outward.value, inward.u + outward.u


@measure("deformation at the centre over the gap there, at jump-in", term("jump_in_gap"), term("jump_in_displacement"))
def jump_in_deformation(at: Place, gap: Number, displacement: Number) -> Measured:
    """w(0) = H_0 + delta (Eq. 4)."""
    share = abs(gap.value + displacement.value) / abs(gap.value)
    return share, (gap.u + displacement.u + share * gap.u) / abs(gap.value)


@measure("", term("{0}"))
def size(at: Place, number: Number) -> Measured:
    return abs(number.value), number.u, f"size of {number.title}"


def signed(value: Number, exact: Number) -> tuple[float, float]:
    """Return the relative error of a value, with the bound that both bounds give it.

    Examples
    --------
    >>> signed(Number(0.75, 0.0, "force"), Number(1.0, 0.0, "force"))
    (-0.25, 0.0)
    """
    kappa = value.value / exact.value - 1.0
    return kappa, (value.u + (1.0 + abs(kappa)) * exact.u) / (abs(exact.value) - exact.u)


def refused(number: Number) -> bool:
    """Whether a model has no such quantity in the case."""
    return bool(np.isnan(number.value) and number.u == 0.0)


def _against(at: Place) -> str:
    """Model that an error is against: the third argument, or the reference."""
    return (*at.arguments, at.reference)[2]


def _exact(at: Place) -> Plan[Number]:
    return measured(f"{at.arguments[0]} {_against(at)}", at.reference, at.case)


@measure("", term("{0} {1}"), _exact)
def signed_error(at: Place, value: Number, exact: Number) -> Measured:
    title = f"relative error of {at.arguments[1]} against {_against(at)}: {value.title}"
    return *signed(value, exact), title


@measure("", term("{0} {1}"), _exact)
def relative_error(at: Place, value: Number, exact: Number) -> Measured:
    kappa, u, title = signed_error(at, value, exact)
    return abs(kappa), u, title


@measure("", term("{0} {1}"), term("{0}"))
def difference(at: Place, value: Number, exact: Number) -> Measured:
    title = f"difference of {at.arguments[1]} from {at.reference}: {value.title}"
    return exact.value - value.value, exact.u + value.u, title


@measure("", term("{0}"), term("{0}", k=lambda _: 0.0))
def gradient_error(at: Place, graded: Number, homogeneous: Number) -> Measured:
    """Deviation from the homogeneous solid of the same Tabor number."""
    kappa, u = signed(graded, homogeneous)
    return abs(kappa), u, f"relative error of the graded solid against k = 0: {graded.title}"


@measure("", term("{0}"), term("{0}", mu=lambda mu: 2.0 * mu))
def power_of_mu(at: Place, small: Number, large: Number) -> Measured:
    """Difference of the power of mu, between it and its double, from that of the asymptote."""
    n, k, mu = at.n, at.k, at.mu
    # Eq. 47 is 1 - C mu^p; Eq. 54 is -C mu.
    is_jump_in = at.arguments[0] == "jump_in_displacement"
    shift, expected = (1.0, (2 * n + k - 1) / (4 * n + k - 1)) if is_jump_in else (0.0, 1.0)
    steps = np.log(2.0)
    power = np.log((shift - large.value) / (shift - small.value)) / steps
    u = (small.u / (shift - small.value) + large.u / (shift - large.value)) / steps
    where = f"n = {n:g}, k = {k:g}, mu from {mu:g} to {2.0 * mu:g}"
    return power - expected, u, f"difference of the power {power:.4f} of mu from {expected:.4f}, {where}"


# The critical number depends on no Tabor number.
@measure("", call(quantity, "{reference}", "critical_tabor_number", mu=1.0))
def critical_difference(at: Place, critical: dict[str, Any]) -> Measured:
    printed = float(at.arguments[0])
    title = f"difference of the critical Tabor number {critical['value']:.6f} from {printed:g}"
    return abs(critical["value"] - printed), critical["u_num"], title
