"""Predictions as data: a folder with `model.toml` and a CSV, judged without the execution of any code.

For codes that cannot be shipped and for measurements. The form of `model.toml` is in docs/judge_your_model.md and
`comparisons/data/model.schema.json`. The CSV has the columns quantity, n, k, mu, value, u_num and one row for each case
that is covered, no other. For problem files, with values in SI, the column problem stands in place of n, k, mu. `u_num`
bounds the numerical error of the value (for a measurement, its uncertainty).
"""

from __future__ import annotations

import csv
import hashlib
import math
from collections.abc import Collection, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import LARGEST_TABLE, read_bytes, read_text, utf8_text
from comparisons.data.plain_numbers import plain_float
from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, validated
from comparisons.domain import Domain
from comparisons.external.text_rules import model_name, one_line
from comparisons.model import Result, refuse
from comparisons.numerics.number_text import case_text
from comparisons.problem import Problem
from comparisons.problem.variation import problems_of
from comparisons.quantities import QUANTITIES

#: Name of the file that describes a model in a folder.
MANIFEST = "model.toml"

#: The quantity with n, k and mu, or with the name of a problem.
Key = tuple[Any, ...]

#: Columns of a case, or else of one of a problem file, and of its value.
_NUMBERS, _PROBLEM, _VALUES = ("n", "k", "mu"), ("problem",), ("value", "u_num")
#: Most cases of n, k and mu, and of problem files, which take 0.2 and 2 ms each to be built: half a minute.
_MOST_CASES, _MOST_PROBLEMS = 100_000, 10_000
#: Empty lines among the cases are admissible.
_MOST_LINES = 10 * _MOST_CASES

#: Most bytes of the description: twenty thousand numbers, which are checked in a second.
_LARGEST_MANIFEST = 400_000

#: Most characters of a line of the CSV: six cells, one of them the name of a problem.
_LONGEST_LINE = 10_000

#: So many cases more than the CSV has lines are still built: the sentence then names the first that is missing.
_NAMED_MISSING = 1000


class DataModel:
    """Predictions in a folder as a `comparisons.model.Model`.

    Parameters
    ----------
    folder : Path

    Attributes
    ----------
    rows : dict
        (quantity, n, k, mu), or (quantity, name of the problem) -> (value, u_num), of a problem in SI.
    problems : dict
        The problems of files by their names; empty where the cases are n, k and mu.

    Raises
    ------
    ValueError
        At the first thing that is wrong; one sentence names it with its place.
    """

    #: Its manifest lists the cases.
    applies_to = Domain(())

    def __init__(self, folder: Path) -> None:
        try:
            manifest = _manifest(folder)
            lines = _lines(folder, manifest)
            covered = _covered_cases(folder, manifest, len(lines))
            rows = _rows(lines, manifest, covered)
            self.rows = {(key[0], covered[key]): prediction for key, prediction in rows.items()}
        except (ValueError, OSError) as error:
            raise ValueError(f"{one_line(str(folder), 200)}: {one_line(str(error))}") from None
        self.name, self.domain = manifest["name"], manifest["domain"]
        self.limits = tuple(one_line(limit, 60) for limit in manifest.get("limits", []))
        self.version = f"{manifest['version']} ({manifest['sha256'].lower()[:12]})"
        source = "" if manifest["doi"] == "none" else f", doi:{manifest['doi']}"
        self.citation = f"{manifest['author']}{source} ({manifest['licence']})"
        self.hashed = f"the predictions, a CSV with {len(self.rows)} rows"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not for a case that the submission does not cover."""
        covered = (quantity, problem.without_nu()) in self.rows
        return None if covered else "the submission does not cover this case"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the prediction, or raise `NotApplicable` for a case that the submission does not cover."""
        refuse(self.skip(problem, quantity))
        value, u_num = self.rows[quantity, problem.without_nu()]
        unit = 1.0 if problem.is_dimensionless else problem.units[QUANTITIES[quantity].scale]
        return Result(value / unit, u_num / unit)

    def close(self) -> None:
        """Do nothing: there is no process."""


def _manifest(folder: Path) -> dict[str, Any]:
    manifest = parse(read_text(folder / MANIFEST, "the description of the predictions", _LARGEST_MANIFEST), MANIFEST)
    validated(manifest, "model", MANIFEST)
    model_name(manifest["name"])
    quantities = {quantity for table in manifest["covers"] for quantity in table["quantities"]}
    for quantity in quantities:
        known_name("quantity", quantity, QUANTITIES, f"{MANIFEST}: [[covers]]")
    if manifest["units"].keys() != quantities:
        raise ValueError(f"{MANIFEST}: [units] must have exactly {', '.join(sorted(quantities))}")
    forms = {frozenset(table) - {"quantities"} for table in manifest["covers"]}
    of_files = all(form - {"vary"} == {*_PROBLEM} for form in forms)
    if not of_files and forms != {frozenset(_NUMBERS)}:
        raise ValueError(f"{MANIFEST}: each [[covers]] has n, k and mu, or each has problem and perhaps vary")
    for name, unit in manifest["units"].items():
        compared = QUANTITIES[name].si_unit if of_files else QUANTITIES[name].unit
        if unit != compared:
            raise ValueError(
                f'{MANIFEST}: {name} has the unit "{unit}" but is compared in "{compared}": state the values in that'
            )
    return manifest


