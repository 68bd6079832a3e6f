r"""Power law that stands for a solid that is none, and the elastic energy at the pull-off force by wave number.

A pressure J0(xi r) displaces the surface by C(xi) J0(xi r).  With the transform q(xi) of the pressure, integral of
p(r) J0(xi r) r dr, the energy in the solid is pi times the integral of C q^2 xi dxi, so that every decade of xi has a
share of it.  The pressure is joined by straight lines, and the transform of those is exact:

    q(xi) = -(sum of the slopes times the differences of F(xi r))/xi^3,
    F(x) = (integral of J0 from 0 to x) - x J0(x) = (pi x/2) (J1(x) H0(x) - J0(x) H1(x)),  H: Struve functions.

The first form cancels at small x, and its function in SciPy 1.13.0 is wrong above x = 20.

The surface compliance of E0 (z/c0)^k is C(xi) = A xi^(k-1).  ln(xi C) of the solid is fitted by k ln(xi) + ln(A): least
squares, each wave number with its share of the energy.  The force itself is not fitted.  This is the one rule for the
equivalent power law of a solid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import scipy

import fscm
from comparisons.model import Array, NotApplicable, translated
from comparisons.problem.problem import Problem, Section
from fscm._surface.response.body import compliance_of
from fscm.solids import PowerLaw

#: Wave numbers beside the inverse of the mean radius of the load, and points for each decade.  The shares fall as xi
#: below and as 1/xi above the contact (less than that above the width of its edge): 2 % are missing at most.
_LOWEST, _HIGHEST, _POINTS = 1e-2, 1e3, 32

#: Argument from which Struve's functions are taken by their asymptotic series, a fifth of the time of SciPy's, and its
#: terms: what is left is below rounding.
_ASYMPTOTIC, _TERMS = 30.0, 12

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

    Examples
    --------
    >>> xi = np.array([1e6, 1e7, 1e8])
    >>> round(EnergySpectrum(xi, np.ones(3), np.array([0.25, 0.5, 0.25])).length(0.5), 12)
    1e-07
    """

    wave_numbers: Array
    compliances: Array
    shares: Array

    def length(self, share: float) -> float:
        """Return the length 1/xi above which a share of the energy is, in m."""
        # Each share is spread evenly over the interval around its wave number.
        below = np.cumsum(self.shares) - self.shares / 2.0
        return float(np.exp(-np.interp(share, below, np.log(self.wave_numbers))))


def modulus_at(problem: Problem, wave_numbers: Array) -> Array:
    """Return E* = 2/(xi C) in Pa of the solid of a problem at wave numbers xi in 1/m.

    Parameters
    ----------
    problem : Problem
        Its solid is not homogeneous.
    wave_numbers : ndarray

    Examples
    --------
    >>> layers = Section("layers", {"E": (1e3, 1e6), "nu": (0.5, 0.0), "thickness": (1e-6,)})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> problem = Problem(layers, Section("sphere", {"R": 1e-7}), law)
    >>> [float(f"{modulus:.3g}") for modulus in modulus_at(problem, np.array([1e3, 1e8]))]
    [1000000.0, 1330.0]
    """
    if problem.posed.graded is not None:
        return np.asarray(2.0 / compliance_of(problem.posed.graded, wave_numbers * problem.units["radius"]))
    solid: Any = problem.build(fscm).solid.power_law
    gamma = math.gamma((1.0 + solid.k) / 2.0) / math.gamma((1.0 - solid.k) / 2.0)
    at_surface = solid.E0 / (solid.response_factor * (1.0 - solid.nu**2)) * gamma
    return np.asarray(at_surface * (2.0 / (wave_numbers * solid.c0)) ** solid.k)


def surface_ratio(problem: Problem) -> float:
    """Return Poisson's ratio at the surface of the solid."""
    return float(problem.build(fscm).solid.poisson(np.zeros(1))[0])


@lru_cache(maxsize=64)
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
    posed = problem.posed
    if posed.graded is None:
        raise ValueError(f"{problem.label} has a {problem.solid.kind} solid, whose surface compliance is known")
    count = round(np.log10(_HIGHEST / _LOWEST)) * _POINTS + 1
    with translated(fscm):
        # The shares need few digits.
        field = fscm.profile(posed, "pull_off", "quick")
        size = np.abs(field.pressure)
        moments = [float(np.trapezoid(size * field.radius**power, field.radius)) for power in (1, 2)]
        xi = np.geomspace(_LOWEST, _HIGHEST, count) / (moments[1] / moments[0])
        values = compliance_of(posed.graded, xi)
    density = values * xi * _transform(field.radius, field.pressure, xi) ** 2
    return EnergySpectrum(xi / problem.units["radius"], values, density / np.sum(density))


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
    """F of the first lines of this module; of x above _ASYMPTOTIC by the series of H - Y and Wronski's determinant."""
    j0, j1, struve = scipy.special.j0, scipy.special.j1, scipy.special.struve
    F = np.empty(x.shape)
    below = x < _ASYMPTOTIC
    near, far = x[below], x[~below]
    F[below] = np.pi / 2.0 * near * (j1(near) * struve(0, near) - j0(near) * struve(1, near))
    # (pi/2) x (H0 - Y0) and (pi/2) (H1 - Y1), by terms of falling size.
    zero, one, term = np.ones_like(far), np.ones_like(far), np.ones_like(far)
    for odd in range(1, 2 * _TERMS, 2):
        one -= (term := term * (-odd / far**2))
        zero += (term := term * odd)
    F[~below] = 1.0 + j1(far) * zero - far * j0(far) * one
    return F


