"""Inputs of a run: its cases and its gates, read and checked before anything is computed."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path, PurePath
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import GRID_TEXT, INPUTS, RECORD
from comparisons.data.input_files import LARGEST_TABLE, LARGEST_TEXT, read_bytes, read_text
from comparisons.data.validation import known_name, label, shown
from comparisons.domain import Domain
from comparisons.judging.fresh_cases import FreshCases
from comparisons.judging.gates import Gate, gates_text, load_gates, of_tier
from comparisons.judging.selection import cases_of, load_user_gates, needed_keys
from comparisons.model import HasSkip
from comparisons.problem import Problem
from comparisons.problem.evaluation import REFERENCES, SOLVERS
from comparisons.problem.variation import parse_variations, require_units
from comparisons.registry import MODELS, ExternalIdentity, create
from comparisons.runs.cases import TIERS, VERIFICATION, Grid, cases_text, grids, grids_for, load_grids
from comparisons.runs.tasks import Task, plan

#: The name of a text that is in no file, for messages and for the record.
_TEXT = "a text"


@dataclass(frozen=True, slots=True)
class Cases:
    """The grids of a run.

    Attributes
    ----------
    grids : list of Grid
    tier : str or None
        Of the standing cases; None if the grids are others.
    text : str
        The TOML text that declares them.
    source : str or None
        The file of the text; None for the standing cases.
    files : mapping of str to bytes
        The problem files of the grids and their tables, by their path beside the text.
    """

    grids: list[Grid]
    tier: str | None
    text: str
    source: str | None
    files: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def sha256(self) -> str:
        """The checksum of the text, and of the problem files."""
        digest = sha256(self.text.encode())
        for name, content in sorted(self.files.items()):
            digest.update(f"{name} {len(content)} ".encode() + content)
        return digest.hexdigest()

    @property
    def tier_of_gates(self) -> str:
        """The tier up to which gates are used: without standing cases, all of them."""
        return self.tier or TIERS[-1]

    @property
    def compared(self) -> list[Grid]:
        """The grids that the tables of errors are about: without those that verify the references."""
        return [grid for grid in self.grids if self.tier is None or VERIFICATION not in grid.tags]


@dataclass(frozen=True, slots=True)
class Gates:
    """The gates of a run: those that are judged, and the text of all of them with its file (None: the standing one)."""

    gates: list[Gate]
    text: str
    source: str | None

    @property
    def sha256(self) -> str:
        """The checksum of the text."""
        return sha256(self.text.encode()).hexdigest()


@dataclass(frozen=True, slots=True)
class RunInputs:
    """What a run computes and judges.

    Attributes
    ----------
    cases : Cases
    gates : Gates or None
        None if nothing is judged.
    models : list of str or None
        Names of the candidates in place of those each grid names.
    external : mapping of str to ExternalIdentity
        Those of them that are external.
    domains : mapping of str to Domain
        The domains that external models declare.
    fresh : FreshCases or None
        None if the run has no random cases.
    """

    cases: Cases
    gates: Gates | None
    models: list[str] | None
    external: Mapping[str, ExternalIdentity]
    domains: Mapping[str, Domain] = field(default_factory=dict)
    fresh: FreshCases | None = None

    @property
    def specs(self) -> dict[str, str]:
        """The SPEC that finds each external model."""
        return {name: model.spec for name, model in self.external.items()}

    @property
    def taken(self) -> dict[str, HasSkip]:
        """What the candidates take: the closed forms and the atlas themselves, and the declared domains.

        A solver finds out while it computes whether a problem has an event.
        """
        names = self.models or sorted({name for grid in self.cases.grids for name in grid.models})
        ours = {name: create(name) for name in names if name in MODELS and name not in SOLVERS}
        return {**{name: model for name, model in ours.items() if isinstance(model, HasSkip)}, **self.domains}

    def plan(self) -> list[Task]:
        """Return every task once, as `comparisons.runs.tasks.plan`."""
        standing = plan(self.cases.grids, self.models, self.external)
        fresh = plan([part.grid for part in self.fresh.parts], None, self.external) if self.fresh else []
        return list(dict.fromkeys([*standing, *fresh]))

    def needed(self) -> list[Task]:
        """Return the tasks of `comparisons.judging.selection.needed_keys`; without gates all."""
        if self.gates is None:
            return self.plan()
        needed = needed_keys(self.gates.gates, self.cases.grids, self.models)
        for part in self.fresh.parts if self.fresh else ():
            needed |= needed_keys([part.gate], [part.grid], None)
        return [task for task in self.plan() if task.key in needed]


def load_cases(cases: str | Path, models: Sequence[str] | None, folder: Path | None = None) -> Cases:
    """Return the grids of a run.

    Parameters
    ----------
    cases : str or Path
        A tier of the standing cases, the path of a file of grids, or the text of such a file.
    models : sequence of str or None
        Models in place of those each grid names; the standing cases are then without those of verification.
    folder : Path, optional
        Where the problem files of the grids are; by default beside the file.

    Raises
    ------
    ValueError
        If the file cannot be read, or a grid is not admissible.

    Examples
    --------
    >>> load_cases("quick", None).tier
    'quick'
    """
    if isinstance(cases, str) and cases in TIERS:
        return Cases(grids_for(grids(cases), models), cases, cases_text(), None)
    if isinstance(cases, Path):
        source, text, folder = str(cases), read_text(cases, "the file of cases"), folder or cases.parent
    elif "\n" in cases:
        source, text = _TEXT, cases
    else:
        raise ValueError(
            f"the cases {cases!r} are neither a tier ({', '.join(TIERS)}) nor the text of [[grid]] tables; "
            "a file is given as a pathlib.Path"
        )
    loaded = load_grids(text, source, folder, tiers=None)
    return Cases(loaded, None, text, source, _files(loaded, folder) if folder else {})


def cases_of_problem(
    problem: Path, vary: Sequence[str], models: Sequence[str], quantities: Sequence[str], reference: str | None = None
) -> Cases:
    """Return the grid of a problem file for every combination of values of its keys.

    Parameters
    ----------
    problem : Path
        A problem file.
    vary : sequence of str
        ``SECTION.KEY=VALUES``, as of `comparisons.problem.variation.parse_variation`.
    models : sequence of str
        Names.
    quantities : sequence of str
        Of `comparisons.QUANTITIES`.
    reference : str, optional
        By default the first of `comparisons.problem.evaluation.REFERENCES` among the models, if one is.

    Raises
    ------
    ValueError
        One sentence, if a quantity is unknown, or a text or one of the problems is not admissible.
    """
    variations = parse_variations(vary)
    require_units(Problem.load(problem), variations)
    text = grid_text(
        id=problem.stem,
        title=problem.name,
        reference=reference or next((name for name in REFERENCES if name in models), ""),
        # Models from outside are given beside the grid, as for every other.
        models=[name for name in models if name in MODELS] or [REFERENCES[0]],
        quantities=quantities,
        problem=problem.name,
        vary=variations,
    )
    try:
        cases = load_cases(text, None, problem.parent)
    except ValueError as error:
        # The user knows the problem file and no grid.
        of_grid = f"{_TEXT}: {label('grid', {'id': problem.stem}, 1)}: "
        raise ValueError(str(error).removeprefix(of_grid)) from None
    return replace(cases, source=str(problem))


def grid_text(**entries: Any) -> str:
    """Return a [[grid]] table, which a folder keeps, of the entries that are not empty.

    Examples
    --------
    >>> print(grid_text(id="mine", models=["jkr"], reference="", n=[2.0], vary={"punch.R": ("1 um",)}), end="")
    [[grid]]
    id = "mine"
    models = ["jkr"]
    n = [2.0]
    vary = { "punch.R" = ["1 um"] }
    """
    return "".join(["[[grid]]\n", *(f"{name} = {_toml(value)}\n" for name, value in entries.items() if value)])


def _toml(value: Any) -> str:
    """Return a value as TOML; the text of a number is that of Python, also of one that is refused."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{json.dumps(key)} = {_toml(inner)}' for key, inner in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    return json.dumps(value) if isinstance(value, str) else str(value)


