"""Files of the atlas: coordinates, coefficients and bounds."""

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
from fscm.interpolation.cells import CELLS
from fscm.interpolation.coordinates import Coordinates
from fscm.interpolation.series import Series

__all__ = ["Stored", "coordinates_of", "data_digest", "read", "stored", "write"]

_LAYOUTS, _RECORD, _COEFFICIENTS, _BOUNDS = "layouts.json", "record.json", "coefficients.csv", "bounds.csv"

# Decimals of a coefficient.  The rounding changes a series of 4000 coefficients by 2e-10 at most, by 2e-12 usually.
_DECIMALS = 13


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
    return read(_folder())


@cache
def data_digest() -> str:
    """First eight digits of the SHA-256 of the data in the package.

    Examples
    --------
    >>> len(data_digest())
    8
    """
    digest = hashlib.sha256()
    for name in (_LAYOUTS, _COEFFICIENTS, _BOUNDS):
        digest.update((_folder() / name).read_bytes())
    return digest.hexdigest()[:8]


def _folder() -> Path:
    return Path(str(files("fscm.interpolation") / "data"))


def read(folder: Path) -> Stored:
    """The data in a folder."""
    layouts = json.loads((folder / _LAYOUTS).read_text(encoding="utf-8"))
    coordinates = {name: coordinates_of(row) for name, row in layouts.items()}
    record = json.loads((folder / _RECORD).read_text(encoding="utf-8"))
    terms: dict[str, list[tuple[list[int], float]]] = defaultdict(list)
    with (folder / _COEFFICIENTS).open(encoding="utf-8", newline="") as file:
        for name, *degrees, value in csv.reader(file):
            if name != "component":
                terms[name].append(([int(degree) for degree in degrees if degree], float(value)))
    series = {
        name: Series.of(np.array([degrees for degrees, _ in rows]), np.array([value for _, value in rows]))
        for name, rows in terms.items()
    }
    bounds: dict[tuple[str, str], Array] = {}
    with (folder / _BOUNDS).open(encoding="utf-8", newline="") as file:
        for quantity, patch, *cell, value in csv.reader(file):
            if quantity != "quantity":
                index = tuple(int(number) for number in cell if number)
                known = bounds.setdefault((quantity, patch), np.full((CELLS,) * len(index), math.inf))
                known[index] = float(value)
    return Stored(coordinates, series, bounds, record)


def write(folder: Path, found: Stored) -> None:
    """Write coefficients, bounds and the record into a folder that has the layouts."""
    (folder / _RECORD).write_text(json.dumps(found.record, indent=1) + "\n", encoding="utf-8")
    with (folder / _COEFFICIENTS).open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["component", "of_n", "of_k", "of_mu", "value"])
        for name, series in found.series.items():
            rounded = np.round(series.coefficients, _DECIMALS)
            for degrees in np.argwhere(rounded != 0.0):
                padded = [*degrees.tolist(), "", ""][:3]
                table.writerow([name, *padded, repr(float(rounded[tuple(degrees)]))])
    with (folder / _BOUNDS).open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["quantity", "patch", "cell_of_n", "cell_of_k", "cell_of_mu", "bound"])
        for (quantity, patch), values in found.bounds.items():
            for index, value in np.ndenumerate(values):
                table.writerow([quantity, patch, *[*index, "", ""][:3], f"{value:.2e}"])


def coordinates_of(row: Mapping[str, Any]) -> Coordinates:
    """Coordinates from a row of the layouts, in which null is an infinite distance.

    Examples
    --------
    >>> coordinates_of({"scale": [0, 0, 0, 0, 0], "n_pole": None, "k_pole": 0.4}).k_pole
    0.4
    """
    n_pole, k_pole = (math.inf if row[name] is None else float(row[name]) for name in ("n_pole", "k_pole"))
    return Coordinates(tuple(float(a) for a in row["scale"]), n_pole, k_pole, bool(row.get("root")))
