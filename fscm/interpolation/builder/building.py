"""Data of the atlas from the table of its nodes: series, and bounds by the statistics of their largest deviations.

The deviations above a high threshold are taken to be distributed exponentially: the heaviest tail of a bounded
quantity's that is usual (a generalised Pareto tail with shape zero; that of a bounded one is negative).
"""

from __future__ import annotations

import csv
import json
import math
from typing import Any

import numpy as np
from pandas import DataFrame

from fscm._typing import Array
from fscm.interpolation.builder.fitting import Fit, Layout, fit_component, fit_critical, usable_nodes
from fscm.interpolation.components import CRITICAL, QUANTITIES, RELATIVE, Composition
from fscm.interpolation.coordinates import CELLS, Cells, cells_of, plane_cells
from fscm.interpolation.forms import critical_of_smooth
from fscm.interpolation.storage import BOUNDS, COEFFICIENTS, LAYOUTS, RECORD, Stored, coordinates_of

__all__ = ["FACTOR", "build", "layouts", "tail_bound", "write"]

#: A bound is at least this many times the largest deviation: the nodes of a cell are few.
FACTOR = 3.0
#: Share of the sample above the threshold, and its least number of members.
_UPPER, _FEWEST = 1.0 / 3.0, 6
#: Probability that a point of the cell has a larger deviation.
_EXCEEDED = 1e-5
#: A cell with fewer nodes has the bound of the patch.
_FEWEST_IN_CELL = 18
#: The bound of a cell is at least this share of that of its neighbours: the deviation grows within a cell towards the
#: worse neighbour.  Measured without: one of 85 random problems, in the corner of a cell, was outside by 1.3 times.
_BESIDE = 0.5
#: Decimals of a coefficient.  The rounding changes a series of 4000 coefficients by 2e-10 at most, by 2e-12 usually.
_DECIMALS = 13


def layouts() -> dict[str, Layout]:
    """Layouts of all components."""
    table = json.loads(LAYOUTS.read_text(encoding="utf-8"))
    return {name: Layout(coordinates_of(row), tuple(row["shape"]), row["power"]) for name, row in table.items()}


def build(nodes: DataFrame, of_component: dict[str, Layout]) -> Stored:
    """Series and bounds from nodes.

    Parameters
    ----------
    nodes : DataFrame
        Columns n, k, mu and, for each quantity, its name and u_name; nan where a node has no value.
    of_component : dict of str to Layout
        Of the critical Tabor number, and of every component that is fitted.  A bound needs all those of its quantity.
    """
    on_plane = nodes[nodes[CRITICAL].notna()]
    fit = fit_critical(of_component[CRITICAL], on_plane)
    value, u_value = (on_plane[name].to_numpy() for name in (CRITICAL, f"u_{CRITICAL}"))
    relative = np.abs(fit.deviations / value)
    of_plane = plane_cells(on_plane["n"].to_numpy(), on_plane["k"].to_numpy())
    series, bounds = {CRITICAL: fit.series}, {(CRITICAL, "plane"): _of_cells(relative, u_value / value, of_plane)}
    record: dict[str, Any] = {CRITICAL: _summary(fit, len(relative)) | _sizes(relative)}

    n, k, mu = (nodes[name].to_numpy() for name in ("n", "k", "mu"))
    critical = critical_of_smooth(n, k, fit.series(of_component[CRITICAL].coordinates.plane(n, k)))
    deviations: dict[str, Array] = {}
    for name, layout in of_component.items():
        if name != CRITICAL:
            mask = usable_nodes(name, nodes, critical)
            fit = fit_component(name, layout, nodes[mask], critical[mask])
            series[name], deviations[name] = fit.series, np.full(len(n), math.nan)
            deviations[name][mask] = fit.deviations
            record[name] = _summary(fit, int(mask.sum()))
    for quantity, composition in QUANTITIES.items():
        for patch in ("upper",) if composition.jumps else ("lower", "upper"):
            if _components(composition, patch) <= deviations.keys():
                scale = np.abs(nodes[quantity].to_numpy()) + (0.0 if quantity in RELATIVE else 1.0)
                relative = _deviation(composition, patch, deviations) / scale
                mask = np.isfinite(relative)
                cells = cells_of(patch == "upper", n[mask], k[mask], mu[mask], critical[mask])
                u_relative = nodes[f"u_{quantity}"].to_numpy()[mask] / scale[mask]
                bounds[quantity, patch] = _of_cells(relative[mask], u_relative, cells)
                record[f"{quantity}.{patch}.deviations"] = _sizes(relative[mask])
    coordinates = {name: layout.coordinates for name, layout in of_component.items()}
    return Stored(coordinates, series, bounds, record)


