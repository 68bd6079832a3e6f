"""The atlas: quantities of the FSCM from series, with bounds."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fscm._typing import Array
from fscm.errors import NoSuchEvent, OutsideAtlas
from fscm.interpolation.components import COMPONENTS, CRITICAL, QUANTITIES, RELATIVE, Composition
from fscm.interpolation.coordinates import BOX, MOST_MU, cells_of, patch_ends, plane_cells, seam
from fscm.interpolation.curve.limits import JKR_QUANTITIES, jkr_value
from fscm.interpolation.forms import FORMS, Points, critical_of_smooth
from fscm.interpolation.storage import Stored, stored

__all__ = ["ATLAS_QUANTITIES", "AtlasValue", "atlas"]

#: Quantities of the atlas.
ATLAS_QUANTITIES = (*QUANTITIES, CRITICAL)
#: Tabor numbers at which the distance of JKR is known; more than one, because it changes its sign for some n and k.
#: Measured with mu = 14 and 20 at five pairs of n and k: from there it falls at least as 1/mu, but for a factor of 1.27
#: at n = 5, k = 0.2, whose sign changes near 10; the bound has twice the distance.
_KNOWN_DISTANCES, _SAFETY = (5.0, 7.0, MOST_MU), 2.0
#: Powers of w with which a component starts at the critical Tabor number (`fscm.interpolation.forms`).
_POWERS = {"power_1_2": 0.5, "power_3_2": 1.5, "quarter": 2.0}


class AtlasValue(NamedTuple):
    """Values of the atlas, floats or arrays.

    Attributes
    ----------
    value : float or ndarray
        In the units of `fscm.solve`.
    bound : float or ndarray
        Bound on its distance from the exact value.

    Examples
    --------
    >>> value, bound = AtlasValue(1.5, 1e-7)
    >>> value
    1.5
    """

    value: float | Array
    bound: float | Array


def atlas(
    n: ArrayLike, k: ArrayLike, mu: ArrayLike, quantity: str, *, missing: str = "raise", outside: str = "raise"
) -> AtlasValue:
    """Interpolate a quantity of the FSCM for a power-law punch, a power-law solid and the Lennard-Jones 9-3 law.

    Parameters
    ----------
    n, k, mu : array_like of float
        Shape index, 1 to 6; gradient exponent, 0 to 0.8; Tabor number, 0.01 to 10.  They are broadcast together.
    quantity : str
        One of `ATLAS_QUANTITIES`.
    missing : str
        Where the quantity does not exist, below the critical Tabor number: "raise" an error, or return "nan".
    outside : str
        Above the largest Tabor number: "raise" an error, or return the value of "jkr", with a bound that covers its
        distance from the model; for the quantities that JKR has.

    Returns
    -------
    AtlasValue
        Value and bound; arrays if one of the parameters is an array.

    Raises
    ------
    OutsideAtlas
        If a parameter is outside its range.
    NoSuchEvent
        If there is no jump at a Tabor number.
    ValueError
        For an unknown quantity, or another word for `missing`.

    Examples
    --------
    >>> value, bound = atlas(2, 0.4, 1.0, "pull_off_force")
    >>> abs(value - 1.78848171) <= bound < 1e-3
    True
    >>> atlas(2, 0.4, [0.5, 1.0], "jump_in_gap", missing="nan").value.round(2).tolist()
    [nan, 0.6]
    """
    if quantity not in ATLAS_QUANTITIES:
        raise ValueError(f"the atlas has no quantity {quantity!r}; it has {', '.join(ATLAS_QUANTITIES)}")
    if missing not in ("raise", "nan"):
        raise ValueError(f'missing = {missing!r} is unknown; it is "raise" or "nan"')
    if outside not in ("raise", "jkr"):
        raise ValueError(f'outside = {outside!r} is unknown; it is "raise" or "jkr"')
    if outside == "jkr" and quantity not in JKR_QUANTITIES:
        raise ValueError(f"JKR has no {quantity}, so that it has no limit; it has {', '.join(JKR_QUANTITIES)}")
    most_mu = math.inf if outside == "jkr" else MOST_MU
    parameters = [_inside("n", n), _inside("k", k), _inside("mu", mu, most_mu)]
    try:
        grids = np.broadcast_arrays(*parameters)
    except ValueError:
        shapes = ", ".join(str(values.shape) for values in parameters)
        raise ValueError(f"the shapes {shapes} of n, k and mu do not fit together") from None
    flat = tuple(np.ascontiguousarray(grid, dtype=float).ravel() for grid in grids)
    inside = np.minimum(flat[2], MOST_MU)
    value, bound = _evaluated(stored(), flat[0], flat[1], inside, quantity)
    beyond = flat[2] > MOST_MU
    if beyond.any():
        value[beyond], bound[beyond] = _limit(stored(), flat[0][beyond], flat[1][beyond], flat[2][beyond], quantity)
    if missing == "raise" and np.isnan(value).any():
        i = int(np.flatnonzero(np.isnan(value))[0])
        at = tuple(values[i : i + 1] for values in flat)
        raise NoSuchEvent(
            f"there is no jump at n = {at[0][0]:g}, k = {at[1][0]:g}, mu = {at[2][0]:g}: jumps exist above the "
            f"critical Tabor number {_critical(stored(), at[0], at[1])[0][0]:.6g}"
        )
    if grids[0].ndim == 0:
        return AtlasValue(float(value[0]), float(bound[0]))
    return AtlasValue(value.reshape(grids[0].shape), bound.reshape(grids[0].shape))


def _inside(name: str, values: ArrayLike, most: float = math.inf) -> Array:
    low, high = BOX[name][0], BOX[name][1] if name != "mu" else most
    array = np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name} = {values!r} is not a real number, nor an array of them")
    outside = array[~((array >= low) & (array <= high))]
    if outside.size:
        raise OutsideAtlas(
            f"{name} = {outside.flat[0]:g} is outside [{low:g}, {high:g}], the range of the atlas; "
            "fscm.solve has a wider one"
        )
    return array


def _evaluated(data: Stored, n: Array, k: Array, mu: Array, quantity: str) -> tuple[Array, Array]:
    """Values and bounds; nan where the quantity does not exist."""
    critical, u_critical = _critical(data, n, k)
    if quantity == CRITICAL:
        return critical, u_critical
    composition = QUANTITIES[quantity]
    value, bound = np.full(n.shape, math.nan), np.full(n.shape, math.nan)
    upper = mu > critical if composition.jumps else mu >= seam(n)
    for mask, is_upper in ((upper, True), (~upper, False)):
        if mask.any() and (is_upper or not composition.jumps):
            of_patch = n[mask], k[mask], mu[mask], critical[mask]
            value[mask], cusp = _value_of_composition(data, composition, is_upper, *of_patch, u_critical[mask])
            of_cell = data.bounds[quantity, "upper" if is_upper else "lower"]
            scale = np.abs(value[mask]) + (0.0 if quantity in RELATIVE else 1.0)
            bound[mask] = of_cell[cells_of(is_upper, *of_patch)] * scale + cusp
    return value, bound


def _limit(data: Stored, n: Array, k: Array, mu: Array, quantity: str) -> tuple[Array, Array]:
    """Values of JKR, and bounds on their distance from the model, which falls at least like 1/mu."""
    floor = 0.0 if quantity in RELATIVE else 1.0
    relative = np.zeros(n.shape)
    for at in _KNOWN_DISTANCES:
        known = np.full(n.shape, at)
        value, bound = _evaluated(data, n, k, known, quantity)
        limit = jkr_value(n, k, known, quantity)
        relative = np.maximum(relative, at / mu * (np.abs(value - limit) + bound) / (np.abs(limit) + floor))
    limit = jkr_value(n, k, mu, quantity)
    return limit, _SAFETY * relative * (np.abs(limit) + floor)


def _critical(data: Stored, n: Array, k: Array) -> tuple[Array, Array]:
    """Critical Tabor number and its bound."""
    plane = data.coordinates[CRITICAL].plane(n, k)
    value = critical_of_smooth(n, k, data.series[CRITICAL](plane))
    return value, data.bounds[CRITICAL, "plane"][plane_cells(n, k)] * value


def _value_of_composition(
    data: Stored,
    composition: Composition,
    upper: bool,
    n: Array,
    k: Array,
    mu: Array,
    critical: Array,
    u_critical: Array,
) -> tuple[Array, Array]:
    """Values, and the bound on their change at the cusp by the error of the critical Tabor number."""
    name = composition.upper if upper else composition.lower
    value, cusp = _value_of_component(data, name, n, k, mu, critical, u_critical)
    if composition.difference:
        difference, its_cusp = _value_of_component(data, composition.difference, n, k, mu, critical, u_critical)
        value, cusp = value - difference, cusp + its_cusp
    return value, cusp


def _value_of_component(
    data: Stored, name: str, n: Array, k: Array, mu: Array, critical: Array, u_critical: Array
) -> tuple[Array, Array]:
    """Values of a component, and the bound at the cusp."""
    component, coordinates = COMPONENTS[name], data.coordinates[name]
    share = coordinates.share(n, k, mu, *patch_ends(component.upper, n, critical))
    form, at = FORMS[component.form], Points(n, k, mu, share)
    smooth = data.series[name](coordinates.cube(n, k, share))
    value = form.value(smooth, at)
    if component.form not in _POWERS:
        return value, np.zeros(n.shape)
    # ln(1 + c M') is convex in ln mu: w grows most slowly, by its mean rate or less, at the critical Tabor number.
    moved = 2.0 * u_critical / (critical * np.log(MOST_MU / critical))
    power = _POWERS[component.form]
    change = (share + moved) ** power - np.maximum(share - moved, 0.0) ** power
    return value, np.abs(value) / np.maximum(share, 1e-300) ** power * change
