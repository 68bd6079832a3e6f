"""Solutions: reference digits, uncertainty, unit scaling, nu-collapse, other solids and laws, refusals."""

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fem_reference.solution as solution_module
from fem_reference import (
    AccuracyWarning,
    LennardJones,
    Mie,
    NotConverged,
    PowerLaw,
    PowerPunch,
    Problem,
    Solution,
    event_state,
    profile,
    solve,
    solve_together,
    trace,
)
from fem_reference._contact import event_mesh
from fem_reference._contact.event_mesh import EventMesh, chosen
from fem_reference._contact.parts import PARTS
from fem_reference.accuracy import ACCURACIES, level_for
from tests.fem_reference.solved_together import PROBLEM, problem_with, solved, sphere_on
from tests.reference_values import REFERENCE_VALUES
from tests.refusals import refused

#: -P_c / (pi Q w) of paraboloids by (k, mu).
PULL_OFF = {(v.k, v.mu): v.value for v in REFERENCE_VALUES if (v.quantity, v.n) == ("pull_off_force", 2.0)}


#: A punch whose results could not be stored by its value.
UNHASHABLE = SimpleNamespace(height=np.square, slope=np.square)

#: Half a unit of the last digit of the table, relative.
DIGITS = 5e-9

#: Relative error of the default accuracy: measured 8e-9 at most, which is the rounding of the table.
DEFAULT_ERROR = 1e-7


@cache
def _pull_off(k, mu, nu=0.25, accuracy="default", n=2.0, quantity="pull_off_force"):
    return solve(problem_with(k, mu, n, nu), quantity, accuracy)


def test_pull_off_force():
    """On these meshes, too, the error is below that of the default accuracy; other tests need this solution."""
    result, exact = _pull_off(0.4, 1.0, accuracy="quick"), math.pi * PULL_OFF[0.4, 1.0]
    assert abs(result.value - exact) <= DEFAULT_ERROR * exact
    assert abs(result.value - exact) <= result.u_num + DIGITS * exact
    assert result.u_num <= 1e-6 * exact
    assert result.residual < 1e-9
    assert set(result.parts) == set(PARTS)
    assert math.fsum(result.parts.values()) == pytest.approx(result.u_num, rel=1e-12)


def test_profile_is_consistent():
    """Of the solution above, whose meshes are used again."""
    problem = problem_with(0.4, 1.0, nu=0.25)
    r = np.linspace(0.0, 6.0, 50)
    surface = profile(problem, "pull_off", "quick", radii=r)
    together = solve_together(problem, ("pull_off_displacement", "pull_off_force"), "quick")
    assert surface.displacement == pytest.approx(together["pull_off_displacement"].value, rel=1e-12)
    assert surface.load == pytest.approx(-together["pull_off_force"].value, rel=1e-12)
    assert surface.radius == pytest.approx(r)
    assert surface.gap == pytest.approx(-surface.displacement + r**2 / 2 + surface.deformation, abs=1e-12)
    assert surface.pressure == pytest.approx(problem.law.traction(surface.gap))
    assert surface.pressure[0] > 0 > surface.pressure[25]
    for radii in (np.array([1e9]), np.array([-1.0]), np.array([np.nan])):
        refused("not all on the mesh", profile, problem, "pull_off", "quick", radii=radii)


@pytest.mark.heavy
@pytest.mark.parametrize("accuracy", ["quick", "default", "fine"])
@pytest.mark.parametrize(("k", "mu"), sorted(PULL_OFF))
def test_pull_off_force_table(k, mu, accuracy):
    result = _pull_off(k, mu, accuracy=accuracy)
    exact = math.pi * PULL_OFF[k, mu]
    assert abs(result.value - exact) <= (1e-6 if accuracy == "quick" else DEFAULT_ERROR) * exact
    assert abs(result.value - exact) <= result.u_num + DIGITS * exact


