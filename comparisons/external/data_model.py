"""Predictions as data: a folder with `model.toml` and a CSV, judged without executing anything of theirs.

For codes that cannot be shipped and for measurements.  `model.toml`:

    name = "my-abaqus"                       # letters, digits, ".", "_", "-"
    version = "2026-03"
    author = "A. Author"
    doi = "10.1000/xyz"                      # or "none"
    licence = "CC-BY-4.0"                    # SPDX
    domain = "n = 2, k = 0, 0.1 <= mu <= 2"
    predictions = "predictions.csv"          # beside this file
    sha256 = "..."                           # of that file: sha256sum predictions.csv
    limits = []                              # optional: "rigid", "jkr"
    [units]                                  # as fscm-bench list quantities has them
    pull_off_force = "pi Q^(2/n) dgamma z0^(2/n-1)"
    [[covers]]                               # a product of lists; several are allowed
    quantities = ["pull_off_force"]
    n = [2]
    k = [0]
    mu = [0.1, 1, 2]

The CSV has the columns quantity, n, k, mu, value, u_num and one row for each case that is covered, no other.
`u_num` bounds the numerical error of the value (for a measurement, its uncertainty).
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from comparisons.data.toml_text import is_real, parse
from comparisons.external.text_rules import model_name, one_line
from comparisons.model import NotApplicable, Result
from comparisons.quantities import QUANTITIES
from fscm.laws import LennardJones93
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["MANIFEST", "DataModel", "Submission", "read_submission"]

MANIFEST = "model.toml"

Key = tuple[str, float, float, float]

_COLUMNS = ["quantity", "n", "k", "mu", "value", "u_num"]
_TEXTS = ("name", "version", "author", "doi", "licence", "domain", "predictions", "sha256")
_COVERS = ("quantities", "n", "k", "mu")
_DOI = re.compile(r"none|10\.\d{4,9}/[!-;=?-~]{1,200}")
_LICENCE = re.compile(r"[A-Za-z0-9.+ ()-]{1,100}")
_FILE = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,100}\.csv")
_LARGEST_MANIFEST, _LARGEST_CSV, _MOST_CASES = 1_000_000, 50_000_000, 1_000_000

#: So many cases more than the CSV has lines are still built: the sentence then names the first that is missing.
_NAMED_MISSING = 1000


@dataclass(frozen=True, slots=True)
class Submission:
    """What a folder holds, all of it checked.

    Attributes
    ----------
    name, version, author, doi, licence, domain : str
        As the author states them, each one printable line.
    limits : tuple of str
        Limits the predictions are said to be right in.
    sha256 : str
        Of the CSV.
    rows : dict
        (quantity, n, k, mu) -> (value, u_num).
    """

    name: str
    version: str
    author: str
    doi: str
    licence: str
    domain: str
    limits: tuple[str, ...]
    sha256: str
    rows: dict[Key, tuple[float, float]]


class DataModel:
    """A submission as a `comparisons.model.Model`.

    Parameters
    ----------
    submission : Submission
    """

    physical = False

    def __init__(self, submission: Submission) -> None:
        self.submission = submission
        self.name, self.domain, self.limits = submission.name, submission.domain, submission.limits
        self.version = f"{submission.version} ({submission.sha256[:12]})"
        source = "" if submission.doi == "none" else f", doi:{submission.doi}"
        self.citation = f"{submission.author}{source} ({submission.licence})"
        self.hashed = f"the predictions, a CSV with {len(submission.rows)} rows"

    def evaluate(self, problem: Problem, quantity: str, *, scales: int = 0) -> Result:
        """Return the prediction, or raise `NotApplicable` for a case that the submission does not cover."""
        key = (quantity, problem.n, problem.k, problem.mu)
        default = problem.punch == PowerPunch(problem.n) and type(problem.law) is LennardJones93
        if not default or key not in self.submission.rows:
            raise NotApplicable("the submission does not cover this case")
        value, u_num = self.submission.rows[key]
        return Result(value, u_num)

    def close(self) -> None:
        """Do nothing: there is no process."""


def read_submission(folder: Path) -> Submission:
    """Read and check a folder.

    Raises
    ------
    ValueError
        At the first thing that is wrong; one sentence says what and where.
    """
    try:
        return _submission(folder)
    except ValueError as error:
        raise ValueError(f"{one_line(str(folder), 200)}: {one_line(str(error))}") from None
    except OSError as error:
        raise ValueError(f"{one_line(str(folder), 200)}: it cannot be read ({error.strerror})") from None


def _submission(folder: Path) -> Submission:
    manifest = parse(_text_of(_bytes(folder, MANIFEST, _LARGEST_MANIFEST), MANIFEST), MANIFEST)
    optional = {"limits"}
    expected = {*_TEXTS, "units", "covers"}
    if wrong := sorted((expected - manifest.keys()) | (manifest.keys() - expected - optional)):
        raise ValueError(f"{MANIFEST}: {', '.join(wrong)} missing or unknown; see docs/judge_your_model.md")
    texts = {name: _text(name, manifest[name]) for name in _TEXTS}
    model_name(manifest["name"])
    for name, pattern in (("doi", _DOI), ("licence", _LICENCE)):
        if not pattern.fullmatch(texts[name]):
            raise ValueError(f'{MANIFEST}: {name} = "{texts[name]}" is not one ("none" is a doi too)')
    limits = manifest.get("limits", [])
    if not (isinstance(limits, list) and all(isinstance(limit, str) for limit in limits)):
        raise ValueError(f"{MANIFEST}: limits must be a list of names")
    if not _FILE.fullmatch(texts["predictions"]):
        raise ValueError(
            f'{MANIFEST}: predictions = "{texts["predictions"]}" must be the name of a .csv file beside {MANIFEST}'
        )
    content = _bytes(folder, texts["predictions"], _LARGEST_CSV)
    digest = hashlib.sha256(content).hexdigest()
    if digest != texts["sha256"].lower():
        raise ValueError(
            f"{texts['predictions']} has the SHA-256 {digest}, but {MANIFEST} states {texts['sha256']}: "
            "one of them is not the author's"
        )
    covered = _covered(manifest["covers"], _lines(content))
    _check_units(manifest["units"], {key[0] for key in covered})
    rows = _rows(content, texts["predictions"], covered)
    return Submission(
        **{name: texts[name] for name in ("name", "version", "author", "doi", "licence", "domain")},
        limits=tuple(one_line(limit, 60) for limit in limits),
        sha256=digest,
        rows=rows,
    )


def _bytes(folder: Path, name: str, largest: int) -> bytes:
    path = folder / name
    try:
        inside = path.resolve().parent == folder.resolve()
    except RuntimeError:  # Python 3.11 and 3.12; a later one finds no file below
        raise ValueError(f"{name} is a loop of symbolic links") from None
    if not inside:
        raise ValueError(f"{name} leads out of the folder")
    if not path.is_file():
        raise ValueError(f"there is no file {name}")
    if path.stat().st_size > largest:
        raise ValueError(f"{name} has more than {largest} bytes")
    return path.read_bytes()


def _lines(content: bytes) -> int:
    ends = content.count(b"\n") + content.count(b"\r") - content.count(b"\r\n")
    return ends + (not content.endswith((b"\n", b"\r")))


def _text_of(content: bytes, file: str) -> str:
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise ValueError(f"{file}, line {line}: byte 0x{content[error.start]:02x} is not UTF-8 text") from None


def _text(name: str, value: object) -> str:
    if not (isinstance(value, str) and value.strip()):
        raise ValueError(f"{MANIFEST}: {name} must be a text")
    if value != one_line(value):
        raise ValueError(f"{MANIFEST}: {name} must be one line of at most 500 printable characters")
    return value


def _covered(tables: object, lines: int) -> set[Key]:
    """Return the cases that are promised; `lines` is how many the CSV has, and so the most rows it can have."""
    if not (isinstance(tables, list) and tables and all(isinstance(table, dict) for table in tables)):
        raise ValueError(f"{MANIFEST}: covers must be at least one [[covers]] table")
    for table in tables:
        _check_table(table)
    # Nothing is built before it is known how many cases there are: a short file can promise very many.
    lists = [[list(dict.fromkeys(table[name])) for name in _COVERS] for table in tables]
    sizes = [math.prod(map(len, table)) for table in lists]
    if sum(sizes) > _MOST_CASES:
        raise ValueError(
            f"{MANIFEST}: the [[covers]] tables promise {sum(sizes)} cases, more than {_MOST_CASES}: "
            "each of them needs a row"
        )
    if max(sizes) > lines + _NAMED_MISSING:
        raise ValueError(
            f"{MANIFEST}: a [[covers]] table promises {max(sizes)} cases, but the predictions have {lines} lines: "
            "each case needs a row"
        )
    keys: set[Key] = set()
    for table in lists:
        for quantity, n, k, mu in product(*table):
            problem = Problem(n, k, mu)
            keys.add((quantity, problem.n, problem.k, problem.mu))
    if not keys:
        raise ValueError(f"{MANIFEST}: [[covers]] has no case")
    return keys


def _check_table(table: dict[str, Any]) -> None:
    if table.keys() != set(_COVERS) or not all(isinstance(table[name], list) for name in _COVERS):
        raise ValueError(f"{MANIFEST}: a [[covers]] table has the lists {', '.join(_COVERS)} and no other")
    for quantity in table["quantities"]:
        if not isinstance(quantity, str) or quantity not in QUANTITIES:
            raise ValueError(f"{MANIFEST}: unknown quantity {quantity!r}; known are {', '.join(QUANTITIES)}")
    for name in ("n", "k", "mu"):
        if wrong := [entry for entry in table[name] if not is_real(entry)]:
            raise ValueError(f"{MANIFEST}: {name} in [[covers]] must be a list of numbers; {wrong[0]!r} is none")


def _check_units(units: object, quantities: set[str]) -> None:
    if not isinstance(units, dict) or units.keys() != quantities:
        raise ValueError(f"{MANIFEST}: [units] must have exactly {', '.join(sorted(quantities))}")
    for name, unit in units.items():
        if unit != QUANTITIES[name].unit:
            raise ValueError(
                f'{MANIFEST}: {name} is given in "{unit}" but compared in "{QUANTITIES[name].unit}": '
                "divide the values by that"
            )


def _rows(content: bytes, file: str, covered: set[Key]) -> dict[Key, tuple[float, float]]:
    # strict: a quotation mark that is not closed is an error, not the rest of the file.
    # A byte order mark, which spreadsheets write, belongs to no cell.
    reader = csv.reader(io.StringIO(_text_of(content, file).removeprefix("\ufeff"), newline=""), strict=True)
    rows: dict[Key, tuple[float, float]] = {}
    blank = ""
    try:
        header = next(reader, [])
        if header != _COLUMNS:
            raise ValueError(f"{file}: the first line must be {','.join(_COLUMNS)}")
        for cells in reader:
            where = f"{file}, line {reader.line_num}"
            if not cells:
                # Blank lines are the end of a file, or something is missing between.
                blank = blank or where
                continue
            if blank:
                raise ValueError(f"{blank}: a blank line, and rows after it")
            if len(cells) != len(_COLUMNS):
                raise ValueError(f"{where}: {len(cells)} cells, not {len(_COLUMNS)}")
            quantity, *rest = cells
            n, k, mu, value, u_num = (_number(cell, name, where) for cell, name in zip(rest, _COLUMNS[1:], strict=True))
            key = (quantity, n, k, mu)
            if key not in covered:
                raise ValueError(f"{where}: {_label(key)} is not among the cases that [[covers]] promises")
            if key in rows:
                raise ValueError(f"{where}: {_label(key)} has a second row")
            if u_num < 0:
                raise ValueError(f"{where}: u_num = {u_num:g} is outside [0, inf): it bounds an error")
            rows[key] = (value, u_num)
    except csv.Error as error:
        raise ValueError(f"{file}, line {reader.line_num}: {error}") from None
    if missing := sorted(covered - rows.keys()):
        raise ValueError(
            f"{file}: {len(missing)} of {len(covered)} rows that [[covers]] promises are missing, "
            f"the first is "
            f"{_label(missing[0])}"
        )
    return rows


def _number(cell: str, name: str, where: str) -> float:
    try:
        number = float(cell)
        if "_" in cell:
            # Ten to Python; whoever wrote 1_0 meant something else.
            raise ValueError
    except ValueError:
        raise ValueError(f"{where}: {name} = {one_line(repr(cell), 40)} is not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{where}: {name} = {number} is not a finite number")
    return number


def _label(key: Key | Iterable[Any]) -> str:
    quantity, n, k, mu = key
    return f"{one_line(str(quantity), 60)} at n = {n:g}, k = {k:g}, mu = {mu:g}"
