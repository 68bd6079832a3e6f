"""Predictions as data: a folder with `model.toml` and a CSV, judged without the execution of any code.

For codes that cannot be shipped and for measurements.  `comparisons.external.manifest` has the keys of
`model.toml`.  The CSV has the columns quantity, n, k, mu, value, u_num and one row for each case that is
covered, no other.  `u_num` bounds the numerical error of the value (for a measurement, its uncertainty).
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
from dataclasses import dataclass
from pathlib import Path

from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import LARGEST_TABLE, LARGEST_TEXT, read_bytes
from comparisons.domain import Domain
from comparisons.external.manifest import MANIFEST, Key, check_units, covered_cases, read_manifest
from comparisons.external.text_rules import one_line
from comparisons.model import NotApplicable, Result
from fscm.laws import LennardJones
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["DataModel", "Submission", "read_submission"]

_COLUMNS = ["quantity", "n", "k", "mu", "value", "u_num"]
_TEXTS = ("name", "version", "author", "doi", "licence", "domain")


@dataclass(frozen=True, slots=True)
class Submission:
    """The checked content of a folder.

    Attributes
    ----------
    name, version, author, doi, licence, domain : str
        As the author states them, each one printable line.
    limits : tuple of str
        Limits in which the predictions are exact, as their author states.
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
    #: Its manifest lists the cases.
    applies_to = Domain(())

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
        default = problem.punch == PowerPunch(problem.n) and problem.law == LennardJones()
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
        At the first thing that is wrong; one sentence names it with its place.
    """
    try:
        return _submission(folder)
    except ValueError as error:
        raise ValueError(f"{one_line(str(folder), 200)}: {one_line(str(error))}") from None
    except OSError as error:
        raise ValueError(f"{one_line(str(folder), 200)}: it cannot be read ({error.strerror})") from None


def _submission(folder: Path) -> Submission:
    manifest = read_manifest(_text_of(_bytes(folder, MANIFEST, LARGEST_TEXT), MANIFEST))
    file = manifest["predictions"]
    content = _bytes(folder, file, LARGEST_TABLE)
    digest = hashlib.sha256(content).hexdigest()
    if digest != manifest["sha256"].lower():
        raise ValueError(
            f"{file} has the SHA-256 {digest}, but {MANIFEST} states {manifest['sha256']}: "
            "one of the two files was changed"
        )
    covered = covered_cases(manifest["covers"], _lines(content))
    check_units(manifest["units"], {key[0] for key in covered})
    return Submission(
        **{name: manifest[name] for name in _TEXTS},
        limits=tuple(one_line(limit, 60) for limit in manifest.get("limits", [])),
        sha256=digest,
        rows=_rows(content, file, covered),
    )


def _bytes(folder: Path, name: str, largest: int) -> bytes:
    try:
        path = path_inside(folder, name)
    except ValueError:
        raise ValueError(f"{name} is not in the folder of {MANIFEST}") from None
    if not path.is_file():
        raise ValueError(f"there is no file {name}")
    return read_bytes(path, largest)


def _lines(content: bytes) -> int:
    ends = content.count(b"\n") + content.count(b"\r") - content.count(b"\r\n")
    return ends + (not content.endswith((b"\n", b"\r")))


def _text_of(content: bytes, file: str) -> str:
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise ValueError(f"{file}, line {line}: byte 0x{content[error.start]:02x} is not UTF-8 text") from None


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
            f"{file}: {len(missing)} of {len(covered)} rows that [[covers]] promises are missing, the first is "
            f"{_label(missing[0])}"
        )
    return rows


def _number(cell: str, name: str, where: str) -> float:
    try:
        number = float(cell)
        if "_" in cell:
            # Python reads 1_0 as ten; in a CSV it is a misprint.
            raise ValueError
    except ValueError:
        raise ValueError(f"{where}: {name} = {one_line(repr(cell), 40)} is not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{where}: {name} = {number} is not a finite number")
    return number


def _label(key: Key) -> str:
    quantity, n, k, mu = key
    return f"{one_line(str(quantity), 60)} at n = {n:g}, k = {k:g}, mu = {mu:g}"
