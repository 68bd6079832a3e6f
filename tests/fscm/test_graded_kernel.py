"""Response of graded solids to a ring: compliances, images against quadrature and 16 digits, limits, refusals."""

import json
from functools import cache

import mpmath
import numpy as np
import pytest
from numpy.polynomial import chebyshev

import fscm
from fscm._bound.parts import _KERNEL_RATE
from fscm._surface.response import GradedKernel
from fscm._surface.response.compliance import START, compliance
from fscm._surface.response.images import RAY, STEP
from fscm._surface.response.kernel import image_sum
from fscm._surface.response.patches import ImageTable, patches_of
from fscm._surface.response.ring_series import Lattice, below_joined, ring_series
from fscm.bodies import surface_of
from tests.fscm import graded_digits
from tests.marks import heavy
from tests.solvers.layered_jkr import Stack

SOLIDS = {
    "offset": fscm.OffsetPowerLaw(1.0, 1.0, 0.4, 1.0, 0.3),
    "offset 0.8": fscm.OffsetPowerLaw(1.0, 1.0, 0.8, 1.0, 0.3),
    "exponential": fscm.Exponential(1.0, 10.0, 1.0, 0.3),
    "soft below": fscm.Exponential(10.0, 1.0, 1.0, 0.5),
    "steep": fscm.Exponential(1.0, 1000.0, 1.0, 0.3),
    "stiff layer": fscm.Coating(1e4, 1.0, 1.0, 0.0, 0.4, 0.49),
    "tanh coating": fscm.Coating(10.0, 1.0, 1.0, 0.1, 0.3, 0.45),
    "sharp layer": fscm.Coating(1.0, 10.0, 1.0, 0.0, 0.3),
    "table": fscm.TabulatedModulus([0.0, 1.0, 2.0, 5.0], [1.0, 3.0, 4.0, 10.0], 0.3),
    "waves": fscm.CustomSolid(lambda z: 2.0 + np.sin(3.0 * z) * np.exp(-z), 0.3, 1.0),
    # A beam on springs.
    "wide bend": fscm.Layers([1e4, 1.0, 1e4], [0.3, 0.2, 0.3], [1.0, 1.0]),
}
#: Of the light tests: the images of the steepest solid are close to the surface, those of a layer reflect.
OFTEN = ("steep", "sharp layer")
NAMES = [*OFTEN, *heavy(*(name for name in SOLIDS if name not in OFTEN))]


#: So thick that the radii and waves of the tests are in the layer.
THICK = fscm.Coating(1.0, 4.0, 1e12, 0.0, 0.3)


@cache
def kernel(name):
    return GradedKernel(THICK if name == "thick" else SOLIDS[name])


def test_a_stiff_layer_on_a_soft_one_on_a_stiff_solid_bends_over_many_thicknesses():
    """Measured 8.2e-11, and 2e-6 with depths that end at 30 thicknesses."""
    assert kernel("wide bend").images.relative < 2e-10


def _signed_error(name, xi):
    """Error of the images at wave numbers, their sum in extended precision."""
    images = kernel(name).images
    depths, strengths = images.depths.astype(np.clongdouble), images.strengths.astype(np.clongdouble)
    approximation = 1.0 - np.exp(-xi.astype(np.longdouble)[:, None] * depths) @ strengths
    return (approximation.real - 0.5 * surface_of(SOLIDS[name]).contact_modulus * compliance(SOLIDS[name], xi)).astype(
        float
    )


#: Rounding of the compliance: 4.4e-15 beyond the bound was measured with SciPy 1.13, on the exponential solid.
_ROUNDING = 1e-14


@pytest.mark.parametrize("name", NAMES)
def test_the_images_are_wrong_by_no_more_than_their_bound_at_any_wave_number(name):
    xi = np.geomspace(1e-4, 1e4, 241)
    assert np.all(np.abs(_signed_error(name, xi)) <= kernel(name).images.error(xi) + _ROUNDING)


