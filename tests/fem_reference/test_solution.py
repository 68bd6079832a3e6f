"""The front door: published digits, honest uncertainty, unit scaling, nu-collapse, other solids, refusals."""

import math

import numpy as np
import pytest

import fem_reference
from fem_reference import (
    CustomModulus,
    CustomSolid,
    LennardJones,
    NoSuchEvent,
    NotConverged,
    PowerPunch,
    Solid,
    profile,
    solve,
    solve_together,
    trace,
)
from fem_reference._contact.mesh_choice import ACCURACIES, MeshChoice, chosen
from fem_reference._contact.uncertainty import three_meshes
from fem_reference.verification.reference_solutions import surface_constant

PULL_OFF = {
    (0.0, 0.1): 1.96895638,
    (0.0, 0.5): 1.78748293,
    (0.0, 1.0): 1.67066478,
    (0.0, 2.0): 1.58359530,
    (0.4, 0.5): 1.86628026,
    (0.4, 1.0): 1.78848171,
    (0.4, 1.4): 1.75861391,
}
"""-P_c / (pi Q w) of paraboloids by (k, mu), from the integral equation; all digits shown."""

DIGITS = 5e-9
"""Half a unit of the last digit of the table, relative."""

DEFAULT_ERROR = 1e-7
"""Promise 1e-5; measured 8e-9 at most, which is the rounding of the table."""


def _solid(k, mu, nu, n=2.0):
    """Solid of a given ratio mu of deformation to range, for Q = c0 = z0 = w = 1 (Eq. 29 of the paper)."""
    E_star = surface_constant(k, nu) / (1 - k) / mu ** ((2 * n + k - 1) / n)
    return Solid(E_star * (1 - nu**2), 1.0, k, nu)


def _pull_off(k, mu, nu=0.25, accuracy="default", n=2.0, quantity="pull_off_force"):
    return solve(_solid(k, mu, nu, n), PowerPunch(n, 1.0), LennardJones(1.0, 1.0), quantity, accuracy)


@pytest.mark.parametrize(("k", "mu"), [(0.0, 1.0), (0.4, 1.0)])
def test_pull_off_force_default(k, mu):
    answer = _pull_off(k, mu)
    exact = math.pi * PULL_OFF[k, mu]
    assert abs(answer.value - exact) <= DEFAULT_ERROR * exact
    assert abs(answer.value - exact) <= answer.u_num + DIGITS * exact
    assert answer.u_num <= 1e-6 * exact
    assert answer.residual < 1e-9


@pytest.mark.heavy
@pytest.mark.parametrize("accuracy", ["quick", "default", "fine"])
@pytest.mark.parametrize(("k", "mu"), sorted(PULL_OFF))
def test_pull_off_force_table(k, mu, accuracy):
    answer = _pull_off(k, mu, accuracy=accuracy)
    exact = math.pi * PULL_OFF[k, mu]
    assert abs(answer.value - exact) <= (1e-6 if accuracy == "quick" else DEFAULT_ERROR) * exact
    assert abs(answer.value - exact) <= answer.u_num + DIGITS * exact


@pytest.mark.heavy
@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 5.0])
@pytest.mark.parametrize(("k", "mu"), [(0.0, 3.0), (0.2, 1.5), (0.4, 0.5), (0.6, 1.0), (0.6, 3.0)])
def test_accuracies_agree_within_their_uncertainties(n, k, mu):
    coarse, fine = (_pull_off(k, mu, accuracy=a, n=n) for a in ("quick", "default"))
    assert abs(coarse.value - fine.value) <= coarse.u_num + fine.u_num
    assert fine.u_num <= 1e-5 * fine.value


