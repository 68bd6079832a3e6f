"""Cases of a run, read from a TOML file.

A case is one dimensionless problem.  A grid is a set of cases (a product of lists of n, k, mu and nu, a list of cases
or a Latin hypercube), with an id, a tier, and the quantities and models that are computed.
The form of the file is checked by ``comparisons/data/cases.schema.json``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any

from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, label, validated
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS
from comparisons.runs.parameter_sets import NAMES, parameter_sets
from fscm.problem import Problem

__all__ = ["TIERS", "VERIFICATION", "Case", "Grid", "cases_text", "grids", "grids_for", "load_grids"]

#: A tier holds its own grids and those of every tier before it.
TIERS = ("quick", "full")

#: Grids with this tag verify the references themselves.  A run with --model does not compute them, and they are not in
#: its tables of errors.
VERIFICATION = "verification"


@dataclass(frozen=True, slots=True, order=True)
class Case:
    """One dimensionless problem with the default punch and surface law.

    Parameters
    ----------
    n, k, mu : float
        Shape index, gradient exponent and Tabor number (see `fscm.problem.Problem`).
    nu : float, optional
        Poisson's ratio in [0, 0.5), for models that solve the physical problem; None leaves it to them.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    >>> Case(2, 0.4, 1.0).label
    'n = 2, k = 0.4, mu = 1'
    """

    n: float
    k: float
    mu: float
    nu: float | None = None

    def __post_init__(self) -> None:
        for name in ("n", "k", "mu"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if self.nu is not None and not 0 <= self.nu < 0.5:
            raise ValueError(
                f"Poisson's ratio nu = {self.nu:g} is not in [0, 0.5): "
                "at 0.5 the solid is incompressible and displacements alone do not give the stress"
            )
        self.problem()

    def problem(self) -> Problem:
        """Return the problem as the models take it."""
        return Problem(n=self.n, k=self.k, mu=self.mu)

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters by name, without Poisson's ratio if it is None."""
        parameters = {"n": self.n, "k": self.k, "mu": self.mu}
        return parameters if self.nu is None else {**parameters, "nu": self.nu}

    @property
    def label(self) -> str:
        """The parameters in one line for people."""
        return ", ".join(f"{name} = {value:g}" for name, value in self.parameters.items())


@dataclass(frozen=True, slots=True)
class Grid:
    """A named set of cases.

    Attributes
    ----------
    id : str
        Stable name, to be cited.
    title : str
        What the grid is for, one line.
    tier : str
        The first of `TIERS` that computes it.
    reference : str
        The model the others are compared with.
    models : tuple of str
        The candidates.
    quantities : tuple of str
        Quantities that every model computes.
    cases : tuple of Case
        Sorted, without duplicates.
    tags : tuple of str
        Names that gates select several grids by.

    Examples
    --------
    >>> grid = grids("quick")[0]
    >>> grid.reference, grid.cases[0].label
    ('fscm', 'n = 1, k = 0, mu = 0.01')
    """

    id: str
    title: str
    tier: str
    reference: str
    models: tuple[str, ...]
    quantities: tuple[str, ...]
    cases: tuple[Case, ...]
    tags: tuple[str, ...] = ()


def _grid(table: dict[str, Any], where: str, tier: str | None) -> Grid:
    if tier is None and "tier" not in table:
        raise ValueError(f"{where}: tier missing; it is one of {', '.join(TIERS)}")
    if tier is not None and "tier" in table:
        raise ValueError(f"{where}: unknown key 'tier': the grids of a sweep have none")
    for model in (table["reference"], *table["models"]):
        known_name("model", model, MODELS, where)
    for quantity in table["quantities"]:
        known_name("quantity", quantity, tuple(ALL_QUANTITIES), where)
    return Grid(
        id=table["id"],
        title=table["title"],
        tier=tier or table["tier"],
        reference=table["reference"],
        models=tuple(table["models"]),
        quantities=tuple(table["quantities"]),
        cases=tuple(sorted(_cases(table, where), key=lambda case: (case.n, case.k, case.mu, case.nu or 0.0))),
        tags=tuple(table.get("tags", ())),
    )


def _cases(table: dict[str, Any], where: str) -> set[Case]:
    """Return the cases of a grid, each once; refuse one that is not admissible, and so the ends of a range."""
    points = parameter_sets(table, where)
    ends = table.get("latin_hypercube", {})
    try:
        for end in (0, 1) if ends else ():
            Case(*(ends[name][end] for name in NAMES if name in ends))
        return {Case(*values) for values in points}
    except ValueError as refusal:
        raise ValueError(f"{where}: {refusal}") from None


def load_grids(text: str, tier: str | None = None, source: str = "the case file") -> list[Grid]:
    """Read grids from TOML text.

    Parameters
    ----------
    text : str
        ``[[grid]]`` tables and nothing else.
    tier : str, optional
        The tier of all of them, which then state none.
    source : str
        What the text is of, for the sentence that refuses it.

    Raises
    ------
    ValueError
        If the text is not TOML, or a grid has a missing, unknown or inadmissible entry; the message names it.

    Examples
    --------
    >>> text = '''
    ... [[grid]]
    ... id = "mine"
    ... title = "A sphere"
    ... tier = "quick"
    ... reference = "fscm"
    ... models = ["jkr"]
    ... quantities = ["pull_off_force"]
    ... n = [2]
    ... k = [0, 0.4]
    ... mu = [0.1, 1]
    ... '''
    >>> [case.label for case in load_grids(text)[0].cases][:2]
    ['n = 2, k = 0, mu = 0.1', 'n = 2, k = 0, mu = 1']
    """
    tables = parse(text, source)
    validated(tables, "cases", source)
    read = [
        _grid(table, f"{source}: {label('grid', table, number)}", tier)
        for number, table in enumerate(tables["grid"], start=1)
    ]
    ids = [grid.id for grid in read]
    if len(set(ids)) < len(ids):
        raise ValueError(f"{source}: the id of a grid must be unique; found {', '.join(sorted(ids))}")
    return read


def cases_text() -> str:
    """Return the text of the standing cases.

    Examples
    --------
    >>> load_grids(cases_text()) == grids("full")
    True
    """
    return files("comparisons.data").joinpath("cases.toml").read_text(encoding="utf-8")


def grids_for(chosen: Iterable[Grid], models: Sequence[str] | None) -> list[Grid]:
    """Return the grids that a run computes: without those of verification if it has models of its own.

    Examples
    --------
    >>> all(VERIFICATION not in grid.tags for grid in grids_for(grids("quick"), ["jkr"]))
    True
    """
    return [grid for grid in chosen if models is None or VERIFICATION not in grid.tags]


def grids(tier: str) -> list[Grid]:
    """Return the standing grids of a tier and of the tiers before it.

    Examples
    --------
    >>> [grid.id for grid in grids("quick")][0]
    'transition'
    """
    return [grid for grid in _standing(cases_text()) if TIERS.index(grid.tier) <= TIERS.index(tier)]


@lru_cache(maxsize=1)
def _standing(text: str) -> tuple[Grid, ...]:
    return tuple(load_grids(text))
