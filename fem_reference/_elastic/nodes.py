"""Nodes along one side of a mesh: short near given places, with lines among them."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from fem_reference._elastic.depth_scales import DepthScales
from fem_reference._typing import Array

__all__ = ["depth_nodes", "outer_nodes", "radial_nodes", "sinh_nodes"]


def sinh_nodes(width: float, length: float, density: float) -> Array:
    """0 ... length, spaced like width * sinh(x) with x steps of at most `density`."""
    reach = math.asinh(length / width)
    count = max(2, math.ceil(reach / density))
    nodes = width * np.sinh(np.linspace(0.0, reach, count + 1))
    nodes[-1] = length
    return nodes


def outer_nodes(edge: float, width: float, length: float, density: float, far_share: float) -> Array:
    """0 ... length, spaced as `sinh_nodes` up to the distance `edge`, and at equal ratios of radii beyond."""
    if far_share == 1.0 or length <= edge:
        return sinh_nodes(width, length, density)
    inner, reach = sinh_nodes(width, edge, density), math.log((edge + length) / (2.0 * edge))
    count = math.ceil(reach / (far_share * density))
    far = 2.0 * edge * np.exp(np.linspace(0.0, reach, count + 1)) - edge
    far[-1] = length
    return np.concatenate([inner, far[1:]])


#: Length of the elements at a kink of the punch, relative to the distance of the next one, at the density 1. A kink
#: that is as near to the contact edge as this share of the edge replaces the mesh line there.
KINK_SHARE = 0.5

#: Points for the integral of the node density, for each length that it has to follow.
CURVE_POINTS = 400


def depth_nodes(width: float, length: float, density: float, scales: DepthScales) -> Array:
    """0 ... length, spaced as `sinh_nodes` and as the modulus asks for, with its lines among them."""
    lines = [z for z in scales.lines if 0 < z < length]
    parts = np.array([interval for interval in scales.parts if interval[0] < length]).reshape(-1, 2)
    if not lines and not parts.size:
        return sinh_nodes(width, length, density)
    curves = [width * np.sinh(np.linspace(0.0, math.asinh(length / width), 4 * CURVE_POINTS)), np.array(lines)]
    for a, b in parts:
        away = (b - a) * np.sinh(np.linspace(0.0, math.asinh(length / (b - a)), CURVE_POINTS))
        curves += [a - away, b + away, np.linspace(a, b, 9)]
    z, middle = _curve(curves, length)
    longest = np.hypot(width, middle)
    for a, b in parts:
        longest = np.minimum(longest, b - a + np.maximum(np.maximum(a - middle, middle - b), 0.0))
    return _counted_nodes(z, longest, lines, density)


def radial_nodes(edge: float, width: float, apex: float, length: float, density: float, kinks: Array) -> Array:
    """0 ... length, short at the apex, the edge and the kinks; lines at the kinks, and at the edge if it is apart."""
    inside = kinks[(kinks > 0) & (kinks < length)]
    lines = inside.tolist()
    if not lines or np.abs(inside - edge).min() > KINK_SHARE * width:
        lines = sorted([*lines, edge])
    ends = np.array([0.0, *lines, length])
    away = np.minimum(np.diff(ends)[:-1], np.diff(ends)[1:])
    centres = [(0.0, apex), (edge, width)]
    centres += [(z, KINK_SHARE * d) for z, d in zip(lines, away.tolist(), strict=True) if z != edge]
    curves = [np.array(lines)]
    for centre, short in centres:
        far = short * np.sinh(np.linspace(0.0, math.asinh(length / short), CURVE_POINTS))
        curves += [centre - far, centre + far]
    r, middle = _curve(curves, length)
    longest = np.min([np.hypot(short, middle - centre) for centre, short in centres], axis=0)
    return _counted_nodes(r, longest, lines, density)


def _curve(curves: list[Array], length: float) -> tuple[Array, Array]:
    """Points from 0 to length for the integral of the node density, and their middles."""
    x = np.unique(np.concatenate(curves))
    x = np.concatenate([[0.0], x[(x > 0) & (x < length)], [length]])
    return x, 0.5 * (x[:-1] + x[1:])


def _counted_nodes(x: Array, longest: Array, lines: list[float], density: float) -> Array:
    """Nodes between 0, the lines and the last x, of a length `density` times the longest there."""
    count = np.concatenate([[0.0], np.cumsum(np.diff(x) / longest)]) / density
    z, ends = x, np.array([0.0, *lines, x[-1]])
    nodes = [np.zeros(1)]
    for low, high in pairwise(ends):
        start, stop = np.interp([low, high], z, count)
        elements = max(1, math.ceil(stop - start))
        inside = np.interp(np.linspace(start, stop, elements + 1)[1:-1], count, z)
        nodes += [inside, np.array([high])]
    return np.concatenate(nodes)
