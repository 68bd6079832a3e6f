"""Finite elements on coated and layered solids, against Hankel transforms and against themselves."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import special

from fem_reference import (
    Coating,
    CustomSolid,
    Interface,
    LennardJones,
    OffsetPowerLaw,
    PowerLaw,
    PowerPunch,
    Problem,
    TabulatedModulus,
)
from fem_reference._contact.mesh_lengths import EXTERIOR_ERROR, mesh_spec
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.depth_scales import FIRST_END, DepthScales, depth_scales
from fem_reference._elastic.exterior import exterior_error
from fem_reference.accuracy import level_for
from tests.fem_reference.hankel_reference import transform
from tests.solvers.layered_jkr import Stack

NU = 0.3
LAW = LennardJones(1.0, 1.0)


def _exponential(z):
    return 1.0 + 10.0 * np.exp(-z / 2.0)


EXPONENTIAL = CustomSolid(_exponential, NU, length=2.0)
STIFF_WITH_TWO_RATIOS = Coating(10.0, 1.0, 1.0, 0.0, 0.2, 0.45)

#: Above the depth 3 a cubic that falls with the slope -3.75: 1/E doubles within 0.13.
FALLING = TabulatedModulus((0.0, 0.5, 1.0, 3.0), (2.0, 1.0, 3.0, 0.5), NU)

#: Relative error of the displacement of `FALLING` on the finest mesh of "default": 1.5e-9 measured.
ELASTIC_ERROR = 1e-8


def _problem(solid, n=2.0):
    return Problem(solid, PowerPunch(n, 1.0), LAW)


def _transform(solid, xi, sharp):
    return transform(solid.modulus, solid.poisson, xi, sharp=sharp)


def test_hankel_transform_of_layers():
    """Against amplitudes of fields that decay and grow; a narrow transition is nearly sharp."""
    xi = np.geomspace(1e-4, 30.0, 7)
    layer = Stack(((10.0, 0.2, 1.0),), (1.0, 0.45))
    unit = 2.0 / layer.surface.plane_strain
    values = _transform(STIFF_WITH_TWO_RATIOS, xi, sharp=(1.0,))
    assert values == pytest.approx(unit * layer.relative_compliance(xi), rel=1e-9)
    narrow = transform(Coating(10.0, 1.0, 1.0, 0.01, NU).modulus, STIFF_WITH_TWO_RATIOS.poisson, xi, sharp=(1.0,))
    assert narrow == pytest.approx(values, rel=2e-2)


def test_displacement_of_a_table_that_falls_to_a_small_modulus():
    """One element spanned the depths 1.4 to 3 on every mesh: the displacements were wrong by 5.1e-6 and 6.6e-6."""
    radii = np.array([0.0, 1.0])
    ends = np.array([0.0, 0.03, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 12.0])
    x, w = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(ends)[:, None]
    xi, weight = (ends[:-1, None] + half * (x + 1.0)).ravel(), (half * w).ravel()
    # The pressure exp(-r^2) has the transform exp(-xi^2/4)/2.
    waves = weight * _transform(FALLING, xi, sharp=FALLING.depths[1:]) * 0.5 * np.exp(-(xi**2) / 4.0)
    exact = special.j0(np.outer(radii, xi)) @ waves
    level = level_for("default")
    spec = replace(mesh_spec(_problem(FALLING), level, 0.25, 1.0, 1.0), density=level.density)
    solid = compliance_for(FALLING, spec, 1.0)
    trace = solid.trace
    load = trace.phi.T @ (np.exp(-(trace.s**2)) * trace.s * trace.weight)
    assert trace.evaluate(radii) @ solid.matrix @ load == pytest.approx(exact, rel=ELASTIC_ERROR)


@pytest.mark.parametrize("depth", [1.0, 0.75, FIRST_END * 1.5, 7.3e-4, 2.0**20])
def test_jumps_of_a_callable(depth):
    """Wherever they are, to rounding; both declared and found."""
    solid = CustomSolid(lambda z: np.where(z < depth, 3.0, 2.0), NU, length=depth)
    if depth != FIRST_END * 1.5:  # the middle of an octave: the one place where a jump is not found
        lines = depth_scales(solid, 1e-3 * depth, 1e3 * depth).lines
        assert lines == pytest.approx([depth], rel=1e-14)
    declared = replace(solid, interfaces=(Interface(depth),))
    assert depth_scales(declared, 1e-3 * depth, 1e3 * depth) == DepthScales((depth,))


def test_layers_and_kinks():
    sandwich = CustomSolid(lambda z: np.where((z < 1) | (z > 1.2), 1.0, 9.0), NU, 1.0)
    assert depth_scales(sandwich, 1e-2, 1e2).lines == pytest.approx([1.0, 1.2], rel=1e-14)
    kink = CustomSolid(lambda z: 1.0 + np.minimum(z, 2.0), NU, 1.0)
    scales = depth_scales(kink, 1e-2, 1e2)
    assert scales.lines == ()
    assert min(b - a for a, b in scales.parts) < 0.2
    assert depth_scales(OffsetPowerLaw(1.0, 1.0, 0.7, 1.0, NU), 1e-3, 1e6) == DepthScales()


def test_error_of_the_exterior():
    """Falls with the square of the extent, of a modulus and of a Poisson ratio that change, and keeps its limit."""
    uniform = PowerLaw(1.0, 1.0, 0.0, NU), CustomSolid(lambda z: 1.0 + 0.0 * z, lambda z: 0.3 + 0.0 * z, 1.0)
    assert [exterior_error(solid, 64.0) for solid in uniform] == [0.0, 0.0]
    for least, solid in ((5e-5, EXPONENTIAL), (1e-7, Coating(1.0, 1.0, 1.0, 0.0, 0.1, 0.4))):
        short, long = (exterior_error(solid, extent) for extent in (256.0, 1024.0))
        assert short / long == pytest.approx(16.0, rel=1e-2)
        assert short > least
    spec = mesh_spec(_problem(EXPONENTIAL, 5.0), level_for("quick"), 0.25, 1.0, 1.0)
    assert 0.1 * EXTERIOR_ERROR < exterior_error(EXPONENTIAL, spec.extent) <= EXTERIOR_ERROR


def test_noise_is_refused():
    rng = np.random.default_rng(7)
    noisy = CustomSolid(lambda z: 1.0 + np.where((z > 0.1) & (z < 10.0), 0.1, 0.0) * rng.random(np.shape(z)), NU, 1.0)
    with pytest.raises(ValueError, match="smooth the data"):
        depth_scales(noisy, 0.5, 2.0)
