r"""Elastic energy at the pull-off force by wave number, of a solid that is not a power law.

A pressure J0(xi r) displaces the surface by C(xi) J0(xi r).  With the transform q(xi) of the pressure, integral of
p(r) J0(xi r) r dr, the energy in the solid is pi times the integral of C q^2 xi dxi, so that every decade of xi has a
share of it.  The pressure is joined by straight lines, and the transform of those is exact:

    q(xi) = -(sum of the slopes times the differences of F(xi r))/xi^3,
    F(x) = (integral of J0 from 0 to x) - x J0(x) = (pi x/2) (J1(x) H0(x) - J0(x) H1(x)),  H: Struve functions.

The first form cancels at small x, and its function in SciPy 1.13.0 is wrong above x = 20.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

import fscm
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.problem.problem import Problem
from fscm.graded.compliance import compliance

Array = NDArray[np.float64]

#: Wave numbers beside the inverse of the mean radius of the load, and points for each decade.  The shares fall as xi
#: below and as 1/xi above the contact (less than that above the width of its edge): 2 % are missing at most.
_LOWEST, _HIGHEST, _POINTS = 1e-2, 1e3, 32

#: Straight lines between two nodes of the solver.
_PIECES = 4


@dataclass(frozen=True, eq=False)
class EnergySpectrum:
    """Shares of the elastic energy, and the compliance, at wave numbers with equal ratios; arrays of shape (m,).

    Attributes
    ----------
    wave_numbers : ndarray
        xi in 1/m.
    compliances : ndarray
        xi C(xi) in 1/Pa; 2 (1 - nu^2)/E for a homogeneous solid.
    shares : ndarray
        Of the energy, by the logarithm of xi; their sum is 1.
    energy : float
        In J.

    Examples
    --------
    >>> xi = np.array([1e6, 1e7, 1e8])
    >>> round(EnergySpectrum(xi, np.ones(3), np.array([0.25, 0.5, 0.25]), 1e-18).length(0.5), 12)
    1e-07
    """

    wave_numbers: Array
    compliances: Array
    shares: Array
    energy: float

    def length(self, share: float) -> float:
        """Return the length 1/xi above which a share of the energy is, in m."""
        # Each share is spread evenly over the interval around its wave number.
        below = np.cumsum(self.shares) - self.shares / 2.0
        return float(np.exp(-np.interp(share, below, np.log(self.wave_numbers))))


def energy_spectrum(problem: Problem) -> EnergySpectrum:
    """Return the elastic energy of a problem at its pull-off force by wave number.

    Parameters
    ----------
    problem : Problem
        Its solid is not a power law, whose compliance is one.

    Raises
    ------
    ValueError
        If it is a power law.
    comparisons.model.ComputationFailed
        If the FSCM does not converge.

    Examples
    --------
    >>> from comparisons.problem import Problem, Section
    >>> solid = Section("exponential", {"E_surface": 1e9, "E_depth": 3e9, "length": 1e-7, "nu": 0.3})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> found = energy_spectrum(Problem(solid, Section("sphere", {"R": 1e-7}), law))
    >>> 3e-9 < found.length(0.5) < 3e-8  # the contact radius is 12 nm
    True
    """
    posed, units = problem.posed, problem.units
    if posed.graded is None:
        raise ValueError(f"{problem.label} has a {problem.solid.kind} solid, whose surface compliance is known")
    count = round(np.log10(_HIGHEST / _LOWEST)) * _POINTS + 1
    try:
        # The shares need few digits.
        field = fscm.profile(posed, "pull_off", "quick")
        first_moment, second_moment = (
            float(np.sum(np.abs(_moments(field.radius, field.pressure, power)))) for power in (1, 2)
        )
        xi = np.geomspace(_LOWEST, _HIGHEST, count) / (second_moment / first_moment)
        values = compliance(posed.graded, xi)
    except fscm.NoSuchEvent as reason:
        raise NotApplicable(str(reason)) from reason
    except fscm.NotConverged as failure:
        raise ComputationFailed(str(failure)) from failure
    density = values * xi * _transform(field.radius, field.pressure, xi) ** 2
    scale = np.pi * units["traction"] ** 2 * units["radius"] ** 3
    energy = float(np.sum(density)) * np.log(xi[1] / xi[0]) * scale
    return EnergySpectrum(xi / units["radius"], values, density / np.sum(density), float(energy))


def _moments(r: Array, p: Array, power: int) -> Array:
    """The integrals of |p| r^power between the nodes."""
    f = np.abs(p) * r**power
    return np.diff(r) * (f[1:] + f[:-1]) / 2.0


def _transform(r: Array, p: Array, xi: Array) -> Array:
    """q(xi) of a pressure at nodes."""
    places = np.linspace(0.0, 1.0, _PIECES, endpoint=False)
    fine = np.append((r[:-1, None] + np.diff(r)[:, None] * places).ravel(), r[-1])
    values = scipy.interpolate.PchipInterpolator(r, p)(fine)
    # Even at the axis and zero beyond the last node.
    fine, values = np.append(0.0, fine), np.append(values[0], values)
    slopes = np.diff(values) / np.diff(fine)
    x = xi[:, None] * fine
    F = _linear_part(x)
    end = values[-1] * fine[-1] ** 2 * scipy.special.j1(x[:, -1]) / x[:, -1]
    return np.asarray(end - (np.diff(F, axis=1) @ slopes) / xi**3)


def _linear_part(x: Array) -> Array:
    """F of the first lines of this module."""
    j0, j1, struve = scipy.special.j0, scipy.special.j1, scipy.special.struve
    return np.asarray(np.pi / 2.0 * x * (j1(x) * struve(0, x) - j0(x) * struve(1, x)))
