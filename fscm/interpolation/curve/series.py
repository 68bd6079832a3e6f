"""Series of the components of a force curve in n, k and mu, their bounds, and the data in the package."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from fscm._typing import Array
from fscm.interpolation.coordinates import BOX
from fscm.interpolation.curve.pieces import PIECES, Numbers

__all__ = [
    "BINS",
    "DATA",
    "SPHERE",
    "CurveSeries",
    "basis",
    "cells_of_curve",
    "coordinates",
    "part_of",
    "position_basis",
    "stored_curve",
]

#: The data in the package.
DATA = Path(str(files("fscm.interpolation") / "data" / "force_curve.npz"))
#: Where a force curve changes fastest over the Tabor number, near the critical one, and over which distance of ln mu:
#: the last coordinate is linear in asinh((ln mu - ln 0.9) / (1 - 0.8 k)); the second one is linear in ln(1.2 - k).
#: Measured at 76 spheres: with coordinates linear in ln mu and k the deviations are three times as large.
_CENTRE, _NARROWING, _K_POLE = 0.9, 0.8, 0.2
#: Equal parts of the positions of a piece, each with its bound.
BINS = 6
#: Shape index and gradient exponent of bodies for which nodes are dense, and which have bounds of their own: spheres,
#: and homogeneous solids (k = 0).
SPHERE = 2.0


def coordinates(n: Numbers, k: Numbers, mu: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Coordinates from -1 to 1.

    Examples
    --------
    >>> [float(x.round(9)) for x in coordinates(np.array(1.0), np.array(0.0), np.array(10.0))]
    [1.0, -1.0, 1.0]
    """
    (least_n, most_n), (_, most_k) = BOX["n"], BOX["k"]
    of_n = (2.0 / n - 1.0 / most_n - 1.0 / least_n) / (1.0 / least_n - 1.0 / most_n)
    first, last = (np.log(1.0 + _K_POLE - end) for end in (0.0, most_k))
    of_k = 2.0 * (np.log(1.0 + _K_POLE - k) - first) / (last - first) - 1.0
    low, high = (_stretched(np.array(end), k) for end in BOX["mu"])
    return of_n, of_k, 2.0 * (_stretched(mu, k) - low) / (high - low) - 1.0


def _stretched(mu: Numbers, k: Numbers) -> Numbers:
    return np.arcsinh(np.log(mu / _CENTRE) / (1.0 - _NARROWING * k))


def basis(degrees: NDArray[np.int_], n: Numbers, k: Numbers, mu: Numbers) -> Numbers:
    """Values of the terms at points, shape (m, terms)."""
    terms: Numbers = np.ones(1)
    for x, degree in zip(coordinates(n, k, mu), degrees.T, strict=True):
        terms = terms * chebvander(x, int(degree.max()))[:, degree]
    return terms


def cells_of_curve(n: Array, k: Array, mu: Array) -> tuple[NDArray[np.int_], ...]:
    """Numbers of the cells of n, k and mu in each of which bounds hold.

    Examples
    --------
    >>> [int(number[0]) for number in cells_of_curve(*(np.array([x]) for x in (2.0, 0.5, 1.0)))]
    [1, 2, 1]
    """
    of_n = np.where(n == SPHERE, 1, np.where(n > SPHERE, 0, 2))
    of_k = np.where(k == 0.0, 0, np.where(k > 0.5 * BOX["k"][1], 2, 1))
    of_mu = coordinates(n, k, mu)[2]
    # Chebyshev nodes are as many in equal parts of the angle.
    number = np.arccos(np.clip(-of_mu, -1.0, 1.0)) * (3.0 / np.pi)
    return of_n, of_k, np.minimum(number.astype(np.int_), 2)


@dataclass(frozen=True)
class CurveSeries:
    """Series and bounds of all pieces.

    Attributes
    ----------
    degrees : ndarray of int, shape (terms, 3)
        In n, k and mu.
    coefficients : dict of str to ndarray, shape (terms, components, degree + 1)
        By the name of the piece; the last axis has the degrees in the position.
    bounds : ndarray, shape (3, 3, 3, pieces, BINS, 3)
        Of displacement, load and contact radius in their units, by cell, piece and part of the positions.
    """

    degrees: NDArray[np.int_]
    coefficients: dict[str, Array]
    bounds: Array

    @cached_property
    def _flat(self) -> Array:
        return np.concatenate([x.reshape(len(self.degrees), -1) for x in self.coefficients.values()], axis=1)

    def components(self, n: Numbers, k: Numbers, mu: Numbers) -> dict[str, Numbers]:
        """Chebyshev coefficients of the components over the position, shape (components, m, degree + 1)."""
        terms, start, of_pieces = basis(self.degrees, n, k, mu), 0, {}
        flat: Numbers = np.real(terms) @ self._flat
        if np.iscomplexobj(terms):
            flat = flat + 1j * (np.imag(terms) @ self._flat)
        for piece, values in self.coefficients.items():
            _, count, degrees = values.shape
            of_pieces[piece] = flat[:, start : start + count * degrees].reshape(-1, count, degrees).swapaxes(0, 1)
            start += count * degrees
        return of_pieces

    def bound(self, n: Array, k: Array, mu: Array, parts: NDArray[np.int_]) -> Array:
        """Bounds of displacement, load and contact radius in their units, shape (3, m, p).

        Parameters
        ----------
        n, k, mu : ndarray, shape (m,)
        parts : ndarray of int, shape (p,)
            `part_of` of each point.
        """
        of_cell = self.bounds.reshape(*self.bounds.shape[:3], -1, 3)[cells_of_curve(n, k, mu)]
        return of_cell[:, parts].transpose(2, 0, 1)

    def save(self, path: Path) -> None:
        """Write a file of NumPy with single precision, whose rounding is below all bounds."""
        approach, contact, compression = (self.coefficients[piece].astype(np.float32) for piece in PIECES)
        np.savez(
            path,
            degrees=self.degrees.astype(np.int8),
            bounds=self.bounds.astype(np.float32),
            approach=approach,
            contact=contact,
            compression=compression,
        )


@cache
def stored_curve() -> CurveSeries:
    """The data in the package.

    Examples
    --------
    >>> stored_curve().bounds.shape
    (3, 3, 3, 3, 6, 3)
    """
    with np.load(DATA) as data:
        coefficients = {piece: data[piece].astype(float) for piece in PIECES}
        return CurveSeries(data["degrees"].astype(int), coefficients, data["bounds"].astype(float))


def part_of(piece: str, position: Array) -> NDArray[np.int_]:
    """Number of the part of the path, of the same bound, in which positions of a piece are."""
    return PIECES.index(piece) * BINS + np.minimum((0.5 * (position + 1.0) * BINS).astype(np.int_), BINS - 1)


@cache
def position_basis(count: int, degree: int) -> tuple[Array, Array]:
    """Positions of points of a piece, and the terms there, shapes (p,) and (degree + 1, p)."""
    position = -np.cos(np.pi * np.linspace(0.0, 1.0, count))
    return np.asarray(position), np.ascontiguousarray(chebvander(position, degree).T)
