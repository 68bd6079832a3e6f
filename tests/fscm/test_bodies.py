"""Two elastic bodies and surface tension: the response against quadrature, sums, limits, bounds, bad input."""

import math
import pickle

import numpy as np
import pytest
import scipy

from fscm import (
    Coating,
    CustomSolid,
    Exponential,
    Homogeneous,
    Layers,
    LennardJones,
    OffsetPowerLaw,
    PowerLaw,
    PowerPunch,
    Problem,
    TabulatedModulus,
    solve,
)
from fscm._surface.breaks import initial_mesh
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.response.body import compliance_of
from fscm._surface.response.kernel import GradedKernel
from fscm._surface.response.response import SurfaceResponse, response_of
from fscm.bodies import Bodies, scaled, tension_length
from tests.marks import heavy
from tests.refusals import refused
from tests.solvers.layered_jkr import Stack

LAW, SPHERE = LennardJones(1.0, 1.0), PowerPunch(2.0, 1.0)
STACK = Stack(((1.0, 0.3, 0.5), (0.2, 0.45, 1.0)), (3.0, 0.2))
LAYERS = Layers([1.0, 0.2, 3.0], [0.3, 0.45, 0.2], [0.5, 1.0])


def _layers(xi: np.ndarray) -> np.ndarray:
    """Xi C of LAYERS, by a code of its own."""
    return 2.0 / STACK.surface.plane_strain * STACK.relative_compliance(xi)


def _power(E0: float, c0: float, k: float, nu: float):
    """Xi C of a power law, with the integral of xi^k J0(xi t)."""

    def compliance(xi: np.ndarray) -> np.ndarray:
        factor = scipy.special.gamma(0.5 * (1.0 - k)) / (2.0**k * scipy.special.gamma(0.5 * (1.0 + k)))
        b = PowerLaw(E0, c0, k, nu).response_factor
        return 2.0 * b * c0**k * (1.0 - nu**2) / E0 * factor * xi**k

    return compliance


def _with_tension(compliance, Y: float):
    return lambda xi: compliance(xi) / (1.0 + Y * xi * compliance(xi))


def _sum(first, second):
    return lambda xi: first(xi) + second(xi)


#: Bodies, and xi C(xi) of them together by formulas of this file.
CASES = {
    "two powers": (
        (PowerLaw(1.0, 2.0, 0.4, 0.3), Homogeneous(2.0, 0.5)),
        _sum(_power(1, 2, 0.4, 0.3), _power(2, 1, 0, 0.5)),
    ),
    "power and layers": ((LAYERS, PowerLaw(1.0, 2.0, 0.6, 0.1)), _sum(_layers, _power(1, 2, 0.6, 0.1))),
    "layers and homogeneous": ((Homogeneous(0.5, 0.2), LAYERS), _sum(_layers, _power(0.5, 1, 0, 0.2))),
    "tension": ((Homogeneous(2.0, 0.3, 0.5),), _with_tension(_power(2, 1, 0, 0.3), 0.5)),
    "small tension": ((Homogeneous(2.0, 0.3, 1e-4),), _with_tension(_power(2, 1, 0, 0.3), 1e-4)),
    "liquid": ((Homogeneous(2.0, 0.3, 1e4),), _with_tension(_power(2, 1, 0, 0.3), 1e4)),
    "power with tension": ((PowerLaw(1.0, 2.0, 0.4, 0.3, 0.2),), _with_tension(_power(1, 2, 0.4, 0.3), 0.2)),
    "steep power with tension": ((PowerLaw(1.0, 2.0, 0.9, 0.3, 0.2),), _with_tension(_power(1, 2, 0.9, 0.3), 0.2)),
    "layers with tension": ((Layers(LAYERS.E, LAYERS.nu, LAYERS.thickness, 0.3),), _with_tension(_layers, 0.3)),
    "tension of one body": (
        (PowerLaw(1.0, 2.0, 0.4, 0.3, 0.2), Homogeneous(1.0, 0.3)),
        _sum(_with_tension(_power(1, 2, 0.4, 0.3), 0.2), _power(1, 1, 0, 0.3)),
    ),
    "two tensions": (
        (PowerLaw(1.0, 2.0, 0.4, 0.3, 0.2), Layers(LAYERS.E, LAYERS.nu, LAYERS.thickness, 0.03)),
        _sum(_with_tension(_power(1, 2, 0.4, 0.3), 0.2), _with_tension(_layers, 0.03)),
    ),
}
OFTEN = ("two powers", "power and layers", "tension")
NAMES = [*OFTEN, *heavy(*(name for name in CASES if name not in OFTEN))]
#: Ends of panels on which exp(-1.7 s^2) is a polynomial to rounding, the shortest near s = 1.
BREAKS = np.unique(
    np.concatenate([np.linspace(0.0, 5.0, 11), 1.0 - 0.5 ** np.arange(2, 9), 1.0 + 0.5 ** np.arange(2, 9)])
)
#: Relative error of the displacement that the quadrature of this file has at most.
QUADRATURE = 1e-11


