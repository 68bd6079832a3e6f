"""Nodes of the atlas: quasi-random points with the density of Chebyshev nodes, and the sweep that computes them.

A least-squares fit at points of this density is as good as an interpolation, needs a fraction of the points of a
product grid, and can be continued: the first points of a Sobol sequence stay the same when there are more of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from fscm._typing import Array
from fscm.interpolation.components import CRITICAL, FOLD_GAPS, QUANTITIES
from fscm.interpolation.coordinates import BOX, LEAST_MU, MOST_MU, seam
from fscm.interpolation.nodes import Nodes

__all__ = [
    "SEEDS",
    "critical_nodes",
    "lower_nodes",
    "near_critical_problems",
    "random_problems",
    "sweep_of",
    "sweep_text",
    "upper_nodes",
]

#: Seeds of the Sobol sequences.
SEEDS = {"lower": 20261122, "upper": 20261123, "critical": 20261124, "verification": 13}
# Digits of a parameter, as in a Latin hypercube of a sweep.
_DIGITS = 6
# Upper nodes keep this relative distance from the critical Tabor number, where the two folds merge.
_DISTANCE = 5e-4
_PATH = tuple(name for name, composition in QUANTITIES.items() if not composition.jumps)
Node = tuple[float, float, float]


def _sobol(dimensions: int, count: int, seed: int) -> Array:
    # It takes a second to import.
    from scipy.stats import qmc

    exponent = max(0, int(np.ceil(np.log2(count))))
    # The name of this argument is the one that every supported SciPy knows.
    points = qmc.Sobol(dimensions, scramble=True, seed=seed).random_base2(exponent)
    return np.asarray(points[:count])


def _chebyshev(unit: Array) -> Array:
    """Even points in (0, 1), moved to the density of Chebyshev nodes."""
    return 0.5 * (1.0 - np.cos(np.pi * unit))


def _rounded(value: float, low: float, high: float) -> float:
    return min(max(float(f"{value:.{_DIGITS}g}"), low), high)


def _shapes(of_n: Array, of_k: Array) -> Iterator[tuple[float, float]]:
    (least_n, most_n), (_, most_k) = BOX["n"], BOX["k"]
    for a, b in zip(of_n.tolist(), of_k.tolist(), strict=True):
        nu = 1.0 / most_n + (1.0 / least_n - 1.0 / most_n) * a
        yield _rounded(1.0 / nu, least_n, most_n), _rounded(most_k * b, 0.0, most_k)


def lower_nodes(count: int) -> list[Node]:
    """Nodes between mu = 0.01 and the seam, even and odd ones with the densities of two coordinates.

    Examples
    --------
    >>> all(0.01 <= mu <= 1.1 for _, _, mu in lower_nodes(8))
    True
    """
    unit = _chebyshev(_sobol(3, count, SEEDS["lower"]))
    found = []
    for i, ((n, k), part) in enumerate(zip(_shapes(unit[:, 0], unit[:, 1]), unit[:, 2].tolist(), strict=True)):
        high = float(seam(np.array(n)))
        if i % 2:
            mu = LEAST_MU * (high / LEAST_MU) ** part
        else:
            exponent = (2.0 * n + k - 1.0) / n
            first, last = (np.log1p(20.0 * m**exponent) for m in (LEAST_MU, high))
            mu = (np.expm1(first + (last - first) * part) / 20.0) ** (1.0 / exponent)
        found.append((n, k, _rounded(float(mu), LEAST_MU, high)))
    return found


def upper_nodes(count: int, critical: Callable[[float, float], float]) -> list[Node]:
    """Nodes between the critical Tabor number, a function of n and k, and mu = 10."""
    unit = _chebyshev(_sobol(3, count, SEEDS["upper"]))
    found = []
    for (n, k), part in zip(_shapes(unit[:, 0], unit[:, 1]), unit[:, 2].tolist(), strict=True):
        low = critical(n, k)
        mu = max(low * (MOST_MU / low) ** part, low * (1.0 + _DISTANCE))
        found.append((n, k, _rounded(mu, LEAST_MU, MOST_MU)))
    return found


def critical_nodes(count: int) -> list[Node]:
    """Nodes of the plane (n, k), where the Tabor number does not matter."""
    unit = _chebyshev(_sobol(2, count, SEEDS["critical"]))
    return [(n, k, 1.0) for n, k in _shapes(unit[:, 0], unit[:, 1])]


def random_problems(count: int) -> list[Node]:
    """Problems for the verification: even in n, k and the logarithm of mu.

    Examples
    --------
    >>> len(set(random_problems(16)))
    16
    """
    unit = _sobol(3, count, SEEDS["verification"])
    (least_n, most_n), (_, most_k) = BOX["n"], BOX["k"]
    return [
        (
            _rounded(least_n + (most_n - least_n) * a, least_n, most_n),
            _rounded(most_k * b, 0.0, most_k),
            _rounded(LEAST_MU * (MOST_MU / LEAST_MU) ** c, LEAST_MU, MOST_MU),
        )
        for a, b, c in unit.tolist()
    ]


def near_critical_problems(count: int, critical: Callable[[float, float], float]) -> list[Node]:
    """Problems for the verification from 1e-3 to 1e-2 above the critical Tabor number, with the n and k of random ones.

    Examples
    --------
    >>> all(0.7007 <= mu <= 0.707 for _, _, mu in near_critical_problems(8, lambda n, k: 0.7))
    True
    """
    decades = np.log10(MOST_MU / LEAST_MU)
    return [
        (n, k, _rounded(critical(n, k) * (1.0 + 10.0 ** (-3.0 + np.log10(mu / LEAST_MU) / decades)), LEAST_MU, MOST_MU))
        for n, k, mu in random_problems(count)
    ]


def sweep_of(nodes: Nodes) -> str:
    """Text of the sweep file that computes the values of nodes again."""

    def having(quantity: str) -> list[Node]:
        some = nodes.with_value(quantity)
        return list(zip(some.n.tolist(), some.k.tolist(), some.mu.tolist(), strict=True))

    return sweep_text(having(CRITICAL), having(_PATH[0]), having(FOLD_GAPS[0]))


def sweep_text(critical: list[Node], path: list[Node], jumps: list[Node]) -> str:
    """Text of a sweep file for the critical Tabor number, the quantities of every path, and those of jumps.

    Examples
    --------
    >>> sweep_text([], [(2.0, 0.4, 1.0)], []).splitlines()[-2]
    '  { n = 2.0, k = 0.4, mu = 1.0 },'
    """
    of_jumps = [name for name, composition in QUANTITIES.items() if composition.jumps]
    grids = (
        ("critical", "Critical Tabor numbers", [CRITICAL], critical),
        ("path", "Pull-off and zero load", [*_PATH], path),
        ("jumps", "Jumps and hysteresis", of_jumps, jumps),
    )
    lines = ["# The nodes of the atlas: see docs/atlas.md."]
    for name, title, quantities, cases in grids:
        if not cases:
            continue
        lines += [
            "",
            "[[grid]]",
            f'id = "{name}"',
            f'title = "{title}"',
            'reference = "fscm"',
            'models = ["fscm"]',
            "quantities = [" + ", ".join(f'"{quantity}"' for quantity in quantities) + "]",
            "cases = [",
            *(f"  {{ n = {n!r}, k = {k!r}, mu = {mu!r} }}," for n, k, mu in cases),
            "]",
        ]
    return "\n".join(lines) + "\n"