@pytest.mark.parametrize("traceable", ["quick", "default", "fine", None])
def test_finer_meshes_are_taken_where_a_path_cannot_be_traced(monkeypatch, traceable):
    """As that of n = 5, k = 0.6, mu = 3, whose contact begins on a spot a 500th of the rim."""
    tried = []

    def suitable(meshes, events, start=None, force_alone=False):
        tried.append(meshes.level)
        if traceable is None or meshes.level != level_for(traceable):
            raise NotConverged("the path stops")
        return EventMesh(SimpleNamespace(meshes=meshes), "the mesh", 1.0, "pull_off")

    monkeypatch.setattr(event_mesh, "event_mesh", suitable)
    problem = problem_with(0.0, 1.0)
    if traceable is None:
        refused("the path stops", chosen, problem, ("pull_off",), "quick", error=NotConverged)
        assert tried == [level_for(name) for name in ACCURACIES]
    else:
        mesh = chosen(problem, ("pull_off",), "quick")
        assert (mesh.meshes.level, mesh.spec, mesh.size) == (level_for(traceable), "the mesh", 1.0)
    if traceable == "quick":
        with pytest.raises(NotConverged):
            chosen(problem, ("pull_off",), "default")


def test_unit_scaling():
    """The same body in millimetres and millinewtons."""
    base = _pull_off(0.4, 1.0, accuracy="quick")
    solid = PowerLaw(1e-3 * problem_with(0.4, 1.0, nu=0.25).solid.E0, 1e3, 0.4, 0.25)
    force = solve(Problem(solid, PowerPunch(2.0, 1e3), LennardJones(1.0, 1e3)), "pull_off_force", "quick")
    assert force.value == pytest.approx(base.value * 1e3, rel=1e-9)
    assert force.u_num == pytest.approx(base.u_num * 1e3, rel=1e-2)


def test_events_lie_on_the_traced_path():
    path = trace(PROBLEM, "quick")
    results = {quantity: solved()[quantity].value for quantity in fem_reference.QUANTITIES}
    assert -path.load.min() == pytest.approx(results["pull_off_force"], rel=3e-3)
    assert results["pull_off_force"] >= -path.load.min() - 1e-6
    assert results["jump_out_displacement"] < results["jump_in_displacement"] < results["zero_load_displacement"]
    assert results["jump_out_gap"] < results["jump_in_gap"]
    assert results["hysteresis_energy"] > 0
    index = int(np.flatnonzero(path.load[:-1] < 0)[-1])
    assert path.displacement[index] < results["zero_load_displacement"] < path.displacement[index + 1]
    assert np.all(np.diff(path.central_gap[np.isnan(path.edge_radius)]) < 0)
    assert np.all(np.diff(path.edge_radius[path.edge_radius > 0]) > 0)


def test_accuracy_names_are_those_of_numbers():
    """No number has coarser meshes than a larger one."""
    for name, number in ACCURACIES.items():
        assert level_for(name) == level_for(number)
    numbers = (1e-3, 1e-6, 5e-7, 2e-7, 1e-7, 5e-8, 1e-8)
    levels = [(-level_for(number).order, level_for(number).density) for number in numbers]
    assert levels == sorted(levels, reverse=True)
    assert len(set(levels)) == 4