def _problem(solids: tuple, punch: PowerPunch = SPHERE, law: LennardJones = LAW) -> Problem:
    return Problem(solids[0], punch, law, *solids[1:])


def _exact(compliance, width: float, r: np.ndarray) -> np.ndarray:
    """Displacement under the pressure exp(-(r/width)^2): int xi C J0(xi r) exp(-(xi width)^2/4) width^2/2 d(xi)."""
    x, w = np.polynomial.legendre.leggauss(24)
    # Panels that halve towards xi = 0, and are shorter than the waves of J0; exp(-144) is left at the end.
    ends = np.concatenate([[0.0], 0.5 ** np.arange(80, 0, -1), np.linspace(1.0, 24.0, 24 * 24 * 8)]) / width
    half = 0.5 * np.diff(ends)[:, None]
    xi, weights = (ends[:-1, None] + half * (1.0 + x)).ravel(), (half * w).ravel()
    amplitude = weights * compliance(xi) * np.exp(-0.25 * (xi * width) ** 2) * 0.5 * width**2
    return np.array([scipy.special.j0(xi * radius) @ amplitude for radius in r])


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("width", [1.0, *heavy(0.03)])
def test_the_displacement_under_a_known_pressure(name: str, width: float) -> None:
    """On a mesh of another scale than the pressure; the error is within the bound of the kernel."""
    solids, compliance = CASES[name]
    core, c = _problem(solids).dimensionless, 1.3 * width
    mesh = PanelMesh(BREAKS, 16)
    disc = Discretisation(core, mesh)
    pressure = np.exp(-((c * mesh.nodes / width) ** 2))
    inside = np.flatnonzero(c * mesh.nodes < 6.0 * width)[::9]
    exact = _exact(compliance, width, np.append(0.0, c * mesh.nodes[inside]))
    factor = disc.stiffness_scale(c)
    displaced = factor * np.append(disc.axis_response(c) @ pressure, (disc.response(c) @ pressure)[inside])
    nodes, axis = response_of(core.graded).error(mesh, c, pressure)
    bound = factor * np.append(axis, nodes[inside])
    assert np.all(np.abs(displaced - exact) <= bound + QUADRATURE * exact)
    # Measured worst 8e-9; on the axis the bound is coarse.
    assert np.max(bound[1:] / exact[1:]) < 1e-7


@pytest.mark.parametrize("name", ["two powers", "two tensions"])
def test_the_rate_of_the_response_with_the_scale(name: str) -> None:
    """By differences of fourth order."""
    core, c, step = _problem(CASES[name][0]).dimensionless, 0.7, 1e-2
    disc = Discretisation(core, initial_mesh(core, 12, 1e6))
    pressure = np.exp(-disc.mesh.nodes)

    def displaced(shift: float) -> np.ndarray:
        at = c * math.exp(shift)
        return np.append(disc.response(at) @ pressure, disc.axis_response(at) @ pressure)

    values = [displaced(i * step) for i in (-2, -1, 1, 2)]
    differences = (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * step)
    nodes, axis = disc.growth(c, pressure)
    assert np.append(nodes, axis) == pytest.approx(differences, rel=1e-6, abs=1e-7 * np.max(np.abs(differences)))


@pytest.mark.parametrize("name", CASES)
def test_the_compliance_of_the_bodies(name: str) -> None:
    solids, compliance = CASES[name]
    xi = np.geomspace(1e-4, 1e4, 40)
    graded = _problem(solids).dimensionless.graded
    # The units of this file are those of the dimensionless problem.
    assert compliance_of(graded, xi) == pytest.approx(compliance(xi), rel=1e-10)


@pytest.mark.parametrize("k", [0.0, 0.4])
def test_halves_of_a_modulus_are_the_whole(k: float) -> None:
    """To 1e-12, also of two different moduli, depths and Poisson's ratios."""
    punch = PowerPunch(2.0, 50.0)
    whole = solve(Problem(PowerLaw(0.2, 1.0, k, 0.3), punch, LAW), "pull_off_force")
    halves = Problem(PowerLaw(0.4, 1.0, k, 0.3), punch, LAW, PowerLaw(0.4, 1.0, k, 0.3))
    assert halves.dimensionless.graded is None
    assert solve(halves, "pull_off_force").value == pytest.approx(whole.value, rel=1e-12)
    factor = PowerLaw(1.0, 1.0, k, 0.1).response_factor / PowerLaw(1.0, 1.0, k, 0.3).response_factor
    other = PowerLaw(0.4 * 5.0**k * factor * (1.0 - 0.1**2) / (1.0 - 0.3**2), 5.0, k, 0.1)
    assert Problem(other, punch, LAW, PowerLaw(0.4, 1.0, k, 0.3)).mu == pytest.approx(halves.mu, rel=1e-12)


