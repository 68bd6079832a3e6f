"""Meaning and unit of each column of the stored tables (`columns.toml`)."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from importlib.resources import files
from typing import Any, NamedTuple

__all__ = ["Column", "column", "title"]


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
    """Return what a column of a table holds; None of a column that fscm-bench does not name.

    Examples
    --------
    >>> column("results", "mu")
    Column(unit='1', description='generalised Tabor number (Eq. 29 of the paper)')
    >>> column("largest_kappa", "mu").description
    'generalised Tabor number at which abs(kappa) is largest'
    >>> column("results", "depth_of_my_own") is None
    True
    """
    content = _content()
    found = content["table"].get(table, {}).get("column", {}).get(name) or content["column"].get(name)
    return Column(**found) if found else None


def title(table: str) -> str | None:
    """Return what a row of a table is; None of a table without a title.

    Examples
    --------
    >>> title("results")
    'One row for each model, quantity and case'
    """
    found: str | None = _content()["table"].get(table, {}).get("title")
    return found


@lru_cache(maxsize=1)
def _content() -> dict[str, Any]:
    return tomllib.loads(files("comparisons.data").joinpath("columns.toml").read_text(encoding="utf-8"))
