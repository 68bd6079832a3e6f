"""Checks of a modulus: values that a solid can have, and exponents that are those of the values."""

from __future__ import annotations

import math

import numpy as np

from fem_reference._typing import Array
from fem_reference.modulus import Modulus

__all__ = ["check_exponents", "positive_modulus"]

#: Depths, relative to the one over which E leaves its surface law, between which its exponents are measured.
SHALLOW, DEEP = (1e-14, 1e-12), (1e6, 1e8)

#: Largest difference of the surface exponent from the one measured. The chart of the first layer has z^(1-k) for the
#: declared k (measured with an exponent that is 1e-3 too small: the pull-off force moves by 1e-8).
SURFACE_TOLERANCE = 1e-3

#: Largest difference of the exponent at depth, which many moduli approach slowly. The mesh is extended until the
#: exterior matters little, whatever its exponent.
DEPTH_TOLERANCE = 0.02


def positive_modulus(modulus: Modulus, z: Array) -> Array:
    """E(z) of an array of depths, which must be positive and finite.

    Raises
    ------
    ValueError
        With the first depth where it is not, or if its shape is not that of the depths.

    Examples
    --------
    >>> from fem_reference.modulus import PowerLawModulus
    >>> positive_modulus(PowerLawModulus(1.0, 1.0, 0.5), np.array([4.0]))
    array([2.])
    """
    with np.errstate(all="ignore"):
        E = np.asarray(modulus(z), float)
    if E.shape != z.shape:
        raise ValueError(f"the modulus of {z.size} depths has the shape {E.shape}: E(z) must have the shape of z")
    bad = ~(np.isfinite(E) & (E > 0))
    if bad.any():
        raise ValueError(
            f"the modulus is {E[bad][0]:g} at the depth {z[bad][0]:g}, outside (0, infinity): "
            "it must be positive and finite at every depth of the half-space"
        )
    return E


def check_exponents(modulus: Modulus) -> None:
    """Refuse a modulus whose declared exponents are not those of its values.

    Raises
    ------
    ValueError
        With the declared and the measured exponent, or as `positive_modulus`.

    Examples
    --------
    >>> from fem_reference.depth_profiles import CustomProfile
    >>> check_exponents(CustomProfile(np.sqrt, surface_exponent=0.0, depth_exponent=0.5, surface_depth=1.0))
    Traceback (most recent call last):
    ValueError: surface exponent 0 is declared, but E(z) rises as z^0.5 between the depths 1e-14 and 1e-12: ...
    """
    if not math.isfinite(modulus.surface_depth):
        return
    for name, declared, range_, tolerance, remedy in (
        ("surface exponent", modulus.surface_exponent, SHALLOW, SURFACE_TOLERANCE, "the mesh at the surface"),
        ("depth exponent", modulus.depth_exponent, DEEP, DEPTH_TOLERANCE, "the exterior of the mesh"),
    ):
        z = modulus.surface_depth * np.array(range_)
        E = positive_modulus(modulus, z)
        measured = math.log(E[1] / E[0]) / math.log(z[1] / z[0])
        if abs(measured - declared) > tolerance:
            raise ValueError(
                f"{name} {declared:g} is declared, but E(z) rises as z^{measured:.3g} between the depths "
                f"{z[0]:.3g} and {z[1]:.3g}: {remedy} would be that of another solid; declare the exponent of E, and "
                "the depth over which it leaves its surface law"
            )
