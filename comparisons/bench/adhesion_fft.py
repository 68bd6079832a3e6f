"""Pull-off force of a sphere by the package Adhesion (contactengineering): energy on a square grid, by FFT and L-BFGS.

The same problem and units as in `comparisons.bench.greenwood`, on a square whose sides are 10 (R z0)^(1/2) from its
middle.  ``VDW82``, the potential 1/(3 h^8) - 4/(3 h^2) in units of w and z0, has the pressure of the 9-3 law.
It has no bound: it shows what such a scheme costs for its error.

Run it by ``python -m comparisons.bench.adhesion_fft`` after ``pip install Adhesion``.
"""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from scipy.optimize import minimize_scalar

#: Side of the square, in (R z0)^(1/2).
_WIDTH = 20.0
#: Potential 1/(3 h^8) - A/(12 pi h^2): repulsion and Hamaker constant A.
_REPULSION, _HAMAKER = 1.0 / 3.0, 16.0 * np.pi
#: The pressure is constant at smaller gaps, in z0: the minimiser tries such gaps, no equilibrium here has them.
_CORE = 0.7
#: Displacements in z0 between which the load has its least value for Tabor numbers from 0.1 to 1.1; end of the search.
_BETWEEN, _CLOSE = (-2.2, -0.6), 1e-2
#: The largest force at a point in w R at which the minimiser ends, and its iterations.
_SMALL, _ITERATIONS = 1e-6, 2000


def is_installed() -> bool:
    """Whether the package can be imported."""
    return find_spec("Adhesion") is not None


def pull_off_force(mu: float, points: int) -> float:
    """Return the pull-off force of a sphere in pi w R.

    Parameters
    ----------
    mu : float
        Tabor number.
    points : int
        Along a side of the square.

    Raises
    ------
    ArithmeticError
        If the minimiser does not converge.
    """
    from Adhesion.Interactions import VDW82
    from Adhesion.Interactions.Cutoff import LinearCorePotential
    from Adhesion.System import SmoothContactSystem
    from ContactMechanics import FreeFFTElasticHalfSpace
    from SurfaceTopography import Topography

    grid, square = (points, points), (_WIDTH, _WIDTH)
    x = (np.arange(points) - points // 2) * _WIDTH / points
    sphere = Topography(-(x[:, None] ** 2 + x**2) / 2.0, square)
    law = LinearCorePotential(VDW82(_REPULSION, _HAMAKER), r_ti=_CORE)
    system = SmoothContactSystem(FreeFFTElasticHalfSpace(grid, mu**-1.5, square), law, sphere)

    def load(displacement: float) -> float:
        # From the deformation of the displacement before.
        options = {"gtol": _SMALL, "ftol": 0.0, "maxiter": _ITERATIONS}
        ended = system.minimize_proxy(displacement, initial_displacements=system.disp, options=options)
        if not ended.success:
            raise ArithmeticError(f"{ended.message} at the displacement {displacement:.3g} z0, mu = {mu:g}")
        return float(system.compute_normal_force())

    return -float(minimize_scalar(load, bounds=_BETWEEN, method="bounded", options={"xatol": _CLOSE}).fun) / np.pi


if __name__ == "__main__":
    for points in (64, 128):
        print(points, *(f"mu = {mu:g}: {pull_off_force(mu, points):.6f}" for mu in (0.1, 0.5, 1.0)))
