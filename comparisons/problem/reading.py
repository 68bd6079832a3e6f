"""Reader of problem files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

import fscm
from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.data.validation import known_name, shown
from comparisons.problem.columns import read_columns
from comparisons.problem.form import Source, kind_of, values_in_si
from comparisons.problem.kinds import KINDS, PUNCH_SOLID, SECTIONS, absent
from comparisons.problem.problem import Problem, Section
from fscm.punch import unit_of_radii

#: Largest and smallest admissible ratio of the radius of the punch to the range of the law.  A lens of 10 m
#: and a range of 0.2 nm give 5e10; a tip with a radius far below an atom has no meaning.
_RATIOS = 1e-3, 1e12


def load_problem(path: str | os.PathLike[str]) -> Problem:
    """Read a problem file.

    Parameters
    ----------
    path : str or path
        A TOML file with the sections solid, punch and law, and perhaps punch_solid; tables are in its folder.

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


def problem_of_sections(sections: Mapping[str, Any], folder: str | os.PathLike[str] = "") -> Problem:
    """Return the problem of sections that are written in Python; their tables are in a folder.

    Raises
    ------
    ValueError
        As `load_problem`.

    Examples
    --------
    >>> sections = {"solid": {"kind": "homogeneous", "E": "2 nm", "nu": 0.3}, "punch": {}, "law": {}}
    >>> problem_of_sections(sections)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ValueError: problem: solid.E = '2 nm' has the unit nm, which is not one of Pa; it must be a positive modulus, ...
    """
    document = {name: _as_written(section) for name, section in sections.items()}
    return replace(problem_of(document, Source(Path(folder) / "problem", "")), path=None)


def _as_written(section: object) -> object:
    """A section whose values are those of a file: lists for tuples and arrays, and numbers for those of NumPy."""
    if not isinstance(section, Mapping):
        return section
    return {key: _plain(value) for key, value in section.items()}


def _plain(value: object) -> object:
    if isinstance(value, tuple | np.ndarray):
        return [_plain(entry) for entry in value]
    return float(value) if isinstance(value, Real) and not isinstance(value, bool | int | float) else value


def document_of(path: str | os.PathLike[str]) -> tuple[dict[str, Any], Source]:
    """Return the sections of a problem file as they are written, and its text.

    Raises
    ------
    ValueError
        As `load_problem`, if the file cannot be read or is not TOML.
    """
    source = Source(Path(path), read_text(Path(path), "the problem file"))
    return parse(source.text, str(path)), source


def problem_of(document: Mapping[str, Any], source: Source) -> Problem:
    """Return the problem of the sections of a file.

    Raises
    ------
    ValueError
        As `load_problem`.
    """
    for name in document:
        if name not in KINDS and (remedy := absent(name) or next(filter(None, map(absent, _keys(document[name]))), "")):
            raise source.refusal(f"section {shown(name)}: {remedy}", name)
        known_name("section", name, KINDS, source.place(name))
    if missing := [name for name in SECTIONS if name not in document]:
        raise ValueError(f"{source.path}: {', '.join(missing)} missing; a problem file has {', '.join(SECTIONS)}")
    sections = {name: _section(name, table, source) for name, table in document.items()}
    solid, punch, law = (sections[name] for name in SECTIONS)
    body = sections.get(PUNCH_SOLID)
    problem = Problem(solid, punch, law, name=source.path.name, path=source.path, punch_solid=body)
    if problem.punch_solid is not None and "solid.friction" in problem.surface:
        raise source.refusal(
            'solid.friction = "bonded" needs a rigid punch, at which points keep their radius; leave out '
            '[punch_solid], or write "none"',
            "solid",
            "friction",
        )
    _check_scales(problem, source)
    return problem


def _keys(section: object) -> Iterable[str]:
    return section if isinstance(section, Mapping) else ()


def _section(name: str, table: Mapping[str, Any], source: Source) -> Section:
    kind = kind_of(name, table, source)
    values, uncertain = values_in_si(name, table, source)
    columns: dict[str, tuple[float, ...]] = {}
    if kind.columns:
        try:
            path = path_inside(source.path.parent, values["file"])
        except ValueError:
            path = None
        # False for a name that is too long, too.
        if path is None or not os.path.isfile(path):
            sentence = f"file = {shown(values['file'])} is not in the folder of {source.path.name}"
            raise source.refusal(f"{name}.{sentence}; put the table there and check its name", name, "file")
        columns = read_columns(path, kind.columns)
    section = Section(table["kind"], values, columns, uncertain)
    try:
        kind.build(fscm, section)
    except ValueError as error:
        raise source.refusal(f"{name}: {error}; correct the values", name, "file" if columns else None) from None
    return section


def _check_scales(problem: Problem, source: Source) -> None:
    """Refuse a problem whose scales do not fit together, or whose profile ends inside the contact."""
    try:
        posed = problem.build(fscm)
        z0 = posed.law.z0
        n, Q = unit_of_radii(posed.punch, z0)
        # Q of a cone is a slope: it has no scale.  Near a cone, Q^(1/(n-1)) is no length of the contact: r^2/z0 at the
        # height z0 is, which is R for a sphere.
        radius = z0 if n <= 1.0 else (Q * z0) ** (2.0 / n) / z0 if n < 2.0 else Q ** (1.0 / (n - 1.0))
        mu, reach = problem.posed.mu, problem.units["displacement"]
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{source.path}: {error}; check the values and their units") from None
    low, high = _RATIOS
    if not low <= radius / z0 <= high:
        key = next((key for key in ("R", "Q", "file") if key in problem.punch.values), None)
        sentence = f"the length {radius:.3g} m of the punch is {radius / z0:.1e} times the range {z0:.3g} m of the law"
        raise source.refusal(f"{sentence}, outside [{low:g}, {high:g}]; check the units of both", "punch", key)
    if problem.punch.kind == "table":
        # At pull-off the height of the shape at the contact edge is about mu z0 (1.2 times that for a sphere, by JKR),
        # and the law reaches further by its own range.
        height = problem.punch.columns["height"][-1] - problem.punch.columns["height"][0]
        needed = (1.0 + mu) * reach
        if height < needed:
            sentence = f"the profile {problem.punch['file']} ends at the height {height:.3g} m inside the contact"
            raise source.refusal(
                f"{sentence}, which reaches about {needed:.3g} m; measure it further out", "punch", "file"
            )
