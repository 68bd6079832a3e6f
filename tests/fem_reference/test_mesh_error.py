"""Estimate of a mesh error from three densities, and the parts of a bound, on numbers whose answer is known."""

import math

import numpy as np
import pytest
from scipy.interpolate import BarycentricInterpolator

from fem_reference import NotConverged
from fem_reference._contact.error_parts import PARTS, EventsOnMeshes
from fem_reference._contact.uncertainty import three_meshes
from fem_reference.quantities import TABLE

# Relative rounding of a quantity itself: 4.5 units of the last place.
ROUNDING = 1e-15
# Sums and differences of numbers near 1, relative to the differences of 1e-3 between them.
ROUNDED = 1e-10


def _series(order, error, limit=1.0, ratio=2.0):
    """Coarse, medium and fine value with an error that falls with this order; `error` is that of the fine mesh."""
    return tuple(limit + error * ratio ** (order * steps) for steps in (2, 1, 0))


@pytest.mark.parametrize("ratio", [1.25, 2.0])
@pytest.mark.parametrize("order", [1.0, 2.0, 6.0])
def test_a_series_of_an_order_up_to_the_declared_one_gives_its_error(order, ratio):
    found = three_meshes(_series(order, 1e-3, ratio=ratio), ratio, declared=6.0)
    assert found.error == pytest.approx(1e-3, rel=1e-9)
    assert found.observed_order == pytest.approx(order, abs=1e-9)


def test_a_series_that_is_slower_than_the_first_order_gets_the_error_of_the_first_order():
    """The differences 0.1 and 0.09 have the order 0.15: at the first order as much is left as the last difference."""
    found = three_meshes((1.19, 1.09, 1.0), ratio=2.0, declared=6.0)
    assert found.observed_order < 0.2
    assert found.error == pytest.approx(0.09, rel=1e-9)


def test_an_order_above_the_declared_one_is_not_trusted():
    """The order is 5, 2 is declared: the fine difference is a quarter of the coarse one, the error a third of that."""
    found = three_meshes((1.33, 1.01, 1.0), ratio=2.0, declared=2.0)
    assert found.observed_order == pytest.approx(5.0, abs=1e-9)
    assert found.error == pytest.approx(0.32 / 4.0 / 3.0, rel=1e-9)


@pytest.mark.parametrize("declared", [2.0, 4.0])
def test_differences_of_rounding_have_the_declared_order(declared):
    found = three_meshes((1.01, 1.0, 1.0 + 1e-14), ratio=2.0, declared=declared, rounding=1e-12)
    growth = 2.0**declared
    assert math.isnan(found.observed_order)
    assert found.error == pytest.approx(0.01 / growth / (growth - 1.0), rel=1e-9)


def test_values_that_turn_back_keep_the_error_of_the_medium_mesh():
    assert three_meshes((1.16, 1.04, 1.07), ratio=2.0, declared=2.0).error == pytest.approx(0.12 / 3.0, rel=1e-9)


def test_a_lower_degree_raises_the_estimate_and_never_lowers_it():
    plain = _series(2.0, 1e-3)
    assert three_meshes(plain, 2.0, 2.0, lower_degree=plain[1] - 0.04).error == pytest.approx(0.01, rel=1e-9)
    assert three_meshes(plain, 2.0, 2.0, lower_degree=plain[1] + 1e-6).error == pytest.approx(1e-3, rel=1e-9)


def _number(events):
    """A functional of events that are numbers already; None is an event that cannot be found."""
    if events is None:
        raise NotConverged("the event cannot be found on this mesh")
    return events


#: Values of one quantity on the meshes: every difference has another size.
ON_MESHES = {
    "path": 1.001, "coarse": 1.016, "medium": 1.004, "lower_degree": 1.0041,
    "base": 1.1, "finest_lower_degree": lambda: 1.0016, "features": {"first layer": 1.1 + 1e-3, "apex": 1.1 - 2e-4},
    "full_degree": {"extent": 1.016 + 5e-3, "first layer": 1.016 - 7e-3, "apex": 1.016 + 9e-4}.__getitem__,
    "placements": (1.001 - 3e-5, 1.001 + 4e-5), "tail": 1.001 - 6e-6, "rounding": 1.001 + 8e-7, "ratio": 2.0,
    "refined": True, "scaling": True,
}  # fmt: skip
EXPECTED = {
    "mesh": 0.001, "first layer": 1e-3, "interior and exterior": 5e-3, "edge": 4e-5 + 2e-4, "tail": 6e-6,
    "algebra": 8e-7 + ROUNDING * 1.001,
}  # fmt: skip


