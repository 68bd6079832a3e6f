"""Fit of the series of the atlas to nodes, and the deviation at each node from the series without that node.

The deviation of a node is that of the series fitted to all other nodes.  It needs no further fit: with the inverse G of
the regularised Gram matrix of the nodes and the values y, it is (G y)_i / G_ii.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array
from fscm.interpolation.components import COMPONENTS, CRITICAL, FOLD_GAPS, RELATIVE, Component
from fscm.interpolation.coordinates import LEAST_MU, MOST_MU, Coordinates, seam
from fscm.interpolation.forms import FORMS, Place, critical_of_smooth, smooth_of_critical
from fscm.interpolation.nodes import Nodes
from fscm.interpolation.series import Series, degrees_within, design_matrix

__all__ = ["Fit", "Layout", "fit_component", "fit_critical", "least_squares", "nodes_of"]

# Terms for each node; rates at which coefficients may fall; squared noise of the nodes, relative to the series.
_TERMS, _RATES, _RIDGE = 1.6, (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2), 1e-11
# A node whose relative bound is larger counts less.
_NOISE = 1e-7
# Near the critical Tabor number the solver may find one fold twice: then the gaps differ by rounding only.
_DISTINCT = 1e-6
# Step of a smooth form for the change of its value.
_STEP = 1e-6


@dataclass(frozen=True)
class Layout:
    """Coordinates of a component and proportions of its degrees.

    Attributes
    ----------
    coordinates : Coordinates
    shape : tuple of float
        Proportions of the largest degrees in 1/n, k and mu.
    power : float
        1 for a bound on the sum of the degrees, 2 for one on the sum of their squares.
    """

    coordinates: Coordinates
    shape: tuple[float, ...]
    power: float


@dataclass(frozen=True)
class Fit:
    """A series, and the deviations of values at its nodes, each without that node.

    Attributes
    ----------
    series : Series
    deviations : ndarray, shape (m,)
    terms : int
    rate : float
        At which the coefficients are expected to fall.
    """

    series: Series
    deviations: Array
    terms: int
    rate: float


def least_squares(cube: Array, smooth: Array, weight: Array, layout: Layout) -> Fit:
    """Regularised least squares: the deviations from each node are smallest for the best of several rates.

    The rates are tried from the smallest one, as long as the deviations become smaller.

    The series has more terms than there are nodes.  Of those that pass the nodes, to their noise, it is the one whose
    coefficients are smallest when each is divided by exp(-rate * degree).  So it uses every node, and the terms of
    high degree stay as small as those of a smooth function are.

    Parameters
    ----------
    cube : ndarray, shape (m, dimensions)
    smooth, weight : ndarray, shape (m,)
    layout : Layout

    Examples
    --------
    >>> x = np.linspace(-1.0, 1.0, 20)[:, None]
    >>> plain = Layout(Coordinates((0.0,) * 5, math.inf, math.inf), (1.0,), 1.0)
    >>> fit = least_squares(x, x[:, 0] ** 2, np.ones(20), plain)
    >>> bool(abs(fit.series(np.array([[0.3]]))[0] - 0.09) < 1e-6)
    True
    """
    count = len(cube)
    if count < 2 * len(layout.shape):
        raise ValueError(f"{count} nodes are too few for a series of {len(layout.shape)} coordinates")
    largest = next(size for size in _sizes(layout.shape) if len(degrees_within(size, layout.power)) > _TERMS * count)
    degrees = degrees_within(largest, layout.power)
    degree = np.sum((degrees / np.array(layout.shape)) ** layout.power, axis=1) ** (1.0 / layout.power)
    matrix = design_matrix(cube, degrees) * weight[:, None]
    mean = float(weight @ (weight * smooth) / (weight @ weight))
    wanted = weight * (smooth - mean)
    best: tuple[float, Array, Array, float] = math.inf, wanted, degree, 0.0
    for rate in _RATES:
        expected = np.exp(-rate * degree)
        scaled = matrix * expected
        gram = scaled @ scaled.T
        gram /= np.trace(gram) / count
        gram += _RIDGE * np.eye(count)
        # Not the product with the inverse, which loses half of the digits.
        multipliers = np.linalg.solve(gram, wanted)
        deviations = multipliers / np.diag(np.linalg.inv(gram))
        size = float(np.sqrt(np.mean(deviations**2)))
        if size >= best[0]:
            break
        factor = float(np.sum(scaled * scaled)) / count
        best = size, deviations / weight, expected * (scaled.T @ multipliers) / factor, rate
    coefficients = best[2]
    coefficients[0] += mean
    return Fit(Series.of(degrees, coefficients), best[1], len(degrees), best[3])


def _sizes(shape: tuple[float, ...]) -> Iterator[tuple[int, ...]]:
    known: set[tuple[int, ...]] = set()
    for size in np.arange(2.0, 400.0, 0.5) / max(shape):
        largest = tuple(max(1, round(size * one)) for one in shape)
        if largest not in known:
            known.add(largest)
            yield largest


def nodes_of(name: str, nodes: Nodes, critical: Array) -> NDArray[np.bool_]:
    """Which nodes a component is fitted to."""
    component = COMPONENTS[name]
    value, _ = _component_values(component, nodes)
    # Nodes are rounded, so that one at the seam may be above it.
    inside = nodes.mu > critical if component.upper else nodes.mu <= seam(nodes.n) * (1.0 + 1e-5)
    usable = np.logical_and(inside, np.isfinite(value))
    if component.first.startswith(("jump", "hysteresis")):
        with np.errstate(invalid="ignore"):
            usable &= nodes.values[FOLD_GAPS[0]] - nodes.values[FOLD_GAPS[1]] > _DISTINCT
    return usable


def _component_values(component: Component, nodes: Nodes) -> tuple[Array, Array]:
    value, bound = nodes.values[component.first], nodes.bounds[component.first]
    if component.second:
        value = value - nodes.values[component.second]
        bound = bound + nodes.bounds[component.second]
    return value, bound


def fit_component(name: str, layout: Layout, nodes: Nodes, critical: Array) -> Fit:
    """Fit a component to nodes that all have its value; the deviations are those of the value.

    Parameters
    ----------
    name : str
    layout : Layout
    nodes : Nodes
    critical : ndarray
        Critical Tabor numbers of the atlas at the nodes.
    """
    component = COMPONENTS[name]
    form, coordinates = FORMS[component.form], layout.coordinates
    value, bound = _component_values(component, nodes)
    low, high = (critical, MOST_MU) if component.upper else (LEAST_MU, seam(nodes.n))
    part = coordinates.part(nodes.n, nodes.k, nodes.mu, low, high)
    at = Place(nodes.n, nodes.k, nodes.mu, part)
    smooth = form.smooth(value, at)
    scale = np.abs(value) + (0.0 if component.first in RELATIVE else 1.0)
    slope = (form.value(smooth + _STEP, at) - form.value(smooth - _STEP, at)) / (2.0 * _STEP)
    weight = np.abs(slope) / scale / np.hypot(1.0, bound / scale / _NOISE)
    fit = least_squares(coordinates.cube(nodes.n, nodes.k, part), smooth, weight, layout)
    return Fit(fit.series, value - form.value(smooth - fit.deviations, at), fit.terms, fit.rate)


def fit_critical(layout: Layout, nodes: Nodes) -> Fit:
    """Fit the critical Tabor number; the deviations are those of the value."""
    value = nodes.values[CRITICAL]
    smooth = smooth_of_critical(nodes.n, nodes.k, value)
    plane = layout.coordinates.plane(nodes.n, nodes.k)
    fit = least_squares(plane, smooth, np.ones(len(value)), layout)
    return Fit(fit.series, value - critical_of_smooth(nodes.n, nodes.k, smooth - fit.deviations), fit.terms, fit.rate)
