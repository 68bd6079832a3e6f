"""Checks of the elastic half-space against exact solutions.

Each function measures one kind of error and returns checks; a check passes when the error is at most its limit.
`elastic_checks` collects them, with those of `fem_reference.verification.element_checks`.  Errors of surface
displacements are relative to the central displacement.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product

import numpy as np

from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.trace import Trace
from fem_reference._threads import one_thread
from fem_reference._typing import Array
from fem_reference.solid import PowerLaw, Solid
from fem_reference.solids import OffsetPowerLaw
from fem_reference.verification.check import Check
from fem_reference.verification.element_checks import element_checks, manufactured_checks
from fem_reference.verification.load_vectors import disc_load, ring_load, smooth_load
from fem_reference.verification.reference_solutions import gaussian_displacement, power_displacement, ring_displacement

__all__ = [
    "DEFAULT",
    "EXPONENTS",
    "FINE",
    "FINE_RING",
    "POISSON",
    "RING",
    "disc_checks",
    "elastic_checks",
    "far_field_checks",
    "gaussian_checks",
    "limit_checks",
    "ring_checks",
    "surface_displacement",
]


#: Gradient exponents k of the checks.
EXPONENTS = (0.0, 0.1, 0.2, 0.4, 0.6, 0.8)
#: Poisson's ratios of the checks.
POISSON = (0.0, 0.25, 0.45)

#: Material of the checks that are about something else.
K, NU = 0.4, 0.25

#: The density of the default accuracy, for a load of unit radius.
DEFAULT = MeshSpec(0.25, 2e-3, 64.0, 0.69, 6)

#: The density of the fine accuracy.
FINE = MeshSpec(0.25, 5e-4, 64.0, 0.5, 6)

#: For pressures with a singular edge at r = 1.
EDGE = MeshSpec(1e-3, 2e-5, 64.0, 0.69, 6)

#: Mesh for a load on the line r = 1, by which w is singular.
RING = MeshSpec(1e-3, 2e-3, 64.0, 0.55, 6, 0.05)
#: For a load on the line r = 1, by which w is singular: denser than the others (with the default density the error is
#: 1e-5, and 2e-5 for k = 0.8, nu = 0.45), and fine at the line and at the axis.
FINE_RING = MeshSpec(1e-3, 2e-3, 64.0, 0.4, 6, 0.05)

#: Largest error allowed, relative to w(0) (measured: 1.4e-6 at nu = 0.49, 2e-7, 3e-7, 5e-6, 7e-7).
LIMITS = {"default": 5e-6, "fine": 5e-7, "edge": 1e-6, "ring": 1e-5, "fine ring": 1e-6}

#: Largest change with the size of the interior: that of two results of the default mesh (measured: 1.0e-6).
FAR_FIELD_LIMIT = 2e-6

#: Largest distance of the ratio of two errors from 2 when k is halved: the second-order term at k = 2e-3 (measured:
#: 2.2e-3).
FIRST_ORDER_LIMIT = 0.02

#: Largest distance of the rate in z_s from 1 - k, which holds for z_s -> 0 only (measured: 0.02).
RATE_LIMIT = 0.1


_GAUSSIAN = smooth_load(lambda r: np.exp(-(r**2)))


def surface_displacement(
    solid: Solid, spec: MeshSpec, load: Callable[[Trace], Array]
) -> tuple[Callable[[Array], Array], int]:
    """Solve the half-space under a given surface load.

    Parameters
    ----------
    solid : Solid
    spec : MeshSpec
        Mesh in absolute units.
    load : callable
        The load vector on a surface mesh, as `fem_reference.verification.load_vectors` makes them.

    Returns
    -------
    displacement : callable
        u_z at the surface for any radii inside the mesh.
    unknowns : int
    """
    compliance = compliance_for(solid, spec, 1.0)
    trace = compliance.trace
    w = compliance.factor(1.0) * (compliance.matrix @ load(trace))

    def displacement(r: Array) -> Array:
        return np.asarray(trace.evaluate(np.asarray(r, float)) @ w)

    return displacement, compliance.unknowns


def gaussian_checks(spec: MeshSpec, name: str, exponents: Iterable[float], poisson: Iterable[float]) -> list[Check]:
    """(c, h) Under p = exp(-r^2), against Eqs. 6-7 in closed form, on 0 <= r <= 4."""
    cases, r = product(exponents, poisson), np.linspace(0.0, 4.0, 81)
    return [_against("p = exp(-r^2)", _GAUSSIAN, gaussian_displacement, r, spec, name, k, nu) for k, nu in cases]


def ring_checks(spec: MeshSpec, name: str, exponents: Iterable[float], poisson: Iterable[float]) -> list[Check]:
    """(c) Under a ring load, against Eqs. 6-7, on r <= 0.8 and 1.25 <= r <= 4: it is singular at r = 1."""
    cases, r = product(exponents, poisson), np.concatenate([np.linspace(0.0, 0.8, 41), np.linspace(1.25, 4.0, 41)])
    return [_against("ring load", ring_load, ring_displacement, r, spec, name, k, nu) for k, nu in cases]


def _against(
    subject: str,
    load: Callable[[Trace], Array],
    exact: Callable[[Array, float, float], Array],
    r: Array,
    spec: MeshSpec,
    name: str,
    k: float,
    nu: float,
) -> Check:
    """Compare the displacement of one material under a load with Eq. 6, at radii of which the first is 0."""
    w, unknowns = surface_displacement(PowerLaw(1.0, 1.0, k, nu), spec, load)
    expected = exact(r, k, nu)
    error = float(np.abs(w(r) - expected).max() / expected[0])
    return Check(f"{subject} against Eq. 6", f"{name}, k = {k}, nu = {nu}", error, LIMITS[name], unknowns)


def _power(beta: float) -> Callable[[Array], Array]:
    def pressure(q: Array) -> Array:
        return np.asarray(q**beta)

    return pressure


def disc_checks(exponents: Iterable[float]) -> list[Check]:
    """(b, d) Uniform disc, Hertz pressure (Giannakopoulos and Suresh 1997), flat punch; 0 <= r <= 0.95."""
    r = np.linspace(0.0, 0.95, 40)
    rows = []
    for k in exponents:
        for name, beta in (
            ("uniform disc", 0.0),
            ("Hertz pressure gives a parabola", 0.5 * (1.0 + k)),
            ("flat punch gives a plane", -0.5 * (1.0 - k)),
        ):
            pressure = _power(beta)
            w, unknowns = surface_displacement(PowerLaw(1.0, 1.0, k, NU), EDGE, disc_load(pressure))
            exact = power_displacement(r, k, NU, beta)
            error = float(np.abs(w(r) - exact).max() / exact[0])
            rows.append(Check(name, f"k = {k}, nu = {NU}", error, LIMITS["edge"], unknowns))
    return rows


def far_field_checks() -> list[Check]:
    """(e) The displacement does not depend on where the exterior begins."""
    r = np.linspace(0.0, 4.0, 41)
    base, _ = surface_displacement(PowerLaw(1.0, 1.0, K, NU), DEFAULT, _GAUSSIAN)
    rows = []
    for extent in (8.0, 16.0, 512.0):
        spec = MeshSpec(DEFAULT.edge_width, DEFAULT.surface_depth, extent, DEFAULT.density, DEFAULT.order)
        w, unknowns = surface_displacement(PowerLaw(1.0, 1.0, K, NU), spec, _GAUSSIAN)
        error = float(np.abs(w(r) - base(r)).max() / base(r)[0])
        case = f"extent {extent:g} against 64, k = {K}"
        rows.append(Check("interior of another size", case, error, FAR_FIELD_LIMIT, unknowns))
    return rows


def limit_checks() -> list[Check]:
    """(f) A vanishing surface modulus tends to the power law, a vanishing exponent to the homogeneous solid.

    The distance must fall with the parameter at the rate theory gives: first order in k, and first order in
    z_s^(1-k), the relative share of the layer whose stiffness is changed.
    """
    r = np.linspace(0.0, 4.0, 41)
    rows = []
    exact = gaussian_displacement(r, 0.0, NU)
    unit = {}
    for k in (2e-3, 1e-3):
        w, unknowns = surface_displacement(PowerLaw(1.0, 1.0, k, NU), DEFAULT, _GAUSSIAN)
        unit[k] = float(np.abs(w(r) - exact).max() / exact[0])
    rate = abs(unit[2e-3] / unit[1e-3] - 2.0)
    name = "k -> 0 tends to the homogeneous solid, first order"
    rows.append(Check(name, "k = 2e-3, 1e-3", rate, FIRST_ORDER_LIMIT, unknowns))
    exact = gaussian_displacement(r, K, NU)
    for z_s in (1e-2, 1e-3):
        depth = min(DEFAULT.surface_depth, 0.2 * z_s)
        spec = MeshSpec(DEFAULT.edge_width, depth, DEFAULT.extent, DEFAULT.density, DEFAULT.order)
        w, unknowns = surface_displacement(OffsetPowerLaw(1.0, 1.0, K, z_s, NU), spec, _GAUSSIAN)
        unit[z_s] = float(np.abs(w(r) - exact).max() / exact[0])
    rate = abs(np.log10(unit[1e-2] / unit[1e-3]) - (1.0 - K))
    name = "z_s -> 0 tends to the power law as z_s^(1-k)"
    rows.append(Check(name, "z_s = 1e-2, 1e-3", float(rate), RATE_LIMIT, unknowns))
    return rows


def elastic_checks(full: bool = False) -> list[Check]:
    """Return all checks on the default mesh; `full` adds the fine mesh and every exponent.

    Examples
    --------
    >>> checks = gaussian_checks(DEFAULT, "default", (0.0,), (0.25,))
    >>> all(check.passed for check in checks)
    True
    """
    with one_thread:
        few = EXPONENTS if full else (0.0, 0.4, 0.8)
        rows = manufactured_checks() + element_checks()
        rows += gaussian_checks(DEFAULT, "default", few, POISSON if full else (0.25,))
        if full:
            rows += gaussian_checks(FINE, "fine", EXPONENTS, POISSON)
        rows += gaussian_checks(DEFAULT, "default", (0.0, 0.4), (0.49,))
        rows += ring_checks(RING, "ring", (0.0, 0.4), (0.25,))
        if full:
            rows += ring_checks(FINE_RING, "fine ring", EXPONENTS, POISSON)
        rows += disc_checks(few)
        rows += far_field_checks()
        rows += limit_checks()
        return rows