def test_two_gibson_solids_are_one() -> None:
    first, second = PowerLaw(2.0, 1.0, 1.0, 0.5), PowerLaw(6.0, 3.0, 1.0, 0.5)
    pair = Problem(first, SPHERE, LAW, second)
    assert pair.mu == pytest.approx(Problem(PowerLaw(1.0, 1.0, 1.0, 0.5), SPHERE, LAW).mu, rel=1e-12)
    assert solve(pair, "pull_off_force").value == pytest.approx(2.0 * math.pi, rel=1e-9)


#: Pairs of solids of all kinds, of lengths near the contact radius of PUNCH.
PUNCH = PowerPunch(2.0, 20.0)
PAIRS = {
    "layers, power law": (LAYERS, PowerLaw(1.0, 3.0, 0.5, 0.3)),
    "powers": (PowerLaw(1.0, 3.0, 0.2, 0.3), PowerLaw(0.5, 2.0, 0.7, 0.1)),
    "coating, exponential": (Coating(1.0, 5.0, 2.0, 0.5, 0.3), Exponential(0.5, 2.0, 3.0, 0.4)),
    "table, offset": (TabulatedModulus([0.0, 1.0, 3.0], [1.0, 2.0, 4.0], 0.3), OffsetPowerLaw(1.0, 1.0, 0.5, 0.3, 0.2)),
    "function, tension": (CustomSolid(lambda z: 1.0 + np.log1p(z), 0.3, 1.0), Homogeneous(1.0, 0.3, 0.5)),
}


@pytest.mark.parametrize("name", ["powers", *heavy(*(name for name in PAIRS if name != "powers"))])
def test_solid_and_punch_solid_can_be_exchanged(name: str) -> None:
    first, second = PAIRS[name]
    one, other = (solve(Problem(a, PUNCH, LAW, b), "pull_off_force") for a, b in ((first, second), (second, first)))
    assert abs(one.value - other.value) <= one.u_num + other.u_num
    assert one.u_num < 1e-7 * one.value


def _pull_off(tension: float, modulus: float = 0.5, R: float = 50.0, nu: float = 0.3) -> float:
    """In pi R w."""
    solution = solve(Problem(Homogeneous(modulus, nu, tension), PowerPunch(2.0, R), LAW), "pull_off_force")
    assert solution.u_num < 1e-6 * solution.value
    return solution.value / (math.pi * R)


def test_a_small_surface_tension() -> None:
    """The change is proportional to it."""
    plain, small, twice = (_pull_off(Y) for Y in (0.0, 1e-5, 2e-5))
    assert (plain - twice) / (plain - small) == pytest.approx(2.0, rel=1e-3)
    assert 0.0 < plain - small < 1e-5


@pytest.mark.parametrize(("ratio", "error"), [(10.0, 0.13), *heavy((50.0, 0.04), (200.0, 0.01), (1000.0, 0.003))])
def test_the_surface_of_a_liquid(ratio: float, error: float) -> None:
    """Held by its surface tension alone, 2 Y = 1e4 E* R: one third below JKR if w R / (Y z0), the ratio, is large.

    The surface meets the contact at the slope sqrt(2 w/Y), so that the load 2 pi a Y (sqrt(2 w/Y) - a/R) is at most
    pi R w; here R = w = z0 = 1.
    """
    Y = 1.0 / ratio
    assert _pull_off(Y, 2e-4 * Y, 1.0, 0.0) == pytest.approx(1.0, rel=error)


def test_a_large_surface_tension_leaves_a_plane() -> None:
    """Bradley's force 2 pi R w."""
    assert _pull_off(1e9) == pytest.approx(2.0, rel=1e-6)


def test_a_bead_on_pdms() -> None:
    """R = 5 um, 1.5 MPa, 50 mJ/m^2: about two per cent below JKR, with a tension of 20 mN/m."""
    law = LennardJones(work_of_adhesion=0.05, z0=0.3e-9)
    force = solve(Problem(Homogeneous(1.5e6, 0.5, 0.02), PowerPunch(2.0, 5e-6), law), "pull_off_force")
    jkr = 1.5 * math.pi * 5e-6 * 0.05
    assert -0.03 < force.value / jkr - 1.0 < -0.015
    assert force.u_num < 1e-8 * force.value


