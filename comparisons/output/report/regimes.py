"""The cases behind a map of regimes: their regimes, and the choices that a reader has."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import pandas as pd

from comparisons.models.closed_form import SOFT, STIFF
from comparisons.numerics.number_text import exact
from comparisons.problem.problem import split_name
from comparisons.quantities import ALL_QUANTITIES, title_of
from comparisons.runs.frames import with_problem

#: More Tabor numbers than these are put together by decades, and more cases of files by their files: a reader compares
#: no more rows at a glance.
MOST_REGIMES = 24

#: Bounds of the Tabor numbers of a regime within a decade.
_MANTISSAS = (1.0, 2.0, 5.0)

#: Kinds of solids of the dimensionless problem, and the option that has every kind.
HOMOGENEOUS, GRADED, EVERY_SOLID = "homogeneous", "graded, E ~ z^k", "every solid"

#: Kind of the solid and of the punch of a file that is not known, and its option of the gradient.
_OF_FILE, _GRADIENT_OF_FILE = ("problem file", "its punch"), "as in its file"

#: Labels of the choices.
LABELS = ("quantity", "reference", "solid", "punch", "gradient")

#: The options of a choice, one for each label.
Options = tuple[str, ...]


@dataclass(frozen=True, order=True)
class Label:
    """The name of a regime, which sorts by its place, and what it means."""

    place: tuple[float, str]
    text: str = field(compare=False)
    meaning: str = field(compare=False)


class Evaluation(NamedTuple):
    """The error of a model in a case, whether the model declares the case, its regime, and its options."""

    model: str
    status: str
    kappa: float
    u_kappa: float
    inside: bool
    case: tuple[Any, ...]
    regime: Label
    solid: str
    punch: str
    k: str

    @property
    def has_error(self) -> bool:
        """Whether both the model and the reference have a value."""
        return not math.isnan(self.kappa)


def chosen(table: pd.DataFrame, problems: Mapping[str, tuple[str, str]]) -> Iterator[tuple[Options, list[Evaluation]]]:
    """Yield the options of every choice, in the order of the quantities, with its evaluations.

    Parameters
    ----------
    table : DataFrame
        As `comparisons.output.report.stored_run.Stored.evaluations` returns them.
    problems : dict
        Name of a problem file -> kind of its solid and of its punch.
    """
    rows = with_problem(table)
    rows = rows.assign(problem=rows["problem"].fillna(""))
    order = {name: rank for rank, name in enumerate(ALL_QUANTITIES)}
    groups = [(key, _read(group, problems)) for key, group in rows.groupby(["quantity", "reference"], sort=False)]
    # The reference with most cases first.
    groups.sort(key=lambda group: (order.get(group[0][0], len(order)), -len(group[1])))
    for (quantity, reference), evaluations in groups:
        for options, of_choice in _choices(evaluations):
            yield (title_of(quantity), str(reference), *options), of_choice


def _read(rows: pd.DataFrame, problems: Mapping[str, tuple[str, str]]) -> list[Evaluation]:
    """Return the cases in which a model has an error or fails, with their regimes and options."""
    evaluations = []
    for row, regime in zip(rows.to_dict("records"), _regimes(rows), strict=True):
        if file := split_name(row["problem"])[0]:
            options = (*problems.get(file, _OF_FILE), _GRADIENT_OF_FILE)
        else:
            solid = HOMOGENEOUS if row["k"] == 0 else GRADED
            options = (solid, f"n = {exact(row['n'])}", f"k = {exact(row['k'])}")
        # Poisson's ratio makes no other case: most models have none.  Numbers that are missing are equal.
        case = tuple("" if row[name] != row[name] else row[name] for name in ("n", "k", "mu", "problem"))
        errors = (float(row["kappa"]), float(row["u_kappa"]), bool(row["inside"]))
        evaluations.append(Evaluation(row["model"], row["status"], *errors, case, regime, *options))
    compared = {row.case for row in evaluations if row.has_error or row.status == "failed"}
    return [row for row in evaluations if row.case in compared]


def _regimes(rows: pd.DataFrame) -> list[Label]:
    """Return the regime of each row."""
    together = rows["mu"].nunique() > MOST_REGIMES
    many = rows["problem"].nunique() > MOST_REGIMES
    labels = []
    for mu, problem in rows[["mu", "problem"]].itertuples(index=False, name=None):
        if problem:
            name = split_name(problem)[0] if many else problem
            labels.append(Label((math.inf, name), name, ""))
        else:
            low, high = _decade(mu) if together else (mu, mu)
            text = f"μ = {exact(mu)}" if low == high else f"{low:g} ≤ μ < {high:g}"
            labels.append(Label((low, ""), text, _meaning(low)))
    return labels


def _decade(mu: float) -> tuple[float, float]:
    """Return the bounds 1, 2 or 5 times a power of ten between which a Tabor number is."""
    power = math.floor(math.log10(mu))
    ends = [mantissa * 10.0**exponent for exponent in (power - 1, power, power + 1) for mantissa in _MANTISSAS]
    low = max(end for end in ends if end <= mu)
    return low, min(end for end in ends if end > mu)


def _meaning(mu: float) -> str:
    if mu <= STIFF["mu"][1]:
        return "stiff or small"
    return "soft or large" if mu >= SOFT["mu"][0] else "transition"


def _choices(rows: list[Evaluation]) -> Iterator[tuple[tuple[str, str, str], list[Evaluation]]]:
    """Yield the options of each choice of solid, punch and k, and the rows that it has."""
    for solid, of_solid in _options(rows, "solid", EVERY_SOLID):
        for punch, of_punch in _options(of_solid, "punch", "every punch"):
            # Every solid has every k.
            if solid == EVERY_SOLID:
                yield (solid, punch, "every k"), of_punch
                continue
            for k, of_k in _options(of_punch, "k", "every k"):
                yield (solid, punch, k), of_k


def _options(rows: list[Evaluation], name: str, every: str) -> Iterator[tuple[str, list[Evaluation]]]:
    """Yield the options of a choice with their rows, and before them all rows if there are several options."""
    groups = defaultdict(list)
    for row in rows:
        groups[getattr(row, name)].append(row)
    if len(groups) > 1:
        yield every, rows
    yield from groups.items()


def all_first(text: str) -> tuple[bool, bool, float, str]:
    """Sort an option: all, then homogeneous, then by the number in it."""
    number = text.rpartition("= ")[2]
    is_number = number.replace(".", "", 1).isdigit()
    return not text.startswith("every"), text != HOMOGENEOUS, float(number) if is_number else math.inf, text
