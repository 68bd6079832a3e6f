"""Radii beyond the mesh under slow laws, and rings there, on solids that far away are others than at the contact."""

from dataclasses import replace

import numpy as np
import pytest

from fscm import Analysis, CustomSolid, Layers, Mie, OffsetPowerLaw, PowerLaw, PowerPunch, Problem, solve
from fscm._surface.kernel import ring_response
from fscm._surface.response.distant_ring import DistantRing
from fscm._surface.response.response import response_of
from fscm._surface.tail import deformation_beyond, tail_errors, tail_of, tail_variation
from fscm.accuracy import Meshes
from tests.fscm.distant_stack import Stiff, lifted_from_beyond, response_at_center
from tests.marks import heavy

SLOW = Problem(2.0, 0.0, 1.0, law=Mie(m=9.0, n=1.1), graded=Layers(*Stiff.solid))
#: The same in SI, with 0.9995 for the Tabor number: sphere of 100 nm, w = 50 mJ/m^2, z0 = 0.4 nm.
IN_SI = Problem(
    Layers([1.8e9, 1.8e6], [0.3, 0.3], [12.65e-6]), PowerPunch(n=2, Q=100e-9), Mie(0.05, 0.4e-9, m=9.0, n=1.1)
)
#: By the closed form, with a mesh that ends at f = 1e12, and by the finite elements (1e-14 in SI).
DISPLACEMENT, DISPLACEMENT_IN_SI = -0.4545982982, -1.81692066e-10
T, DELTA = 1.6e3, -0.4
#: A mesh that ends 1000 times farther out.
FARTHER = replace(Meshes(), end_height=1e12)


def test_the_displacement_by_the_far_pressure_is_that_of_the_closed_compliance() -> None:
    tail = tail_of(SLOW, T, DELTA)
    exact = lifted_from_beyond(T, DELTA, 9.0, 1.1, SLOW.compliance)
    errors, remainder = tail_errors(SLOW, T, DELTA)
    assert tail.displacement == pytest.approx(exact, rel=1e-8)
    assert abs(tail.displacement - exact) <= abs(errors[1]) + remainder[1] + 1e-10 * abs(exact)
    # With the compliance at T for all of it: what was wrong.
    at_start = float(response_of(SLOW.graded).distant.by_images(np.array(T)))
    assert at_start * 2.0 * T * float(SLOW.law.traction(np.array(T**2 / 2.0))) / 1.2 > 0.5 * exact


@pytest.mark.parametrize(
    ("problem", "value"), [(SLOW, DISPLACEMENT), *[pytest.param(IN_SI, DISPLACEMENT_IN_SI, marks=pytest.mark.heavy)]]
)
def test_the_displacement_at_pull_off(problem: Problem, value: float) -> None:
    """Once 880 and 1000 bounds from the value of a farther mesh, of the closed compliance and of the elements."""
    solution = solve(problem, "pull_off_displacement", 1e-6)
    assert abs(solution.value - value) <= solution.u_num + 1e-9 * abs(value)
    assert solution.u_num < 1e-5 * abs(value)


@pytest.mark.heavy
def test_the_bounds_hold_against_a_mesh_that_ends_far_beyond() -> None:
    for name in ("pull_off_displacement", "jump_out_displacement", "zero_load_displacement", "hysteresis_energy"):
        near, far = Analysis(SLOW).solution(name), Analysis(SLOW, FARTHER).solution(name)
        assert abs(near.value - far.value) <= near.u_num + far.u_num, name
        assert near.u_num < 1e-6 * abs(near.value), name


@pytest.mark.parametrize(
    ("problem", "T", "displacement", "h"),
    [(SLOW, T, DELTA, 0.1), (Problem(1.1, 0.3, 0.8, law=Mie(m=3, n=2)), 40.0, -1.5, 1e-5)],
)
def test_the_derivatives_of_the_tail(problem: Problem, T: float, displacement: float, h: float) -> None:
    """Against central differences in the radius and, with steps of h, in the displacement."""
    tail, dt = tail_of(problem, T, displacement), 1e-5
    farther = [tail_of(problem, T * (1.0 + x), displacement) for x in (dt, -dt)]
    shifted = [tail_of(problem, T, displacement + x) for x in (h, -h)]
    for name in ("load", "displacement"):
        for derivative, (after, before), step in (("rate", farther, dt), ("slope", shifted, h)):
            difference = (getattr(after, name) - getattr(before, name)) / (2.0 * step)
            assert getattr(tail, f"{name}_{derivative}") == pytest.approx(difference, rel=1e-6)


