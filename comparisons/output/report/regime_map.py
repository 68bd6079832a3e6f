"""The map of regimes: the error of each model in each regime, with the model to use there.

A regime is a Tabor number, for the chosen kind of solid, punch and gradient exponent, or a problem file.  Where several
cases are chosen together, a cell has the error of largest absolute value over them.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import pandas as pd

from comparisons.description.overview import LIMITS
from comparisons.judging.standing import model_to_use, range_text, shared_ranks, stated_range
from comparisons.numerics.number_text import percent_text, short_percent
from comparisons.output.report.regimes import HOMOGENEOUS, LABELS, Evaluation, Label, Options, all_first, chosen
from comparisons.quantities import title_of

#: Absolute errors from which the colour of a cell is the next one.
STEPS = (0.001, *LIMITS, 0.1, 0.3)

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
    def views(self) -> dict[Options, View]:
        """What each choice shows, by its options."""
        views = {options: self._view(rows) for options, rows in chosen(self.evaluations, self.problems)}
        return {options: view for options, view in views.items() if view.models}

    @property
    def choices(self) -> list[tuple[str, list[str]]]:
        """Label and options of each choice."""
        listed = [
            (label, list(dict.fromkeys(texts)))
            for label, texts in zip(LABELS, zip(*self.views, strict=True), strict=True)
        ]
        return [*listed[:2], *((label, sorted(texts, key=all_first)) for label, texts in listed[2:])]

    @property
    def first(self) -> Options:
        """The choice that a page begins with."""
        return max(self.views, key=lambda options: sum(text in options for text in _FIRST))

    def _declared(self, model: str) -> str:
        return range_text(stated_range(model, self.domains))

    def _view(self, rows: Sequence[Evaluation]) -> View:
        """Return a map of rows of one quantity and reference."""
        of_models: dict[str, list[Evaluation]] = defaultdict(list)
        regimes: dict[Label, list[Evaluation]] = defaultdict(list)
        for row in rows:
            of_models[row.model].append(row)
            regimes[row.regime].append(row)
        # First those that are judged in most cases, of these the ones with the smallest largest error.
        errors = {model: _Errors.of(evaluated, 0) for model, evaluated in of_models.items()}
        known = [model for model, found in errors.items() if found.asked or found.why == "failed"]
        models = sorted(known, key=lambda model: (-errors[model].judged, errors[model].size, model))
        return View(models, [self._regime(label, regimes[label], models) for label in sorted(regimes)])

    def _regime(self, label: Label, rows: Sequence[Evaluation], models: Sequence[str]) -> Regime:
        cases = len({row.case for row in rows})
        of_models: dict[str, list[Evaluation]] = defaultdict(list)
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

    @property
    def size(self) -> float:
        """The largest absolute error; infinite where there is none, so that it sorts last."""
        return abs(self.largest) if self.judged else math.inf

    @classmethod
    def of(cls, rows: Sequence[Evaluation], cases: int) -> _Errors:
        known = [row for row in rows if row.has_error]
        judged = [row for row in known if row.inside]
        beyond = [row.kappa for row in known if not row.inside]
        far = f"({short_percent(max(beyond, key=abs))})" if beyond else ""
        why = "failed" if any(row.status == "failed" for row in rows) else "–"
        if not judged:
            return cls(cases, len(known), 0, math.nan, math.nan, math.nan, far, why)
        errors = [row.kappa for row in judged]
        bound = max(row.u_kappa for row in judged)
        covered = len({row.case for row in judged})
        return cls(cases, len(known), covered, max(errors, key=abs), bound, sum(errors) / len(errors), far, why)