def stored_inputs(folder: Path, record: Mapping[str, Any]) -> RunInputs:
    """Return what the command of a record has computed, without gates; external models are not loaded.

    Raises
    ------
    ValueError
        As `load_cases`, or if the record names a model that it does not describe: it would be loaded, and its code run.
    """
    arguments = record["arguments"]
    specs, models = arguments["external"], arguments["model"]
    for name in [*specs, *(models or [])]:
        known_name("model", name, {*MODELS, *specs} & {*record["models"]}, str(folder / RECORD))
    cases = load_cases(arguments["tier"] or folder / GRID_TEXT, models, folder / INPUTS)
    external = {name: ExternalIdentity(name=name, spec=spec, **record["models"][name]) for name, spec in specs.items()}
    domains = {name: Domain.of_json(tables) for name, tables in record.get("domains", {}).items()}
    return RunInputs(replace(cases, source=arguments["grid"]), None, models, external, domains)


def _files(grids: Iterable[Grid], folder: Path) -> dict[str, bytes]:
    """Return the problem files of grids, and the tables that they name."""
    contents: dict[str, bytes] = {}
    for grid in grids:
        if not grid.problem:
            continue
        contents[PurePath(grid.problem).as_posix()] = read_bytes(path_inside(folder, grid.problem), LARGEST_TEXT)
        for name in dict.fromkeys(name for case in grid.cases for name in case.tables):
            table = PurePath(grid.problem).parent / name
            contents[table.as_posix()] = read_bytes(path_inside(folder, str(table)), LARGEST_TABLE)
    return contents


def read_gates(
    gates: str | Path | None, cases: Cases, models: Sequence[str] | None, *, standing: bool = False
) -> Gates:
    """Return the gates of a run.

    Parameters
    ----------
    gates : str, Path or None
        The path of a gates file, or the text of one; None for the standing gates.
    cases : Cases
    models : sequence of str or None
        Models in place of those each grid names.
    standing : bool
        Whether the file is a copy of the standing gates: gates about models that are not computed are then usual.

    Raises
    ------
    ValueError
        If the file cannot be read, a gate is not admissible, or a gate needs a model that is not computed.
    """
    if isinstance(gates, str) and "\n" not in gates:
        raise ValueError(
            f"the gates {shown(gates)} are not the text of [[gate]] tables; a file is given as a pathlib.Path"
        )
    text = gates if isinstance(gates, str) else gates_text(gates)
    if gates is None or standing:
        return Gates(_computed(of_tier(load_gates(text), cases.tier_of_gates), cases, models), text, None)
    source = str(gates) if isinstance(gates, Path) else _TEXT
    return Gates(load_user_gates(text, source, cases.tier_of_gates, cases.grids, models), text, source)


def _computed(gates: list[Gate], cases: Cases, models: Sequence[str] | None) -> list[Gate]:
    """Return the standing gates without those whose cases verify the references: chosen models do not compute them."""
    if models is None or cases.tier is None:
        return gates
    standing = grids(cases.tier)
    return [
        gate
        for gate in gates
        if gate.candidate not in models or cases_of(gate, cases.grids, models) or not cases_of(gate, standing, models)
    ]
