"""Variation of a problem file: every combination of values of some of its keys."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.data.validation import known_name, shown
from comparisons.problem.kinds import KINDS
from comparisons.problem.problem import BETWEEN, Problem
from comparisons.problem.reading import document_of, problem_of
from comparisons.problem.units import NUMBER

#: Values of one key, as in a problem file.
Values = Sequence[float | str]

#: Most problems of one variation, and most values of a range.
_MOST = 100_000

#: A range of values: first, last, number, unit.
RANGE = re.compile(rf"\s*({NUMBER})\s*:\s*({NUMBER})\s*:\s*(\d+)\s*(.*?)\s*")
_PLAIN = re.compile(rf"\s*{NUMBER}\s*")
_UNIT = re.compile(rf"\s*{NUMBER}\s*(.*?)\s*")

_FORM = 'write SECTION.KEY=VALUES, as "solid.thickness=5 nm, 10 nm" or "law.work_of_adhesion=20:100:5 mJ/m^2"'


def parse_variation(text: str) -> tuple[str, Values]:
    """Read ``SECTION.KEY=VALUES``: the name of the key and its values.

    The values are separated by commas, and the unit of the last one is that of those without; or ``first:last:number
    unit`` for values at equal distances, both ends included.

    Raises
    ------
    ValueError
        One sentence.

    Examples
    --------
    >>> parse_variation("solid.thickness=5, 10, 20 nm")
    ('solid.thickness', ['5 nm', '10 nm', '20 nm'])
    >>> parse_variation("law.work_of_adhesion=20:100:5 mJ/m^2")[1][:2]
    ['20 mJ/m^2', '40 mJ/m^2']
    """
    name, _, listed = text.partition("=")
    if not listed.strip():
        raise ValueError(f"--vary {shown(text)} names no key with values; {_FORM}")
    if match := RANGE.fullmatch(listed):
        try:
            texts, unit = spaced(match[1], match[2], match[3]), match[4]
        except ValueError as error:
            raise ValueError(f"--vary {shown(text)}: {error}") from None
    else:
        texts = [value.strip() for value in listed.split(",")]
        if "" in texts:
            raise ValueError(f"--vary {shown(text)}: a value is missing beside a comma; {_FORM}")
        unit_of_last = _UNIT.fullmatch(texts[-1])
        unit = unit_of_last[1] if unit_of_last else ""
    return ".".join(word.strip() for word in name.split(".")), [_value(value, unit) for value in texts]


def _value(text: str, unit: str) -> float | str:
    if not _PLAIN.fullmatch(text):
        return text
    return f"{text.strip()} {unit}" if unit else float(text)


def spaced(start: str, end: str, count: str, logarithmic: bool = False) -> list[str]:
    """Return numbers as texts, at equal distances, or at equal ratios to six digits, both ends included.

    Raises
    ------
    ValueError
        One sentence.

    Examples
    --------
    >>> spaced("20", "100", "5"), spaced("0.1", "10", "3", logarithmic=True)
    (['20', '40', '60', '80', '100'], ['0.1', '1', '10'])
    """
    ends, number = (float(start), float(end)), int(count)
    if not 2 <= number <= _MOST:
        raise ValueError(f"{count} values are outside 2 to {_MOST}; a range has both ends")
    if logarithmic and min(ends) <= 0.0:
        raise ValueError("values at equal ratios need ends above 0")
    # Twelve digits: 20:100:5 is 20, 40, 60 and not 60.000000000000007.  Equal ratios are seldom round: six digits.
    values, digits = (np.geomspace(*ends, number), 6) if logarithmic else (np.linspace(*ends, number), 12)
    texts = [f"{value:.{digits}g}" for value in values]
    if len(set(texts)) < number:
        raise ValueError("its ends are too near each other for so many values")
    return texts


def parse_variations(texts: Sequence[str]) -> dict[str, Values]:
    """Read several variations, as `parse_variation`; `ValueError` if one key is there twice."""
    variations = dict(map(parse_variation, texts))
    if len(variations) < len(texts):
        raise ValueError(f"--vary {', '.join(variations)}: a key is there twice; give all its values in one --vary")
    return variations


def require_units(problem: Problem, variations: Mapping[str, Values]) -> None:
    """Refuse a value without a unit of a key that has one: in a problem file, such a text is refused as well.

    Raises
    ------
    ValueError
        One sentence.
    """
    for name, values in variations.items():
        section_name, key, *_ = _parts(name, values)
        section = problem.section(section_name)
        form = KINDS[section_name][section.kind].keys.get(key)
        # The slope Q of a cone has no unit.
        unit = "" if form is None or (form.unit == "m^(n-1)" and section["n"] == 1.0) else form.unit
        for value in values:
            if unit and not isinstance(value, str):
                raise ValueError(f"--vary {name}: the value {value:g} has no unit; write it as {value:g} {unit}")


def with_unit(text: str) -> str:
    """Return ``SECTION.KEY=VALUE`` with the unit of the key, if the value is a plain number, which is in SI.

    Examples
    --------
    >>> with_unit("punch.R=2e-06"), with_unit("solid.k=0.4"), with_unit("punch.R=2 um")
    ('punch.R=2e-06 m', 'solid.k=0.4', 'punch.R=2 um')
    """
    name, _, value = text.partition("=")
    section, key = [*name.split("."), ""][:2]
    unit = next((kind.keys[key].unit for kind in KINDS.get(section, {}).values() if key in kind.keys), "")
    return f"{text} {unit}" if unit and _PLAIN.fullmatch(value) else text


def problems_of(path: Path, variations: Mapping[str, Values], name: str = "") -> Iterator[Problem]:
    """Yield the problem of a file for every combination of values.

    Parameters
    ----------
    path : Path
    variations : mapping of str to sequence of float or str
        The values of keys as "solid.thickness", as in a problem file; the key of one entry of a list has the number of
        the entry, from 1, behind a dot.
    name : str
        Of the file, for the names of the problems; by default that of the path.

    Raises
    ------
    ValueError
        One sentence, if a key, the file or one of the problems is not admissible, or there are too many.
    """
    keys = [_parts(varied, values) for varied, values in variations.items()]
    if (count := prod(map(len, variations.values()))) > _MOST:
        raise ValueError(f"the values have {count} combinations, more than {_MOST}; give fewer values")
    document, source = document_of(path)
    as_written = problem_of(document, source)
    for section, *_ in keys:
        as_written.section(section)
    for values in product(*variations.values()):
        changed = deepcopy(document)
        for key, value in zip(keys, values, strict=True):
            _change(changed, *key, value=value)
        texts = [f"{varied}={value}" for varied, value in zip(variations, values, strict=True)]
        try:
            problem = problem_of(changed, source)
        except ValueError as error:
            raise ValueError(f"{', '.join(texts)}: {error}" if texts else str(error)) from None
        parameters = {problem.form(varied).named(varied): problem[varied] for varied in variations}
        yield replace(problem, name=BETWEEN.join([name or path.name, *texts]), parameters=parameters)


def _parts(name: str, values: Values) -> list[str]:
    """Section, key and perhaps number of an entry; refuse values of which one is there twice."""
    parts, where = name.split(".", 2), f"vary {shown(name)}"
    if len(parts) < 2 or not all(parts):
        raise ValueError(f'{where} names no key; write SECTION.KEY, as "solid.thickness"')
    known_name("section", parts[0], KINDS, where)
    if parts[1] == "kind":
        raise ValueError(f"{where}: a kind is not varied, since its keys differ; write one file for each")
    if len(set(map(str, values))) < len(values):
        raise ValueError(f"{where} has one value twice; give each value once")
    return parts


def _change(document: Mapping[str, dict[str, Any]], section: str, key: str, number: str = "", *, value: Any) -> None:
    """Write a value into a section as it is written in a file; with a number, as that entry of a list."""
    if not number:
        document[section][key] = value
        return
    entries = document[section].get(key)
    count = len(entries) if isinstance(entries, list) else 0
    if not isinstance(entries, list) or number not in map(str, range(1, count + 1)):
        form = f"a list with the entries {key}.1 to {key}.{count}" if count else f"no list; leave out .{number}"
        raise ValueError(f"{shown(f'{section}.{key}.{number}')}: {key} is {form} in this file")
    entries[int(number) - 1] = value