def _lines(folder: Path, manifest: dict[str, Any]) -> list[str]:
    """Return the lines of the CSV, whose checksum the manifest states."""
    name = manifest["predictions"]
    path = path_inside(folder, name)
    if not path.is_file():
        raise ValueError(f"there is no file {name}")
    content = read_bytes(path, LARGEST_TABLE)
    digest = hashlib.sha256(content).hexdigest()
    if digest != manifest["sha256"].lower():
        raise ValueError(
            f"{name} has the SHA-256 {digest}, but {MANIFEST} states {manifest['sha256']}: one of the two files was "
            "changed"
        )
    if content.count(b"\n") > _MOST_LINES:
        raise ValueError(f"{name} has more than {_MOST_LINES} lines")
    lines = utf8_text(path, content).split("\n")
    if (length := max(map(len, lines))) > _LONGEST_LINE:
        raise ValueError(f"{name} has a line of {length} characters; they have at most {_LONGEST_LINE}")
    return lines


def _covered_cases(folder: Path, manifest: dict[str, Any], lines: int) -> dict[Key, Problem]:
    """Return the cases that the [[covers]] tables promise, for a CSV with so many lines."""
    # Nothing is built before it is known how many cases there are: a short file can promise very many.
    tables = manifest["covers"]
    lists = [
        [table["quantities"], *(table.get(name, [None]) for name in _NUMBERS), *table.get("vary", {}).values()]
        for table in tables
    ]
    sizes = [math.prod(len({*values}) for values in columns) for columns in lists]
    most = _MOST_PROBLEMS if "problem" in tables[0] else _MOST_CASES
    if sum(sizes) > most or max(sizes) > lines + _NAMED_MISSING:
        raise ValueError(
            f"{MANIFEST}: the [[covers]] tables promise {sum(sizes)} cases, but the predictions have {lines} "
            f"lines, and at most {most} cases are read: each case needs a row"
        )
    covered: dict[Key, Problem] = {}
    for table, (quantities, *columns) in zip(tables, lists, strict=True):
        if "problem" in table:
            problems = problems_of(path_inside(folder, table["problem"]), table.get("vary", {}), table["problem"])
            cases = {(problem.name,): problem for problem in problems}
        else:
            numbers = product(*map(dict.fromkeys, columns))
            cases = {case: Problem.dimensionless(*case) for case in numbers}
        covered |= {(quantity, *cells): case for quantity in dict.fromkeys(quantities) for cells, case in cases.items()}
    if not covered:
        raise ValueError(f"{MANIFEST}: [[covers]] has no case")
    return covered


def _rows(lines: Sequence[str], manifest: dict[str, Any], covered: Collection[Key]) -> dict[Key, tuple[float, float]]:
    """Return the predictions of a CSV, one for each covered case."""
    rows: dict[Key, tuple[float, float]] = {}
    name, case = manifest["predictions"], _PROBLEM if "problem" in manifest["covers"][0] else _NUMBERS
    columns = ["quantity", *case, *_VALUES]
    # strict: a quotation mark that is not closed is an error, not the rest of the file.
    reader = csv.reader(lines, strict=True)
    try:
        if next(reader, []) != columns:
            raise ValueError(f"the first line must be {','.join(columns)}")
        for cells in filter(None, reader):
            key, prediction = _prediction(cells, columns)
            if key not in covered or key in rows:
                why = "has a second row" if key in rows else "is not among the cases that [[covers]] promises"
                raise ValueError(f"{_label(key)} {why}")
            rows[key] = prediction
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{name}, line {reader.line_num}: {error}") from None
    if missing := sorted(set(covered) - rows.keys()):
        raise ValueError(
            f"{name}: {len(missing)} of {len(covered)} rows that [[covers]] promises are missing, the first is "
            f"{_label(missing[0])}"
        )
    return rows


def _prediction(cells: list[str], columns: Sequence[str]) -> tuple[Key, tuple[float, float]]:
    if len(cells) != len(columns):
        raise ValueError(f"{len(cells)} cells, not {len(columns)}")
    (quantity, *case), (value, u_num) = cells[:-2], map(_number, _VALUES, cells[-2:])
    if u_num < 0:
        raise ValueError(f"u_num = {u_num:g} is outside [0, inf): it bounds an error")
    return (quantity, *(case if len(case) == 1 else map(_number, _NUMBERS, case))), (value, u_num)


def _number(name: str, cell: str) -> float:
    try:
        number = plain_float(cell)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{name} = {one_line(repr(cell), 40)} is not a finite number")
    return number


def _label(key: Key) -> str:
    quantity, *case = key
    text = case[0] if len(case) == 1 else case_text(dict(zip(_NUMBERS, case, strict=True)))
    return f"{one_line(quantity, 60)} at {one_line(text, 200)}"
