"""Parameters of the cases of a grid: a product of lists, a list of cases, or a Latin hypercube."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import prod
from typing import Any

import numpy as np

from comparisons.problem import PARAMETERS

__all__ = ["FORMS", "Point", "latin_hypercube", "parameter_sets"]

#: n, k, mu and nu, the last None if it is not prescribed.
Point = tuple[float, float, float, float | None]

#: Ways in which a grid states its cases.
FORMS = (
    "lists n, k, mu (and nu); cases = [{n = 2, k = 0, mu = 1}, ...]; a table [grid.latin_hypercube]; "
    'or problem = "FILE" (and vary)'
)

#: Most combinations of lists, each of which is built before anything is computed: they take a gigabyte.
_MOST_CASES = 1_000_000

#: Significant digits of a sampled parameter: as many as a message prints, so that a printed case is the exact one.
_DIGITS = 6


def parameter_sets(table: Mapping[str, Any], where: str) -> list[Point]:
    """Return n, k, mu and nu (None if not prescribed) of every case of a grid.

    Parameters
    ----------
    table : mapping
        A [[grid]] table that fits the schema of case files.
    where : str
        The grid, for the sentence that refuses it.

    Raises
    ------
    ValueError
        If the cases are stated in no way, in two, or in part.

    Examples
    --------
    >>> parameter_sets({"n": [2], "k": [0, 0.4], "mu": [1]}, "grid a")
    [(2, 0, 1, None), (2, 0.4, 1, None)]
    >>> parameter_sets({"cases": [{"n": 2, "k": 0, "mu": 1, "nu": 0.3}]}, "grid a")
    [(2, 0, 1, 0.3)]
    """
    lists = [name for name in PARAMETERS if name in table]
    stated = [", ".join(lists)] if lists else []
    stated += [name for name in ("cases", "latin_hypercube") if name in table]
    if len(stated) != 1:
        forms = f"{' and '.join(stated)} together" if stated else "no cases"
        raise ValueError(f"{where}: it has {forms}; state the cases once: {FORMS}")
    if "cases" in table:
        return [(case["n"], case["k"], case["mu"], case.get("nu")) for case in table["cases"]]
    if "latin_hypercube" in table:
        return latin_hypercube(table["latin_hypercube"], f"{where}: latin_hypercube")
    if missing := [name for name in PARAMETERS[:3] if name not in lists]:
        raise ValueError(f"{where}: {', '.join(missing)} missing; lists of cases are n, k, mu and perhaps nu")
    columns = [*(table[name] for name in PARAMETERS[:3]), table.get("nu", [None])]
    if (count := prod(map(len, columns))) > _MOST_CASES:
        raise ValueError(f"{where}: the lists have {count} combinations, more than {_MOST_CASES}; give shorter lists")
    return list(product(*columns))


def latin_hypercube(table: Mapping[str, Any], where: str) -> list[Point]:
    """Return points of a Latin hypercube: even in n, k, nu and in the logarithm of mu.

    Each parameter is rounded to six significant digits, inside its range.

    Parameters
    ----------
    table : mapping
        `count`, `seed`, and the ranges `n`, `k`, `mu` and perhaps `nu`: the smallest and the largest value.
    where : str
        For the sentence that refuses a range.

    Raises
    ------
    ValueError
        If a range is not one.

    Examples
    --------
    >>> table = {"count": 2, "seed": 1, "n": [2, 2], "k": [0, 0.4], "mu": [0.01, 1]}
    >>> [(point[0], point[1] < 0.2, point[2] < 0.1) for point in sorted(latin_hypercube(table, "a"))]
    [(2.0, True, False), (2.0, False, True)]
    """
    # It takes a second to import, and a product of lists does not need it.
    from scipy.stats import qmc

    names = [name for name in PARAMETERS if name in table]
    for name in names:
        low, high = table[name]
        if not (np.isfinite([low, high]).all() and low <= high):
            raise ValueError(
                f"{where}: {name} = [{low:g}, {high:g}] is not a range: it is the smallest and the largest value"
            )
    if table["mu"][0] <= 0:
        raise ValueError(
            f"{where}: mu = [{table['mu'][0]:g}, {table['mu'][1]:g}] is outside (0, inf): "
            "points are even in the logarithm of mu"
        )
    # The name of this argument is the one that every supported SciPy knows.
    sampler = qmc.LatinHypercube(len(names), seed=np.random.default_rng(table["seed"]))
    unit = sampler.random(table["count"])
    columns = {name: _scaled(unit[:, column], table[name], name == "mu") for column, name in enumerate(names)}
    nu: Sequence[float | None] = columns.get("nu") or [None] * table["count"]
    return list(zip(columns["n"], columns["k"], columns["mu"], nu, strict=True))


def _scaled(unit: np.ndarray, ends: Sequence[float], logarithmic: bool) -> list[float]:
    low, high = ends
    values = low * (high / low) ** unit if logarithmic else low + (high - low) * unit
    # Powers may differ in their last bit from one processor to the next; rounded, the points are the same.
    return [min(max(float(f"{value:.{_DIGITS}g}"), low), high) for value in values.tolist()]