def test_an_error_of_the_response_by_images_is_seen_by_the_waves(monkeypatch: pytest.MonkeyPatch) -> None:
    exact, by_images = tail_of(SLOW, T, DELTA).displacement, DistantRing.by_images
    monkeypatch.setattr(DistantRing, "by_images", lambda rings, t: (1.0 + 1e-3 * (t > 3.0 * T)) * by_images(rings, t))
    wrong = tail_of(SLOW, T, DELTA).displacement
    errors, _ = tail_errors(SLOW, T, DELTA)
    assert abs(wrong - exact) > 1e-4 * abs(exact)
    assert errors[1] == pytest.approx(wrong - exact, rel=0.01)


def test_what_the_tail_neglects_is_bounded() -> None:
    """The change of its displacement over the mesh, and the deformation beyond by the load inside."""
    radii = T * np.array([1e-4, 0.01, 0.3, 0.9])
    kernel = response_of(SLOW.graded).kernel
    x, w = np.polynomial.legendre.leggauss(60)
    log_t = 0.5 * np.log(1e4) * (1.0 + x)
    t = T * np.exp(log_t)
    pressure = SLOW.law.traction(t**2 / 2.0 - DELTA) * t * w * 0.5 * np.log(1e4)
    change = kernel.response(radii[:, None], t) - kernel.response(0.0 * radii[:, None], t)
    exact = SLOW.compliance * np.abs(change @ pressure)
    bound = np.abs(tail_variation(SLOW, T, DELTA, radii))
    assert np.all(exact <= bound)
    assert np.all(bound < 30.0 * exact)
    # By a load 1 on a spot of radius 1, on which G is that of a ring of half that radius.
    lifted = 0.5 * SLOW.compliance * kernel.response(np.full(60, 0.5), np.full(60, 1.0) * t) / t
    assert np.max(lifted) <= deformation_beyond(SLOW, T, 1.0) * (1.0 + 1e-6)


#: Relative error by images: measured worst 2e-11; by the waves: 9e-9 at the end of them, 7e-11 elsewhere.
BY_IMAGES, BY_WAVES = 1e-10, 1e-8
#: Distance from the power law far below of the response of an offset one at 1e5 offsets: measured 3e-6.
LIMIT = 1e-5


def test_both_ways_against_the_closed_form_of_a_stiff_layer() -> None:
    """From a hundredth of the thickness, where the layer bends, to 500 times it."""
    rings = response_of(Layers(*Stiff.solid)).distant
    radii = Stiff.thickness * np.array([0.01, 0.3, 1.0, 8.0, 70.0, 500.0])
    exact = np.array([response_at_center(t) for t in radii])
    assert exact[-2] > 100.0 * exact[0]
    assert rings.by_images(radii) == pytest.approx(exact, rel=BY_IMAGES)
    assert rings.by_waves(radii) == pytest.approx(exact, rel=BY_WAVES)


@pytest.mark.parametrize("k", [0.5, *heavy(0.1, 0.9)])
def test_far_away_an_offset_power_law_is_a_power_law(k: float) -> None:
    """Both ways, and the power of the radius beyond the reach of the images."""
    solid, limit = OffsetPowerLaw(1.0, 1.0, k, 1.0, 0.3), PowerLaw(1.0, 1.0, k, 0.3)
    rings = response_of(solid).distant
    t = np.array([1e5, 1e3 * rings.reach])
    expected = (1.0 - k) * limit.response_factor / (1.0 - k) * t * ring_response(k, np.zeros(2), t) / t
    assert rings.by_images(t) == pytest.approx(expected, rel=LIMIT)
    assert rings.by_waves(t[:1]) == pytest.approx(expected[:1], rel=LIMIT)


def test_the_interpolation_is_the_kernel() -> None:
    response = response_of(CustomSolid(lambda z: 1.0 + np.log1p(z), 0.3, length=1.0))
    radii = np.geomspace(0.1, 1e6, 40)
    exact = response.kernel.response(np.zeros(40), radii)
    assert response.distant.by_images(radii) == pytest.approx(exact, rel=1e-11)
    assert response.distant.by_waves(radii) == pytest.approx(exact, rel=BY_WAVES)
