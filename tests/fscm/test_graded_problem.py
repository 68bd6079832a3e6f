"""Events on graded solids: limits, finite elements, exact rates, bounds, bad input."""

from types import SimpleNamespace

import numpy as np
import pytest

from fscm import (
    Coating,
    Exponential,
    LennardJones,
    NotConverged,
    OffsetPowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    TabulatedLaw,
    TabulatedModulus,
    solve,
    solve_together,
)
from fscm._arc_length import parameter_of, rates_of
from fscm._continuation import moved
from fscm._meshes import Meshes
from fscm._panels import PanelMesh
from fscm._pull_off_path import pull_off_path
from fscm._whole_path import bracketing_path
from fscm.analysis import Analysis
from fscm.graded import response_of
from fscm.graded.panels import remainder
from fscm.stability import margins

SOFT_BELOW = Coating(5.0, 1.0, 0.7, 0.1, 0.3)


@pytest.mark.parametrize(
    "quantities",
    [
        ["pull_off_force"],
        # Of a whole path.
        pytest.param(["jump_in_displacement", "jump_out_gap"], marks=pytest.mark.heavy),
    ],
)
def test_a_homogeneous_solid_has_the_numbers_of_the_power_law(quantities):
    computed, exact = (
        solve_together(problem, quantities)
        for problem in (Problem(2, 0.0, 1.0, graded=Exponential(1.0, 1.0, 1.0, 0.3)), Problem(2, 0, 1.0))
    )
    for name, value in computed.items():
        assert abs(value.value - exact[name].value) <= value.u_num + exact[name].u_num + 1e-13


@pytest.mark.parametrize(
    ("thickness", "mu"),
    [
        (1e8, 1.0),
        # Its kernel is in the homogeneous limits of `test_graded_kernel.py`.
        pytest.param(1e-13, 1.0 / 4.0 ** (2.0 / 3.0), marks=pytest.mark.heavy),
    ],
)
def test_a_thin_or_thick_coating_has_the_numbers_of_one_modulus(thickness, mu):
    force = solve(Problem(2, 0.0, 1.0, graded=Coating(1.0, 4.0, thickness, 0.0, 0.3)), "pull_off_force")
    # 2e-9: the coating changes the response at radii of its thickness, or of its inverse.
    assert force.value == pytest.approx(solve(Problem(2, 0, mu), "pull_off_force").value, rel=2e-9)


def test_rates_along_the_path_are_exact():
    state = Analysis(Problem(2, 0.0, 1.0, graded=SOFT_BELOW)).event("pull_off").value
    rates, step = rates_of(state), 1e-3
    assert state.parameter == "log_scale"
    after, before = (moved(state, rates, parameter_of(state) + sign * step, 1e-12) for sign in (1.0, -1.0))
    for name in ("displacement", "central_gap", "load"):
        slope = (getattr(after, name) - getattr(before, name)) / (2.0 * step)
        # 1e-5: the third derivative times the square of the step
        assert slope == pytest.approx(getattr(rates, name), abs=1e-5)


#: Values of `fem_reference` at its default accuracy, with its bounds, for unit Q, z0 and work of adhesion, n = 2.
FINITE_ELEMENTS = [
    (
        OffsetPowerLaw(0.91, 1.0, 0.4, 1.0, 0.3),
        {
            "pull_off_force": (1.74302095588, 2.2e-8),
            "jump_in_displacement": (-1.32916086976, 7.9e-8),
            "jump_out_displacement": (-1.33851188361, 1.0e-7),
        },
    ),
    (Coating(0.91, 4.55, 0.7, 0.1, 0.3), {"pull_off_force": (1.88374381887, 1.8e-8)}),
    (SOFT_BELOW_SHARP := Coating(0.91, 0.182, 0.7, 0.0, 0.3), {"pull_off_force": (1.39415784109, 9.4e-8)}),
    # Of a whole path; the light one is the first solid.
    pytest.param(SOFT_BELOW_SHARP, {"jump_in_displacement": (-2.89799085593, 1.4e-7)}, marks=pytest.mark.heavy),
]


@pytest.mark.parametrize(("solid", "values"), FINITE_ELEMENTS)
def test_events_agree_with_the_finite_elements(solid, values):
    problem = Problem(solid, PowerPunch(2.0, Q=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0)).dimensionless
    solutions = solve_together(problem, values)
    for name, (value, bound) in values.items():
        assert solutions[name].value == pytest.approx(value, abs=bound + solutions[name].u_num)


SOLIDS = [
    SOFT_BELOW,
    OffsetPowerLaw(1.0, 1.0, 0.4, 0.5, 0.3),
    Coating(1.0, 10.0, 0.5, 0.0, 0.3, 0.5),
    TabulatedModulus([0.0, 1.0, 2.0, 5.0], [1.0, 3.0, 4.0, 10.0], 0.3),
]
#: Shape index, Tabor number and place of the solid of the light tests: every shape and every solid occurs.
SHAPES = [(2, 0.3, 1), (2, 0.3, 2)]


