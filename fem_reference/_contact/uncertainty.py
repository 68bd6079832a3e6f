"""Error of a mesh from three densities and another degree: observed order and Richardson estimate.

Every element of a mesh is `density` times a length that belongs to the problem, so three densities are a family of
similar meshes and the error behaves like density^p.  The difference of two degrees on the medium mesh is a second
estimate of the error there; the family tells how much of it is left on the fine mesh.  A short interval between two
lines may have one element at every density.  The family does not show its error, and all of the difference of the
degrees is the estimate then.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["Convergence", "three_meshes", "two_degrees"]

#: Lower limit of the order that is used.
SLOWEST = 1.0


#: Ratio of the errors of two degrees: the smallest is assumed everywhere, and the largest is believed of a measured one
#: (measured under coatings of 1 and 10 GPa, 100 and 30 nm thick, on 1.5 MPa: 37 and 36 on the medium mesh).
SMALLEST_GAIN, LARGEST_GAIN = 2.0, 3.0


@dataclass(frozen=True, slots=True)
class Convergence:
    """Outcome of three meshes.

    Attributes
    ----------
    error : float
        Estimate of the error on the fine mesh.
    observed_order : float
        log |d12 / d23| / log ratio; nan when the differences are rounding.

    Examples
    --------
    >>> round(three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0).error, 9)  # the limit is 1
    0.01
    """

    error: float
    observed_order: float


def three_meshes(
    values: tuple[float, float, float],
    ratio: float,
    declared: float,
    lower_degree: float | None = None,
    rounding: float = 0.0,
    refined: bool = True,
) -> Convergence:
    """Combine the values of a coarse, a medium and a fine mesh.

    Parameters
    ----------
    values : tuple of float
        Coarse, medium, fine.
    ratio : float
        Refinement ratio of neighbours, > 1.
    declared : float
        Order of the element; the observed order is not trusted beyond it.
    lower_degree : float, optional
        Value of the medium mesh with elements of a lower degree.  Its error is at least twice that of the medium mesh
        if a degree halves the error, and the difference is then at least the latter.
    rounding : float
        Size below which a difference has no order.
    refined : bool
        Whether every interval has more elements on the fine mesh than on the medium one.  Otherwise the error of the
        medium mesh, as the lower degree shows it, is not taken to fall.

    Returns
    -------
    Convergence

    Raises
    ------
    ValueError
        If the ratio is not above 1.

    Examples
    --------
    >>> three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0).observed_order
    2.0
    >>> round(three_meshes((1.16, 1.04, 1.07), ratio=2.0, declared=2.0).error, 9)  # the values turn back
    0.04
    >>> round(three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0, lower_degree=0.96).error, 9)
    0.02
    >>> round(three_meshes((1.16, 1.04, 1.01), ratio=2.0, declared=2.0, lower_degree=0.96, refined=False).error, 9)
    0.08
    """
    if ratio <= 1:
        raise ValueError(f"refinement ratio {ratio} is not above 1: the meshes must be refined")
    coarse, medium, fine = values
    coarse_step, fine_step = abs(coarse - medium), abs(medium - fine)
    order = (
        math.log(coarse_step / fine_step) / math.log(ratio)
        if coarse_step > rounding and fine_step > rounding
        else math.nan
    )
    # Too slow: the lowest order; too fast or rounding: the order of the element.
    trusted = declared if math.isnan(order) else min(max(round(order, 12), SLOWEST), declared)
    growth = ratio**trusted
    # Two fine values may agree by chance: the coarse one tells what their difference should be.
    # Values that turn back do not show that the last refinement has reduced the error: that of the medium mesh is kept.
    turned = (coarse - medium) * (medium - fine) < 0.0 and min(coarse_step, fine_step) > rounding
    error = max(fine_step, coarse_step if turned else coarse_step / growth) / (growth - 1.0)
    if lower_degree is not None:
        error = max(error, abs(lower_degree - medium) / (growth if refined else 1.0))
    return Convergence(error, round(order, 12))


def two_degrees(lower: tuple[float, float], values: tuple[float, float]) -> float:
    """Return the error on the fine mesh from elements of a lower degree there and on the medium mesh.

    Errors C_p h^p of the degrees p - 1 and p have a ratio, the gain of a degree, that grows like 1 / h.  The gain on
    the medium mesh, where the fine value stands for the exact one, is therefore not above that on the fine mesh.  There
    the two degrees differ by at least the gain less one times the error of the higher one.

    Parameters
    ----------
    lower, values : tuple of float
        Medium and fine, of the lower and of the higher degree.

    Examples
    --------
    >>> two_degrees((1.5, 1.25), (1.25, 1.0))  # a gain of 2
    0.25
    >>> two_degrees((3.0, 1.5), (1.125, 1.0))  # a gain of 16, of which 3 is believed
    0.25
    """
    (lower_medium, lower_fine), (medium, fine) = lower, values
    error, left = abs(lower_medium - fine), abs(medium - fine)
    gain = LARGEST_GAIN if error >= LARGEST_GAIN * left else max(error / left, SMALLEST_GAIN)
    return abs(lower_fine - fine) / (gain - 1.0)
