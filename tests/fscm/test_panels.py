"""Nodes, interpolation and transfer between meshes."""

import numpy as np
import pytest

from fscm._panels import PanelMesh, gauss_rule


def test_transfer_within_panels_below_the_rounding_of_the_radius() -> None:
    """Half of a panel 4e-15 wide at r = 1: local coordinates must not be taken from rounded radii."""
    h = 2.0**-48
    mesh, halves = (
        PanelMesh(np.array([0.0, 1.0, 1.0 + h]), 4),
        PanelMesh(np.array([0.0, 1.0, 1 + h / 2, 1 + h]), 4),
    )
    u = gauss_rule(4).nodes
    values = np.concatenate([np.zeros(4), u])
    np.testing.assert_allclose(mesh.transfer(values, halves)[4:], np.concatenate([u / 2, 0.5 + u / 2]), rtol=1e-13)


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
