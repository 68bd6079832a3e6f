"""Data of the atlas in the package: coordinates, coefficients and bounds."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fscm._typing import Array
from fscm.interpolation.coordinates import CELLS, Coordinates
from fscm.interpolation.series import Series

__all__ = ["BOUNDS", "COEFFICIENTS", "FOLDER", "LAYOUTS", "RECORD", "Stored", "coordinates_of", "data_digest", "stored"]

#: Folder of the data.
FOLDER = Path(__file__).with_name("data")
#: Files of the data: layouts of the components, a record of their fit, coefficients and bounds.
LAYOUTS, RECORD, COEFFICIENTS, BOUNDS = (
    FOLDER / name for name in ("layouts.json", "record.json", "coefficients.csv", "bounds.csv")
)


@dataclass(frozen=True)
class Stored:
    """The data of an atlas.

    Attributes
    ----------
    coordinates : dict of str to Coordinates
        Of every component.
    series : mapping of str to Series
    bounds : dict of (str, str) to ndarray, shape (CELLS, CELLS, CELLS)
        Of a quantity in a patch ("lower" or "upper"); in the plane (n, k) for the critical Tabor number.
    record : dict
        Numbers of nodes and terms, and how the data were made.
    """

    coordinates: dict[str, Coordinates]
    series: Mapping[str, Series]
    bounds: dict[tuple[str, str], Array]
    record: dict[str, Any]


class _SeriesInFile(Mapping[str, Series]):
    """Series of the components, each read when it is used first; the rows of a component follow each other."""

    def __init__(self, text: str) -> None:
        self._rows: dict[str, str] = {}
        self._known: dict[str, Series] = {}
        start = text.index("\n")
        while start + 1 < len(text):
            name = text[start + 1 : text.index(",", start)]
            end = text.index("\n", text.rindex(f"\n{name},") + 1)
            self._rows[name], start = text[start + 1 : end], end

    def __getitem__(self, name: str) -> Series:
        if name not in self._known:
            rows = [row.split(",") for row in self._rows[name].split("\n")]
            degrees = [[int(degree) for degree in numbers if degree] for _, *numbers, _ in rows]
            self._known[name] = Series.of(np.array(degrees), np.array([float(row[-1]) for row in rows]))
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)


@cache
def stored() -> Stored:
    """The data in the package.

    Examples
    --------
    >>> sorted(stored().bounds)[0]
    ('critical_tabor_number', 'plane')
    """
    layouts = json.loads(LAYOUTS.read_text(encoding="utf-8"))
    coordinates = {name: coordinates_of(row) for name, row in layouts.items()}
    series = _SeriesInFile(COEFFICIENTS.read_text(encoding="utf-8"))
    bounds: dict[tuple[str, str], Array] = {}
    for quantity, patch, *cell, value in _rows(BOUNDS):
        index = tuple(int(number) for number in cell if number)
        of_patch = bounds.setdefault((quantity, patch), np.full((CELLS,) * len(index), math.inf))
        of_patch[index] = float(value)
    return Stored(coordinates, series, bounds, json.loads(RECORD.read_text(encoding="utf-8")))


def _rows(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]


@cache
def data_digest() -> str:
    """First eight digits of the SHA-256 of the data in the package.

    Examples
    --------
    >>> len(data_digest())
    8
    """
    from hashlib import sha256  # with OpenSSL, which takes milliseconds to load

    return sha256(b"".join(path.read_bytes() for path in (LAYOUTS, COEFFICIENTS, BOUNDS))).hexdigest()[:8]


def coordinates_of(row: Mapping[str, Any]) -> Coordinates:
    """Coordinates from a row of the layouts, in which null is an infinite distance.

    Examples
    --------
    >>> coordinates_of({"scale": [0, 0, 0, 0, 0], "n_pole": None, "k_pole": 0.4}).k_pole
    0.4
    """
    n_pole, k_pole = (math.inf if row[name] is None else float(row[name]) for name in ("n_pole", "k_pole"))
    return Coordinates(tuple(float(a) for a in row["scale"]), n_pole, k_pole, bool(row.get("root")))