def _components(composition: Composition, patch: str) -> set[str]:
    """Names of the components of a quantity in a patch."""
    return {getattr(composition, patch), composition.difference} - {""}


def _deviation(composition: Composition, patch: str, deviations: dict[str, Array]) -> Array:
    """Deviation of a quantity at the nodes."""
    of_patch = deviations[getattr(composition, patch)]
    return of_patch - deviations[composition.difference] if composition.difference else of_patch


def _of_cells(relative: Array, u_relative: Array, cells: Cells) -> Array:
    """Bound in each cell: that of the deviations, and the largest one of the nodes themselves."""
    of_fit, of_nodes = np.full((CELLS,) * len(cells), tail_bound(relative)), np.zeros((CELLS,) * len(cells))
    for cell in np.ndindex(of_fit.shape):
        inside = np.logical_and.reduce([number == index for number, index in zip(cells, cell, strict=True)])
        if np.count_nonzero(inside) >= _FEWEST_IN_CELL:
            of_fit[cell] = tail_bound(relative[inside])
        of_nodes[cell] = np.max(u_relative[inside], initial=0.0)
    return np.maximum(of_fit, _BESIDE * _largest_beside(of_fit)) + of_nodes


def _largest_beside(values: Array) -> Array:
    """Largest value in the cells that share a face with each cell."""
    largest = np.zeros_like(values)
    for axis in range(values.ndim):
        along, moved = np.moveaxis(largest, axis, 0), np.moveaxis(values, axis, 0)
        np.maximum(along[1:], moved[:-1], out=along[1:])
        np.maximum(along[:-1], moved[1:], out=along[:-1])
    return largest


def tail_bound(sample: Array) -> float:
    """Bound on the size of a quantity of which a sample is known.

    Parameters
    ----------
    sample : ndarray
        Of any signs.

    Raises
    ------
    ValueError
        If the sample has fewer than 18 members.

    Examples
    --------
    >>> 3.0 < tail_bound(np.random.default_rng(1).normal(size=100)) < 12.0
    True
    """
    sizes = np.sort(np.abs(sample))
    above = round(_UPPER * len(sizes))
    if above < _FEWEST:
        raise ValueError(f"a sample of {len(sizes)} is outside [{math.ceil(_FEWEST / _UPPER)}, inf): it has no tail")
    threshold = sizes[-above - 1]
    excess = float(np.mean(sizes[-above:] - threshold))
    return float(max(threshold + excess * math.log(above / len(sizes) / _EXCEEDED), FACTOR * sizes[-1]))


def _sizes(relative: Array) -> dict[str, float]:
    sizes = np.abs(relative)
    return {
        "root_mean_square": float(f"{np.sqrt(np.mean(sizes**2)):.2e}"),
        "99 of 100 below": float(f"{np.quantile(sizes, 0.99):.2e}"),
        "largest": float(f"{sizes.max():.2e}"),
    }


def _summary(fit: Fit, nodes: int) -> dict[str, Any]:
    return {"nodes": nodes, "terms": fit.terms, "rate": fit.rate}


def write(data: Stored) -> None:
    """Write coefficients, bounds and the record into the package."""
    RECORD.write_text(json.dumps(data.record, indent=1) + "\n", encoding="utf-8")
    with COEFFICIENTS.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["component", "of_n", "of_k", "of_mu", "value"])
        for name, series in data.series.items():
            rounded = np.round(series.coefficients, _DECIMALS)
            for degrees in np.argwhere(rounded != 0.0):
                table.writerow([name, *[*degrees.tolist(), "", ""][:3], repr(float(rounded[tuple(degrees)]))])
    with BOUNDS.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["quantity", "patch", "cell_of_n", "cell_of_k", "cell_of_mu", "bound"])
        for (quantity, patch), values in data.bounds.items():
            for index, value in np.ndenumerate(values):
                table.writerow([quantity, patch, *[*index, "", ""][:3], f"{value:.2e}"])
