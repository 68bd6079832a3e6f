"""Estimate of a mesh error from three degrees, and the parts of a bound, on numbers whose answer is known."""

import math

import numpy as np
import pytest

from fem_reference import NotConverged
from fem_reference._contact.degree_error import SMALLEST_GAIN, degree_error
from fem_reference._contact.other_lengths import OTHER_LENGTHS
from fem_reference._contact.parts import PARTS, EventsOnMeshes

#: Sums and differences of numbers near 1, relative to the differences of 1e-3 between them.
ROUNDED = 1e-10
#: Relative rounding of a quantity itself.
ROUNDING = 1e-14
DEGREES = (4, 6, 7)


@pytest.mark.parametrize(("gain", "factor"), [(20.0, 9.5), (4.0, 2.427), (2.0, 1.0)])
def test_the_estimate_covers_errors_that_fall_by_a_gain(gain, factor):
    """The last error is 1e-6; half of the gain is believed, from 2 to 3, and the difference is gain - 1 times it."""
    values = tuple(1.0 + 1e-6 * gain**steps for steps in (3, 1, 0))
    assert degree_error(DEGREES, values) == pytest.approx(factor * 1e-6, rel=1e-3)


def test_less_is_believed_where_a_law_has_several_wells():
    values = tuple(1.0 + 1e-6 * 20.0**steps for steps in (3, 1, 0))
    assert degree_error(DEGREES, values, SMALLEST_GAIN) == pytest.approx(2.0 * degree_error(DEGREES, values))


def test_errors_of_a_singular_solution_are_covered():
    """They fall as p^-4: the gain of the last degree is below 2, but the estimate is a third of the error at least."""
    values = tuple(1.0 + p**-4.0 for p in DEGREES)
    assert degree_error(DEGREES, values) > 0.3 * 7**-4.0


@pytest.mark.parametrize("degrees", [(4, 5, 6), (4, 7, 8)])
def test_errors_that_fall_like_a_power_of_the_degree_are_covered(degrees):
    """From p^-5.2 on, where the last gain is 2; at p^-12 half of that from 4 to 7 is above it, but not believed."""
    for power in np.arange(5.5, 25.0, 0.5):
        errors = tuple(degrees[-1] ** power * p**-power for p in degrees)
        assert degree_error(degrees, errors) > 1.0, power


def test_two_values_that_agree_by_chance_show_nothing():
    assert degree_error(DEGREES, (1.9, 1.0, 1.0)) == pytest.approx(0.9 / 900.0 / 2.0)
    assert degree_error(DEGREES, (1.0, 1.0, 1.0)) == 0.0
    # Not of three degrees either: the gain is 9.65 each.
    assert degree_error((4, 7, 8), (1.9, 1.0, 1.0)) == pytest.approx(0.9 / 900.0 / 2.0)


def test_without_the_lowest_degree_the_difference_of_the_others_is_the_error():
    assert degree_error(DEGREES, (math.nan, 1.5, 1.0)) == 0.5


def _number(events):
    """A functional of events that are numbers already; None is an event that cannot be found."""
    if events is None:
        raise NotConverged("the event cannot be found on this mesh")
    return events


#: Changes that coarser features make, with the lowest and with the highest degree.
LOW = {"first layer": 1e-3, "ends": 3e-4}
HIGH = {"first layer": 7e-6, "ends": 5e-6}
BASE, FINE = 1.101, 1.001


def _feature(name, full):
    return FINE + HIGH[name] if full else BASE + LOW[name]


ON_MESHES = {
    "fine": FINE, "lower": 1.004, "base": BASE, "feature": _feature, "placements": (FINE - 3e-5, FINE + 4e-5),
    "resized": (), "tail": FINE - 6e-6, "degrees": DEGREES, "accuracy": 1e-6,
}  # fmt: skip
EXPECTED = {
    "mesh": 0.0018913, "first layer": 1e-3, "interior and exterior": 3e-4, "edge": 4e-5, "tail": 6e-6,
    "rounding": ROUNDING * FINE,
}  # fmt: skip


def _parts(**changed):
    return EventsOnMeshes(**(ON_MESHES | changed)).estimate(_number).parts


def test_each_part_is_the_whole_change_that_its_mesh_makes():
    parts = _parts()
    assert tuple(parts) == PARTS
    assert parts["mesh"] == pytest.approx(degree_error(DEGREES, (BASE, 1.004, FINE)))
    assert dict(parts) | {"mesh": 0.0} == pytest.approx(EXPECTED | {"mesh": 0.0}, rel=ROUNDED, abs=0.0)


def test_elements_of_other_lengths_tell_what_degrees_do_not():
    parts = _parts(resized=(FINE + 1e-3, FINE - 2e-3))
    assert parts["mesh"] == pytest.approx(_parts()["mesh"] + 3e-3, rel=ROUNDED)


def _error_at_kinks(length, places):
    """Error of a Gauss rule on elements of a length, of an integrand with a kink."""
    x, w = np.polynomial.legendre.leggauss(8)
    start = length * np.floor(places / length)
    exact = ((places - start) ** 2 + (start + length - places) ** 2) / 2
    return length / 2 * np.abs(start[:, None] + length * (x + 1) / 2 - places[:, None]) @ w - exact


def test_the_other_lengths_cover_the_error_of_a_kink_at_nearly_any_place():
    """Measured: at 0.999 of them; at 0.98 without one of the lengths, at 0.994 with three that are nearer to 1."""
    places = np.linspace(2.0, 20.0, 4000)
    error = _error_at_kinks(1.0, places)
    covered = sum(abs(_error_at_kinks(ratio, places) - error) for ratio in OTHER_LENGTHS)
    assert np.mean(covered >= abs(error)) > 0.997


def test_an_event_that_the_lowest_degree_does_not_have_takes_the_features_of_the_highest():
    parts = _parts(base=None, feature=lambda name, full: FINE + HIGH[name] if full else None)
    assert parts["mesh"] == pytest.approx(0.003, rel=ROUNDED)
    assert parts["first layer"] == pytest.approx(7e-6, rel=1e-8)
    assert parts["interior and exterior"] == pytest.approx(5e-6, rel=1e-8)


@pytest.mark.parametrize(("accuracy", "change"), [(1e-6, 7e-6), (1e-3, 2e-5)])
def test_a_feature_takes_the_highest_degree_where_its_change_exceeds_the_mesh_and_half_of_the_accuracy(
    accuracy, change
):
    """With the lowest degree it is 2e-5, and the error of the mesh 1e-7."""
    base = FINE + 1e-6
    parts = _parts(
        lower=FINE + 1e-7,
        base=base,
        feature=lambda name, full: FINE + HIGH[name] if full else base + 2e-5,
        accuracy=accuracy,
    )
    assert parts["first layer"] == pytest.approx(change, rel=1e-6)