@pytest.mark.parametrize("walkable", ["quick", "default", "fine", None])
def test_finer_meshes_are_taken_where_a_path_cannot_be_walked(monkeypatch, walkable):
    """As that of n = 5, k = 0.6, mu = 3, whose contact begins on a spot a 500th of the rim."""
    tried = []

    def adapted(choice, quantity):
        tried.append(choice.level)
        if walkable is None or choice.level != ACCURACIES[walkable]:
            raise NotConverged("the path stops")
        return "the mesh", 1.0

    monkeypatch.setattr(MeshChoice, "adapted", adapted)
    problem = _solid(0.0, 1.0, 0.25), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    if walkable is None:
        with pytest.raises(NotConverged, match="the path stops"):
            chosen(*problem, ["pull_off_force"], "quick")
        assert tried == list(ACCURACIES.values())
    else:
        choice, *mesh = chosen(*problem, ["pull_off_force"], "quick")
        assert (choice.level, mesh) == (ACCURACIES[walkable], ["the mesh", 1.0])
    if walkable == "quick":
        with pytest.raises(NotConverged):
            chosen(*problem, ["pull_off_force"], "default")


def test_quick_answer_is_within_its_uncertainty():
    answer = _pull_off(0.0, 2.0, accuracy="quick")
    exact = math.pi * PULL_OFF[0.0, 2.0]
    assert abs(answer.value - exact) <= answer.u_num + DIGITS * exact


def test_poisson_ratio_collapses():
    """At one ratio of deformation to range nu does not matter: this verifies b(k, nu) of Eq. 7."""
    forces = [_pull_off(0.4, 1.0, nu, "quick").value for nu in (0.0, 0.4, 0.49)]
    assert np.ptp(forces) <= 1e-6 * forces[0]


def test_unit_scaling():
    """The same body in millimetres and millinewtons."""
    base = _pull_off(0.4, 1.0, accuracy="quick")
    length, force = 1e3, 1e3
    solid = _solid(0.4, 1.0, 0.25)
    scaled = Solid(solid.E0 * force / length**2, length, 0.4, 0.25)
    answer = solve(scaled, PowerPunch(2.0, length), LennardJones(force / length, length), "pull_off_force", "quick")
    assert answer.value == pytest.approx(base.value * force, rel=1e-9)
    assert answer.u_num == pytest.approx(base.u_num * force, rel=1e-2)


def test_events_lie_on_the_traced_path():
    solid, punch, law = _solid(0.4, 1.5, 0.25), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    path = trace(solid, punch, law, "quick")
    answers = {q: solve(solid, punch, law, q, "quick").value for q in fem_reference.QUANTITIES}
    assert -path.load.min() == pytest.approx(answers["pull_off_force"], rel=3e-3)
    assert answers["pull_off_force"] >= -path.load.min() - 1e-6
    assert answers["jump_out_displacement"] < answers["jump_in_displacement"] < answers["zero_load_displacement"]
    assert answers["jump_out_gap"] < answers["jump_in_gap"]
    assert answers["hysteresis_energy"] > 0
    index = int(np.flatnonzero(path.load[:-1] < 0)[-1])
    assert path.displacement[index] < answers["zero_load_displacement"] < path.displacement[index + 1]
    assert np.all(np.diff(path.central_gap[path.contact_radius == 0]) < 0)
    assert np.all(np.diff(path.contact_radius[path.contact_radius > 0]) > 0)


def test_contact_born_on_a_small_spot():
    """Under a flat punch on a nearly linear gradient contact is born at 1e-3 of the radius it then has.

    The attraction of the rest of the punch holds the displacement back; the turning point is that of the
    integral equation.
    """
    path = trace(_solid(0.6, 3.0, 0.3, n=5.0), PowerPunch(5.0, 1.0), LennardJones(1.0, 1.0), "quick")
    young = (path.contact_radius > 0.007) & (path.contact_radius < 0.015)
    turn = int(np.flatnonzero(young)[path.displacement[young].argmax()])
    # The parabola through the steps beside the turning point, 10 % of the radius apart.
    a, b, c = np.polyfit(np.log(path.contact_radius[turn - 1 : turn + 2]), path.displacement[turn - 1 : turn + 2], 2)
    assert c - b**2 / (4 * a) == pytest.approx(-3.53337, abs=2e-4)


