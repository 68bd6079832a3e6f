"""Table of the nodes of the atlas: values and bounds of the FSCM."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = ["Nodes", "collected"]

_PARAMETERS = ("n", "k", "mu")


@dataclass(frozen=True)
class Nodes:
    """Values at nodes; nan where a node has no value.

    Attributes
    ----------
    n, k, mu : ndarray, shape (m,)
    values, bounds : dict of str to ndarray, shape (m,)
        By quantity.

    Examples
    --------
    >>> one, force = np.ones(1), "pull_off_force"
    >>> Nodes(one, one, one, {force: 2.0 * one}, {force: 0.0 * one}).with_value(force).n.tolist()
    [1.0]
    """

    n: Array
    k: Array
    mu: Array
    values: dict[str, Array]
    bounds: dict[str, Array]

    @classmethod
    def read(cls, path: Path) -> Nodes:
        """The nodes of a file that `write` has written."""
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        columns = {name: np.array([float(row[name] or math.nan) for row in rows]) for name in rows[0]}
        names = [name for name in columns if name not in _PARAMETERS and not name.startswith("u_")]
        return cls(
            columns["n"],
            columns["k"],
            columns["mu"],
            {name: columns[name] for name in names},
            {name: columns[f"u_{name}"] for name in names},
        )

    def write(self, path: Path) -> None:
        """Write a CSV file: a row for each node, a column for each value and each bound."""
        with path.open("w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow([*_PARAMETERS, *(f"{u}{name}" for name in self.values for u in ("", "u_"))])
            for i in range(len(self.n)):
                row = [repr(float(getattr(self, name)[i])) for name in _PARAMETERS]
                for name in self.values:
                    value, bound = float(self.values[name][i]), float(self.bounds[name][i])
                    row += ["", ""] if math.isnan(value) else [repr(value), f"{bound:.1e}"]
                table.writerow(row)

    def chosen(self, which: NDArray[np.bool_]) -> Nodes:
        """Some of the nodes."""
        return Nodes(
            self.n[which],
            self.k[which],
            self.mu[which],
            {name: values[which] for name, values in self.values.items()},
            {name: bounds[which] for name, bounds in self.bounds.items()},
        )

    def with_value(self, *quantities: str) -> Nodes:
        """The nodes that have values of all these quantities."""
        return self.chosen(np.logical_and.reduce([np.isfinite(self.values[name]) for name in quantities]))


def collected(results: Iterable[Path]) -> Nodes:
    """Nodes from the tables `results.csv` of sweeps with the model `fscm`."""
    found: dict[tuple[float, float, float], dict[str, tuple[float, float]]] = {}
    for path in results:
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["model"] == "fscm":
                    node = found.setdefault((float(row["n"]), float(row["k"]), float(row["mu"])), {})
                    if row["status"] == "ok":
                        node[row["quantity"]] = float(row["value"]), float(row["u_num"])
    places = sorted(found)
    parameters = np.array(places)
    names = sorted({name for node in found.values() for name in node})
    none = (math.nan, math.nan)
    table = {name: np.array([found[place].get(name, none) for place in places]) for name in names}
    return Nodes(
        parameters[:, 0],
        parameters[:, 1],
        parameters[:, 2],
        {name: columns[:, 0] for name, columns in table.items()},
        {name: columns[:, 1] for name, columns in table.items()},
    )
