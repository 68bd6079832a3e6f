"""The map of regimes: the error of each model in each regime, with the model to use there.

A regime is a Tabor number, for the chosen kind of solid, punch and gradient exponent, or a problem file.  Where several
cases are chosen together, a cell has the error of largest absolute value over them.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import pandas as pd

from comparisons.description.overview import LIMITS
from comparisons.judging.standing import model_to_use, range_text, shared_ranks, stated_range
from comparisons.models.closed_form import SOFT, STIFF
from comparisons.numerics.number_text import exact, percent_text
from comparisons.problem.problem import split_name
from comparisons.quantities import ALL_QUANTITIES, title_of
from comparisons.runs.frames import with_problem
from comparisons.runs.rows import CASE

#: Absolute errors from which the colour of a cell is the next one.
STEPS = (0.001, *LIMITS, 0.1, 0.3)

#: More Tabor numbers than these are put together by decades, and more cases of a file into one regime: a reader
#: compares no more rows at a glance.
_MOST_REGIMES = 24

#: Bounds of the Tabor numbers of a regime within a decade.
_MANTISSAS = (1.0, 2.0, 5.0)

#: Kinds of solids of the dimensionless problem.
HOMOGENEOUS, GRADED = "homogeneous", "graded, E ~ z^k"

#: The option that has every kind of solid.
EVERY_SOLID = "every solid"

#: The choice that a page begins with, as far as it has it: a sphere on a homogeneous solid.
_FIRST = (title_of("pull_off_force"), HOMOGENEOUS, "n = 2")


class Cell(NamedTuple):
    """A model in a regime.

    Attributes
    ----------
    text : str
        Its largest error with its sign, in percent; else why there is none.
    step : int or None
        The number of `STEPS` that the error reaches; None where the model is not judged.
    use : bool
        Whether it is the model to use in this regime.
    title : str
        The error with its bound, its rank, its mean, or the range that the model declares.
    coverage : str
        In how many cases of the regime the model is judged, if not in all.
    """

    text: str
    step: int | None
    use: bool
    title: str
    coverage: str


class Regime(NamedTuple):
    """A row of a map: its name, what it means, the model to use and how near it is, and a cell for each model."""

    label: str
    meaning: str
    use: str
    nearness: str
    cells: list[Cell]


class View(NamedTuple):
    """What a choice shows: the models of its columns, and its regimes."""

    models: list[str]
    regimes: list[Regime]


@dataclass(frozen=True)
class RegimeMap:
    """A map of regimes.

    Attributes
    ----------
    evaluations : DataFrame
        As `comparisons.output.report.stored_run.Stored.evaluations` returns them.
    domains : dict
        Name of an external model -> its domain, as the record of a run has it.
    problems : dict
        Name of a problem file -> kind of its solid and of its punch.
    """

    evaluations: pd.DataFrame
    domains: Mapping[str, Any] = field(default_factory=dict)
    problems: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    @cached_property
    def views(self) -> dict[str, View]:
        """What each choice shows, by the texts of its options."""
        views = {}
        for (quantity, reference), rows in self._by_quantity():
            for options, chosen in _choices(rows):
                view = self._view(chosen)
                if view.models:
                    views["|".join((quantity, reference, *options))] = view
        return views

    @property
    def choices(self) -> list[tuple[str, list[str]]]:
        """Label and options of each choice."""
        labels = ("quantity", "reference", "solid", "punch", "gradient")
        options = zip(*(key.split("|") for key in self.views), strict=True)
        listed = [(label, list(dict.fromkeys(texts))) for label, texts in zip(labels, options, strict=True)]
        return [*listed[:2], *((label, sorted(texts, key=_all_first)) for label, texts in listed[2:])]

    @property
    def first(self) -> str:
        """The choice that a page begins with."""
        return max(self.views, key=lambda key: sum(text in key.split("|") for text in _FIRST))

    def _declared(self, model: str) -> str:
        return range_text(stated_range(model, self.domains))

    def _by_quantity(self) -> list[tuple[tuple[str, str], list[_Evaluation]]]:
        """Return the evaluations of each quantity and reference, the reference with most cases first."""
        rows = with_problem(self.evaluations)
        rows = rows.assign(problem=rows["problem"].fillna(""))
        order = {name: rank for rank, name in enumerate(ALL_QUANTITIES)}
        groups = [(key, self._read(group)) for key, group in rows.groupby(["quantity", "reference"], sort=False)]
        groups.sort(key=lambda group: (order.get(group[0][0], len(order)), -len(group[1])))
        return [((title_of(quantity), str(reference)), group) for (quantity, reference), group in groups]

    def _read(self, rows: pd.DataFrame) -> list[_Evaluation]:
        """Return the cases in which a model has an error or fails, with their regime and the texts of the choices."""
        labels = _regimes(rows)
        evaluations = []
        for row, regime in zip(rows.to_dict("records"), labels, strict=True):
            file = split_name(row["problem"])[0]
            if file:
                options = (*self.problems.get(file, ("problem file", "its punch")), "as in its file")
            else:
                solid = HOMOGENEOUS if row["k"] == 0 else GRADED
                options = (solid, f"n = {exact(row['n'])}", f"k = {exact(row['k'])}")
            # Numbers that are missing are equal.
            case = tuple("" if row[name] != row[name] else row[name] for name in CASE)
            facts = (row[name] for name in ("model", "status", "kappa", "u_kappa", "inside"))
            evaluations.append(_Evaluation(*facts, case, regime, *options))
        compared = {row.case for row in evaluations if row.kappa == row.kappa or row.status == "failed"}
        return [row for row in evaluations if row.case in compared]

    def _view(self, rows: Sequence[_Evaluation]) -> View:
        """Return a map of rows of one quantity and reference."""
        of_models: dict[str, list[_Evaluation]] = defaultdict(list)
        regimes: dict[_Label, list[_Evaluation]] = defaultdict(list)
        for row in rows:
            of_models[row.model].append(row)
            regimes[row.regime].append(row)
        # First those that are judged in most cases, of these the ones with the smallest largest error.
        errors = {model: _Errors.of(evaluated, 0) for model, evaluated in of_models.items()}
        known = [model for model, found in errors.items() if found.asked or found.why == "failed"]
        models = sorted(known, key=lambda model: (-errors[model].judged, abs(errors[model].largest), model))
        return View(models, [self._regime(label, regimes[label], models) for label in sorted(regimes)])

    def _regime(self, label: _Label, rows: Sequence[_Evaluation], models: Sequence[str]) -> Regime:
        cases = len({row.case for row in rows})
        of_models: dict[str, list[_Evaluation]] = defaultdict(list)
        for row in rows:
            of_models[row.model].append(row)
        errors = {model: _Errors.of(of_models[model], cases) for model in models}
        whole = {model: found for model, found in errors.items() if found.judged == cases}
        use, limit = model_to_use({model: (found.largest, found.bound) for model, found in whole.items()})
        sizes = [abs(found.largest) for found in whole.values()]
        bounds = [found.bound for found in whole.values()]
        rank = dict(zip(whole, shared_ranks(sizes, bounds), strict=True))
        cells = [self._cell(model, errors[model], use == model and limit is not None, rank) for model in models]
        if limit is not None:
            return Regime(label.text, label.meaning, use, f"within {100 * limit:g} %", cells)
        nearest = f"none within {100 * LIMITS[-1]:g} %" + (f"; nearest {use}" if use else "")
        return Regime(label.text, label.meaning, "", nearest, cells)

    def _cell(self, model: str, errors: _Errors, use: bool, rank: Mapping[str, int | None]) -> Cell:
        declared = self._declared(model)
        if not errors.judged:
            beyond = f"outside the range that {model} declares ({declared})" if errors.asked else ""
            return Cell(errors.beyond or errors.why, None, False, beyond or errors.why, "")
        title = f"{model}: κ = {percent_text(errors.largest, errors.bound)} %"
        if errors.judged > 1:
            title += f", mean {short_percent(errors.mean)} %, largest of {errors.judged} cases"
        if model in rank:
            shared = "shared " if [*rank.values()].count(rank[model]) > 1 else ""
            title += f", {shared}rank {rank[model]} of {len(rank)}"
        coverage = "" if errors.judged == errors.cases else f"{errors.judged}/{errors.cases}"
        step = sum(abs(errors.largest) >= limit for limit in STEPS)
        return Cell(short_percent(errors.largest), step, use, title, coverage)


@dataclass(frozen=True, slots=True)
class _Errors:
    """The errors of a model in the cases of a regime: how many are judged, the largest, its bound, and the mean."""

    cases: int
    asked: int
    judged: int
    largest: float
    bound: float
    mean: float
    beyond: str
    why: str

    @classmethod
    def of(cls, rows: Sequence[_Evaluation], cases: int) -> _Errors:
        known = [row for row in rows if row.kappa == row.kappa]
        judged = [row for row in known if row.inside]
        beyond = [row.kappa for row in known if not row.inside]
        far = f"({short_percent(max(beyond, key=abs))})" if beyond else ""
        why = "failed" if any(row.status == "failed" for row in rows) else "–"
        if not judged:
            return cls(cases, len(known), 0, math.nan, math.nan, math.nan, far, why)
        errors = [row.kappa for row in judged]
        bound = max(row.u_kappa for row in judged)
        return cls(cases, len(known), len(judged), max(errors, key=abs), bound, sum(errors) / len(errors), far, why)


class _Evaluation(NamedTuple):
    """A row of the evaluations."""

    model: str
    status: str
    kappa: float
    u_kappa: float
    inside: bool
    case: tuple[Any, ...]
    regime: _Label
    solid: str
    punch: str
    k: str


@dataclass(frozen=True, order=True)
class _Label:
    """The name of a regime, which sorts by its place."""

    place: tuple[float, str]
    text: str = field(compare=False)
    meaning: str = field(compare=False)


def _regimes(rows: pd.DataFrame) -> list[_Label]:
    """Return the regime of each row."""
    together = rows["mu"].nunique() > _MOST_REGIMES
    many = rows["problem"].nunique() > _MOST_REGIMES
    labels = []
    for mu, problem in rows[["mu", "problem"]].itertuples(index=False, name=None):
        if problem:
            name = split_name(problem)[0] if many else problem
            labels.append(_Label((math.inf, name), name, ""))
        else:
            low, high = _decade(mu) if together else (mu, mu)
            text = f"μ = {exact(mu)}" if low == high else f"{low:g} ≤ μ < {high:g}"
            labels.append(_Label((low, ""), text, _meaning(low)))
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


def _choices(rows: list[_Evaluation]) -> Iterator[tuple[tuple[str, str, str], list[_Evaluation]]]:
    """Yield the options of each choice of solid, punch and k, and the rows that it has."""
    for solid, of_solid in _options(rows, "solid", EVERY_SOLID):
        for punch, of_punch in _options(of_solid, "punch", "every punch"):
            # Every solid has every k.
            if solid == EVERY_SOLID:
                yield (solid, punch, "every k"), of_punch
                continue
            for k, of_k in _options(of_punch, "k", "every k"):
                yield (solid, punch, k), of_k


def _options(rows: list[_Evaluation], name: str, every: str) -> Iterator[tuple[str, list[_Evaluation]]]:
    """Yield the options of a choice with their rows, and before them all rows if there are several options."""
    groups = defaultdict(list)
    for row in rows:
        groups[getattr(row, name)].append(row)
    if len(groups) > 1:
        yield every, rows
    yield from groups.items()


def _all_first(text: str) -> tuple[bool, bool, float, str]:
    """Sort an option: all, then homogeneous, then by the number in it."""
    number = text.rpartition("= ")[2]
    is_number = number.replace(".", "", 1).isdigit()
    return not text.startswith("every"), text != HOMOGENEOUS, float(number) if is_number else math.inf, text


def short_percent(kappa: float) -> str:
    """Return an error in percent with its sign and three digits.

    Examples
    --------
    >>> short_percent(-0.0694811), short_percent(11.3294), short_percent(3e-7), short_percent(0.0)
    ('−6.95', '+1133', '+3e-5', '0')
    """
    percent = 100.0 * kappa
    if percent == 0.0:
        return "0"
    size = abs(percent)
    if size >= 1e5:
        text = f"{size:.0e}".replace("e+0", "e").replace("e+", "e")
    elif size < 5e-4:
        text = f"{size:.0e}".replace("e-0", "e-")
    else:
        text = f"{size:.{max(0, 2 - max(-1, math.floor(math.log10(size))))}f}"
    return ("−" if percent < 0.0 else "+") + text
