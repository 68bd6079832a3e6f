"""Meaning and unit of each column of the stored tables (`columns.toml` and the files beside it)."""

from __future__ import annotations

from collections import ChainMap
from functools import lru_cache
from typing import Any, NamedTuple

from comparisons.data.toml_text import shipped

#: Files of the descriptions; the columns that the first one states for every table hold in the tables of all files.
FILES = ("columns.toml", "columns_of_figures.toml", "columns_of_solvers.toml")


class Column(NamedTuple):
    """What a column holds.

    Attributes
    ----------
    unit : str
        ``"1"`` of a plain number, empty of a text, and of what is true or false.
    description : str
    """

    unit: str
    description: str


def column(table: str, name: str) -> Column | None:
    """Return what a column of a table holds; None of one that fscm-bench does not name, as a varied key.

    Examples
    --------
    >>> column("results", "mu")
    Column(unit='1', description='generalised Tabor number (Eq. 29 of the paper)')
    >>> column("largest_kappa", "mu").description
    'generalised Tabor number at which abs(kappa) is largest'
    >>> column("results", "depth_of_my_own") is None
    True
    """
    contents = _contents()
    layers = [contents[0]["column"]]
    for content in contents:
        if table in content["table"]:
            layers[:0] = [content["table"][table].get("column", {}), content.get("column", {})]
    described = ChainMap(*layers).get(name)
    return Column(**described) if described else None


@lru_cache(maxsize=1)
def _contents() -> list[dict[str, Any]]:
    return list(map(shipped, FILES))