def test_impossible_input_is_refused():
    for make, message in (
        (lambda: PowerLaw(1.0, 1.0, 0.4, 0.5), "cannot keep the volume"),
        (lambda: PowerLaw(1.0, 1.0, 1.0, 0.3), "unbounded"),
        (lambda: _pull_off(0.0, 1.0, quantity="adhesion"), "choose one of"),
        (lambda: _pull_off(0.0, 1.0, accuracy="best"), "choose one of"),
        (lambda: _pull_off(0.0, 1.0, accuracy=1e-9), r"accuracy 1e-09 is outside \[1e-08, 1\)"),
        (lambda: _pull_off(0.0, 1.0, accuracy=1.0), "outside"),
        (lambda: _pull_off(0.0, 1.0, accuracy=math.nan), "outside"),
        (lambda: _pull_off(0.0, 1.0, accuracy=True), "outside"),
        (lambda: profile(problem_with(0.0, 1.0), "pull_off_force"), "choose one of pull_off, jump_in"),
        (lambda: event_state(problem_with(0.0, 1.0), "landing"), "choose one of pull_off, jump_in"),
        (lambda: solve_together(problem_with(0.4, 1.0), ()), "at least one"),
        (lambda: trace(PROBLEM.solid), "a fem_reference.PowerLaw is no Problem of fem_reference"),
        (lambda: replace(PROBLEM, punch=UNHASHABLE), "not hashable"),
        (lambda: replace(PROBLEM, solid=1.0), "not a solid"),
        (lambda: replace(PROBLEM, punch=2.0), "not a punch shape"),
        (lambda: replace(PROBLEM, law=np.exp), "not a surface law"),
        (lambda: replace(PROBLEM, punch=PowerPunch(1.0, 1.0), law=Mie(1.0, 1.0, 4.0, 2.0)), "load integral"),
    ):
        refused(message, make)


def test_a_punch_with_an_asperity_is_refused() -> None:
    """Behind its first compressive load the path goes on to a tension 38 times as large (`fscm`, softer solid)."""
    punch = fem_reference.CustomPunch(
        lambda r: -8.0 * np.expm1(-(r**2)) + r**2 / 50.0,
        2.0,
        lambda r: 16.0 * r * np.exp(-(r**2)) + r / 25.0,
    )
    problem = Problem(PowerLaw(10.0, 1.0, 0.0, 0.0), punch, LennardJones(1.0, 1.0))
    for compute in (lambda: solve(problem, "pull_off_force", "quick"), lambda: trace(problem)):
        message = str(refused(r"bends down at r = 1\.\d+, as outside an asperity", compute, error=NotConverged))
        # r f' is largest where 16 (r^2 - 1) exp(-r^2) = 1/25, between two of forty radii in a factor of two.
        named = float(message.split("r = ")[1].split(",")[0])
        assert named < 1.0034153 < named * 2.0 ** (1.0 / 40.0)


def test_a_finer_accuracy_is_never_less_certain(monkeypatch):
    """The bound of the finer meshes may be the larger one by chance: that of the coarser ones is returned then."""
    bounds = {"default": 1e-7, "fine": 5e-6, 3e-8: 1e-8}
    calls = []

    def computed(problem, rows, accuracy, start=None):
        calls.append((accuracy, tuple(rows)))
        u_num = bounds[accuracy]
        return {
            name: Solution(1.0, u_num, 1, 1, 0.0, 1.0, (4, 6, 7), (1.0, 1.0, 1.0), {"mesh": u_num}) for name in rows
        }

    monkeypatch.setattr(solution_module, "_solved_together", computed)
    force = "pull_off_force"
    solution = solve_together(PROBLEM, (force,), "fine")[force]
    assert (solution.u_num, solution.seconds) == (1e-7, 2.0)
    assert calls == [("fine", (force,)), ("default", (force,))]
    # A value that reaches its accuracy, and one that is not finer than "default", are computed once.
    assert solve_together(PROBLEM, (force,), 3e-8)[force].u_num == 1e-8
    assert solve_together(PROBLEM, (force,), "default")[force].u_num == 1e-7
    assert len(calls) == 4


def test_an_accuracy_that_is_not_reached_is_said(monkeypatch):
    """The name of an accuracy selects meshes and asks for no number."""
    problem = sphere_on(PowerLaw(50.0, 1.0, 0.0, 0.3))
    result = solve(problem, "pull_off_force", "quick")
    wide = replace(result, parts={**result.parts, "mesh": 2e-6 * result.value}, u_num=2e-6 * result.value)
    monkeypatch.setattr(solution_module, "_no_less_certain", lambda *arguments: {"pull_off_force": wide})
    with pytest.warns(AccuracyWarning, match="accuracy = 1e-06 is not reached for the pull_off_force: .* 2.0e-06"):
        assert solve(problem, "pull_off_force", 1e-6) == wide
    assert solve(problem, "pull_off_force", "quick") == wide