@pytest.mark.heavy
def test_the_rate_of_the_error_is_the_measured_one():
    """Mean of |xi eps'| over a quarter of a decade against the bound of eps, which oscillates between its waves."""
    xi = np.geomspace(1e-4, 1e4, 961)
    step = np.log(xi[1] / xi[0])
    worst = 0.0
    for name in ("tanh coating", "soft below", "table"):
        rate = np.abs(np.gradient(_signed_error(name, xi), step))
        quarters = (values[:-1].reshape(-1, 30).mean(axis=1) for values in (rate, kernel(name).images.error(xi)))
        worst = max(worst, float(np.max(np.divide(*quarters))))
    # What is left of the factor is for the pressure and the adjoint: about one each, and no more than two each.
    assert _KERNEL_RATE / 2.0 < worst < _KERNEL_RATE - 2.0


@pytest.mark.parametrize("name", NAMES)
def test_the_table_follows_the_images(name):
    rng = np.random.default_rng(7)
    images = kernel(name).images
    A = 10.0 ** rng.uniform(-3.0, 3.0, 400)
    B = A * 10.0 ** rng.uniform(-7.0, 0.0, 400)
    # Measured worst 9e-11 and 5e-8, "wide bend".
    for degree, largest in ((15, 3e-10), (11, 1e-7)):
        table = ImageTable(images, degree)
        value, rate = table.of(A, B)
        assert np.allclose(value, A * kernel(name).images_at(A, B), rtol=0.0, atol=table.error)
        assert table.error < largest * images.largest
        step = 1e-3
        ahead, behind = (table.of(A * np.exp(x), B * np.exp(x))[0] for x in (step, -step))
        assert np.allclose(rate, (ahead - behind) / (2.0 * step), rtol=0.0, atol=1e-5 * images.largest)


def test_homogeneous_limits():
    r, t = 10.0 ** np.random.default_rng(2).uniform(-2.0, 2.0, (2, 50))
    plain = fscm.ring_response(0.0, r, t)
    thin = fscm.Coating(1.0, 4.0, 1e-13, 0.0, 0.3)
    for same in (GradedKernel(fscm.Exponential(2.0, 2.0, 1.0, 0.3)), kernel("thick")):
        assert np.allclose(same.response(r, t), plain, rtol=1e-9, atol=0.0)
    assert np.allclose(GradedKernel(thin, 1e3).response(r, t), 0.25 * plain, rtol=1e-9, atol=0.0)


def test_nothing_is_left_of_the_images_beyond_their_last_wave_number():
    """Strengths that cancelled below left 6e-9 of the kernel."""
    images = kernel("thick").images
    xi = images.waves[-1] * np.geomspace(1.0, 1e4, 200)
    assert np.max(np.abs(images.at(xi) - 1.0)) < 1e-11


STORED = json.loads(graded_digits.FILE.read_text())


@pytest.mark.parametrize("name", graded_digits.SOLIDS)
def test_the_response_of_a_solid_from_16_digits(name):
    """1e-9 of the kernel at 50 random pairs of radii, and the stated bound is never exceeded."""
    stored, kernel = STORED[name], GradedKernel(graded_digits.SOLIDS[name])
    r, t, exact = (np.array(stored[key]) for key in ("r", "t", "G"))
    assert len(exact) == 50
    assert stored["error"] < 3e-12
    errors = np.abs(kernel.response(r, t) - exact)
    assert np.max(errors / exact) < 1e-9
    # Rounding of the sum over the images, whose strengths are up to 3e5 together; the values themselves change by
    # `error` with fewer nodes.
    rounding = 1e-16 * float(np.abs(kernel.images.strengths).sum()) * t + stored["error"] * exact
    assert np.all(errors <= kernel.error(r, t) + rounding)


@pytest.mark.parametrize("name", graded_digits.SOLIDS)
@pytest.mark.parametrize("count", [1, pytest.param(20, marks=pytest.mark.heavy)])
def test_the_stored_compliances_are_those_with_16_digits(name, count):
    """Between the nodes of the table, and in double precision by collocation."""
    solid, modes = graded_digits.SOLIDS[name], np.array(STORED[name]["modes"]).T
    # Below, the depth takes many steps.
    xi = 10.0 ** np.random.default_rng(8).uniform(-1.0 if count > 1 else 1.0, 2.5, count)
    exact = np.array([float(graded_digits.relative_compliance(solid, x)) for x in xi])
    # What the pieces of the table leave; one step of collocation leaves 6e-13 on the smooth coating.
    assert np.allclose(graded_digits.excess(modes, xi), exact - 1.0, rtol=0.0, atol=1e-12)
    assert np.allclose(0.5 * surface_of(solid).contact_modulus * compliance(solid, xi), exact, rtol=2e-12, atol=0.0)


