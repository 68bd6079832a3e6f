"""Bounds at events: added up from signed errors, and moved with the place of the event."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fscm import Analysis, CustomPunch, Problem, RoundedCone
from fscm._bound.defect import Errors
from fscm._bound.parts import EventErrors, bounds, energy_of_jump, root_shift
from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._path.events import MISSED_EXTREME
from fscm.accuracy import Meshes
from fscm.solution import Parts
from tests.fscm.equilibria_on_finer_meshes import pair
from tests.marks import heavy

#: The rate of an error is a central difference of errors of first order.  Measured worst 2e-4.
RATE = 2e-3
#: Bound over error: those of single panels cancel.  Measured 32 (load at jump-out).
LARGEST = 100.0
ERRORS = Errors(np.array([1.0, -2.0, 0.5]), np.array([0.1, -0.3]), np.array([-0.01, 0.02]), 0.004, 0.0005)


def _exactly(parts):
    return pytest.approx(list(parts.values()), rel=1e-14)


def test_sizes_add_up_by_cause_and_the_mesh_counts_twice():
    """The finer mesh may leave half of the error; the tail is computed to first order, a tenth is its square."""
    expected = Parts(mesh=7.0, tail=1.1 * 0.4, domain=0.03, rounding=0.004, kernel=0.0005)
    assert list(bounds(ERRORS).values()) == _exactly(expected)
    amplified = Parts(**{name: 3.0 * part for name, part in expected.items()})
    assert list(bounds(ERRORS, 3.0).values()) == _exactly(amplified)


@pytest.mark.parametrize(("error", "slope", "curvature"), [(0.2, 0.5, 2.0), (0.2, -0.5, 2.0), (1e-6, 0.0, -2.0)])
def test_a_shift_next_to_an_extreme_covers_both_roots(error, slope, curvature):
    """Where the error may join the two roots, or create them, either may be that of the exact function."""
    shift = root_shift(error, slope, curvature)
    shifted = [np.roots([0.5 * curvature, slope, moved]) for moved in (-error, error)]
    real = np.concatenate([roots[abs(roots.imag) < 1e-12].real for roots in shifted])
    assert abs(real).max() == pytest.approx(shift, rel=1e-9)


@pytest.mark.parametrize(("error", "slope", "curvature"), [(1e-9, 1.0, 3.0), (0.04, 0.5, 2.0), (0.2, 0.5, 0.0)])
def test_a_shift_away_from_an_extreme_covers_the_closest_root_for_both_signs_of_the_error(error, slope, curvature):
    shift = root_shift(error, slope, curvature)
    closest = [min(abs(np.roots([0.5 * curvature, slope, moved]))) for moved in (-error, error)]
    assert max(closest) == pytest.approx(shift, rel=1e-9)


@pytest.mark.parametrize("functional", ["load", "displacement", "central_gap"])
@pytest.mark.parametrize("event", ["pull_off", "jump_out"])
def test_the_rate_of_an_error_is_the_difference_of_the_rates_on_two_meshes(event, functional):
    event_pair = pair(2.0, 0.4, 1.0, event)
    expected = getattr(rates_of(event_pair.state), functional) - getattr(event_pair.rates, functional)
    rate = EventErrors(event_pair.state).rate(functional)
    assert rate.mesh.sum() == pytest.approx(expected, rel=RATE, abs=10.0 * rate.rounding)


@pytest.mark.parametrize("event", ["pull_off", "jump_out"])
def test_a_value_at_the_extreme_of_another_moves_with_its_place(event):
    """To first order: the error at a fixed parameter, less that of the place times the rate of the value."""
    event_pair = pair(2.0, 0.4, 1.0, event)
    extremal, functional = ("load", "displacement") if event == "pull_off" else ("displacement", "load")
    errors = EventErrors(event_pair.state)
    _, curvature, _ = errors.derivatives(extremal)
    distance = (getattr(rates_of(event_pair.state), extremal) - getattr(event_pair.rates, extremal)) / curvature
    shifted = event_pair.error(functional) - distance * getattr(errors.rates, functional)
    bound = errors.at_extreme(functional, extremal).total
    assert abs(shifted) < bound < LARGEST * abs(shifted)
    # Neither of the two alone explains the bound.
    assert bounds(errors.controlled(functional, errors.parameter)).total != pytest.approx(bound, rel=1e-2)


@pytest.mark.parametrize("event", ["jump_out", "jump_in"])
def test_a_value_at_a_displacement_next_to_its_fold_moves_with_the_root_of_the_error(event):
    """At the fold itself: where the displacement is wrong by e, the state moves by sqrt(2 e / curvature)."""
    state = pair(2.0, 0.4, 1.0, event).state
    errors = EventErrors(state)
    free = errors.on_path("displacement").total
    _, curvature, _ = errors.derivatives("displacement")
    shift = math.sqrt(2.0 * free / abs(curvature))
    error = errors.prescribed("load", "displacement", state.displacement).total
    least = errors.on_path("load").total + abs(errors.rates.load) * shift
    assert least * (1.0 - 1e-3) < error < 2.0 * least
    assert error > 3.0 * errors.on_path("load").total


def test_a_state_beside_the_extreme_says_how_far_its_value_is_from_there():
    """A millionth of the parameter off: the displacement is wrong by what it changes on the way."""
    state = pair(2.0, 0.4, 1.0, "pull_off").state
    beside = moved(state, rates_of(state), parameter_of(state) + 1e-4)
    errors, at = (EventErrors(of).at_extreme("displacement", "load") for of in (beside, state))
    distance = abs(beside.displacement - state.displacement)
    assert distance > 10.0 * at.total
    assert distance <= errors.rounding < 1.2 * distance


@pytest.mark.parametrize(("slope", "amplified"), [(0.6, False), (1.5, True)])
def test_a_control_near_its_extreme_is_not_divided_by(slope, amplified, monkeypatch):
    """With 2 e c between 1/2 and 2 times the slope squared, the root of the error decides, not the slope."""
    free, curvature = Parts(mesh=0.1), 2.0
    infinite = Errors(np.full(1, math.inf), np.zeros(1), np.zeros(1), 0.0)
    for name, value in (
        ("on_path", lambda self, functional: free),
        ("derivatives", lambda self, functional: (slope, curvature, 0.0)),
        ("controlled", lambda self, *names: infinite),
    ):
        monkeypatch.setattr(EventErrors, name, value)
    errors = EventErrors(pair(2.0, 0.4, 1.0, "jump_in").state)
    assert math.isinf(errors.prescribed("load", "displacement", 0.0).total) == amplified


def _waving(period):
    """A state on a line, on whose path a functional has an error of one panel that waves with a period."""

    def defect(step):
        mesh = 1e-9 * np.array([math.sin(2.0 * math.pi * step / period)])
        return SimpleNamespace(
            errors=lambda *names: Errors(mesh, np.zeros(1), np.zeros(1), 1e-16), rate_rounding=lambda *names: 0.0
        )

    return defect


@pytest.mark.parametrize("period", [1.0, 3e-3, 7e-4, 3e-4])
def test_the_rate_of_an_error_that_waves_along_the_path(period, monkeypatch):
    """Nodes that pass by the knots of a law make such waves: a rate over steps of 1e-3 was 3 times too small."""
    errors, defect, phase = EventErrors(pair(2.0, 0.4, 1.0, "pull_off").state), _waving(period), 0.1 * period
    monkeypatch.setattr(EventErrors, "_defect", defect(phase))
    monkeypatch.setattr(
        EventErrors, "_new_defects_beside", lambda self, step: (defect(phase - step), defect(phase + step))
    )
    exact = 2e-9 * math.pi / period * math.cos(0.2 * math.pi)
    assert errors.rate("load").mesh[0] == pytest.approx(exact, rel=0.1)


@pytest.fixture
def landing_errors(monkeypatch):
    """A function that gives every landing these errors; what is asked of a landing is in the list that it returns."""

    def use(errors):
        called = []

        def of_landing(state):
            return SimpleNamespace(controlled=lambda *names: called.append((state, *names)) or errors)

        monkeypatch.setattr("fscm._bound.parts.EventErrors", of_landing)
        return called

    return use


def _on_panels(order, ends, pressure):
    mesh = SimpleNamespace(order=order, breaks=np.array(ends))
    return SimpleNamespace(
        load=-0.7, scale=1.0, disc=SimpleNamespace(mesh=mesh), pressure=np.full((len(ends) - 1) * order, pressure)
    )


def test_the_energy_of_a_jump_has_the_errors_of_both_ends(landing_errors):
    """The landing is at the displacement of the fold: an error of that moves the energy there by the load."""
    unsigned = (10.0 * ERRORS.rounding, 10.0 * ERRORS.kernel)
    displacement = Errors(10.0 * ERRORS.mesh, 10.0 * ERRORS.tail, 10.0 * ERRORS.domain, *unsigned)
    called = landing_errors(ERRORS)
    fold, landing = _on_panels(2, [0.0, 1.0, 3.0], 0.5), _on_panels(2, [0.0, 2.0, 4.0], 0.5)
    error = energy_of_jump(ERRORS, displacement, fold, landing)
    assert called == [(landing, "energy", "displacement")]
    # e + 0.7 (10 e) at the fold, and e at the landing: 9 times the size of `ERRORS`.
    assert list(error.values()) == _exactly(bounds(ERRORS, 9.0))


def test_the_error_of_a_common_panel_cancels_as_far_as_the_pressures_are_the_same(landing_errors):
    of_fold, none = np.array([3e-9, 5e-9, 7e-9]), np.zeros(6)
    landing_errors(Errors(np.array([-2e-9, 6.9e-9]), none, none, 0.0))
    ends = [0.0, 1.0, 2.0, 8.0], [0.0, 2.0, 8.0]
    for change, left in ((0.0, 0.0), (0.01, 0.5 * 0.1 * 13.9e-9), (3.0, 0.5 * 13.9e-9)):
        fold, landing = _on_panels(2, ends[0], 1.0), _on_panels(2, ends[1], 1.0 + change)
        parts = energy_of_jump(Errors(of_fold, none, none, 0.0), Errors(0.0 * of_fold, none, none, 0.0), fold, landing)
        # Two panels of the fold and one of the landing are their own; the last one is common.
        assert parts.mesh == pytest.approx(2.0 * (3e-9 + 5e-9 + 2e-9 + 0.1e-9 + left), rel=1e-12)


@pytest.mark.parametrize(("k", "mu", "slope"), [(0.3, 0.8, 1.5), *heavy((0.0, 2.0, 5.0))])
def test_the_hysteresis_of_a_rounded_cone_is_bounded_by_its_own_error(k, mu, slope):
    """The energy of a cone diverges with the end of the mesh, which differs between the ends of a jump."""
    problem = Problem(1, k, mu, RoundedCone(1.0, slope))
    solution, fine, nearer = (
        Analysis(problem, meshes).solution("hysteresis_energy")
        for meshes in (Meshes.of("default"), Meshes.of("fine"), Meshes(end_height=1e4))
    )
    for finer in (fine, nearer):
        assert abs(solution.value - finer.value) <= solution.u_num + finer.u_num
    assert solution.u_num < 1e-7 * solution.value
    assert fine.u_num < 1e-8 * solution.value


def _beyond(r):
    return np.maximum(r - 5.0, 0.0)


def test_an_extreme_of_large_curvature_is_not_missed():
    """Under a flat end the load changes within a gap of 1e-5: a step of 1e-8 still left 4e-12 of 8.7."""
    flat = CustomPunch(lambda r: 0.5 * _beyond(r) ** 2, 2.0, _beyond, kinks=(5.0,))
    state = Analysis(Problem(2, 0, 3.0, punch=flat)).event("pull_off").value
    errors = EventErrors(state)
    rate, curvature, _ = errors.derivatives("load")
    assert curvature > 1e5
    assert 0.5 * rate**2 / curvature <= MISSED_EXTREME * (1.0 + abs(state.load))
    # Whatever the share is: a step of 1e-8 left 4e-13.
    assert 0.5 * rate**2 / curvature < 1e-14 * (1.0 + abs(state.load))
    assert MISSED_EXTREME < 1e-14
    assert errors.at_extreme("load", "load").rounding >= MISSED_EXTREME * (1.0 + abs(state.load))
