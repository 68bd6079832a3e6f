"""Samples between the nodes: exact for polynomials, and better than the nodes where a function bends in a panel."""

import numpy as np
import pytest

from fscm._surface.mesh import PanelMesh
from fscm._surface.samples import POINTS, Samples

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