@pytest.mark.heavy
@pytest.mark.parametrize("name", graded_digits.SOLIDS)
def test_a_compliance_has_16_digits(name, monkeypatch):
    solid, xi = graded_digits.SOLIDS[name], 0.3
    value = graded_digits.relative_compliance(solid, xi)
    for constant, finer in (("DIGITS", 25), ("ROUNDS", 20), ("START", 30)):
        monkeypatch.setattr(graded_digits, constant, finer)
    with mpmath.workdps(40):
        assert abs(value / graded_digits.relative_compliance(solid, xi) - 1) < mpmath.mpf(10) ** -16


def test_sharp_layers_are_those_of_a_code_of_their_own():
    rng = np.random.default_rng(4)
    ends = np.append(0.0, np.sort(rng.uniform(0.0, 3.0, 6)))
    moduli = rng.uniform(0.2, 5.0, 7)
    solid = fscm.CustomSolid(lambda z: moduli[np.searchsorted(ends[1:], z, side="right")], 0.3, 1.0, ends[1:])
    xi = np.array([0.05, 0.5, 2.0, 8.0])
    layers = tuple((E, 0.3, thickness) for E, thickness in zip(moduli[:-1], np.diff(ends), strict=True))
    stack = Stack(layers, (moduli[-1], 0.3))
    relative = 0.5 * surface_of(solid).contact_modulus * compliance(solid, xi)
    assert relative == pytest.approx(stack.relative_compliance(xi), rel=1e-11)


def test_a_jump_that_is_no_interface_is_refused():
    solid = fscm.CustomSolid(lambda z: np.where(z < 1.0, 1.0, 2.0), 0.3, 1.0)
    with pytest.raises(fscm.NotConverged, match="jumps near the depth 1"):
        compliance(solid, np.array([1.0]))


@pytest.mark.parametrize("name", SOLIDS)
def test_depths_that_change_a_compliance_by_less_than_rounding_may_be_left_out(name, monkeypatch):
    """Measured worst 2e-13, on the smooth coating, whose steps leave 6e-13."""
    xi = np.geomspace(1e-6, 1e9, 46)
    value = compliance(SOLIDS[name], xi)
    monkeypatch.setattr("fscm._surface.response.compliance._starts", lambda solid, xi, depths: np.full_like(xi, START))
    assert np.allclose(value, compliance(SOLIDS[name], xi), rtol=6e-13, atol=0.0)


def test_a_patch_does_not_depend_on_those_computed_before():
    images, keys = kernel("sharp layer").images, [256 * i + j for i, j in ((130, 125), (131, 126), (129, 124))]
    together, alone = [patches_of.__wrapped__(images, 11) for _ in range(2)]
    first = [together.at(key)[0] for key in keys]
    assert np.array_equal(first[-1], alone.at(keys[-1])[0])


@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("turn", [1.0, RAY])
def test_every_ring_of_the_lattice_is_a_polynomial_on_every_patch(turn, joined):
    """Near B, far above and below it, and far from A; of joined patches where no image is near the distances."""
    x, y = np.random.default_rng(3).uniform(-1.0, 1.0, (2, 20))
    apart = 60 + (below_joined(15) if joined else 0)
    series = ring_series(15, 6, apart, joined)
    A = np.exp(STEP * (apart + 3.0 * (1.0 + x)))
    B = np.exp(STEP * below_joined(15)) * 0.5 * (1.0 + y) if joined else np.exp(STEP * 3.0 * (1.0 + y))
    for m in range(below_joined(15) + 6 if joined else -200, 300, 7):
        ring = np.array([np.exp(STEP * m) * turn], complex), np.ones(1, complex)
        value = chebyshev.chebval2d(x, y, series.of(Lattice(*ring), np.array([0]))[0])
        # Measured worst 1e-12, of a ring on the ray.
        assert np.max(np.abs(value - A * image_sum(A[:, None], B[:, None], *ring))) < 5e-12
