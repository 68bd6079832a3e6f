"""Random solids of every kind of a problem file, over the range of each kind, and of functions of one's own.

`modulus` is the plane-strain modulus of the softest part, and `length` about the radius of the contact.  All take the
package whose classes they use, `fscm` or `fem_reference`, and draw the same for both.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from tests.random_kinds import between

MakeSolid = Callable[[ModuleType, np.random.Generator, float, float], Any]

#: Decades of moduli, and of depths in units of the length.
_CONTRAST, _DEPTHS = 1e3, (0.03, 30.0)
#: Largest Poisson's ratio: the finite elements have displacements alone, which do not tell the pressure at 1/2.
_RATIO = 0.49


def _ratio(rng: np.random.Generator) -> float:
    return float(rng.uniform(0.0, _RATIO))


def _moduli(rng: np.random.Generator, modulus: float, ratios: list[float], contrast: float = _CONTRAST) -> list[float]:
    """Young's moduli of parts with those Poisson's ratios, the softest one with the plane-strain modulus."""
    factors = np.array([between(rng, 1.0, contrast) for _ in ratios])
    plane = modulus * factors / factors.min()
    return [float(E * (1.0 - nu**2)) for E, nu in zip(plane, ratios, strict=True)]


def _homogeneous(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    nu = _ratio(rng)
    return package.Homogeneous(*_moduli(rng, modulus, [nu]), nu)


def _power_law(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    nu, k = _ratio(rng), float(rng.uniform(0.0, 0.8))
    c0 = length * between(rng, *_DEPTHS)
    return package.PowerLaw(modulus * (1.0 - nu**2) * (c0 / length) ** k, c0, k, nu)


def _offset_power_law(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    nu, k = _ratio(rng), float(rng.uniform(0.0, 0.9))
    z_s = length * between(rng, *_DEPTHS)
    return package.OffsetPowerLaw(modulus * (1.0 - nu**2), z_s, k, z_s, nu)


def _exponential(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    nu = _ratio(rng)
    return package.Exponential(*_moduli(rng, modulus, [nu, nu]), length * between(rng, *_DEPTHS), nu)


def _coating(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    ratios, thickness = [_ratio(rng), _ratio(rng)], length * between(rng, *_DEPTHS)
    transition = float(rng.choice([0.0, rng.uniform(0.05, 0.5)])) * thickness
    return package.Coating(*_moduli(rng, modulus, ratios), thickness, transition, *ratios)


def _layers(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    count = int(rng.integers(1, 4))
    ratios = [_ratio(rng) for _ in range(count + 1)]
    first = length * between(rng, *_DEPTHS)
    thickness = [first * between(rng, 0.3, 3.0) if i else first for i in range(count)]
    return package.Layers(tuple(_moduli(rng, modulus, ratios)), tuple(ratios), tuple(thickness))


def _table(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    count = int(rng.integers(3, 9))
    depths = np.append(0.0, np.cumsum(length * between(rng, *_DEPTHS) * rng.uniform(0.2, 1.0, count)))
    nu: Any = _ratio(rng) if rng.random() < 0.5 else [_ratio(rng) for _ in depths]
    ratios = nu if isinstance(nu, list) else [nu] * len(depths)
    return package.TabulatedModulus(tuple(depths.tolist()), tuple(_moduli(rng, modulus, ratios, 30.0)), nu)


def _function(package: ModuleType, rng: np.random.Generator, modulus: float, length: float) -> Any:
    """A modulus that approaches that of the depth slowly, as a power of the depth."""
    nu, depth, power = _ratio(rng), length * between(rng, *_DEPTHS), float(rng.uniform(0.5, 3.0))
    surface, deep = _moduli(rng, modulus, [nu, nu], 30.0)

    def E(z: np.ndarray) -> np.ndarray:
        return deep + (surface - deep) * (1.0 + z / depth) ** -power

    return package.CustomSolid(E, nu, depth)


#: By the names of `comparisons/data/kinds.toml`, and one more.
SOLIDS: dict[str, MakeSolid] = {
    "homogeneous": _homogeneous,
    "power-law": _power_law,
    "offset-power-law": _offset_power_law,
    "exponential": _exponential,
    "coating": _coating,
    "layers": _layers,
    "table": _table,
    "function": _function,
}
