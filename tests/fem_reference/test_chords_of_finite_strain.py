"""Finite strain with few factorisations: a linearisation serves its neighbours, and never instead of convergence."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fem_reference import Ball, LennardJones, NeoHookean, PowerPunch, Problem
from fem_reference._elastic.mesh import edge_grid, uniform_grid
from fem_reference._large_strain import equilibrium, error_parts
from fem_reference._large_strain.block import block_of
from fem_reference._large_strain.core import core_of
from fem_reference._large_strain.discretisation import linear_event
from fem_reference._large_strain.equilibrium import settled, solve_state
from fem_reference._large_strain.error_parts import estimate
from fem_reference._large_strain.events import Family, found_event
from fem_reference.large_strain import _discretisation

#: Load of a state that a chord found, relative to that by Newton's method (measured: up to 2e-11).
CHORD = 1e-9

#: Of the load as the derivative of polynomials through five states (measured: 6e-7).
WORK = 2e-6

#: Of derivatives by central differences.
DIFFERENCE = 1e-7

SOFT = Problem(NeoHookean(182.0, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 0.0585))

#: Incompressible, with a modulus of depth: each radius of the edge has elements of its own.
GRADED = Problem(NeoHookean(150.0, 0.5, k=0.5, z_s=1.0), Ball(1.0), LennardJones(1.0, 0.0146))


@cache
def start(problem):
    """The event of small strain, and coarse elements."""
    linear = linear_event(problem, "pull_off")
    elements = _discretisation(problem, linear, "none", "auto")
    return linear, replace(elements, spec=replace(elements.spec, order=4))


@pytest.fixture
def factorisations(monkeypatch):
    """States at which the elements were linearised for a step."""
    states, linearised = [], equilibrium._linearised

    def counted(state):
        states.append(state)
        return linearised(state)

    monkeypatch.setattr(equilibrium, "_linearised", counted)
    return states


@pytest.mark.parametrize("problem", [SOFT, GRADED], ids=["one block", "a block for each radius"])
def test_a_state_nearby_needs_no_other_factorisation(factorisations, problem):
    linear, elements = start(problem)
    family = Family(elements, linear)
    family.state(0.0)
    count = len(factorisations)
    assert 0 < count < 4
    near = family.state(1e-3)
    assert len(factorisations) == count
    # Newton's method at the same place, from there.
    control = near.control
    again = solve_state(near.light, control)
    assert len(factorisations) == count + 1
    assert near.load == pytest.approx(again.load, rel=CHORD)
    assert near.displacement == pytest.approx(again.displacement, rel=CHORD)


def test_a_chord_that_does_not_shrink_is_given_up(factorisations):
    linear, elements = start(SOFT)
    state = Family(elements, linear).state(0.0)
    count = len(factorisations)
    exact = solve_state(state, replace(state.control, gap=0.97 * state.control.gap))
    kept = state.linearisation
    # Factors of something else, with which steps shrink to 0.6 of their size.
    wrong = replace(kept, factors=_Longer(kept.factors, 1.6))
    found = solve_state(replace(state, linearisation=wrong), exact.control)
    assert len(factorisations) > count
    assert found.load == pytest.approx(exact.load, rel=CHORD)


def test_the_load_is_the_derivative_of_the_energy_along_a_chord(factorisations):
    """Of core, exterior and surface, whose forces the steps bring into balance."""
    linear, elements = start(SOFT)
    state = Family(elements, linear).state(0.0)
    count = len(factorisations)
    shares = np.linspace(-0.1, 0.1, 5)
    gap = state.control.gap
    path = [solve_state(state, replace(state.control, gap=gap * (1.0 + share))) for share in shares]
    assert len(factorisations) == count
    delta, load, energy = (
        np.polynomial.Polynomial.fit(shares, [getattr(state, name) for state in path], 4)
        for name in ("displacement", "load", "energy")
    )
    for share in shares[1:-1]:
        assert energy.deriv()(share) / delta.deriv()(share) == pytest.approx(load(share), rel=WORK)


class _Longer:
    """Factors whose solutions are too long."""

    def __init__(self, factors, ratio):
        self._factors, self._ratio = factors, ratio

    def solve(self, load):
        return self._ratio * self._factors.solve(load)


def test_elements_with_other_rows_are_not_served():
    linear, elements = start(SOFT)
    state = Family(elements, linear).state(0.0)
    radius = linear.radius
    kept = state.linearisation
    assert kept.serves(elements.block(radius))
    assert kept.serves(replace(elements, extra=elements.extra + 3).block(radius))
    for other in (elements.spec.order + 1, elements.spec.order - 1):
        assert not kept.serves(replace(elements, spec=replace(elements.spec, order=other)).block(radius))
    assert not kept.serves(replace(elements, extent=0.5 * elements.extent).block(radius))
    assert not kept.serves(replace(elements, mixed=True).block(radius))
    assert not kept.serves(replace(elements, friction="bonded").block(radius))


def test_a_further_step_shows_what_a_state_lacks():
    linear, elements = start(SOFT)
    state = Family(elements, linear).state(0.0)
    assert abs(settled(state).load / state.load - 1.0) < CHORD
    lacking = replace(state, u=(1.0 + 1e-6) * state.u)
    missing = abs(lacking.load / state.load - 1.0)
    assert missing > 1e-6
    assert abs(settled(lacking).load / state.load - 1.0) < 0.25 * missing  # measured: 0.14
    assert settled(state.light).load == state.load


@pytest.mark.parametrize(("mixed", "nu"), [(False, 0.3), (True, 0.3), (True, 0.5)])
def test_tangents_and_couplings_are_derivatives(mixed, nu):
    """Of the forces of elements, with more points than usual, that are sheared and stretched along z."""

    def constants(z):
        shear = 1.0 + 0.5 * z
        return shear, np.full_like(z, (1.0 - 2.0 * nu) / (2.0 * nu)) / shear

    core = core_of(uniform_grid(1.0, 2), constants, 3, mixed, extra=4)
    random, step = np.random.default_rng(5), 1e-6
    u, direction = 0.01 * random.normal(size=(2, core.size))
    # Zero on the axis and in r, on which the hoop strain would have no bound.
    u[0::2] = 0.0
    pressures = 0.1 * random.normal(size=core.no_pressure().shape)
    K, response = core._linearised(slice(None), u, pressures, 1.0)
    ends = [core.forces(u + sign * step * direction, pressures, 1.0) for sign in (1, -1)]
    along = direction[core.rows]
    by_forces = (ends[0].residual - ends[1].residual) / (2.0 * step)
    change = np.einsum("eij,ej->ei", K, along)
    if mixed:
        B = np.linalg.solve(core.rise, response)
        by_lack = (ends[0].lack - ends[1].lack) / (2.0 * step)
        assert np.abs(by_lack - np.einsum("emi,ei->em", B, along)).max() < DIFFERENCE * np.abs(by_lack).max()
        # The tangent has the pressures that follow; the forces have those that are given.
        followed = np.einsum("emi,em->ei", B, np.einsum("emi,ei->em", response, along))
        assert np.abs(by_forces + followed - change).max() < DIFFERENCE * np.abs(change).max()
    else:
        assert np.abs(by_forces - change).max() < DIFFERENCE * np.abs(change).max()


def test_the_sparse_tangent_is_the_sum_of_its_parts():
    block = block_of(edge_grid(1.0, 0.3, 0.3, 4.0, 0.8), NeoHookean(1.0, 0.3), 3, mixed=False)
    random, rows, surface = np.random.default_rng(6), block.core.sides, block.surface_rows
    elements = random.normal(size=(rows.shape[0], rows.shape[1], rows.shape[1]))
    on_surface = random.normal(size=(surface.shape[0], surface.shape[1], surface.shape[1]))
    dense = np.zeros((block.core.size, block.core.size))
    np.add.at(dense, (rows[:, :, None], rows[:, None, :]), elements)
    np.add.at(dense, (surface[:, :, None], surface[:, None, :]), on_surface)
    dense[np.ix_(block.boundary, block.boundary)] += block.exterior
    expected = dense[np.ix_(block.free, block.free)]
    assert np.abs(block.matrix(elements, on_surface).toarray() - expected).max() < 1e-12 * np.abs(expected).max()


def test_what_is_before_a_root_is_the_last_step_of_its_search():
    problem = Problem(NeoHookean(1e3, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 0.02))
    linear = linear_event(problem, "zero_load")
    elements = _discretisation(problem, linear, "none", "auto")
    family = Family(replace(elements, spec=replace(elements.spec, order=4)), linear)
    event = found_event("zero_load", family)
    scale = math.pi * problem.law.work_of_adhesion
    assert abs(event.state.load) < 1e-9 * scale
    assert abs(event.previous.load) < 1e-5 * scale
    assert event.previous is not event.state


def test_lines_get_their_places_anew_where_an_event_is_far_from_them(monkeypatch):
    linear, elements = start(SOFT)

    def bound():
        return estimate(
            {"pull_off": linear}, {"pull_off": elements}, lambda states: -states["pull_off"].load, stationary=True
        )

    at_once = bound()
    placed, calls = error_parts._placed, []

    def counted(bases, linear, events):
        calls.append(events["pull_off"].x)
        return placed(bases, linear, events)

    monkeypatch.setattr(error_parts, "_placed", counted)
    monkeypatch.setattr(error_parts, "MISPLACED", 0.0)
    again = bound()
    assert len(calls) == 2
    assert again.value == pytest.approx(at_once.value, abs=sum(at_once.parts.values()))
    assert again.value == pytest.approx(at_once.value, rel=1e-7)
