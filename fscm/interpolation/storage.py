"""Data of the atlas in the package: coordinates, coefficients and bounds."""

from __future__ import annotations

import csv
import hashlib
import json
import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from fscm._typing import Array
from fscm.interpolation.coordinates import CELLS, Coordinates
from fscm.interpolation.series import Series

__all__ = ["BOUNDS", "COEFFICIENTS", "FOLDER", "LAYOUTS", "RECORD", "Stored", "coordinates_of", "data_digest", "stored"]

#: Folder of the data.
FOLDER = Path(str(files("fscm.interpolation") / "data"))
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
    series : dict of str to Series
    bounds : dict of (str, str) to ndarray, shape (CELLS, CELLS, CELLS)
        Of a quantity in a patch ("lower" or "upper"); in the plane (n, k) for the critical Tabor number.
    record : dict
        Numbers of nodes and terms, and how the data were made.
    """

    coordinates: dict[str, Coordinates]
    series: dict[str, Series]
    bounds: dict[tuple[str, str], Array]
    record: dict[str, Any]


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
    degrees: dict[str, list[list[int]]] = defaultdict(list)
    coefficients: dict[str, list[float]] = defaultdict(list)
    for name, *numbers, value in _rows(COEFFICIENTS):
        degrees[name].append([int(degree) for degree in numbers if degree])
        coefficients[name].append(float(value))
    series = {name: Series.of(np.array(degrees[name]), np.array(coefficients[name])) for name in degrees}
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
    return hashlib.sha256(b"".join(path.read_bytes() for path in (LAYOUTS, COEFFICIENTS, BOUNDS))).hexdigest()[:8]


def coordinates_of(row: Mapping[str, Any]) -> Coordinates:
    """Coordinates from a row of the layouts, in which null is an infinite distance.

    Examples
    --------
    >>> coordinates_of({"scale": [0, 0, 0, 0, 0], "n_pole": None, "k_pole": 0.4}).k_pole
    0.4
    """
    n_pole, k_pole = (math.inf if row[name] is None else float(row[name]) for name in ("n_pole", "k_pole"))
    return Coordinates(tuple(float(a) for a in row["scale"]), n_pole, k_pole, bool(row.get("root")))
