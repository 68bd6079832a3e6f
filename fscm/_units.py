"""Units of the dimensionless problem, and the Tabor number of a power law (Eqs. 25, 29 and 31).

Any consistent units do: lengths in one unit, moduli and tractions in another, loads in traction * length^2,
the work of adhesion in traction * length, Q in length^(n-1).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from fscm._response_factor import response_factor_per_rest
from fscm.solids import PowerLaw

__all__ = [
    "DIMENSIONLESS",
    "log_tabor_number",
    "modulus_for",
    "number_from_log",
    "units_of",
]

#: Natural logarithm of 1e304: within the range of floating-point numbers.
_LOG_RANGE = 700.0

_KINDS = ("displacement", "gap", "radius", "traction", "load", "energy", "stiffness", "energy_per_area", "number")

#: Units of a dimensionless problem: each is one.
DIMENSIONLESS: Mapping[str, float] = MappingProxyType(dict.fromkeys(_KINDS, 1.0))


def number_from_log(name: str, log: float) -> float:
    """The exponential, or ValueError where it is outside the range of floating-point numbers."""
    if not abs(log) < _LOG_RANGE:
        raise ValueError(f"the {name} is 10^{log / math.log(10.0):.0f}, outside (1e-304, 1e304): check the units")
    return math.exp(log)


def units_of(n: float, Q: float, work_of_adhesion: float, z0: float) -> Mapping[str, float]:
    """Physical unit of each kind of quantity.

    displacement, gap: z0; radius: (Q z0)^(1/n); traction: dgamma / z0; load: pi Q^(2/n) dgamma z0^(2/n-1)
    (Eq. 31); energy: load * displacement; stiffness: load / displacement; energy_per_area: dgamma; number: 1.

    Raises
    ------
    ValueError
        When one is outside the range of floating-point numbers.

    Examples
    --------
    >>> units = units_of(n=2, Q=8.0, work_of_adhesion=3.0, z0=2.0)
    >>> round(units["radius"], 12), units["traction"]
    (4.0, 1.5)
    """
    z, w = math.log(z0), math.log(work_of_adhesion)
    log_r = (math.log(Q) + z) / n
    log_load = math.log(math.pi) + 2.0 * log_r + w - z
    logs = {
        "radii": log_r,
        "tractions": w - z,
        "loads": log_load,
        "energies": log_load + z,
        "stiffnesses": log_load - z,
    }
    for name, log in logs.items():
        number_from_log(f"unit of {name}", log)
    r = Q ** (1.0 / n) * z0 ** (1.0 / n)
    load = math.pi * (r * work_of_adhesion) * (r / z0)
    units = (z0, z0, r, work_of_adhesion / z0, load, load * z0, load / z0, work_of_adhesion, 1.0)
    return MappingProxyType(dict(zip(_KINDS, units, strict=True)))


def log_tabor_number(solid: PowerLaw, n: float, Q: float, work_of_adhesion: float, z0: float) -> float:
    """Logarithm of the Tabor number (Eq. 29), because powers of metres and pascals overflow for large n."""
    k = solid.k
    elastic = math.log(work_of_adhesion) - math.log(solid.contact_modulus)
    elastic += math.log(response_factor_per_rest(k, solid.nu))
    total = (1.0 - k) * math.log(Q) + n * k * math.log(solid.c0) + n * elastic
    return total / (2.0 * n + k - 1.0) - math.log(z0)


def modulus_for(
    mu: float, *, n: float, k: float, nu: float, c0: float, Q: float, work_of_adhesion: float, z0: float
) -> float:
    """Modulus E0 of the power law that gives a Tabor number.

    Raises
    ------
    ValueError
        When it is outside the range of floating-point numbers.
    """
    # E0 enters Eq. 29 as E0^(-n / (2n+k-1)); start from a unit modulus and scale.
    unit = log_tabor_number(PowerLaw(1.0, c0, k, nu), n, Q, work_of_adhesion, z0)
    return number_from_log(f"modulus for mu = {mu:g}", (2.0 * n + k - 1.0) / n * (unit - math.log(mu)))