#: Largest exponent of the power law: both references take it.
LARGEST_K = 0.9

#: Largest deviation of a compliance for which a law stands for the solid.  Measured for power laws under a sphere: at
#: most 0.33 where the modulus rises with depth, up to a hundredfold; 0.55 to 2 where it falls, but 0.36 for a coating
#: much thinner than the contact.
LARGEST_DEVIATION = 0.5


def equivalent_solids(problem: Problem) -> tuple[Problem, Problem]:
    """Return a problem with the power law that stands for its solid, and with that of every second wave number.

    What a model gives for both differs by more than the first has an error: the fit converges with the second power of
    the distance of the wave numbers or faster (measured: a twentieth of the difference on two coatings).

    Raises
    ------
    NotApplicable
        If no power law stands for the solid.
    comparisons.model.ComputationFailed
        If the FSCM does not converge.
    """
    spectrum = energy_spectrum(problem)
    _, _, deviation, _ = least_wrong(spectrum)
    if deviation > LARGEST_DEVIATION:
        raise NotApplicable(
            f"no power law stands for the {problem.solid.kind} solid: the nearest misses its compliance by "
            f"{100 * deviation:.0f} %, more than {100 * LARGEST_DEVIATION:.0f} %"
        )
    shares = spectrum.shares[::2] / float(np.sum(spectrum.shares[::2]))
    coarse = EnergySpectrum(spectrum.wave_numbers[::2], spectrum.compliances[::2], shares)
    return power_law_of(problem, spectrum), power_law_of(problem, coarse)


def least_wrong(spectrum: EnergySpectrum) -> tuple[float, float, float, float]:
    """Fit a power of the wave number to a compliance.

    Returns
    -------
    k, free_k, deviation : float
        As of `EquivalentPowerLaw`.
    compliance : float
        xi C of the power law at the middle of the fit, where the mean of ln(xi) is.

    Examples
    --------
    >>> xi = np.geomspace(1e6, 1e8, 5)
    >>> k, free_k, deviation, _ = least_wrong(EnergySpectrum(xi, 3e-9 * xi**0.25, np.full(5, 0.2)))
    >>> round(k, 12), round(free_k, 12), deviation < 1e-14
    (0.25, 0.25, True)
    """
    x, y, shares = np.log(spectrum.wave_numbers), np.log(spectrum.compliances), spectrum.shares
    x = x - shares @ x
    mean = float(shares @ y)
    free_k = float(shares @ (x * y) / (shares @ x**2))
    k = min(max(free_k, 0.0), LARGEST_K)
    deviation = float(np.sqrt(shares @ (mean + k * x - y) ** 2))
    return k, free_k, deviation, math.exp(mean)


def power_law_of(problem: Problem, spectrum: EnergySpectrum) -> Problem:
    """Return the problem with the power law that `least_wrong` fits to a compliance.

    Its Poisson's ratio is that of the surface.  Its c0 is that of the file, or else the length 1/xi of the middle of
    the fit.
    """
    k, _, _, compliance = least_wrong(spectrum)
    nu = float(problem.posed.graded.poisson(np.zeros(1))[0])  # type: ignore[union-attr]  # it is not a power law
    middle = math.exp(-float(spectrum.shares @ np.log(spectrum.wave_numbers)))
    c0 = problem.solid.get("c0", middle)
    # xi C = 2 b (1 - nu^2)/E0 (xi c0/2)^k Gamma((1-k)/2)/Gamma((1+k)/2)
    b = PowerLaw(E0=1.0, c0=1.0, k=k, nu=nu).response_factor
    gamma = math.gamma((1.0 - k) / 2.0) / math.gamma((1.0 + k) / 2.0)
    E0 = 2.0 * b * (1.0 - nu**2) * (c0 / (2.0 * middle)) ** k * gamma / compliance
    solid = Section("power-law", {"E0": E0, "c0": c0, "k": k, "nu": nu})
    return replace(problem, solid=solid)
