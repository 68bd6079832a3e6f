"""Numerical uncertainty from three meshes: observed order, Richardson estimate, safety factor.

Every element of a mesh is `density` times a length that belongs to the problem, so three densities in
constant ratio are a family of similar meshes and the error behaves like density^p.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["Convergence", "three_meshes"]

SAFETY = 3.0
"""Factor on the Richardson estimate: high orders are seldom in their asymptotic range (measured: the true
error stays below a third of the bound)."""

FLOOR = 2e-7
"""Relative error that refinement in the family does not show: first layer, exterior, tail, quadrature (measured
against the integral equation: worst 8e-8, for a cone at 0 < k <= 0.2; 1e-8 and less for paraboloids)."""


@dataclass(frozen=True, slots=True)
class Convergence:
    """Outcome of three meshes.

    Attributes
    ----------
    value : float
        Result of the finest mesh (no extrapolation).
    u_num : float
        Bound of its numerical error.
    observed_order : float
        log |d12 / d23| / log ratio; nan when the differences are rounding.

    Examples
    --------
    >>> three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0, scale=1.0).value
    1.01
    """

    value: float
    u_num: float
    observed_order: float


def three_meshes(values: tuple[float, float, float], ratio: float, declared: float, scale: float) -> Convergence:
    """Combine the values of a coarse, a medium and a fine mesh.

    Parameters
    ----------
    values : tuple of float
        Coarse, medium, fine.
    ratio : float
        Refinement ratio of neighbours, > 1.
    declared : float
        Order of the element; the observed order is not trusted beyond it.
    scale : float
        Size of the quantity, for the floor of the estimate.

    Returns
    -------
    Convergence

    Raises
    ------
    ValueError
        If the ratio is not above 1.

    Examples
    --------
    >>> three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0, scale=1.0).observed_order
    2.0
    """
    if ratio <= 1:
        raise ValueError(f"refinement ratio {ratio} is not above 1: the meshes must be refined")
    coarse, medium, fine = values
    first, second = abs(coarse - medium), abs(medium - fine)
    floor = FLOOR * scale
    tiny = 1e-3 * floor
    order = math.log(first / second) / math.log(ratio) if first > tiny and second > tiny else math.nan
    # Too slow: the declared lower limit 1; too fast or rounding: the order of the element.
    trusted = declared if math.isnan(order) else min(max(round(order, 12), 1.0), declared)
    growth = ratio**trusted
    difference = max(second, first / growth)
    return Convergence(fine, SAFETY * difference / (growth - 1.0) + floor, round(order, 12))
