"""Moduli and Poisson ratios of depth: values, interfaces, what a mesh follows, refused data."""

import math

import numpy as np
import pytest

from fem_reference import Coating, Interface, PowerLaw, TabulatedModulus
from fem_reference._elastic.compliance import is_scaling, scaled_poisson
from fem_reference._elastic.depth_scales import DepthScales, depth_scales
from fem_reference.depth_profiles import CustomProfile, TabulatedProfile, TransitionProfile
from fem_reference.modulus import PowerLawModulus
from tests.fem_reference.profile_solid import ProfileSolid, table_of_moduli

STEPS = table_of_moduli((0.0, 1.0, 1.5, 4.0), (1.0, 1.1, 3.0, 3.0))


def test_a_table_is_monotone_and_constant_beyond_its_ends():
    z = np.linspace(0.0, 6.0, 601)
    E = STEPS(z)
    assert np.all(np.diff(E) >= 0)
    assert E[0] == 1.0
    assert np.all(E[z >= 4.0] == 3.0)
    assert STEPS(np.array(STEPS.depths)) == pytest.approx(STEPS.values, rel=1e-15)
    deep = table_of_moduli((2.0, 3.0), (5.0, 4.0))
    assert deep(np.array([0.0, 1.9, 2.5, 9.0])) == pytest.approx([5.0, 5.0, 4.5, 4.0])
    assert table_of_moduli([0, 1, 1.5, 4], [1, 1.1, 3, 3]) == STEPS


def test_rows_of_a_table_are_mesh_lines():
    """Two rows with a large ratio are a short part as well, with a line between them."""
    scales = depth_scales(STEPS, 1e-2, 1e2)
    assert scales == DepthScales((1.0, 1.25, 1.5, 4.0), ((1.0, 1.5),))
    z = np.linspace(0.0, 5.0, 200)
    smooth = table_of_moduli(z, 1.0 + np.exp(-z))
    assert smooth.interfaces == ()
    assert all(line == pytest.approx(5.0) for line in depth_scales(smooth, 1e-2, 1e2).lines)


def test_poisson_ratios():
    z = np.array([0.0, 0.9, 1.1, 50.0])
    assert TransitionProfile(0.1, 0.4, 1.0)(z) == pytest.approx([0.1, 0.1, 0.4, 0.4])
    wide = TransitionProfile(0.1, 0.4, 1.0, transition=0.2)(np.array([1.0, 9.0]))
    assert wide == pytest.approx([0.25, 0.4])
    assert TabulatedProfile((0.0, 2.0), (0.4, 0.2))(np.array([1.0, 3.0])) == pytest.approx([0.3, 0.2])
    half = scaled_poisson(TransitionProfile(0.1, 0.4, 1.0), 2.0)
    assert half(np.array([0.4, 0.6])) == pytest.approx([0.1, 0.4])
    assert half.interfaces == (Interface(0.5),)


def test_a_mesh_follows_poissons_ratio():
    E = PowerLawModulus(1.0, 1.0, 0.0)
    assert depth_scales(E, 1e-2, 1e2, 0.3) == DepthScales()
    assert depth_scales(E, 1e-2, 1e2, TransitionProfile(0.1, 0.4, 3.0)).lines == (3.0,)
    coating = TransitionProfile(2.0, 1.0, 1.0)
    assert depth_scales(coating, 1e-2, 1e2, TransitionProfile(0.1, 0.4, 3.0)).lines == (1.0, 3.0)
    undeclared = CustomProfile(lambda z: np.where(z < 3.0, 0.1, 0.4))
    assert depth_scales(E, 1e-2, 1e2, undeclared).lines == pytest.approx([3.0], rel=1e-14)
    # As the modulus of a layer that cannot widen, (lambda + 2 G)/E.
    ratio = CustomProfile(lambda z: 0.225 * (1.0 + np.tanh((z - 3.0) / 0.2)))
    layer = CustomProfile(lambda z: (1.0 - ratio(z)) / ((1.0 + ratio(z)) * (1.0 - 2.0 * ratio(z))), 0.0, 0.0, 1.0)
    assert depth_scales(E, 1e-2, 1e2, ratio) == depth_scales(layer, 1e-2, 1e2) != DepthScales()
    assert is_scaling(E, 0.3, ())
    assert not is_scaling(E, TransitionProfile(0.1, 0.4, 3.0), ())
    assert not is_scaling(E, 0.3, (1.0,))


def _custom(*arguments):
    return ProfileSolid(CustomProfile(*arguments), 0.3)


def test_impossible_solids_are_refused():
    for make, message in (
        (lambda: _custom(np.sqrt, 0.0, 0.5, 1.0), r"surface exponent 0 is declared, but E\(z\) rises as z\^0.5"),
        (lambda: _custom(np.sqrt, 0.5, 0.0, 1.0), r"depth exponent 0 is declared, but E\(z\) rises as z\^0.5"),
        (lambda: _custom(np.sqrt, 0.5, 0.5, 1.0, (1.0,)), "not a tuple of Interface"),
        (lambda: Interface(-1.0), "depth of an interface = -1.0"),
        (lambda: Interface(1.0, math.nan), "transition = nan"),
        (lambda: TabulatedModulus((0.0, 1.0), (1.0, 1.0), (0.3, 0.5)), r"nu = 0.5 is outside \[0, 0.5\)"),
        (lambda: Coating(1.0, 1.0, 1.0, 0.0, -0.1, 0.3), r"nu = -0.1 is outside"),
        (lambda: PowerLaw(1.0, 1.0, 0.0, TransitionProfile(0.1, 0.3, 1.0)), "take CustomSolid"),
        (lambda: ProfileSolid(STEPS, CustomProfile(lambda z: 0.3 + z)), "at the depth"),
        (lambda: ProfileSolid(STEPS, CustomProfile(lambda z: 0.3)), "must have that of z"),
    ):
        with pytest.raises(ValueError, match=message):
            make()
