"""The file `model.toml` of predictions as data: its keys, its texts and the cases that it promises.

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

Types, patterns and keys are in `comparisons/data/model.schema.json`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import product
from typing import Any

from comparisons.data.toml_text import is_real, parse
from comparisons.data.validation import known_name, validated
from comparisons.external.text_rules import model_name, one_line
from comparisons.quantities import QUANTITIES
from fscm.problem import Problem

__all__ = ["MANIFEST", "Key", "check_units", "covered_cases", "read_manifest"]

#: Name of the file that describes a model in a folder.
MANIFEST = "model.toml"

#: quantity, n, k, mu
Key = tuple[str, float, float, float]

_COVERS = ("quantities", "n", "k", "mu")
_MOST_CASES = 1_000_000

#: So many cases more than the CSV has lines are still built: the sentence then names the first that is missing.
_NAMED_MISSING = 1000


def read_manifest(text: str) -> dict[str, Any]:
    """Return the tables of a manifest.

    Raises
    ------
    ValueError
        At the first key that is missing, unknown or not admissible; the sentence has the key and its value.

    Examples
    --------
    >>> read_manifest('licens = "CC-BY-4.0"')
    Traceback (most recent call last):
    ...
    ValueError: model.toml: unknown key 'licens': did you mean licence?
    """
    manifest = parse(text, MANIFEST)
    try:
        validated(manifest, "model", MANIFEST)
    except RecursionError:
        raise ValueError(f"{MANIFEST} cannot be read: its brackets are nested too deeply") from None
    for name, value in manifest.items():
        if isinstance(value, str) and value != one_line(value):
            raise ValueError(f"{MANIFEST}: {name} must be one line of 1 to 500 printable characters")
    model_name(manifest["name"])
    return manifest


def covered_cases(tables: list[dict[str, Any]], lines: int) -> set[Key]:
    """Return the cases that the [[covers]] tables promise.

    Parameters
    ----------
    tables : list of dict
        The tables of a manifest that `read_manifest` returned.
    lines : int
        Number of lines of the CSV, and so the most rows it can have.

    Raises
    ------
    ValueError
        If a list has an unknown quantity or a value that is no number, if there is no case, or if there are too
        many.

    Examples
    --------
    >>> covered_cases([{"quantities": ["pull_off_force"], "n": [2], "k": [0], "mu": [1]}], lines=2)
    {('pull_off_force', 2.0, 0.0, 1.0)}
    """
    for table in tables:
        _check_values(table)
    # Nothing is built before it is known how many cases there are: a short file can promise very many.
    lists = [[list(dict.fromkeys(table[name])) for name in _COVERS] for table in tables]
    sizes = [math.prod(map(len, columns)) for columns in lists]
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
    for columns in lists:
        for quantity, n, k, mu in product(*columns):
            problem = Problem(n, k, mu)
            keys.add((quantity, problem.n, problem.k, problem.mu))
    if not keys:
        raise ValueError(f"{MANIFEST}: [[covers]] has no case")
    return keys


def _check_values(table: dict[str, Any]) -> None:
    for quantity in table["quantities"]:
        known_name("quantity", quantity, QUANTITIES, f"{MANIFEST}: [[covers]]")
    for name in ("n", "k", "mu"):
        if wrong := [entry for entry in table[name] if not is_real(entry)]:
            raise ValueError(f"{MANIFEST}: {name} in [[covers]] must be a list of numbers; found {wrong[0]!r}")


def check_units(units: dict[str, str], quantities: Iterable[str]) -> None:
    """Compare the [units] of a manifest with the units of the quantities that it covers.

    Raises
    ------
    ValueError
        If a unit is missing, unnecessary or another one.

    Examples
    --------
    >>> check_units({"jump_in_gap": "nm"}, ["jump_in_gap"])
    Traceback (most recent call last):
    ...
    ValueError: model.toml: jump_in_gap has the unit "nm" but is compared in "z0": divide the values by that
    """
    if units.keys() != set(quantities):
        raise ValueError(f"{MANIFEST}: [units] must have exactly {', '.join(sorted(quantities))}")
    for name, unit in units.items():
        if unit != QUANTITIES[name].unit:
            raise ValueError(
                f'{MANIFEST}: {name} has the unit "{unit}" but is compared in "{QUANTITIES[name].unit}": '
                "divide the values by that"
            )
