r"""Pieces of the equilibrium path, and the functions of n, k and mu in which each piece is smooth.

A path is cut where the central gap is the one of the largest tension, H_c, and where the load is L = 1 + mu^(2/n-1) in
compression.  On each piece runs a position from -1 to 1:

* approach, from the central gap 10 + 5 mu to H_c: the position is linear in 1 / (1 + H_0 / (1 + mu^(1/2)));
* contact, from H_c to L: the share of the length of the curve in the space of asinh(delta / (1 + mu)), asinh(P / L)
  and H_0.  For large mu the path turns many times in a small spiral near the jump-in; both pieces end in its middle;
* compression, from L to `LARGEST_LOAD`: the position is linear in ln P.

The functions take complex numbers: a step in the imaginary direction gives exact derivatives.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = [
    "COMPONENTS",
    "CONTACT_GAP",
    "LARGEST_LOAD",
    "PIECES",
    "Numbers",
    "States",
    "forms_of",
    "gap_at",
    "load_scale",
    "load_unit",
    "rigid_load",
    "states_of",
]

#: Real or complex numbers.
Numbers: TypeAlias = NDArray[Any]

#: Central gap at which the 9-3 law has its largest tension, 3^(1/6) - 1.
CONTACT_GAP = 3.0 ** (1.0 / 6.0) - 1.0
#: Load at the end of the path, in the unit of loads: adhesion is a ten-thousandth of it.
LARGEST_LOAD = 1.2e4
#: Names of the pieces, in the order of the path.
PIECES = ("approach", "contact", "compression")
#: Number of components of each piece: functions that a series expands.
COMPONENTS = {"approach": 2, "contact": 3, "compression": 2}


class States(NamedTuple):
    """States along a path; the contact radius is zero before the surface is at its largest tension."""

    displacement: Numbers
    load: Numbers
    contact_radius: Numbers


def load_unit(n: Numbers, mu: Numbers) -> Numbers:
    """L, of the order of the pull-off force for rigid and for soft contacts.

    Examples
    --------
    >>> float(load_unit(np.array(2.0), np.array(10.0)))
    2.0
    """
    return 1.0 + mu ** (2.0 / n - 1.0)


def load_scale(n: Array, mu: Array, load: Array) -> Array:
    """Unit of the errors of a load."""
    return load_unit(n, mu) + np.abs(load)


def rigid_load(n: Numbers, central_gap: Numbers) -> Numbers:
    """P of a rigid power-law punch (Eq. 42).

    Examples
    --------
    >>> float(rigid_load(np.array(2.0), np.array(0.0)))
    -2.0
    """
    b = 2.0 / n
    x = b - 1.0
    # B(3 - b, b) = (1 - x) x' / 2 with x' = pi x / sin(pi x), by its limits at x = 0 and x = 1.
    near_one = np.real(x) > 0.5
    beta_3 = 0.5 * np.where(near_one, x / np.sinc(1.0 - x), (1.0 - x) / np.sinc(x))
    ratio: Numbers = np.asarray(2.0 / 40320.0)
    for m in range(3, 9):
        ratio = ratio * (m - b)
    q = 1.0 / (central_gap + 1.0)
    return 16.0 / 3.0 * n ** (b - 1.0) * beta_3 * q ** (3.0 - b) * (ratio * q**6 - 1.0)


def _inverse_gap(mu: Numbers, central_gap: Numbers | float) -> Numbers:
    return 1.0 / (1.0 + central_gap / (1.0 + mu**0.5))


def gap_at(mu: Numbers, position: Array) -> Numbers:
    """Central gap at a position of the approach.

    Examples
    --------
    >>> gap_at(np.array(1.0), np.array([-1.0, 1.0])).round(4).tolist()
    [15.0, 0.2009]
    """
    start, end = _inverse_gap(mu, 10.0 + 5.0 * mu), _inverse_gap(mu, CONTACT_GAP)
    return (1.0 + mu**0.5) * (1.0 / (start + (end - start) * 0.5 * (position + 1.0)) - 1.0)


def states_of(piece: str, n: Numbers, mu: Numbers, position: Array, components: Numbers) -> States:
    """States from components.

    Parameters
    ----------
    piece : str
    n, mu : ndarray, shape (m, 1)
    position : ndarray, shape (p,)
    components : ndarray, shape (number of components, m, p)
    """
    if piece == "approach":
        gap = gap_at(mu, position)
        return States(
            (1.0 + mu) * components[0] - gap, rigid_load(n, gap) * components[1], np.zeros_like(components[0])
        )
    displacement = (1.0 + mu) * np.sinh(components[0])
    # Where contact begins the error of a series may be below zero.
    square = np.expm1(components[-1])
    radius = np.sqrt(np.where(np.real(square) > 0.0, square, 0.0))
    unit = load_unit(n, mu)
    if piece == "contact":
        return States(displacement, unit * np.sinh(components[1]), radius)
    load = unit * (LARGEST_LOAD / unit) ** (0.5 * (position + 1.0))
    return States(displacement, load + np.zeros_like(displacement), radius)


def forms_of(mu: float, unit: float, states: States) -> tuple[Array, Array, Array]:
    """The forms asinh(delta / (1 + mu)), asinh(P / L), ln(1 + a^2) of states in contact."""
    return (
        np.arcsinh(np.real(states.displacement) / (1.0 + mu)),
        np.arcsinh(np.real(states.load) / unit),
        np.log1p(np.real(states.contact_radius) ** 2),
    )
