"""Reader of problem files."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.problem.columns import read_columns
from comparisons.problem.consistency import check_consistency
from comparisons.problem.form import SECTIONS, checked_section
from comparisons.problem.kinds import kind_of
from comparisons.problem.problem import Problem, Section
from comparisons.problem.source import Source, shown

__all__ = ["document_of", "load_problem", "problem_of"]

#: Rows that a smoothed profile needs: a cubic spline has four coefficients.
_FEWEST_SMOOTHED = 8

#: A whole number that Python does not read.
_MANY_DIGITS = re.compile(rf"\d{{{sys.int_info.default_max_str_digits + 1},}}")


def load_problem(path: str | os.PathLike[str]) -> Problem:
    """Read a problem file.

    Parameters
    ----------
    path : str or path
        A TOML file with the sections solid, punch and law; tables are in its folder.

    Returns
    -------
    Problem
        In SI units.

    Raises
    ------
    ValueError
        One sentence with file, line, value and remedy.

    Examples
    --------
    >>> load_problem("no_such_file.toml")
    Traceback (most recent call last):
    ValueError: no_such_file.toml: the problem file cannot be read (No such file or directory); check the name
    """
    return problem_of(*document_of(path))


def document_of(path: str | os.PathLike[str]) -> tuple[dict[str, Any], Source]:
    """Return the sections of a problem file as they are written, and its text.

    Parameters
    ----------
    path : str or path

    Raises
    ------
    ValueError
        As `load_problem`, if the file cannot be read or is not TOML.
    """
    path = Path(path)
    source = Source(path, read_text(path, "the problem file"))
    return _document(source), source


def problem_of(document: Mapping[str, Any], source: Source) -> Problem:
    """Return the problem of the sections of a file.

    Raises
    ------
    ValueError
        As `load_problem`.
    """
    path = source.path
    for name in document:
        if name not in SECTIONS:
            near = get_close_matches(name, SECTIONS, n=1)
            remedy = f"did you mean {near[0]}?" if near else f"the sections are {', '.join(SECTIONS)}"
            raise source.refusal(name, None, f"is unknown; {remedy}")
    for name in SECTIONS:
        if name not in document:
            raise ValueError(f"{path}: the section [{name}] is missing; a problem file has {', '.join(SECTIONS)}")
    solid, punch, law = (_section(document, name, source) for name in SECTIONS)
    problem = Problem(solid, punch, law, name=path.name, path=path)
    check_consistency(problem, source)
    return problem


def _document(source: Source) -> dict[str, Any]:
    try:
        return parse(source.text, str(source.path))
    except ValueError as error:
        # tomllib has the line at the end of its sentence, in brackets.
        if digits := _MANY_DIGITS.search(source.text):
            line = source.text.count("\n", 0, digits.start()) + 1
            raise ValueError(
                f"{source.path}, line {line}: {shown(digits[0])} has too many digits; write a power of ten, as 1e9"
            ) from None
        found = re.search(r" \(at line (\d+), column \d+\)$", str(error))
        if found is None:
            raise
        reason = str(error)[: found.start()].partition(": ")[2]
        text = source.text.splitlines()[int(found[1]) - 1].strip()
        raise ValueError(
            f"{source.path}, line {found[1]}: {shown(text)} is not TOML ({reason}); "
            "write key = value, and text in quotes"
        ) from None


def _section(document: Mapping[str, Any], name: str, source: Source) -> Section:
    values, uncertain = checked_section(document, name, source)
    kind = values.pop("kind")
    row = kind_of(name, kind)
    if not row.columns:
        return Section(kind, values, uncertain=uncertain)
    columns, fewest = row.columns, row.fewest_rows
    path = source.table(name, values["file"])
    # False for a name that is too long, too.
    if not os.path.isfile(path):
        raise source.refusal(
            name, "file", f"file = {shown(values['file'])} is not in the folder of {source.path.name}; check the name"
        )
    found = read_columns(path, columns, _FEWEST_SMOOTHED if "smoothing" in values else fewest)
    if name == "solid" and ("nu" in found) == ("nu" in values):
        has = "both have" if "nu" in found else "have no"
        raise source.refusal(name, None, f"the table and the section {has} nu; give it in one of the two")
    if name == "punch":
        first = found["r"][0], found["height"][0]
        if first[0] != 0.0 or (first[1] != 0.0 and "smoothing" not in values):
            raise ValueError(
                f"{path}: the first row is ({first[0]:g} m, {first[1]:g} m) and not the apex (0, 0); "
                "subtract the position of the apex"
            )
        if not found["height"][-1] > found["height"][0]:
            raise ValueError(f"{path}: the last height is not above the first one; a punch rises to the outside")
    return Section(kind, values, found, uncertain)
