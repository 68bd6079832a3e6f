"""Fit of the series of the atlas to nodes, and the deviation at each node from the series without that node.

The deviation of a node is that of the series fitted to all other nodes.  It needs no further fit: with the inverse G of
the regularised Gram matrix of the nodes and the values y, it is (G y)_i / G_ii.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pandas import DataFrame

from fscm._typing import Array
from fscm.interpolation.components import COMPONENTS, CRITICAL, FOLD_GAPS, RELATIVE, Component
from fscm.interpolation.coordinates import Coordinates, patch_ends, seam
from fscm.interpolation.forms import FORMS, Points, critical_of_smooth, smooth_of_critical
from fscm.interpolation.series import Series, degrees_within, design_matrix

__all__ = ["Fit", "Layout", "fit_component", "fit_critical", "largest_degrees", "least_squares", "usable_nodes"]

#: Terms for each node; rates at which coefficients may fall; squared noise of the nodes, relative to the series.
_TERMS, _RATES, _RIDGE = 1.6, (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2), 1e-11
#: Relative bound of a node above which it has a smaller weight.
_NOISE = 1e-7
#: Near the critical Tabor number the solver may find one fold twice: then the gaps differ by rounding only.
_DISTINCT = 1e-6
#: Step of a smooth form for the slope of its value.
_STEP = 1e-6


class Layout(NamedTuple):
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


class Fit(NamedTuple):
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
    """Regularised least squares, with the rate for which the deviations are smallest.

    The rates are tried in ascending order, as long as the deviations decrease.  The series has more terms than there
    are nodes.  Of those that pass the nodes, within their noise, it is the one with the smallest coefficients divided
    by exp(-rate * degree): it uses every node, and its terms of high degree are as small as those of a smooth function.

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
    sizes = largest_degrees(layout.shape)
    largest = next(size for size in sizes if len(degrees_within(size, layout.power)) > _TERMS * count)
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


def largest_degrees(shape: tuple[float, ...]) -> Iterator[tuple[int, ...]]:
    """Largest degrees in ascending order, each once."""
    rounded = (np.maximum(1, np.round(size * np.array(shape))) for size in np.arange(2.0, 400.0, 0.5) / max(shape))
    return iter(dict.fromkeys(tuple(row.astype(int).tolist()) for row in rounded))


def usable_nodes(name: str, nodes: DataFrame, critical: Array) -> NDArray[np.bool_]:
    """Mask of the nodes to which a component is fitted."""
    component, mu = COMPONENTS[name], nodes["mu"].to_numpy()
    # Nodes are rounded, so that one at the seam may be above it.
    inside = mu > critical if component.upper else mu <= seam(nodes["n"].to_numpy()) * (1.0 + 1e-5)
    usable = np.logical_and(inside, np.isfinite(_values(component, nodes)[0]))
    if component.quantity.startswith(("jump", "hysteresis")):
        usable &= (nodes[FOLD_GAPS[0]] - nodes[FOLD_GAPS[1]] > _DISTINCT).to_numpy()
    return np.asarray(usable, bool)


def _values(component: Component, nodes: DataFrame) -> tuple[Array, Array]:
    """Values of a component at the nodes, and their bounds."""
    value, bound = (nodes[f"{u}{component.quantity}"].to_numpy() for u in ("", "u_"))
    if component.subtracted:
        value = value - nodes[component.subtracted].to_numpy()
        bound = bound + nodes[f"u_{component.subtracted}"].to_numpy()
    return value, bound


def fit_component(name: str, layout: Layout, nodes: DataFrame, critical: Array) -> Fit:
    """Fit a component to nodes that all have its value; the deviations are those of the value.

    Parameters
    ----------
    name : str
    layout : Layout
    nodes : DataFrame
    critical : ndarray
        Critical Tabor numbers of the atlas at the nodes.
    """
    component, coordinates = COMPONENTS[name], layout.coordinates
    form, n, k, mu = FORMS[component.form], *(nodes[name].to_numpy() for name in ("n", "k", "mu"))
    value, bound = _values(component, nodes)
    share = coordinates.share(n, k, mu, *patch_ends(component.upper, n, critical))
    at = Points(n, k, mu, share)
    smooth = form.smooth(value, at)
    scale = np.abs(value) + (0.0 if component.quantity in RELATIVE else 1.0)
    slope = (form.value(smooth + _STEP, at) - form.value(smooth - _STEP, at)) / (2.0 * _STEP)
    weight = np.abs(slope) / scale / np.hypot(1.0, bound / scale / _NOISE)
    fit = least_squares(coordinates.cube(n, k, share), smooth, weight, layout)
    return fit._replace(deviations=value - form.value(smooth - fit.deviations, at))


def fit_critical(layout: Layout, nodes: DataFrame) -> Fit:
    """Fit the critical Tabor number; the deviations are those of the value."""
    n, k, value = (nodes[name].to_numpy() for name in ("n", "k", CRITICAL))
    smooth = smooth_of_critical(n, k, value)
    fit = least_squares(layout.coordinates.plane(n, k), smooth, np.ones(len(value)), layout)
    return fit._replace(deviations=value - critical_of_smooth(n, k, smooth - fit.deviations))
