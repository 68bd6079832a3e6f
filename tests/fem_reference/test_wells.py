"""Laws with a barrier: their wells and the work of their tension, and where a path begins."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from fem_reference import Dlvo, Homogeneous, LennardJones, PowerPunch, Problem, TabulatedLaw
from fem_reference._contact.degree_error import LARGEST_GAIN, SMALLEST_GAIN
from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.parts import events_on_meshes
from fem_reference._wells import outermost_turn, work_of_tension
from fem_reference.laws import SurfaceLaw

BARRIER = Dlvo(hamaker_constant=16.0 * math.pi, z0=1.0, double_layer=8.0 / 3.0, debye_length=1.0)


def test_the_deepest_well_is_the_gap_zero() -> None:
    assert float(BARRIER.traction(np.array(0.0))) == pytest.approx(0.0, abs=1e-13)
    assert float(BARRIER.slope(np.array(0.0))) < 0.0
    gap = np.geomspace(0.8, 500.0, 2000) - BARRIER.distance
    assert np.all(BARRIER.energy(gap) >= -BARRIER.work_of_adhesion - 1e-12)


def test_the_work_of_adhesion_is_the_integral_of_the_traction() -> None:
    work = -quad(BARRIER.traction, 0.0, np.inf, limit=500)[0]
    assert BARRIER.work_of_adhesion == pytest.approx(work, rel=1e-9)
    assert -float(BARRIER.energy(np.array(0.0))) == pytest.approx(work, rel=1e-9)


def test_the_tension_works_more_than_the_adhesion() -> None:
    """What the barrier returns on separation is left out."""
    tension = quad(lambda H: max(-float(BARRIER.traction(np.array(H))), 0.0), 0.0, np.inf, limit=500)[0]
    assert work_of_tension(BARRIER) == pytest.approx(tension, rel=1e-3)
    assert work_of_tension(BARRIER) > BARRIER.work_of_adhesion
    assert work_of_tension(LennardJones(2.0, 0.5)) == 2.0


def test_the_tension_only_falls_beyond_the_outermost_turn() -> None:
    gap = np.geomspace(0.8, 500.0, 20_000) - BARRIER.distance
    tension = -BARRIER.traction(gap)
    turn = gap[np.flatnonzero(np.diff(tension) > 0.0)[-1] + 1]
    assert outermost_turn(BARRIER) == pytest.approx(turn, rel=1e-2)


def test_a_table_may_have_a_barrier() -> None:
    distance = np.concatenate([np.linspace(0.7, 8.0, 400), np.geomspace(8.05, 400.0, 150)])
    table = TabulatedLaw(distance, BARRIER.traction(distance - BARRIER.distance), z0=1.0, tail_exponent=3.0)
    gap = np.geomspace(0.8, 500.0, 50) - BARRIER.distance
    assert table.work_of_adhesion == pytest.approx(BARRIER.work_of_adhesion, rel=1e-7)
    assert table.peak_gap == pytest.approx(BARRIER.peak_gap, rel=1e-6)
    assert table.traction(gap) == pytest.approx(BARRIER.traction(gap), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize(
    ("changed", "name"),
    [({"z0": 0.0}, "z0"), ({"double_layer": -1.0}, "double_layer"), ({"debye_length": -1.0}, "debye")],
)
def test_a_parameter_outside_its_range_is_named(changed: dict[str, float], name: str) -> None:
    values = {"hamaker_constant": 1.0, "z0": 1.0, "double_layer": 1.0, "debye_length": 1.0}
    with pytest.raises(ValueError, match=name):
        Dlvo(**values | changed)


@pytest.mark.parametrize(("law", "gain"), [(BARRIER, SMALLEST_GAIN), (LennardJones(1.0, 1.0), LARGEST_GAIN)])
def test_a_bound_believes_less_where_a_law_has_a_barrier(law: SurfaceLaw, gain: float) -> None:
    problem = Problem(Homogeneous(law.work_of_adhesion, 0.0), PowerPunch(2.0, 1.0), law)
    assert events_on_meshes(chosen(problem, ("pull_off",), "quick")).largest_gain == gain
