"""Panels, samples between their nodes, and deformation: closed forms, order, symmetry, transfer, response blocks."""

import numpy as np
import pytest
from scipy.special import gamma, hyp1f1

from fscm import Problem
from fscm._surface import response_store as store
from fscm._surface.deformation import axis_row, response_matrix
from fscm._surface.discretisation import Discretisation
from fscm._surface.kernel import Kernel
from fscm._surface.mesh import PanelMesh
from fscm._surface.samples import POINTS, Samples

# Relative to the largest displacement; measured worst 7.0e-13 (k = 0.8).
CLOSED_FORM = 5e-12


def _graded_mesh(order: int = 16, depth: int = 20) -> PanelMesh:
    """Panels to r = 8, graded towards r = 1 from both sides down to 2^-depth."""
    steps = 2.0 ** -np.arange(1, depth)
    outer = 2.0 ** np.arange(-5, 3.5)
    return PanelMesh(np.unique(np.concatenate([[0.0], outer, 1 - steps, 1 + steps])), order)


@pytest.mark.parametrize("k", [0.0, 1e-8, 0.05, 0.4, 0.8, 0.95])
def test_gaussian_pressure(k: float) -> None:
    """p = exp(-t^2): the integral is (1/2) Gamma((1-k)/2) 1F1((1+k)/2; 1; -r^2)."""
    mesh = _graded_mesh()
    p = np.exp(-(mesh.nodes**2))
    w = response_matrix(Kernel(k), mesh) @ p
    exact = 0.5 * gamma((1 - k) / 2) * hyp1f1((1 + k) / 2, 1, -(mesh.nodes**2))
    assert np.abs(w - exact).max() < CLOSED_FORM * exact.max()
    assert axis_row(Kernel(k), mesh) @ p == pytest.approx(0.5 * gamma((1 - k) / 2), rel=1e-13)


@pytest.mark.parametrize("k", [0.0, 0.5])
@pytest.mark.parametrize("order", [4, 6])
def test_order_of_convergence(k: float, order: int) -> None:
    """Halving all panels of a smooth pressure gains 2^order: that of interpolation at `order` nodes.

    It holds down to the floor of the Gauss rule of order q at one panel length, (3 + sqrt 8)^-2q h^(1-k): at
    q = 4 and 6 that is 1e-6 and 1e-9 of a weak singularity, at the q >= 10 in use below rounding.
    """
    errors = []
    for count in (12, 24):
        mesh = PanelMesh(np.linspace(0, 6, count + 1), order)
        w = response_matrix(Kernel(k), mesh) @ np.exp(-(mesh.nodes**2))
        exact = 0.5 * gamma((1 - k) / 2) * hyp1f1((1 + k) / 2, 1, -(mesh.nodes**2))
        errors.append(np.abs(w - exact).max())
    assert np.log2(errors[0] / errors[1]) > order - 0.1


def test_a_mesh_on_which_nothing_is_solved_passes_on_the_blocks_of_its_exponent() -> None:
    """Ends that are no binary fractions are not stored: their blocks come from the mesh before."""
    ends = np.array([0.0, 1.0 / 3.0, 1.0, 3.0, 10.0])
    finer = np.sort(np.append(ends, 0.7))
    meshes = [PanelMesh(offsets, 8) for offsets in (ends, ends, finer)]
    for k in (0.0, 0.4):
        disc = Discretisation(Problem(2, 0.0, 1.0), meshes[0])
        assert disc.response(1.0).shape == (32, 32)
        for mesh in meshes[1:]:
            disc = Discretisation(Problem(2, k, 1.0), mesh, disc)
        np.testing.assert_array_equal(
            disc.response(1.0), Discretisation(Problem(2, k, 1.0), PanelMesh(finer, 8)).response(1.0)
        )


def test_distances_from_the_origin_are_exact() -> None:
    """Panels of 1e-20 at s = 1: nodes, values and lengths there, and the same function seen from the axis."""
    ends = np.array([-1.0, -0.5, 0.0, 1e-20, 3e-20, 2.0])
    mesh = PanelMesh(ends, 5, origin=1.0)
    assert mesh.starts[0] == 0.0
    assert mesh.lengths[2:4] == pytest.approx([1e-20, 2e-20], rel=1e-14)
    values = np.where((mesh.node_offsets > 0.0) & (mesh.node_offsets < 1e-20), 1e20 * mesh.node_offsets, 0.0)
    assert mesh.evaluate_at_offsets(values, np.array([0.25e-20]))[0] == pytest.approx(0.25, rel=1e-12)
    finer = PanelMesh(np.insert(ends, 3, 0.5e-20), 5, origin=1.0)
    np.testing.assert_allclose(mesh.transfer(values, finer)[10:20], 1e20 * finer.node_offsets[10:20], rtol=1e-12)
    coarse, seen = PanelMesh(np.array([0.0, 0.5, 3.0]), 5), mesh.nodes**2
    np.testing.assert_allclose(coarse.transfer(coarse.nodes**2, mesh), seen, rtol=1e-12, atol=1e-15)