def test_profile_is_consistent():
    solid, punch, law = _solid(0.0, 1.0, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    r = np.linspace(0.0, 6.0, 50)
    surface = profile(solid, punch, law, "pull_off_force", "quick", radii=r)
    delta = solve(solid, punch, law, "pull_off_displacement", "quick").value
    assert surface.gap == pytest.approx(-delta + r**2 / 2 + surface.displacement, abs=1e-5)
    assert surface.pressure == pytest.approx(law.traction(surface.gap))
    assert surface.pressure[0] > 0 > surface.pressure[25]
    with pytest.raises(ValueError, match="leave the mesh"):
        profile(solid, punch, law, "pull_off_force", "quick", radii=np.array([1e9]))


@pytest.mark.heavy
def test_surface_offset_tends_to_the_power_law():
    base = _solid(0.4, 0.7, 0.25)
    punch, law = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    exact = solve(base, punch, law, "pull_off_force", "quick").value
    change = []
    for z_s in (0.04, 0.01):
        solid = Solid(base.E0, 1.0, 0.4, 0.25, z_s=z_s)
        change.append(abs(solve(solid, punch, law, "pull_off_force", "quick").value / exact - 1))
    # The stiffer skin changes the compliance by a share of z_s^(1-k); 4^0.6 = 2.3.
    assert 1.9 < change[0] / change[1] < 3.2


def test_solid_that_does_not_scale_agrees_with_the_power_law_it_is():
    """The path on a mesh of fixed size, for a power law in disguise."""
    solid = _solid(0.4, 0.7, 0.25)
    disguised = CustomSolid(CustomModulus(solid.modulus, 0.4, 0.4, surface_depth=1e9), 0.25)
    punch, law = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    exact = solve(solid, punch, law, "pull_off_force", "quick")
    answer = solve(disguised, punch, law, "pull_off_force", "quick")
    assert abs(answer.value - exact.value) <= answer.u_num + exact.u_num
    assert answer.u_num <= 1e-5 * exact.value


def test_stiff_solid_has_no_jump():
    with pytest.raises(NoSuchEvent, match="too stiff"):
        _pull_off(0.0, 0.1, accuracy="quick", quantity="jump_in_displacement")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Solid(1.0, 1.0, 0.4, 0.5), "cannot keep the volume"),
        (lambda: Solid(1.0, 1.0, 1.0, 0.3), "unbounded"),
        (lambda: Solid(-1.0, 1.0, 0.4, 0.3), "reference modulus"),
        (lambda: Solid(1.0, 1.0, 0.4, 0.3, z_s=-1.0), "negative"),
        (lambda: LennardJones(0.0, 1.0), "work of adhesion"),
        (lambda: _pull_off(0.0, 1.0, quantity="adhesion"), "choose one of"),
        (lambda: _pull_off(0.0, 1.0, accuracy="best"), "choose one of"),
        (lambda: solve_together(_solid(0.4, 1.0, 0.3), PowerPunch(2.0, 1.0), LennardJones(1, 1), ()), "at least one"),
    ],
)
def test_impossible_input_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_three_meshes():
    """A sequence of known order: the estimate covers the error, and the order is recovered."""
    exact, order, ratio = 2.0, 4.0, 1.3
    values = tuple(exact + 1e-3 * ratio ** (-order * i) for i in range(3))
    outcome = three_meshes(values, ratio, declared=6.0, scale=2.0)
    assert outcome.observed_order == pytest.approx(order)
    assert abs(values[2] - exact) <= outcome.u_num <= 4 * abs(values[2] - exact)


def test_three_meshes_does_not_trust_a_coincidence():
    """Two equal fine values do not prove convergence when the coarse one is far away."""
    outcome = three_meshes((1.1, 1.0, 1.0), 1.3, declared=6.0, scale=1.0)
    assert outcome.u_num > 0.01
    with pytest.raises(ValueError, match="not above 1"):
        three_meshes((1.0, 1.0, 1.0), 1.0, 2.0, 1.0)
