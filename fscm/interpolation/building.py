"""Computation of the data of the atlas from the table of nodes."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from fscm._typing import Array
from fscm.interpolation.cells import CELLS, Cells, cells_of, plane_cells
from fscm.interpolation.components import CRITICAL, QUANTITIES, RELATIVE, Composition
from fscm.interpolation.extremes import tail_bound
from fscm.interpolation.fitting import Fit, Layout, fit_component, fit_critical, nodes_of
from fscm.interpolation.forms import critical_of_smooth
from fscm.interpolation.nodes import Nodes
from fscm.interpolation.storage import Stored, coordinates_of

__all__ = ["build", "layouts"]

# A cell with fewer nodes has the bound of the patch.
_FEWEST = 18
# The bound of a cell is at least this part of that of its neighbours: the deviation grows within a cell towards the
# worse neighbour.  Measured without: one of 85 random problems, in the corner of a cell, was outside by 1.3 times.
_BESIDE = 0.5


def layouts(path: Path) -> dict[str, Layout]:
    """Layouts of all components, from a JSON file."""
    table = json.loads(path.read_text(encoding="utf-8"))
    return {name: Layout(coordinates_of(row), tuple(row["shape"]), row["power"]) for name, row in table.items()}


def build(nodes: Nodes, of_component: dict[str, Layout]) -> Stored:
    """Series and bounds from nodes.

    Parameters
    ----------
    nodes : Nodes
    of_component : dict of str to Layout
        Of the critical Tabor number, and of every component that is fitted.  A bound needs all those of its quantity.
    """
    on_plane = nodes.with_value(CRITICAL)
    fit = fit_critical(of_component[CRITICAL], on_plane)
    relative = np.abs(fit.deviations / on_plane.values[CRITICAL])
    u_relative = on_plane.bounds[CRITICAL] / on_plane.values[CRITICAL]
    of_plane = plane_cells(on_plane.n, on_plane.k)
    series, bounds = {CRITICAL: fit.series}, {(CRITICAL, "plane"): _of_cells(relative, u_relative, of_plane)}
    record: dict[str, Any] = {CRITICAL: _summary(fit, relative)}

    plane = of_component[CRITICAL].coordinates.plane(nodes.n, nodes.k)
    critical = critical_of_smooth(nodes.n, nodes.k, fit.series(plane))
    deviations: dict[str, Array] = {}
    for name, layout in of_component.items():
        if name == CRITICAL:
            continue
        which = nodes_of(name, nodes, critical)
        fit = fit_component(name, layout, nodes.chosen(which), critical[which])
        series[name] = fit.series
        deviations[name] = np.full(len(nodes.n), math.nan)
        deviations[name][which] = fit.deviations
        record[name] = {"nodes": int(which.sum()), "terms": fit.terms, "rate": fit.rate}
    for quantity, composition in QUANTITIES.items():
        for patch in ("upper",) if composition.jumps else ("lower", "upper"):
            if not _components(composition, patch == "upper") <= deviations.keys():
                continue
            of_quantity = _relative(quantity, composition, patch == "upper", nodes, deviations)
            known = np.isfinite(of_quantity)
            some = nodes.chosen(known)
            scale = np.abs(some.values[quantity]) + (0.0 if quantity in RELATIVE else 1.0)
            cells = cells_of(patch == "upper", some.n, some.k, some.mu, critical[known])
            bounds[quantity, patch] = _of_cells(of_quantity[known], some.bounds[quantity] / scale, cells)
            record[f"{quantity}.{patch}.deviations"] = _sizes(of_quantity[known])
    coordinates = {name: layout.coordinates for name, layout in of_component.items()}
    return Stored(coordinates, series, bounds, record)


def _components(composition: Composition, upper: bool) -> set[str]:
    """Names of the components of a quantity in a patch."""
    return {composition.upper if upper else composition.lower, composition.difference} - {""}


def _relative(
    quantity: str, composition: Composition, upper: bool, nodes: Nodes, deviations: dict[str, Array]
) -> Array:
    """Deviation of a quantity at the nodes, in units of its scale."""
    found = deviations[composition.upper if upper else composition.lower]
    if composition.difference:
        found = found - deviations[composition.difference]
    return found / (np.abs(nodes.values[quantity]) + (0.0 if quantity in RELATIVE else 1.0))


def _of_cells(relative: Array, u_relative: Array, cells: Cells) -> Array:
    """Bound in each cell: that of the deviations, and the largest one of the nodes themselves."""
    own, of_nodes = np.full((CELLS,) * len(cells), tail_bound(relative)), np.zeros((CELLS,) * len(cells))
    for cell in np.ndindex(own.shape):
        inside = np.logical_and.reduce([number == index for number, index in zip(cells, cell, strict=True)])
        if np.count_nonzero(inside) >= _FEWEST:
            own[cell] = tail_bound(relative[inside])
        of_nodes[cell] = np.max(u_relative[inside], initial=0.0)
    return np.maximum(own, _BESIDE * _largest_beside(own)) + of_nodes


def _largest_beside(values: Array) -> Array:
    """Largest value in the cells that share a face with each cell."""
    found = np.zeros_like(values)
    for axis in range(values.ndim):
        along, moved = np.moveaxis(found, axis, 0), np.moveaxis(values, axis, 0)
        np.maximum(along[1:], moved[:-1], out=along[1:])
        np.maximum(along[:-1], moved[1:], out=along[:-1])
    return found


def _sizes(relative: Array) -> dict[str, float]:
    sizes = np.abs(relative)
    return {
        "root_mean_square": float(f"{np.sqrt(np.mean(sizes**2)):.2e}"),
        "99 of 100 below": float(f"{np.quantile(sizes, 0.99):.2e}"),
        "largest": float(f"{sizes.max():.2e}"),
    }


def _summary(fit: Fit, relative: Array) -> dict[str, Any]:
    return {"nodes": len(relative), "terms": fit.terms, "rate": fit.rate} | _sizes(relative)
