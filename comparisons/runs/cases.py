"""Cases of a run, read from a TOML file.

A case is one problem: dimensionless, or that of a problem file.  A grid is a set of cases (a product of lists of n, k,
mu and nu, a list of cases, or a problem file with values of some of its keys), with an id, a tier, and the quantities
and models that are computed.
The form of the file is checked by ``comparisons/data/cases.schema.json``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, label, validated
from comparisons.problem import PARAMETERS, Problem
from comparisons.problem.variation import problems_of
from comparisons.quantities import ALL_QUANTITIES
from comparisons.registry import MODELS

#: Ways in which a grid states its cases.
_FORMS = 'lists n, k, mu (and nu); cases = [{n = 2, k = 0, mu = 1}, ...]; or problem = "FILE" (and vary)'

#: Most combinations of lists, each of which is built before anything is computed: they take a gigabyte.
_MOST_CASES = 1_000_000

#: The standing cases and their problem files.
_DATA = Path(str(files("comparisons.data")))

#: A tier holds its own grids and those of every tier before it.
TIERS = ("quick", "full")

#: Grids with this tag verify the references themselves.  A run with --model does not compute them, and they are not in
#: its tables of errors.
VERIFICATION = "verification"

#: Grids with this tag compare the closed forms with the finite elements.  A run with --model does not compute them: the
#: elements would take longer than everything else that it needs.
AGAINST_ELEMENTS = "against-fem"

#: Grids with this tag are computed by a run with --model alone: no gate is about them, but reports and board show them.
FOR_GIVEN_MODELS = "given"


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
        The model the others are compared with; empty where there is none.
    models : tuple of str
        The candidates.
    quantities : tuple of str
        Quantities that every model computes.
    cases : tuple of Problem
        Sorted, without duplicates.
    tags : tuple of str
        Names that gates select several grids by.
    problem : str
        The problem file of the cases, empty if they have none.

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
    cases: tuple[Problem, ...]
    tags: tuple[str, ...] = ()
    problem: str = ""


def _grid(table: dict[str, Any], where: str, folder: Path | None) -> Grid:
    reference = table.get("reference", "")
    for model in {reference, *table["models"]} - {""}:
        known_name("model", model, MODELS, where)
    for quantity in table["quantities"]:
        known_name("quantity", quantity, tuple(ALL_QUANTITIES), where)
    return Grid(
        id=table["id"],
        title=table["title"],
        tier=table.get("tier", TIERS[0]),
        reference=reference,
        models=tuple(table["models"]),
        quantities=tuple(table["quantities"]),
        cases=tuple(sorted(_cases(table, where, folder))),
        tags=tuple(table.get("tags", ())),
        problem=table.get("problem", ""),
    )


def _cases(table: dict[str, Any], where: str, folder: Path | None) -> set[Problem]:
    """Return the cases of a grid, each once; refuse one that is not admissible."""
    try:
        if "problem" in table:
            return _cases_of_file(table, folder)
        return {Problem.dimensionless(*numbers) for numbers in _numbers(table)}
    except ValueError as refusal:
        raise ValueError(f"{where}: {refusal}") from None


def _numbers(table: dict[str, Any]) -> Iterable[tuple[float, float, float, float | None]]:
    """Return n, k, mu and nu (None if not prescribed) of every case: of a list, or of the product of lists."""
    lists = [name for name in PARAMETERS if name in table]
    if ("cases" in table) == bool(lists):
        forms = f"{', '.join(lists)} and cases together" if lists else "no cases"
        raise ValueError(f"it has {forms}; state the cases once: {_FORMS}")
    if "cases" in table:
        return [(case["n"], case["k"], case["mu"], case.get("nu")) for case in table["cases"]]
    if missing := [name for name in PARAMETERS[:3] if name not in lists]:
        raise ValueError(f"{', '.join(missing)} missing; lists of cases are n, k, mu and perhaps nu")
    columns = [*(table[name] for name in PARAMETERS[:3]), table.get("nu", [None])]
    if (count := prod(map(len, columns))) > _MOST_CASES:
        raise ValueError(f"the lists have {count} combinations, more than {_MOST_CASES}; give shorter lists")
    return product(*columns)


def _cases_of_file(table: dict[str, Any], folder: Path | None) -> set[Problem]:
    """Return the cases of a problem file, which is in a folder, for every combination of values of its keys."""
    numbers = [name for name in (*PARAMETERS, "cases") if name in table]
    if numbers:
        raise ValueError(f"it has problem and {', '.join(numbers)} together; state the cases once: {_FORMS}")
    name = table["problem"]
    if folder is None:
        raise ValueError(
            f"problem = {name!r} is the name of a file beside that of the cases; give the cases as a file, "
            "not as a text"
        )
    return set(problems_of(path_inside(folder, name), table.get("vary", {}), name))


def load_grids(
    text: str,
    source: str = "the case file",
    folder: Path | None = None,
    tiers: Sequence[str] | None = TIERS,
) -> list[Grid]:
    """Read grids from TOML text.

    Parameters
    ----------
    text : str
        ``[[grid]]`` tables and nothing else.
    source : str
        What the text is of, for the sentence that refuses it.
    folder : Path, optional
        That the problem files are in; without it no grid may name one.
    tiers : sequence of str, optional
        The tiers that are read; None for the grids of a user, which have no tier.

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
    read = []
    for number, table in enumerate(tables["grid"], start=1):
        where = f"{source}: {label('grid', table, number)}"
        if tiers is None and "tier" in table:
            raise ValueError(f"{where}: unknown key 'tier': the grids of a sweep have none")
        if tiers is None or table.get("tier", TIERS[0]) in tiers:
            read.append(_grid(table, where, folder))
    ids = [grid.id for grid in read]
    if len(set(ids)) < len(ids):
        raise ValueError(f"{source}: the id of a grid must be unique; found {', '.join(sorted(ids))}")
    return read


def cases_text() -> str:
    """Return the text of the standing cases.

    Examples
    --------
    >>> tuple(load_grids(cases_text(), folder=_DATA, tiers=["quick"])) == grids("quick")
    True
    """
    return _DATA.joinpath("cases.toml").read_text(encoding="utf-8")


def grids_for(standing: Iterable[Grid], models: Sequence[str] | None) -> list[Grid]:
    """Return the grids that a run computes: some only without given models, and others only with them.

    Examples
    --------
    >>> with_models, without = grids_for(grids("quick"), ["jkr"]), grids_for(grids("quick"), None)
    >>> [grid.id for grid in with_models if grid not in without]
    ['displacements']
    """
    excluded = {FOR_GIVEN_MODELS} if models is None else {VERIFICATION, AGAINST_ELEMENTS}
    return [grid for grid in standing if not excluded & set(grid.tags)]


@lru_cache(maxsize=len(TIERS))
def grids(tier: str) -> tuple[Grid, ...]:
    """Return the standing grids of a tier and of the tiers before it.

    Examples
    --------
    >>> [grid.id for grid in grids("quick")][0]
    'transition'
    """
    return tuple(load_grids(cases_text(), folder=_DATA, tiers=TIERS[: TIERS.index(tier) + 1]))