OFFSETS = np.array([-1.0, -0.5, -0.125, 0.0, 0.0625, 0.25, 1.0, 7.0])


def split(mesh: PanelMesh, i: int) -> PanelMesh:
    return PanelMesh(np.insert(mesh.offsets, i + 1, mesh.middles[i]), mesh.order, mesh.origin)


@pytest.fixture(autouse=True)
def empty() -> None:
    store.clear()


@pytest.mark.parametrize("k", [0.0, 0.4, 0.9])
def test_known_blocks_give_the_same_matrix_bit_for_bit(k: float) -> None:
    """Whatever was computed before: a result must not depend on the problems that were solved earlier."""
    kernel, meshes = Kernel(k), [PanelMesh(OFFSETS, 6, 1.0)]
    for i in (3, 1, 7, 0):
        meshes.append(split(meshes[-1], i))
    matrices = [response_matrix(kernel, mesh) for mesh in meshes]
    for mesh, matrix in zip(meshes, matrices, strict=True):
        store.clear()
        np.testing.assert_array_equal(response_matrix(Kernel(k), mesh), matrix)


@pytest.mark.parametrize("bound", [200_000, 2_000_000, 8_000_000])
def test_memory_is_bounded(monkeypatch: pytest.MonkeyPatch, bound: int) -> None:
    """By the stated number, after every matrix; a table that is full or thrown away changes no value."""
    monkeypatch.setattr(store, "BLOCKS_MEMORY", bound)
    kernels, most = [Kernel(k) for k in (0.1, 0.2, 0.3)], 0
    for kernel in kernels:
        mesh = PanelMesh(OFFSETS, 8, 1.0)
        for i in range(30):
            mesh = split(mesh, (7 * i) % len(mesh.lengths))
            response_matrix(kernel, mesh)
            most = max(most, store.memory())
            assert store.memory() <= bound
    assert most > bound // 8 or bound < 1_000_000
    matrix = response_matrix(kernels[0], mesh)
    store.clear()
    np.testing.assert_array_equal(matrix, response_matrix(Kernel(0.1), mesh))


MESH = PanelMesh(np.array([0.0, 1.0, 1.5, 4.0]), 12)
SAMPLES = Samples(MESH)


def test_polynomials_are_sampled_exactly():
    values = SAMPLES.radii**11 - 3.0 * SAMPLES.radii
    assert SAMPLES.projected(values) == pytest.approx(MESH.nodes**11 - 3.0 * MESH.nodes, rel=1e-11, abs=1e-13)
    exact = np.diff(MESH.breaks**12 / 12.0 - 1.5 * MESH.breaks**2)
    assert SAMPLES.integrals(values) == pytest.approx(exact, rel=1e-13)


def test_samples_are_those_of_the_transfer():
    values = np.cos(MESH.nodes)
    finer = PanelMesh(np.array([0.0, 0.125, 1.0, 1.5, 4.0]), 16)
    samples = MESH.transfer(values, finer, POINTS)
    assert samples == pytest.approx(np.cos(Samples(finer).radii), abs=1e-9)


@pytest.mark.parametrize("order", [1, 3])
def test_a_bend_anywhere_in_a_panel_is_integrated(order):
    """Also when it is weighed by a polynomial, as by the adjoint."""
    by_nodes, by_samples, by_projection = [], [], []
    for bend in np.linspace(1.6, 3.9, 47):

        def bent(r, bend=bend):
            return np.maximum(r - bend, 0.0) ** order

        weight, rest = MESH.nodes**2, 4.0 - bend
        exact = rest ** (order + 1) / (order + 1)
        weighed = sum(c * rest ** (order + 1 + i) / (order + 1 + i) for i, c in enumerate((bend**2, 2.0 * bend, 1.0)))
        by_nodes.append(MESH.weights @ bent(MESH.nodes) - exact)
        by_samples.append(SAMPLES.integrals(bent(SAMPLES.radii))[2] - exact)
        by_projection.append(MESH.weights @ (weight * SAMPLES.projected(bent(SAMPLES.radii))) - weighed)
    assert np.abs(by_samples).max() < 0.03 * np.abs(by_nodes).max()
    assert np.abs(by_projection).max() < 0.5 * np.abs(by_nodes).max()
