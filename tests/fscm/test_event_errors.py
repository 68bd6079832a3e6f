"""Bounds at events: added up from signed errors, and moved with the place of the event."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fscm import Analysis, Problem, _bounds, solve
from fscm._arc_length import rates_of
from fscm._bounds import EventErrors, bounds, energy_of_jump, root_shift
from fscm._defect import Errors
from fscm._events import MISSED_EXTREME
from fscm._meshes import Mesh, Meshes
from fscm.solution import Parts
from tests.fscm.equilibria_on_finer_meshes import pair

#: The rate of an error is a central difference of errors of first order.  Measured worst 2e-4.
RATE = 2e-3
#: Bound over error: those of single panels cancel.  Measured 32 (load at jump-out).
LARGEST = 100.0
ERRORS = Errors(np.array([1.0, -2.0, 0.5]), np.array([0.1, -0.3]), np.array([-0.01, 0.02]), 0.004, 0.0005)


class RoundedFlat:
    """(r - a)^2 / 2 outside of a flat end of the radius a."""

    growth = 2.0

    def __init__(self, flat):
        self.flat, self.kinks = flat, (flat,)

    def height(self, r):
        return 0.5 * np.maximum(np.asarray(r) - self.flat, 0.0) ** 2

    def slope(self, r):
        return np.maximum(np.asarray(r) - self.flat, 0.0)


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
    found = [np.roots([0.5 * curvature, slope, moved]) for moved in (-error, error)]
    real = np.concatenate([roots[abs(roots.imag) < 1e-12].real for roots in found])
    assert abs(real).max() == pytest.approx(shift, rel=1e-9)


@pytest.mark.parametrize("functional", ["load", "displacement", "central_gap"])
@pytest.mark.parametrize("event", ["pull_off", "jump_out"])
def test_the_rate_of_an_error_is_the_difference_of_the_rates_on_two_meshes(event, functional):
    found = pair(2.0, 0.4, 1.0, event)
    expected = getattr(rates_of(found.state), functional) - getattr(found.rates, functional)
    rate = EventErrors(found.state).rate(functional)
    assert rate.mesh.sum() == pytest.approx(expected, rel=RATE, abs=10.0 * rate.rounding)


@pytest.mark.parametrize("event", ["pull_off", "jump_out"])
def test_a_value_at_the_extreme_of_another_moves_with_its_place(event):
    """To first order: the error at a fixed parameter, less that of the place times the rate of the value."""
    found = pair(2.0, 0.4, 1.0, event)
    extremal, functional = ("load", "displacement") if event == "pull_off" else ("displacement", "load")
    errors = EventErrors(found.state)
    _, curvature, _ = errors.derivatives(extremal)
    place = (getattr(rates_of(found.state), extremal) - getattr(found.rates, extremal)) / curvature
    moved = found.error(functional) - place * getattr(errors.rates, functional)
    bound = errors.at_extreme(functional, extremal).total
    assert abs(moved) < bound < LARGEST * abs(moved)
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
    found = errors.prescribed("load", "displacement", state.displacement).total
    least = errors.on_path("load").total + abs(errors.rates.load) * shift
    assert least * (1.0 - 1e-3) < found < 2.0 * least
    assert found > 3.0 * errors.on_path("load").total


def test_the_energy_of_a_jump_has_the_errors_of_both_ends(monkeypatch):
    """The landing is at the displacement of the fold: an error of that moves the energy there by the load."""
    unsigned = (10.0 * ERRORS.rounding, 10.0 * ERRORS.kernel)
    displacement = Errors(10.0 * ERRORS.mesh, 10.0 * ERRORS.tail, 10.0 * ERRORS.domain, *unsigned)
    called = []

    class OfLanding:
        def __init__(self, state):
            self.state = state

        def controlled(self, functional, control):
            called.append((self.state, functional, control))
            return ERRORS

    monkeypatch.setattr(_bounds, "EventErrors", OfLanding)
    landing = SimpleNamespace(load=-0.7)
    found = energy_of_jump(ERRORS, displacement, landing)
    assert called == [(landing, "energy", "displacement")]
    # e + 0.7 (10 e) at the fold, and e at the landing: 9 times the size of `ERRORS`.
    assert list(found.values()) == _exactly(bounds(ERRORS, 9.0))


def test_an_extreme_of_large_curvature_is_not_missed():
    """Under a flat end the load changes within a gap of 1e-5: a step of 1e-8 still left 4e-12 of 8.7."""
    state = Analysis(Problem(2, 0, 3.0, punch=RoundedFlat(5.0))).event("pull_off").value
    errors = EventErrors(state)
    rate, curvature, _ = errors.derivatives("load")
    assert curvature > 1e5
    assert 0.5 * rate**2 / curvature <= MISSED_EXTREME * (1.0 + abs(state.load))
    # Whatever the share is: a step of 1e-8 left 4e-13.
    assert 0.5 * rate**2 / curvature < 1e-14 * (1.0 + abs(state.load))
    assert MISSED_EXTREME < 1e-14
    assert errors.at_extreme("load", "load").rounding >= MISSED_EXTREME * (1.0 + abs(state.load))


@pytest.mark.heavy
@pytest.mark.parametrize(("k", "flat", "mu"), [(0, 5.0, 3.0), (0, 1.5, 1.0), (0.3, 1.5, 0.3), (0.3, 0.3, 3.0)])
def test_the_bound_of_a_flat_end_covers_the_distance_to_a_finer_mesh(k, flat, mu):
    problem = Problem(2, k, mu, punch=RoundedFlat(flat))
    found = solve(problem, "pull_off_force")
    fine = solve(problem, "pull_off_force", Meshes(value=Mesh(18, 1e-10)))
    assert abs(found.value - fine.value) <= found.u_num + fine.u_num
    assert fine.u_num < 2e-12