def _parts(**changed):
    return EventsOnMeshes(**(ON_MESHES | changed)).estimate(_number, 2.0).parts


def test_each_part_is_the_whole_change_that_its_mesh_makes():
    parts = _parts()
    assert tuple(parts) == PARTS
    assert dict(parts) == pytest.approx(EXPECTED, rel=ROUNDED)


def test_an_edge_that_the_lower_degree_cannot_resolve_takes_the_features_of_the_full_degree():
    parts = _parts(base=None, lower_degree=None)
    # The coarse mesh is in the place of that of the lower degree: its distance from the medium one, over 2^2.
    assert parts["mesh"] == pytest.approx(0.012 / 4.0, rel=ROUNDED)
    assert parts["first layer"] == pytest.approx(7e-3, rel=ROUNDED)
    assert parts["edge"] == pytest.approx(4e-5 + 9e-4, rel=ROUNDED)


def test_features_of_a_solid_that_does_not_scale_have_the_full_degree_where_the_lower_one_hides_them():
    small = {"first layer": 1.1 + 1e-3, "apex": 1.1 - 5e-7}
    parts = _parts(scaling=False, features=small)
    assert parts["first layer"] == pytest.approx(7e-3, rel=ROUNDED)
    assert parts["edge"] == pytest.approx(4e-5 + 5e-7, rel=ROUNDED)


def test_a_large_difference_of_the_degrees_is_told_by_the_finest_mesh():
    """The lower degree is 0.02 and 0.006 away there, the medium mesh 0.003: of the gain of 6.7, 3 is believed."""
    lower = {"lower_degree": 1.021, "finest_lower_degree": lambda: 1.007}
    assert _parts(scaling=False, **lower)["mesh"] == pytest.approx(0.003, rel=ROUNDED)
    assert _parts(scaling=True, **lower)["mesh"] == pytest.approx(0.017 / 4.0, rel=ROUNDED)


def test_the_difference_of_the_degrees_is_not_divided_where_an_interval_keeps_its_elements():
    assert _parts(lower_degree=1.0)["mesh"] == pytest.approx(1e-3, rel=ROUNDED)
    assert _parts(lower_degree=1.0, refined=False)["mesh"] == pytest.approx(4e-3, rel=ROUNDED)


def test_a_solid_whose_edge_cannot_be_placed_elsewhere_keeps_the_part_of_the_apex():
    assert _parts(placements=())["edge"] == pytest.approx(2e-4, rel=ROUNDED)


def test_rounding_of_a_quantity_is_a_part_when_the_factorisations_agree():
    assert _parts(rounding=1.001)["algebra"] == ROUNDING * 1.001


@pytest.mark.parametrize("degree", [2, 4, 6])
def test_the_declared_order_of_the_gap_at_jump_out_is_that_of_the_displacement_under_a_tip(degree):
    """Of r^2 log r an element that begins at r = 0 misses as much as its length squared, at any degree."""
    errors = []
    for h in (0.4, 0.2, 0.1):
        nodes = 0.5 * h * (1.0 + np.cos(np.pi * np.arange(degree + 1) / degree))
        r = np.linspace(1e-9, h, 500)
        polynomial = BarycentricInterpolator(nodes, _tip(nodes))
        errors.append(np.abs(polynomial(r) - _tip(r)).max())
    found = three_meshes((errors[0], errors[1], errors[2]), ratio=2.0, declared=float(degree))
    assert found.observed_order == pytest.approx(TABLE["jump_out_gap"].order, abs=1e-6)
    assert all(row.order is None for name, row in TABLE.items() if name != "jump_out_gap")


def _tip(r):
    return r**2 * np.log(np.maximum(r, 1e-300))
