"""Shapes of punches of the finite elements: heights, slopes, kinks and the meshes that follow them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fem_reference import MeasuredPunch, NotConverged, PowerLaw, PowerSum
from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.mesh_lengths import kinks_within
from fem_reference._elastic.mesh import MeshSpec, edge_grid
from fem_reference._elastic.trace import trace_of
from tests.fem_reference.solved_together import sphere_on
from tests.refusals import refused

SOFT = PowerLaw(1.0, 1.0, 0.0, 0.3)


def test_mesh_lines_at_kinks():
    kinks = (0.2, 0.7, 1.0 + 1e-9, 3.0)
    grid = edge_grid(apex_width=0.05, kinks=kinks)
    assert set(kinks) <= set(grid.r)
    assert 1.0 not in grid.r  # the kink beside it is the line there
    assert np.diff(grid.r).min() > 1e-3
    apart = edge_grid(apex_width=0.05, kinks=(0.2, 3.0)).r
    assert {0.2, 1.0, 3.0} <= set(apart)
    assert apart.size < 2 * edge_grid(apex_width=0.05).r.size
    spec = MeshSpec(0.1, 0.05, 100.0, 0.5, 4, kinks=(2.0,))
    assert 0.5 in spec.moved(4.0).grid().r


def test_derivatives_of_the_surface_functions():
    trace = trace_of(edge_grid(density=1.0), 6)
    s, h = np.array([0.01, 0.9, 1.3, 40.0]), 1e-6
    differences = (trace.evaluate(s * (1 + h)) - trace.evaluate(s * (1 - h))) / (2 * h * s[:, None])
    assert trace.slopes(s) == pytest.approx(differences, abs=1e-7 * np.abs(differences).max())
    node = trace.nodes[5:6]
    assert trace.slopes(node) == pytest.approx(trace.slopes(node * (1 + 1e-12)), rel=1e-9, abs=1e-9)


def test_only_kinks_in_reach_are_lines():
    r = np.linspace(0.0, 60.0, 121)
    kinks = kinks_within(replace(sphere_on(SOFT), punch=MeasuredPunch(r[::2], r[::2] ** 2 / 2)))
    assert len(kinks) == 24
    assert max(kinks) < math.sqrt(600.0)


def test_too_many_kinks_are_refused():
    r = np.linspace(0.0, 20.0, 101)
    with pytest.raises(NotConverged, match="the slope of the punch jumps at 100 radii"):
        chosen(replace(sphere_on(SOFT), punch=MeasuredPunch(r, r**2 / 2)), ("pull_off",), "quick")


def test_a_sum_with_a_cusp_and_a_profile_that_ends_at_its_apex_are_refused():
    """The pressure at a cusp has no bound, and a profile without height does not rise beyond its last point."""
    refused("exponent 0.9 ", PowerSum, (1.0, 1.0), (2.0, 0.9))
    assert PowerSum((1.0, 1.0), (2.0, 1.0)).height(np.array([1.0]))[0] == 2.0
    refused("last height 0 ", MeasuredPunch, (0.0, 1.0), (0.0, 0.0))
