"""Tests of the response blocks that are kept for later meshes."""

import numpy as np
import pytest

from fscm import _response_store as store
from fscm._deformation import response_matrix
from fscm._kernel import Kernel
from fscm._panels import PanelMesh

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
