"""Adhesive contact of a rigid sphere with a coated half-space in the limit of JKR, by an integral equation.

It shares no code with either reference: the compliance of the coated solid is a closed form (Burmister 1945, as written
by O'Sullivan and King 1988 and Nogi and Kato 1997), and the contact is one smooth integral equation (the approach of
Perriot and Barthel 2004).  A pressure p in r < a is written by a function theta,

    p(r) = theta(a)/sqrt(a^2 - r^2) - integral_r^a theta'(s)/sqrt(s^2 - r^2) ds,   P = 2 pi integral_0^a theta ds,

so that its Hankel transform is integral theta(s) cos(xi s) ds.  With xi C(xi) = (2/E*) (1 + m(xi)), E* of the coating,
the Abel transform of the displacement delta - r^2/(2 R) inside the contact is

    (2/E*) [(pi/2) theta(x) + integral_0^a K(x, s) theta(s) ds] = delta - x^2/R,
    K(x, s) = integral_0^inf m(xi) cos(xi x) cos(xi s) dxi.

At the edge the pressure is theta(a)/sqrt(2 a (a - r)).  Its energy release rate pi theta(a)^2/(2 a E*) is the work of
adhesion w, with theta(a) < 0.  Lengths are in (w R^2/E*)^(1/3) and loads in w R here.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from comparisons.model import ComputationFailed

__all__ = ["coated_compliance", "coated_load", "coated_pull_off"]

Array = NDArray[np.float64]

# The kernel is below exp(-2 _DEEPEST) of its size at larger wave numbers.
_DEEPEST = 19.0
# Gauss points of a panel; a panel spans at most this phase of cos(xi x) and this part of q = xi times thickness.
_POINTS, _PHASE, _PANEL = 16, 6.0, 0.5
# First panel of the wave numbers, in units of the ratio of the moduli, and the ratio of the next ones.
_FIRST, _GROWTH = 1e-3, 1.6
# Contact radii among which the smallest load is searched for, before the search by parabolas.
_RADII = np.geomspace(0.2, 4.0, 16)
#: The number of points of the integral equation changes the force by less: measured 3e-13 over the cases of the study.
U_NUM = 1e-11


def coated_compliance(q: Array, ratio: float, nu_coating: float, nu_substrate: float) -> Array:
    """xi C(xi) E*/2 of a homogeneous coating on a homogeneous substrate, 1 for large q.

    Parameters
    ----------
    q : ndarray
        Wave number times thickness, >= 0.
    ratio : float
        Young's modulus of the substrate over that of the coating.
    nu_coating, nu_substrate : float
        Poisson's ratios.

    Returns
    -------
    ndarray, shape of `q`

    Examples
    --------
    >>> coated_compliance(np.array([0.0, 20.0]), 4.0, 0.3, 0.3).round(12)
    array([0.25, 1.  ])
    """
    shear = (1.0 + nu_substrate) / (1.0 + nu_coating) / ratio
    kappa = (shear - 1.0) / (shear + 3.0 - 4.0 * nu_coating)
    lamda = 1.0 - 4.0 * (1.0 - nu_coating) / (1.0 + shear * (3.0 - 4.0 * nu_substrate))
    decay = np.exp(-2.0 * q)
    above = 1.0 + (4.0 * q * kappa - lamda * kappa * decay) * decay
    return above / (1.0 - (lamda + kappa + 4.0 * kappa * q**2 - lamda * kappa * decay) * decay)


def _gauss(ends: Array) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(_POINTS)
    a, h = ends[:-1, None], np.diff(ends)[:, None]
    return (a + 0.5 * h * (x + 1.0)).ravel(), (0.5 * h * w).ravel()


def _wave_numbers(radius: float, ratio: float, thickness: float) -> tuple[Array, Array]:
    """Nodes and weights of q: panels that grow from the ratio of the moduli, and resolve cos(xi x)."""
    longest = min(_PANEL, _PHASE * thickness / radius)
    ends, step = [0.0], min(longest, _FIRST * min(ratio, 1.0 / ratio))
    while ends[-1] < _DEEPEST:
        ends.append(ends[-1] + step)
        step = min(longest, _GROWTH * step)
    return _gauss(np.array(ends))


def coated_load(radius: float, ratio: float, thickness: float, nu_coating: float, nu_substrate: float) -> float:
    """Load on a contact of a radius, in w R; tension is negative.

    Parameters
    ----------
    radius, thickness : float
        In (w R^2/E*)^(1/3), E* = E/(1 - nu^2) of the coating, > 0.
    ratio, nu_coating, nu_substrate : float
        As for `coated_compliance`.

    Examples
    --------
    The load of JKR, 4/3 a^3 - (8 pi a^3)^(1/2), on a homogeneous solid.

    >>> round(coated_load(1.0, 1.0, 0.5, 0.3, 0.3), 9), round(4 / 3 - math.sqrt(8 * math.pi), 9)
    (-3.679923216, -3.679923216)
    """
    q, weights = _wave_numbers(radius, ratio, thickness)
    panels = max(2, math.ceil(radius / thickness))
    # Panels that shrink towards the edge, where theta changes within the thickness.
    ends = radius * np.sin(0.5 * math.pi * np.linspace(0.0, 1.0, panels + 1))
    s, ds = _gauss(ends)
    x = np.append(s, radius)
    xi = q / thickness
    excess = (coated_compliance(q, ratio, nu_coating, nu_substrate) - 1.0) * weights / thickness
    waves = np.cos(np.outer(x, xi))
    kernel = (waves * excess) @ waves[:-1].T * ds
    right = 0.5 * np.stack([np.ones_like(x), x**2], axis=1)
    inside = np.linalg.solve(0.5 * math.pi * np.eye(s.size) + kernel[:-1], right[:-1])
    at_edge = (right[-1] - kernel[-1] @ inside) * 2.0 / math.pi
    # theta = delta theta_1 - theta_2 has the value -sqrt(2 a/pi) at the edge.
    delta = (at_edge[1] - math.sqrt(2.0 * radius / math.pi)) / at_edge[0]
    return float(2.0 * math.pi * (ds @ (delta * inside[:, 0] - inside[:, 1])))


def coated_pull_off(ratio: float, thickness: float, nu_coating: float, nu_substrate: float) -> dict[str, float]:
    """Pull-off force of a coated half-space in the limit of JKR.

    Parameters
    ----------
    ratio, thickness, nu_coating, nu_substrate : float
        As for `coated_load`.

    Returns
    -------
    dict
        ``force`` in pi w R, ``radius`` of the contact there, in (w R^2/E*)^(1/3), and ``u_num`` of the force.

    Raises
    ------
    ComputationFailed
        If the smallest load is at the end of the radii that are searched.

    Examples
    --------
    >>> found = coated_pull_off(1.0, 0.5, 0.3, 0.3)
    >>> round(found["force"], 9), round(found["radius"], 4), round((9 * math.pi / 8) ** (1 / 3), 4)
    (1.5, 1.5232, 1.5232)
    """

    def load(log_radius: float) -> float:
        return coated_load(math.exp(log_radius), ratio, thickness, nu_coating, nu_substrate)

    places = np.log(_RADII)
    loads = [load(log_radius) for log_radius in places]
    least = int(np.argmin(loads))
    if not 0 < least < len(places) - 1:
        raise ComputationFailed(f"the load is smallest at the contact radius {_RADII[least]:g}, an end of the search")
    minimum = minimize_scalar(load, bracket=tuple(places[least - 1 : least + 2]), tol=1e-8)
    return {"force": -float(minimum.fun) / math.pi, "radius": math.exp(float(minimum.x)), "u_num": U_NUM}
