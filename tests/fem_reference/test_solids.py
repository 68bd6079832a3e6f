"""Moduli and Poisson ratios of depth: values, interfaces, what a mesh follows, refused data."""

import math

import numpy as np
import pytest

from fem_reference import Coating, CustomSolid, Interface, Layers, PowerLaw, TabulatedModulus
from fem_reference._elastic.depth_scales import DepthScales, depth_scales

STEPS = TabulatedModulus((0.0, 1.0, 1.5, 4.0), (1.0, 1.1, 3.0, 3.0), 0.3)


def test_a_table_is_monotone_and_constant_beyond_its_ends():
    z = np.linspace(0.0, 6.0, 601)
    E = STEPS.modulus(z)
    assert np.all(np.diff(E) >= 0)
    assert E[0] == 1.0
    assert np.all(E[z >= 4.0] == 3.0)
    assert STEPS.modulus(np.array(STEPS.depths)) == pytest.approx(STEPS.moduli, rel=1e-15)
    deep = TabulatedModulus((2.0, 3.0), (5.0, 4.0), 0.3)
    assert deep.modulus(np.array([0.0, 1.9, 2.5, 9.0])) == pytest.approx([5.0, 5.0, 4.5, 4.0])
    assert TabulatedModulus([0, 1, 1.5, 4], [1, 1.1, 3, 3], 0.3) == STEPS


def test_rows_of_a_table_are_mesh_lines():
    """Two rows with a large ratio are a short part as well, with a line between them."""
    scales = depth_scales(STEPS, 1e-2, 1e2)
    assert scales == DepthScales((1.0, 1.25, 1.5, 4.0), ((1.0, 1.5),))
    z = np.linspace(0.0, 5.0, 200)
    smooth = TabulatedModulus(z, 1.0 + np.exp(-z), 0.3)
    assert smooth.interfaces == ()
    assert all(line == pytest.approx(5.0) for line in depth_scales(smooth, 1e-2, 1e2).lines)


def test_poisson_ratios():
    z = np.array([0.0, 0.9, 1.1, 50.0])
    sharp = Coating(1.0, 1.0, 1.0, 0.0, 0.1, 0.4)
    assert sharp.poisson(z) == pytest.approx([0.1, 0.1, 0.4, 0.4])
    wide = Coating(1.0, 1.0, 1.0, 0.2, 0.1, 0.4).poisson(np.array([1.0, 9.0]))
    assert wide == pytest.approx([0.25, 0.4])
    table = TabulatedModulus((0.0, 2.0), (1.0, 1.0), (0.4, 0.2))
    assert table.poisson(np.array([1.0, 3.0])) == pytest.approx([0.3, 0.2])
    half = sharp.in_lengths(2.0)
    assert half.poisson(np.array([0.4, 0.6])) == pytest.approx([0.1, 0.4])
    assert half.interfaces == (Interface(0.5),)


def _of_ratio(nu, length=1.0):
    return CustomSolid(lambda z: 1.0 + 0.0 * z, nu, length)


def test_a_mesh_follows_poissons_ratio():
    assert depth_scales(PowerLaw(1.0, 1.0, 0.0, 0.3), 1e-2, 1e2) == DepthScales()
    assert depth_scales(Coating(1.0, 1.0, 3.0, 0.0, 0.1, 0.4), 1e-2, 1e2).lines == (3.0,)
    layers = Layers((2.0, 1.0, 1.0), (0.1, 0.1, 0.4), (1.0, 2.0))
    assert depth_scales(layers, 1e-2, 1e2).lines == (1.0, 3.0)
    undeclared = _of_ratio(lambda z: np.where(z < 3.0, 0.1, 0.4))
    assert depth_scales(undeclared, 1e-2, 1e2).lines == pytest.approx([3.0], rel=1e-14)

    def ratio(z):
        return 0.225 * (1.0 + np.tanh((z - 3.0) / 0.2))

    # As the modulus of a layer that cannot widen, (lambda + 2 G)/E.
    layer = CustomSolid(lambda z: (1.0 - ratio(z)) / ((1.0 + ratio(z)) * (1.0 - 2.0 * ratio(z))), 0.0, 1.0)
    assert depth_scales(_of_ratio(ratio), 1e-2, 1e2) == depth_scales(layer, 1e-2, 1e2) != DepthScales()


def _root(surface_exponent, depth_exponent, length=1.0, interfaces=()):
    return CustomSolid(np.sqrt, 0.3, length, interfaces, surface_exponent, depth_exponent)


def test_impossible_solids_are_refused():
    for make, message in (
        (
            lambda: CustomSolid(np.sqrt, 0.3, 1.0, (), 0.0, 0.5),
            r"surface exponent 0 is declared, but E\(z\) rises as z\^0.5",
        ),
        (
            lambda: CustomSolid(np.sqrt, 0.3, 1.0, (), 0.5, 0.0),
            r"depth exponent 0 is declared, but E\(z\) rises as z\^0.5",
        ),
        (lambda: CustomSolid(np.sqrt, 0.3, 1.0, (-1.0,), 0.5, 0.5), "depth of an interface = -1.0"),
        (lambda: CustomSolid(np.sqrt, 0.3, 0.0, (), 0.5, 0.5), "length = 0.0"),
        (lambda: CustomSolid(np.sqrt, 0.3, 1.0, (), 1.0, 0.5), "exponent k = 1.0"),
        (lambda: Interface(-1.0), "depth of an interface = -1.0"),
        (lambda: Interface(1.0, math.nan), "transition = nan"),
        (lambda: TabulatedModulus((0.0, 1.0), (1.0, 1.0), (0.3, 0.5)), r"nu = 0.5 is outside \[0, 0.5\)"),
        (lambda: Coating(1.0, 1.0, 1.0, 0.0, -0.1, 0.3), r"nu = -0.1 is outside"),
        (lambda: PowerLaw(1.0, 1.0, 0.0, lambda z: 0.3 + 0.0 * z), "take CustomSolid"),
        (lambda: _of_ratio(lambda z: 0.3 + z), "at the depth"),
        (lambda: _of_ratio(lambda z: 0.3), "must have that of z"),
    ):
        with pytest.raises(ValueError, match=message):
            make()
