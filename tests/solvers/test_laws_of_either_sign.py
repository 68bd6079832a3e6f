"""Laws with a barrier and a work of adhesion of either sign, by both references, a third code and the rigid limit."""

from __future__ import annotations

import math

import numpy as np
import pytest

import fem_reference
import fscm
from fscm.laws import dimensionless_law, unit_of_energy
from tests.fscm import ring_code
from tests.marks import heavy
from tests.solvers.laws_of_either_sign import ADHESIVE, REPULSIVE, Layered

#: The two codes for the integral equation; measured worst 2e-14.
AGREEMENT = 1e-11


def unit(law: Layered) -> float:
    """That of energy per area: to what the depth of a well is known is a matter of the unit alone."""
    return unit_of_energy(law)


def by_fscm(law: Layered, mu: float, quantity: str, n: float = 2.0) -> fscm.Solution:
    return fscm.solve(fscm.Problem(n, 0.0, mu, law=law), quantity)


def by_elements(law: Layered, mu: float, quantity: str, n: float = 2.0) -> tuple[float, float]:
    """Value and bound, dimensionless."""
    solid = fem_reference.Homogeneous(unit(law) * mu ** (1.0 / n - 2.0), 0.0)
    solution = fem_reference.solve(fem_reference.Problem(solid, fem_reference.PowerPunch(n, 1.0), law), quantity)
    scale = math.pi * unit(law) if quantity in ("pull_off_force", "hysteresis_energy") else 1.0
    return solution.value / scale, solution.u_num / scale


def by_ring_code(law: Layered, mu: float, quantity: str) -> float:
    scaled = ring_code.Law(
        lambda H: law.traction(H) / unit(law), lambda H: law.slope(H) / unit(law), law.peak_gap, -0.9
    )
    state = ring_code.solve(2.0, 0.0, mu, quantity.rsplit("_", 1)[0], law=scaled)
    return -state.load if quantity == "pull_off_force" else state.displacement


@pytest.mark.parametrize(
    ("law", "mu", "quantity"),
    [
        (REPULSIVE, 0.5, "jump_in_displacement"),
        *heavy(
            (ADHESIVE, 0.5, "pull_off_force"),
            (ADHESIVE, 0.5, "jump_in_displacement"),
            (ADHESIVE, 0.5, "jump_out_displacement"),
            (REPULSIVE, 0.5, "jump_out_displacement"),
            (REPULSIVE, 1.0, "jump_in_displacement"),
        ),
    ],
)
def test_three_codes(law: Layered, mu: float, quantity: str) -> None:
    ours, (elements, u_elements) = by_fscm(law, mu, quantity), by_elements(law, mu, quantity)
    assert ours.value == pytest.approx(by_ring_code(law, mu, quantity), rel=AGREEMENT, abs=AGREEMENT)
    assert abs(ours.value - elements) <= ours.u_num + u_elements
    assert u_elements <= 1e-5


@pytest.mark.heavy
@pytest.mark.parametrize("quantity", ["pull_off_force", "jump_out_displacement", "hysteresis_energy"])
def test_a_flatter_punch_is_held_where_the_barrier_takes_more_than_the_tension(quantity: str) -> None:
    """The least load of a paraboloid is that of the energy; a flatter punch feels the tension itself."""
    ours, (elements, u_elements) = by_fscm(REPULSIVE, 0.3, quantity, 6.0), by_elements(REPULSIVE, 0.3, quantity, 6.0)
    assert ours.value > 0.0 or quantity == "jump_out_displacement"
    assert abs(ours.value - elements) <= ours.u_num + u_elements


def test_no_pull_off_of_a_paraboloid_under_compression() -> None:
    """Neither solver has a force: the load is nowhere negative."""
    with pytest.raises(fem_reference.NoSuchEvent, match="tension"):
        by_elements(REPULSIVE, 0.5, "pull_off_force")
    analysis = fscm.Analysis(fscm.Problem(2.0, 0.0, 0.5, law=REPULSIVE))
    for quantity, reason in (("zero_load_displacement", "no zero"), ("pull_off_force", "tension")):
        with pytest.raises(fscm.NoSuchEvent, match=reason):
            analysis.solution(quantity)


@pytest.mark.parametrize("law", [ADHESIVE, REPULSIVE])
def test_the_load_of_a_rigid_paraboloid_is_the_energy(law: Layered) -> None:
    """Derjaguin: P = 2 pi R U(H_0), largest at the top of the barrier and least in the well."""
    folds = [fold for fold in fscm.Analysis(fscm.Problem(2.0, 0.0, 1e-5, law=law)).folds if fold.quantity == "load"]
    expected = [2.0 * law.top / unit(law), -2.0 * law.work_of_adhesion / unit(law)]
    assert [fold.load for fold in folds] == pytest.approx(expected, rel=1e-4)
    assert [fold.maximum for fold in folds] == [True, False]


@pytest.mark.parametrize("law", [ADHESIVE, REPULSIVE])
def test_the_unit_of_energy(law: Layered) -> None:
    """The work of adhesion, or the depth of the well where that is not positive."""
    expected = law.work_of_adhesion if law is ADHESIVE else law.depth
    assert unit(law) == pytest.approx(expected, rel=1e-4)
    scaled = dimensionless_law(law)
    assert scaled.work_of_adhesion == pytest.approx(law.work_of_adhesion / unit(law))
    assert scaled.energy(np.array(0.3)) == pytest.approx(law.energy(np.array(0.3)) / unit(law))


@pytest.mark.parametrize("law", [ADHESIVE, REPULSIVE])
@pytest.mark.parametrize("z0", [1.0, 3e-10])
def test_a_table_has_either_sign(law: Layered, z0: float) -> None:
    """The gap is counted from another origin; a repulsion that has faded ends with zero."""
    gap, traction = points(law)
    for module in (fscm, fem_reference):
        table = module.TabulatedLaw((gap + 5.0) * z0, traction, z0=z0)
        assert table.work_of_adhesion == pytest.approx(law.work_of_adhesion * z0, rel=1e-4)
        assert table.traction(np.array(0.3 * z0)) == pytest.approx(law.traction(np.array(0.3)), rel=1e-6)
        assert table.energy(np.array(0.3 * z0)) == pytest.approx(law.energy(np.array(0.3)) * z0, rel=1e-4)
        if law is REPULSIVE:
            with pytest.raises(ValueError, match="work"):
                module.TabulatedLaw(gap + 5.0, traction, work=1.0)


def points(law: Layered) -> tuple[np.ndarray, np.ndarray]:
    """Gaps and tractions of a table, which fade from the gap 9, where they are 1e-6 of the largest, to zero at 12."""
    gap = np.linspace(-0.3, 12.0, 800)
    t = np.clip((12.0 - gap) / 3.0, 0.0, 1.0)
    return gap, law.traction(gap) * t**4 * (35.0 - 84.0 * t + 70.0 * t**2 - 20.0 * t**3)


def test_a_table_gives_the_jump_of_its_law() -> None:
    table = fscm.TabulatedLaw(*points(REPULSIVE))
    values = [by_fscm(law, 0.5, "jump_in_displacement").value for law in (REPULSIVE, table)]
    assert values[1] == pytest.approx(values[0], rel=1e-3)


def test_what_is_no_well_is_refused() -> None:
    """At H = 0 the energy is the largest of all."""
    with pytest.raises(ValueError, match="no well"):
        fscm.Problem(2.0, 0.0, 1.0, law=Layered(-12.0, -2.0))