@pytest.mark.parametrize(
    ("n", "mu", "solid"),
    [
        pytest.param(n, mu, solid, id=f"{n}-{mu}-{i}", marks=() if (n, mu, i) in SHAPES else pytest.mark.heavy)
        for n, mu in ((2, 0.3), (1, 1.0), (2, 3.0))
        for i, solid in enumerate(SOLIDS)
    ],
)
def test_the_bound_covers_the_distance_to_finer_meshes(n, mu, solid):
    problem = Problem(n, 0.0, mu, graded=solid)
    coarse, fine = (solve(problem, "pull_off_force", accuracy) for accuracy in (1e-5, 1e-9))
    assert coarse.u_num < 1e-5 * coarse.value
    assert fine.u_num < 1e-7 * fine.value
    # The kernel is the same for both.
    apart = abs(coarse.value - fine.value)
    assert apart <= coarse.u_num + fine.u_num - coarse.parts["kernel"] - fine.parts["kernel"] + 1e-13


def test_the_error_of_the_kernel_is_a_part_of_the_bound():
    parts = solve(Problem(2, 0.0, 1.0, graded=SOFT_BELOW), "pull_off_force").parts
    assert 0.0 < parts["kernel"] < 1e-7
    assert solve(Problem(2, 0, 1.0), "pull_off_force").parts["kernel"] == 0.0


def test_a_refined_mesh_keeps_the_response_between_its_old_panels():
    ends = [-1.0, -0.75, -0.5, -0.1, 0.0, 0.25, 1.0, 3.0, 9.0]
    coarse, fine = (PanelMesh(np.array(x), 8, 1.0) for x in (ends, sorted({*ends, -0.3, 0.1} - {3.0})))
    response = response_of(SOFT_BELOW)
    for c in (1.0, 20.0):
        table, length = response._table, 0.6
        full = remainder(table, length, fine, c)
        points = table.of
        counted = []
        spy = SimpleNamespace(of=lambda A, B, seen=counted, of=points: (seen.append(A.size), of(A, B))[1])
        reused = remainder(spy, length, fine, c, (coarse, remainder(table, length, coarse, c)))
        assert counted[0] < fine.size * (fine.size + 1) // 2
        for name in ("matrix", "rate", "axis", "axis_rate"):
            # Products of matrices of other sizes are rounded in another order.
            assert np.allclose(getattr(full, name), getattr(reused, name), rtol=0.0, atol=1e-13)
        step = 1e-4
        moved, there = full.moved(step), remainder(table, length, fine, c * np.exp(step))
        # The second derivative times half the square of the step.
        assert np.allclose(moved.matrix, there.matrix, rtol=0.0, atol=1e-7)
        same = remainder(table, length, fine, c, (fine, moved))
        assert np.array_equal(same.matrix, moved.matrix)


def test_a_solid_that_is_soft_below_needs_no_more_points_of_the_path_than_its_softest_part():
    """The units of the path are those of the largest Tabor number: with that of the surface it had twice the points."""
    below = Problem(1, 0.0, 3.0, graded=Coating(5.0, 1.0, 0.7, 0.1, 0.3))
    assert len(bracketing_path(below, Meshes())) < 80


def test_the_short_path_is_for_power_laws_alone():
    """On layers, and for a law of the user, the load may have several minima."""
    assert pull_off_path(Problem(2, 0.0, 1.0), Meshes()) is not None
    gaps = np.geomspace(0.75, 20.0, 100)
    law = TabulatedLaw(gaps, gaps**-9 - gaps**-3, tail_exponent=3)
    assert pull_off_path(Problem(2, 0.0, 1.0, law=law), Meshes()) is None
    assert pull_off_path(Problem(2, 0.0, 1.0, graded=Coating(5.0, 1.0, 0.7, 0.1, 0.3)), Meshes()) is None


def test_physical_units_scale_out():
    solid = Exponential(E_surface=1e9, E_depth=5e9, length=1e-7, nu=0.3)
    metres = Problem(solid, PowerPunch(2, Q=1e-6), LennardJones(0.05, 3e-10))
    exponential = Exponential(E_surface=1.0, E_depth=5.0, length=1e2, nu=0.3)
    nanometres = Problem(exponential, PowerPunch(2, Q=1e3), LennardJones(0.05, 0.3))
    assert metres.mu == pytest.approx(nanometres.mu, rel=1e-12)
    lengths = [problem.dimensionless.graded.length for problem in (metres, nanometres)]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-12)
    assert nanometres.units["radius"] == pytest.approx((1e3 * 0.3) ** 0.5)


def test_what_needs_a_power_law_is_refused_in_one_sentence():
    with pytest.raises(ValueError, match=r"k = 0.4 is outside \[0, 0\]"):
        Problem(2, 0.4, 1.0, graded=SOFT_BELOW)
    with pytest.raises(ValueError, match="is no graded solid"):
        Problem(2, 0.0, 1.0, graded=3.0)
    state = Analysis(Problem(2, 0.0, 0.3, graded=SOFT_BELOW)).event("pull_off").value
    assert np.isfinite(margins(state, 0)).all()
    with pytest.raises(NotConverged, match="power-law modulus only"):
        margins(state, 1)
    rough = PowerSum([1.0, -2.0, 1.05], [2, 3, 4])
    with pytest.raises(NotConverged, match="power-law modulus only"):
        Analysis(Problem(4, 0.0, 1.0, graded=SOFT_BELOW, punch=rough)).event("zero_load")
