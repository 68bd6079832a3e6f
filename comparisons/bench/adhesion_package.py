"""Pull-off force by the package `adhesion`: an FFT half-space under the 9-3 law, minimised at given displacements.

Its `Lj82` is the law of this package in other words: with a work of adhesion and an equilibrium distance of one its
traction is (8/3) [(H+1)^-9 - (H+1)^-3].  The parabola r^2/2 on a half-space of contact modulus mu^(-3/2) is then the
problem n = 2, k = 0 with the Tabor number mu, and a force of pi is one unit of the pull-off force.
"""

from __future__ import annotations

import math
from importlib.metadata import distributions
from importlib.util import find_spec

import numpy as np
from scipy.optimize import minimize_scalar

__all__ = ["INSTALL", "installed", "pull_off", "versions"]

#: What is printed where the package is not installed.
INSTALL = 'adhesion is not installed: pip install "fscm-bench[bench]"'

_MODULES = ("Adhesion", "ContactMechanics", "SurfaceTopography")
_DISTRIBUTIONS = ("adhesion", "ContactMechanics", "SurfaceTopography", "NuMPI", "muGrid")

#: The displacement is sought within this distance of the one that `fscm` has, to this tolerance.  The load has a
#: minimum there: with a tolerance of 1e-5 the force changes by at most 1.2e-6 (measured on 64 x 64 pixels, mu = 0.1 to
#: 1).
_AROUND, _TOLERANCE = 0.1, 3e-3

#: Largest force on a pixel that is out of equilibrium, in units of its area.  With a thousandth of it the force at
#: pull-off changes by at most 7e-6 of it (measured as above), a hundredth of the error of the pixels, for twice the
#: evaluations; with ten times as much it changes by 2e-4.
_GRADIENT = 1e-4

#: Previous steps that the minimiser (L-BFGS-B) keeps; its limits of iterations are never reached.
_MINIMISER = {"ftol": 0.0, "maxcor": 20, "maxiter": 10_000, "maxfun": 20_000}


def installed() -> bool:
    """Whether the package can be imported."""
    return all(find_spec(name) is not None for name in _MODULES)


def versions() -> dict[str, str]:
    """Return the versions of the package and of those below it, as far as they are installed."""
    numbers = {distribution.name.lower(): distribution.version for distribution in distributions()}
    return {name: numbers[name.lower()] for name in _DISTRIBUTIONS if name.lower() in numbers}


def pull_off(mu: float, half_width: float, points: int, displacement: float) -> tuple[float, int]:
    """Return the largest tension on the parabola, n = 2, k = 0, and the evaluations of the energy that it took.

    Parameters
    ----------
    mu : float
        Tabor number.
    half_width : float
        Half the side of the square that is discretised, in (Q z0)^(1/2).
    points : int
        Pixels along a side.
    displacement : float
        Displacement at pull-off, which `fscm` knows: the search begins there, so that it takes the least time.
    """
    from Adhesion.Interactions import Lj82
    from Adhesion.System import SmoothContactSystem
    from ContactMechanics import FreeFFTElasticHalfSpace
    from SurfaceTopography import Topography

    side, pixel = 2.0 * half_width, 2.0 * half_width / points
    x = (np.arange(points) + 0.5) * pixel - half_width
    sphere = Topography(-0.5 * (x[:, None] ** 2 + x[None, :] ** 2), (side, side))
    half_space = FreeFFTElasticHalfSpace((points, points), mu**-1.5, (side, side))
    system = SmoothContactSystem(half_space, Lj82(1.0, 1.0), sphere)
    options = {**_MINIMISER, "gtol": _GRADIENT * pixel**2}
    states: dict[float, np.ndarray] = {}
    evaluations = 0

    def load(delta: float) -> float:
        nonlocal evaluations
        start = states[min(states, key=lambda solved: abs(solved - delta))] if states else None
        # The package measures the gap from the singularity of the law, which is 1 below H = 0.
        state = system.minimize_proxy(offset=delta - 1.0, initial_displacements=start, options=options)
        evaluations += int(state.nfev)
        states[delta] = system.disp.copy()
        return float(system.compute_normal_force()) / math.pi

    ends = (displacement - _AROUND, displacement + _AROUND)
    least = minimize_scalar(load, bounds=ends, method="bounded", options={"xatol": _TOLERANCE})
    return -float(least.fun), evaluations
