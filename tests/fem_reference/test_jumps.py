"""All jumps of a cycle of approach and retreat, where the displacement has several pairs of folds."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import fem_reference
import fem_reference.solution as solution_module
from fem_reference._contact.event_kinds import event_energy
from fem_reference._contact.events import PathEvents
from fem_reference.quantities import LOSSES, TABLE, further_losses
from tests.fem_reference.analytic_branch import AnalyticBranch
from tests.fem_reference.solved_together import sphere_on

PAIR = (-1.0, -3.0)
#: Displacements of the turning points from outside to inside, and where the jumps begin, by these displacements.
PATHS = {
    "one pair": (PAIR, [-1.0], [-3.0]),
    # As on a stiff film: the innermost fold is above the last one, and its jump lands between both.
    "two jumps on retreat": ((-1.0, -2.0, -1.5, -5.0, -3.5, -4.0), [-1.0], [-4.0, -5.0]),
    "three jumps on retreat": ((-1.0, -5.0, -2.0, -4.0, -2.5, -3.0), [-1.0], [-3.0, -4.0, -5.0]),
    "a fold that the retreat passes over": ((-1.0, -3.0, -2.0, -5.0), [-1.0], [-5.0]),
    "two jumps on approach": ((-3.0, -5.0, -1.0, -4.0), [-3.0, -1.0], [-4.0, -5.0]),
    "a fold that the approach passes over": ((-1.0, -4.0, -2.0, -3.0), [-1.0], [-3.0, -4.0]),
}


def _branch(turns):
    """A branch with given turning points of the displacement at 1, 2, ... of the parameter."""
    t = np.arange(len(turns) + 2.0)
    ends = [min(turns) - 2.0, *turns, max(turns) + 2.0]
    return AnalyticBranch(CubicHermiteSpline(t, ends, [4.0, *np.zeros(len(turns)), 4.0]), [-2.0, 0.0, 0.1])


def _events(turns):
    events = PathEvents(_branch(turns).points(np.linspace(0.05, len(turns) + 0.95, 9 * len(turns))))
    # The samples of a spline are as close as they need to be.
    vars(events)["points"] = events.samples
    return events


def _lost(turns, retreat):
    """Energy lost by a displacement that falls or rises in small steps over all branches."""
    branch = _branch(turns)
    t = np.linspace(0.0, len(turns) + 1.0, 400001)
    delta, load = branch.displacement(t), branch.load(t)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (load[1:] + load[:-1]) * np.diff(delta))])
    order = slice(None, None, -1) if retreat else slice(None)
    sign = -1.0 if retreat else 1.0
    level, energy = sign * delta[order], energy[order]
    highest = np.maximum.accumulate(level)
    # The state is where the displacement is beyond all of before; it jumps over the rest.
    visited = np.flatnonzero(level >= highest)
    gaps = np.flatnonzero(np.diff(visited) > 1)
    return sum(float(energy[visited[i]] - energy[visited[i + 1]]) for i in gaps)


@pytest.mark.parametrize("name", PATHS)
def test_a_cycle_has_a_jump_for_each_fold_that_it_reaches(name):
    turns, approach, retreat = PATHS[name]
    events = _events(turns)
    begin = {fold: events.at(fold).state.displacement for fold, _ in events.jumps}
    assert sorted(begin.values()) == pytest.approx(sorted(approach + retreat))
    assert (begin["jump_in"], begin["jump_out"]) == pytest.approx((approach[0], retreat[-1]))
    for fold, end in events.jumps:
        assert events.at(end).state.displacement == pytest.approx(begin[fold])
        assert events.at(end).displacement_rate > 0.0
        assert (events.at(end).parameter > events.at(fold).parameter) == fold.startswith("jump_in")


@pytest.mark.parametrize("name", PATHS)
def test_the_hysteresis_is_the_sum_over_all_jumps(name):
    turns = PATHS[name][0]
    events = _events(turns)
    exact = _lost(turns, retreat=False) + _lost(turns, retreat=True)
    both = TABLE["hysteresis_energy"].value(events.at)
    further = [row.value(events.at) for row in further_losses(events).values()]
    assert both + sum(further) == pytest.approx(exact, rel=1e-4)
    assert (both == pytest.approx(exact, rel=1e-4)) is (len(events.jumps) == 2)


def test_a_jump_that_the_cycle_does_not_have_is_told():
    with pytest.raises(fem_reference.NoSuchEvent, match="jump_out_2"):
        _events(PAIR).at("jump_out_2")


def test_folds_that_cannot_be_told_apart_are_refused():
    """On its own mesh the outer fold was lower, where the path has the inner one lower."""
    events = _events((-1.0, -4.0, -2.0, -4.001))
    vars(events)["jump_out"] = events.minima("jump_out")[0]
    with pytest.raises(fem_reference.NotConverged, match="not decided"):
        _ = events.jumps


@pytest.mark.parametrize("error", [0.0, 1e-4])
def test_the_parts_of_a_further_jump_are_its_loss(error):
    """Also where the other mesh has the end of the jump at a slightly different displacement."""
    events = _events(PATHS["two jumps on retreat"][0])
    rows = further_losses(events)
    assert {row.events for row in rows.values()} == {("jump_out_2",), ("separated_2",)}
    end = events.at("separated_2")
    moved = end.branch.solve(end.parameter + error, None)
    meshes = {"jump_out_2": events, "separated_2": SimpleNamespace(at=lambda event: moved)}
    parts = sum(row.value(meshes[row.events[0]].at) for row in rows.values())
    lost = event_energy(events.at("jump_out_2")) - event_energy(events.at("separated_2"))
    assert parts == pytest.approx(lost, abs=1e-7 + 10.0 * error**2)


@pytest.mark.parametrize("name", ["one pair", "two jumps on retreat"])
def test_the_loss_on_meshes_of_their_own_has_every_jump(name, monkeypatch):
    """With the bounds of all parts."""
    events, requested = _events(PATHS[name][0]), []

    def solved(problem, rows, accuracy):
        requested.extend(rows)
        return {
            row: fem_reference.Solution(
                quantity.value(events.at), 1e-8, 1, 1, 0.0, 1.0, (4, 6, 7), (1.0, 1.0, 1.0), {"mesh": 1e-8}
            )
            for row, quantity in rows.items()
        }

    monkeypatch.setattr(solution_module, "_solved_together", solved)
    monkeypatch.setattr(solution_module, "whole_path", lambda problem, accuracy: events)
    problem = sphere_on(fem_reference.Exponential(3.0, 1.0, 5.0, 0.1))
    row = TABLE["hysteresis_energy"]
    loss = solution_module._by_addends(problem, {"hysteresis_energy": row}, "default")["hysteresis_energy"]
    assert requested[:2] == list(LOSSES)
    further = sum(addend.value(events.at) for addend in further_losses(events).values())
    assert loss.value == pytest.approx(row.value(events.at) + further)
    assert loss.u_num == pytest.approx(1e-8 * len(requested))
    # A further jump has two parts.
    assert len(requested) == 2 * len(events.jumps) - 2


@pytest.mark.heavy
def test_the_hysteresis_on_a_stiff_film_has_three_jumps():
    """A film of 1 GPa on 1.5 MPa: the innermost fold is at -122.3 nm, and the jump out of contact at -135.4 nm."""
    film = fem_reference.Coating(
        E_coating=1e9, E_substrate=1.5e6, thickness=1e-7, transition=0.0, nu_coating=0.4, nu_substrate=0.49
    )
    problem = fem_reference.Problem(film, fem_reference.PowerPunch(2.0, 5e-6), fem_reference.LennardJones(0.05, 4e-10))
    solutions = fem_reference.solve_together(problem, ("hysteresis_energy", *LOSSES), "quick")
    further = solutions["hysteresis_energy"].value - sum(solutions[name].value for name in LOSSES)
    assert further == pytest.approx(1.4542e-16, rel=1e-3)
