"""Response of the surface to a pressure, with surface tension, bonded, and of two bodies, by Hankel transforms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import special

import fem_reference
from fem_reference._contact.bodies import compliance_of
from fem_reference._contact.friction import with_friction
from fem_reference._contact.mesh_lengths import mesh_spec
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.condensation import surface_stiffness
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.surface_tension import SurfaceTension
from fem_reference._linear.linear_solver import solve_cg, solve_direct
from fem_reference.accuracy import level_for
from fem_reference.solid import ScaledSolid
from tests.fem_reference.hankel_reference import power_law_constant, transform
from tests.refusals import refused

#: Relative error of displacements on meshes of "quick" (measured: up to 3.2e-7, of two layered bodies).
MESH_ERROR = 1e-6

#: Wave number below which layers are not felt: they change the displacement by its square.
LONGEST = 1e-5

RADII = np.array([0.0, 0.5, 1.0])
PARTS = fem_reference.PowerPunch(2.0, 1.0), fem_reference.LennardJones(1.0, 1.0)

UNIFORM, GRADED = fem_reference.Homogeneous(0.8, 0.2), fem_reference.PowerLaw(0.7, 1.3, 0.4, 0.3)
COATED, LAYERED = (
    fem_reference.Coating(10.0, 1.0, 1.0, 0.0, 0.2, 0.45),
    fem_reference.Layers((1.0, 5.0, 2.0), (0.3, 0.2, 0.4), (0.5, 0.7)),
)
SHARP = {COATED: (1.0,), LAYERED: (0.5, 1.2)}


def _waves():
    """Gauss points in ln(xi) and weights of d(xi): the compliance of a power law is xi^(k-1)."""
    x, w = np.polynomial.legendre.leggauss(16)
    ends = np.concatenate(
        [np.linspace(np.log(1e-12), np.log(LONGEST), 6), np.linspace(np.log(LONGEST), np.log(14.0), 22)[1:]]
    )
    half = 0.5 * np.diff(ends)[:, None]
    xi = np.exp((ends[:-1, None] + half * (x + 1.0)).ravel())
    return xi, xi * (half * w).ravel()


def _response(solid, xi, bonded=False):
    """C(xi) of a solid with its surface tension."""
    if isinstance(solid, fem_reference.Homogeneous):
        C = power_law_constant(0.0, solid.nu, bonded) / (solid.E * xi)
    elif isinstance(solid, fem_reference.PowerLaw):
        C = power_law_constant(solid.k, solid.nu, bonded) * solid.c0**solid.k / solid.E0 * xi ** (solid.k - 1.0)
    else:
        core = replace(solid, surface_tension=0.0)
        shorter = xi[xi > LONGEST]
        values = transform(solid.modulus, solid.poisson, shorter, SHARP[core], bonded=bonded)
        C = np.interp(xi, shorter, values) / xi
    return C / (1.0 + solid.surface_tension * xi**2 * C)


def _exact(C, xi, weight):
    """Displacement under the pressure exp(-r^2), whose transform is exp(-xi^2/4)/2."""
    return special.j0(np.outer(RADII, xi)) @ (weight * C * xi * 0.5 * np.exp(-(xi**2) / 4.0))


def _displacement(problem):
    """The same by finite elements, with the mesh that the problem has for an edge at r = 1."""
    compliance = compliance_of(problem.solids, mesh_spec(problem, level_for("quick"), 0.25, 1.0, 0.1), 1.0)
    trace = compliance.trace
    load = trace.phi.T @ (trace.weight * trace.s * np.exp(-(trace.s**2)))
    return trace.evaluate(RADII) @ (compliance.factor(1.0) * (compliance.matrix @ load))


def _tense(solid, tension):
    return replace(solid, surface_tension=tension)


@pytest.mark.parametrize("k", [0.0, 0.4])
def test_constants_of_the_power_law(k):
    """Of a homogeneous solid both are known; a bonded surface of an incompressible one is a free one."""
    nu = 0.3
    if k == 0.0:
        assert power_law_constant(k, nu) == pytest.approx(2.0 * (1.0 - nu**2), rel=1e-9)
        bonded = (1.0 + nu) * (3.0 - 4.0 * nu) / (2.0 * (1.0 - nu))
        assert power_law_constant(k, nu, bonded=True) == pytest.approx(bonded, rel=1e-9)
        ratio = power_law_constant(k, 0.4999, bonded=True) / power_law_constant(k, 0.4999)
        assert ratio == pytest.approx(1.0, abs=1e-7)
    assert power_law_constant(k, nu, bonded=True) < power_law_constant(k, nu)


@pytest.mark.parametrize(
    ("bodies", "friction"),
    [
        *(((_tense(UNIFORM, tension),), "none") for tension in (1e-3, 0.5, 20.0)),
        *(((solid,), "none") for solid in (_tense(GRADED, 0.5), _tense(COATED, 3.0))),
        *(((solid,), "bonded") for solid in (UNIFORM, GRADED, COATED, _tense(GRADED, 0.5))),
        *((pair, "none") for pair in ((COATED, LAYERED), (GRADED, UNIFORM))),
        ((_tense(UNIFORM, 0.5), _tense(COATED, 0.1)), "none"),
    ],
)
def test_the_displacement_is_that_of_hankel_transforms(bodies, friction):
    xi, weight = _waves()
    exact = _exact(sum(_response(solid, xi, friction == "bonded") for solid in bodies), xi, weight)
    problem = with_friction(fem_reference.Problem(bodies[0], *PARTS, *bodies[1:]), friction)
    assert _displacement(problem) == pytest.approx(exact, rel=MESH_ERROR)


@pytest.mark.parametrize(
    ("solid", "halved"),
    [
        (_tense(COATED, 3.0), replace(COATED, thickness=0.5, surface_tension=1.5)),
        (_tense(GRADED, 0.5), replace(GRADED, c0=0.5 * GRADED.c0, surface_tension=0.25)),
    ],
)
def test_a_unit_of_length_does_not_matter(solid, halved):
    """A tension is a modulus times a length."""
    spec = MeshSpec(0.1, 0.05, 64.0, 1.3, 4)
    large, small = compliance_for(solid, spec, 2.0), compliance_for(halved, spec, 1.0)
    assert large.factor(2.0) * large.matrix == pytest.approx(2.0 * small.factor(1.0) * small.matrix, rel=1e-9)


def test_forces_of_the_surface_tension():
    """Those of the matrix; exactly none under a common displacement but for the end; the energy of r^2 is known."""
    nodes = np.array([0.0, 0.4, 0.4 + 1e-7, 1.0, 3.0])
    skin = SurfaceTension(nodes, 4, 0.4)
    rng = np.random.default_rng(3)
    w = rng.normal(size=(skin.matrix.shape[0], 2))
    assert skin.forces(w) == pytest.approx(skin.matrix @ w, abs=1e-7)
    common = np.zeros((w.shape[0], 1))
    common[: nodes.size] = 0.1
    assert np.flatnonzero(skin.forces(common)).tolist() == [nodes.size - 1]
    parabola = np.zeros(w.shape[0])
    parabola[: nodes.size] = nodes**2
    parabola[nodes.size :: 3] = np.diff(nodes) ** 2 / np.sqrt(6.0)
    # The integral of (2 r)^2 r to 3, and the end: (1 + k)/2 w(3)^2.
    assert parabola @ skin.matrix @ parabola == pytest.approx(81.0 + 0.7 * 81.0, rel=1e-6)


@pytest.mark.parametrize(("tension", "bonded"), [(0.7, False), (0.0, True), (30.0, True)])
def test_pyamg_and_a_direct_solve_and_the_condensation_agree(tension, bonded):
    """Three routes to the displacement of the surface; conjugate gradients iterate."""
    spec = MeshSpec(0.1, 0.05, 64.0, 1.3, 4)
    solid = ScaledSolid(fem_reference.PowerLaw(1.0, 1.0, 0.4, 0.3, tension), bonded=bonded)
    half_space = assemble_half_space(spec.grid(), solid, spec.order)
    load = np.zeros(half_space.elements.size)
    load[half_space.surface[:3]] = 1.0, 0.5, 0.2
    iterative, direct = solve_cg(half_space, load), solve_direct(half_space, load)
    condensed = np.linalg.solve(surface_stiffness(half_space), load[half_space.surface])
    assert 0 < iterative.iterations[0] <= 20
    scale = np.abs(condensed).max()
    for other in (iterative, direct):
        assert other.solution[half_space.surface] == pytest.approx(condensed, abs=1e-9 * scale)
    fixed = np.abs(iterative.solution[half_space.surface - 1]).max()
    assert (fixed == 0.0) == bonded


@pytest.mark.parametrize("tension", [-1.0, float("nan"), float("inf"), "1 N/m", True])
def test_a_surface_tension_that_is_none_is_refused(tension):
    for build in (
        lambda: fem_reference.Homogeneous(1.0, 0.3, surface_tension=tension),
        lambda: replace(GRADED, surface_tension=tension),
        lambda: replace(COATED, surface_tension=tension),
        lambda: replace(LAYERED, surface_tension=tension),
    ):
        refused(r"surface_tension = .* is outside \[0, infinity\)", build)
