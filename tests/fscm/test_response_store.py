"""Tests of the response blocks that are kept for later meshes."""

import numpy as np
import pytest

from fscm import _response_store as store
from fscm._deformation import response_blocks, response_matrix
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
    found = [response_matrix(kernel, mesh) for mesh in meshes]
    for mesh, matrix in zip(meshes, found, strict=True):
        store.clear()
        np.testing.assert_array_equal(response_matrix(Kernel(k), mesh), matrix)


def test_only_blocks_that_lack_are_computed() -> None:
    kernel, mesh = Kernel(0.4), PanelMesh(OFFSETS, 6, 1.0)
    counts = []

    def compute(mesh: PanelMesh, targets: np.ndarray, sources: np.ndarray) -> np.ndarray:
        counts.append(len(targets))
        return response_blocks(kernel, mesh, targets, sources)

    blocks = store.ResponseBlocks(compute)
    m = len(mesh.lengths)
    blocks.of(mesh)
    blocks.of(split(mesh, 2))
    blocks.of(mesh)
    assert counts == [m**2, (m + 1) ** 2 - (m - 1) ** 2]


def test_panels_that_do_not_come_back_are_not_kept() -> None:
    mesh = PanelMesh(OFFSETS + np.r_[0.0, np.full(len(OFFSETS) - 1, 0.1 / 3.0)], 6, 1.0)
    assert store.blocks_of(Kernel(0.4), mesh, lambda *_: np.zeros(0)) is None


def test_memory_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "BLOCKS_MEMORY", 2_000_000)
    kernels = [Kernel(k) for k in (0.1, 0.2, 0.3)]
    for kernel in kernels:
        mesh = PanelMesh(OFFSETS, 8, 1.0)
        for i in (0, 4, 2, 9, 11, 1, 3, 5, 7):
            mesh = split(mesh, i % len(mesh.lengths))
            response_matrix(kernel, mesh)
    assert sum(blocks.memory for blocks in store._STORES.values()) <= 2 * store.BLOCKS_MEMORY
    np.testing.assert_array_equal(response_matrix(kernels[0], mesh), response_matrix(Kernel(0.1), mesh))
