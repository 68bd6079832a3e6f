"""Nodes of the atlas: quasi-random points with the density of Chebyshev nodes, and the sweep that computes them.

A least-squares fit at points of this density is as accurate as interpolation, needs a fraction of the points of a
product grid, and can be extended: the first points of a Sobol sequence stay the same when there are more of them.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from fscm._typing import Array
from fscm.interpolation.atlas import atlas
from fscm.interpolation.components import CRITICAL, QUANTITIES
from fscm.interpolation.coordinates import BOX, LEAST_MU, MOST_MU, seam

__all__ = ["Node", "critical_nodes", "lower_nodes", "rounded", "sobol", "sweep_text", "upper_nodes"]

#: Seeds of the Sobol sequences.
_LOWER, _UPPER, _CRITICAL = 20261122, 20261123, 20261124
#: Digits of a parameter, as in a Latin hypercube of a sweep.
_DIGITS = 6
#: Relative distance of upper nodes from the critical Tabor number, where the two folds merge.
_DISTANCE = 5e-4
#: Factor of the compliance in the coordinate of the even lower nodes.
_C = 20.0
#: A node (n, k, mu).
Node = tuple[float, ...]


def sobol(dimensions: int, count: int, seed: int) -> Array:
    """The first points of a scrambled Sobol sequence, shape (count, dimensions)."""
    from scipy.stats import qmc  # takes a second to import

    exponent = max(0, int(np.ceil(np.log2(count))))
    # `seed` is the name that every supported SciPy accepts.
    return np.asarray(qmc.Sobol(dimensions, scramble=True, seed=seed).random_base2(exponent)[:count])


def rounded(name: str, values: Array) -> Array:
    """Values of a parameter in the range of the atlas, to the digits of a sweep."""
    return np.clip([float(f"{value:.{_DIGITS}g}") for value in values.tolist()], *BOX[name])


def _chebyshev(dimensions: int, count: int, seed: int) -> tuple[Array, Array, Array]:
    """Shape indices, gradient exponents, and the last coordinates, with the density of Chebyshev nodes."""
    unit = 0.5 * (1.0 - np.cos(np.pi * sobol(dimensions, count, seed)))
    (least_n, most_n), (_, most_k) = BOX["n"], BOX["k"]
    nu = 1.0 / most_n + (1.0 / least_n - 1.0 / most_n) * unit[:, 0]
    return rounded("n", 1.0 / nu), rounded("k", most_k * unit[:, 1]), unit[:, -1]


def _nodes(n: Array, k: Array, mu: Array) -> list[Node]:
    return list(zip(n.tolist(), k.tolist(), rounded("mu", mu).tolist(), strict=True))


def lower_nodes(count: int) -> list[Node]:
    """Nodes between mu = 0.01 and the seam, even and odd ones with the densities of two coordinates.

    Examples
    --------
    >>> all(0.01 <= mu <= 1.1 for _, _, mu in lower_nodes(8))
    True
    """
    n, k, share = _chebyshev(3, count, _LOWER)
    high, exponent = seam(n), (2.0 * n + k - 1.0) / n
    start, end = (np.log1p(_C * np.asarray(mu) ** exponent) for mu in (LEAST_MU, high))
    even = (np.expm1(start + (end - start) * share) / _C) ** (1.0 / exponent)
    return _nodes(n, k, np.where(np.arange(count) % 2, LEAST_MU * (high / LEAST_MU) ** share, even))


def upper_nodes(count: int) -> list[Node]:
    """Nodes between the critical Tabor number of the present atlas and mu = 10."""
    n, k, share = _chebyshev(3, count, _UPPER)
    low = np.asarray(atlas(n, k, 1.0, CRITICAL).value)
    return _nodes(n, k, np.maximum(low * (MOST_MU / low) ** share, low * (1.0 + _DISTANCE)))


def critical_nodes(count: int) -> list[Node]:
    """Nodes of the plane (n, k), where the Tabor number does not matter."""
    n, k, _ = _chebyshev(2, count, _CRITICAL)
    return _nodes(n, k, np.ones(count))


def sweep_text(critical: Iterable[Node], path: Iterable[Node], jumps: Iterable[Node]) -> str:
    """Text of a sweep file for the critical Tabor number, the quantities of every path, and those of jumps.

    Examples
    --------
    >>> sweep_text([], [(2.0, 0.4, 1.0)], []).splitlines()[-2]
    '  { n = 2.0, k = 0.4, mu = 1.0 },'
    """
    of_path, of_jumps = ([name for name, row in QUANTITIES.items() if row.jumps is jumps] for jumps in (False, True))
    grids = (
        ("critical", "Critical Tabor numbers", [CRITICAL], critical),
        ("path", "Pull-off and zero load", of_path, path),
        ("jumps", "Jumps and hysteresis", of_jumps, jumps),
    )
    text = "# The nodes of the atlas: see docs/atlas.md.\n"
    for name, title, quantities, nodes in grids:
        cases = "\n".join(f"  {{ n = {n!r}, k = {k!r}, mu = {mu!r} }}," for n, k, mu in nodes)
        if cases:
            names = ", ".join(f'"{quantity}"' for quantity in quantities)
            text += f'\n[[grid]]\nid = "{name}"\ntitle = "{title}"\nreference = "fscm"\nmodels = ["fscm"]\n'
            text += f"quantities = [{names}]\ncases = [\n{cases}\n]\n"
    return text