def test_units_and_parts_of_a_pair() -> None:
    """In other units the dimensionless problem is the same; the problem survives pickle and copy."""
    solids = Layers([1e9, 2e8], [0.3, 0.4], [3e-9], 0.05), PowerLaw(3e8, 2e-9, 0.4, 0.3, 0.02)
    SI = Problem(solids[0], PowerPunch(2.0, 1e-6), LennardJones(0.05, 4e-10), solids[1])
    in_nano = (Layers([1.0, 0.2], [0.3, 0.4], [3.0], 0.05), PowerLaw(0.3, 2.0, 0.4, 0.3, 0.02))
    # nm, GPa and J/m^2, the product of which is 1.
    nano = Problem(in_nano[0], PowerPunch(2.0, 1e3), LennardJones(0.05, 0.4), punch_solid=in_nano[1])
    xi = np.geomspace(1e-3, 1e3, 7)
    relative = [
        compliance_of(p.dimensionless.graded, xi) / compliance_of(p.dimensionless.graded, xi)[0] for p in (SI, nano)
    ]
    assert relative[0] == pytest.approx(relative[1], rel=1e-12)
    assert SI.mu == pytest.approx(nano.mu, rel=1e-12)
    assert SI.k == 0.4
    assert pickle.loads(pickle.dumps(SI)) == SI
    assert hash(SI) == hash(pickle.loads(pickle.dumps(SI)))
    assert "punch_solid=" in repr(SI)
    assert Problem(solids[0], PowerPunch(2.0, 1e-6), LennardJones(0.05, 4e-10)) != SI


def test_the_response_of_tension_alone_is_finite_at_the_ring() -> None:
    kernel, t = GradedKernel(Homogeneous(2.0, 0.0, 1.0)), np.array([0.5, 2.0])
    assert np.all(np.isfinite(kernel.response(t, t)))
    assert np.all(kernel.response(0.999 * t, t) < kernel.response(t, t))


def test_bad_input() -> None:
    refused(r"surface_tension = -1 is outside \[0, inf\)", Homogeneous, 1.0, 0.3, surface_tension=-1)
    refused(r"surface_tension = -1 is outside \[0, inf\)", Layers, [1, 2], [0.3, 0.3], [1], surface_tension=-1)
    refused("is no solid", Problem, LAYERS, SPHERE, LAW, 3.0)
    refused("punch_solid", Problem, 2, 0.0, 1.0, punch_solid=LAYERS)
    gibson = PowerLaw(1.0, 1.0, 1.0, 0.5)
    refused(r"k = 1 is outside \[0, 1\)", Problem, gibson, SPHERE, LAW, LAYERS)
    refused(r"k = 1 is outside \[0, 1\)", Problem, PowerLaw(1.0, 1.0, 1.0, 0.5, 1.0), SPHERE, LAW)
    refused(r"outside \[1e-20, 1e\+20\]", Problem, Homogeneous(1.0, 0.3, 1e-30), SPHERE, LAW)


@pytest.mark.parametrize("k", [0.0, 0.5])
def test_the_length_of_surface_tension_is_a_length(k):
    """In a unit of 4 it is a quarter, and there the tension is as stiff as the solid."""
    solid = PowerLaw(E0=2.0, c0=3.0, k=k, nu=0.3, surface_tension=0.7)
    length = tension_length(solid)
    assert tension_length(scaled(solid, 4.0)) == pytest.approx(length / 4.0, rel=1e-14)
    elastic, tense = (
        compliance_of(body, np.array([1.0 / length])) for body in (PowerLaw(E0=2.0, c0=3.0, k=k, nu=0.3), solid)
    )
    assert elastic / tense == pytest.approx(2.0, rel=1e-12)


def test_the_bound_of_the_kernel_is_that_of_its_waves(monkeypatch):
    """An error e(xi) of the compliance moves the axis by int e d(xi) int p r dr under a pressure on a small spot."""
    solids, _ = CASES["power and layers"]
    response = response_of(_problem(solids).dimensionless.graded)
    wave, c = 1e-3, 1.3
    monkeypatch.setattr(type(response.kernel.images), "error", lambda images, xi: 1e-3 * np.exp(-xi / wave))
    mesh = PanelMesh(BREAKS, 16)
    pressure = np.where(mesh.nodes < 1.0, 1.0, 0.0)
    _, axis = response.error(mesh, c, pressure)
    moved = 1e-3 * wave * float((pressure * mesh.nodes) @ mesh.weights)
    assert axis == pytest.approx(response.weight * c ** (1.0 + response.k) * moved, rel=1e-2)


def test_power_laws_of_one_exponent_add():
    """A problem merges them before; the response of both does not depend on that."""
    soft, stiff = PowerLaw(1.0, 2.0, 0.4, 0.3), PowerLaw(3.0, 2.0, 0.4, 0.3)
    assert SurfaceResponse(Bodies((soft, stiff))).power_laws == {0.4: pytest.approx(1.0, rel=1e-14)}
