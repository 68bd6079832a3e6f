"""Surface forces of a punch in the integral equation: rigid solids, exact tangent, far field, bounds, and refusals."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

import fscm
from fscm import Ball, Homogeneous, LennardJones, PowerPunch, Problem, solve
from fscm._ball import BallUnderMie
from fscm._bound.defect import Defect, finer
from fscm._surface.linearisation import linearised, rates_by
from fscm._surface.newton import newton
from fscm._surface.state import Control
from fscm._surface.tail import tail_errors, tail_of
from fscm._surface.tail_of_body import TailOfBody
from fscm.interaction import Derjaguin, interaction_of
from fscm.punch import ScaledPunch
from fscm.stieltjes import StieltjesScheme
from tests.refusals import refused
from tests.solvers.potentials import composite, table_of


def test_the_unit_of_radii_changes_no_traction():
    plain, scaled = (BallUnderMie(punch, LennardJones()) for punch in (Ball(50.0), ScaledPunch(Ball(50.0), 7.0, 1.0)))
    r, gap = np.array([1.4, 21.0, 42.0, 210.0]), np.array([0.1, -0.1, 5.0, 3e4])
    for name in ("traction", "slope", "drift", "energy"):
        assert getattr(scaled, name)(r / 7.0, gap) == pytest.approx(getattr(plain, name)(r, gap), rel=1e-9)


@pytest.mark.parametrize("R", [20.0, 1000.0])
def test_over_a_rigid_plane_the_load_is_that_of_vertical_gaps_to_the_far_pole(R):
    """Solved, not integrated here: a solid of 1e12 times the stiffness of the adhesion, at a prescribed gap."""
    law = LennardJones()
    stiff = Problem(Homogeneous(1e12, 0.3), Ball(R), law, interaction="body")
    for gap in (0.0, 2.0):
        (state,) = fscm.equilibria(stiff, "central_gap", gap)
        D, weight = composite(np.geomspace(1.0 + gap, 1.0 + gap + 2.0 * R, 60))
        exact = 2.0 * math.pi * float((weight * (R - (D - 1.0 - gap))) @ law.traction(D - 1.0))
        assert state.load == pytest.approx(exact, rel=1e-9)
    if R == 20.0:
        (state,) = fscm.equilibria(stiff, "central_gap", 0.0)
        assert state.load == pytest.approx(-117.889330034344, rel=1e-9)


def bead(softness=1e-3, mu=1.0, law=LennardJones, interaction="body"):
    return Problem(
        Homogeneous(0.91 / softness, 0.3), Ball(1.0), law(1.0, softness ** (2 / 3) / mu), interaction=interaction
    )


@pytest.fixture(scope="module")
def state():
    return fscm.Analysis(bead().dimensionless).event("pull_off").value


def test_the_tangent_is_exact(state):
    """Displacement, gaps and scale, at an edge where the sphere is steep."""
    disc, step = state.disc, 1e-6
    rng = np.random.default_rng(1)
    direction = np.append(rng.normal(size=disc.mesh.size) * np.exp(-((state.radius / state.scale) ** 2)), [0.3, 0.2])

    def left(sign):
        moved = replace(
            state,
            unknowns=state.unknowns + sign * step * direction[:-2],
            displacement=state.displacement + sign * step * direction[-2],
            scale=state.scale * math.exp(sign * step * direction[-1]),
        )
        system = linearised(moved)
        return np.concatenate([system.residual, [system.anchor, moved.load, moved.central_gap]])

    numeric = (left(1.0) - left(-1.0)) / (2.0 * step)
    system = linearised(state)
    by_left_side = system.times(direction)[:-1]
    exact = [*by_left_side, system.load_gradient @ direction, system.axis_gap_gradient @ direction]
    # The mesh ends far away, where heights are 1e6 times the gaps at the edge.
    near = np.append(state.radius < 3.0 * state.scale, [True] * 3)
    assert numeric[near] == pytest.approx(np.array(exact)[near], rel=1e-5, abs=1e-6)
    rates, h = rates_by(state, "log_scale"), 1e-5
    ahead, behind = (
        newton(
            state.shifted(rates.unknowns, rates.displacement, rates.log_scale, sign * h),
            Control(math.log(state.scale) + sign * h, log_scale=1.0),
            1e-12,
        )
        for sign in (1.0, -1.0)
    )
    energy, displacement = ((getattr(ahead, f) - getattr(behind, f)) / (2 * h) for f in ("energy", "displacement"))
    assert displacement == pytest.approx(rates.displacement, rel=1e-5)
    assert energy == pytest.approx(rates.energy, rel=1e-5)  # dE = P d(delta)


def test_the_gradient_of_the_energy_is_exact(state):
    """By the scale at fixed gaps, where the potential changes with the radius."""
    defect, step = Defect(state, finer(state.disc)), 1e-5
    energies = [replace(defect.fine, scale=state.scale * math.exp(sign * step)).energy for sign in (1.0, -1.0)]
    rate = (energies[0] - energies[1]) / (2.0 * step)
    assert defect._gradient("energy")[-1] == pytest.approx(rate, rel=1e-6)


@pytest.mark.parametrize("k", [0.0, 0.3])
def test_the_tail_is_the_integral_of_the_potential(k):
    problem = Problem(2.0, k, 1.0, punch=ScaledPunch(Ball(300.0), math.sqrt(300.0), 1.0), interaction="body")
    T, displacement, step = 900.0, 0.7, 1e-4
    tail = tail_of(problem, T, displacement)
    t, weight = composite(np.geomspace(T, 1e7 * T, 200))
    body = problem.force
    pressure = body.traction(t, problem.punch.height(t) - displacement)
    assert tail.load == pytest.approx(2.0 * float((weight * t) @ pressure), rel=1e-9, abs=0.0)
    lift = problem.compliance * (1.0 - k) * float((weight * t**-k) @ pressure)
    assert tail.displacement == pytest.approx(lift, rel=1e-9, abs=0.0)
    beside = [tail_of(problem, T * math.exp(sign * step), displacement) for sign in (1.0, -1.0)]
    assert (beside[0].load - beside[1].load) / (2 * step) == pytest.approx(tail.load_rate, rel=1e-6, abs=0.0)
    lower, upper = (tail_of(problem, T, displacement + sign * 0.1) for sign in (-1.0, 1.0))
    assert (upper.load - lower.load) / 0.2 == pytest.approx(tail.load_slope, rel=1e-3, abs=0.0)
    computed, remainder = tail_errors(problem, T, displacement)
    assert np.all(np.abs(computed) <= 1e-12 * abs(tail.load) * T**2)
    assert np.all(remainder >= 0.0)
    coarse = TailOfBody(problem, T, displacement)
    assert coarse.load[0] == pytest.approx(2.0 * float((weight * t) @ pressure), rel=1e-9, abs=0.0)


def test_the_interaction_is_a_part_of_the_problem():
    by_name, of_problem = solve(bead(interaction="derjaguin"), "pull_off_force", interaction="body"), bead()
    assert by_name.value == solve(of_problem, "pull_off_force").value
    assert pickle.loads(pickle.dumps(of_problem)) == of_problem != of_problem.under("derjaguin")
    assert of_problem.under("derjaguin") == bead(interaction="derjaguin")
    assert "interaction='body'" in repr(of_problem)
    assert isinstance(of_problem.dimensionless.force, BallUnderMie)
    assert isinstance(Problem(2.0, 0.0, 1.0).force, Derjaguin)


def test_what_curvatures_leave_out_is_in_the_part_of_the_law():
    law = table_of(fscm, LennardJones(1e-3, 0.01))
    force = solve(Problem(Homogeneous(0.91, nu=0.3), PowerPunch(2.0, 1.0), law, interaction="body"), "pull_off_force")
    # The 9-3 law has 1.3e-4 more.
    assert 2e-4 * force.value < force.parts["law"] < 5e-3 * force.value
    assert force.u_num - force.parts["law"] < 1e-8 * force.value


def test_what_has_no_potential_is_refused():
    law, solid = LennardJones(0.05, 1e-9), Homogeneous(1e6, 0.3)
    refused("growth f ~ r\\^0.8", Problem, solid, PowerPunch(0.8, 1.0), law, interaction="body")
    refused("unknown", Problem, solid, Ball(1e-6), law, interaction="bodies")
    refused("unknown", solve, Problem(solid, Ball(1e-6), law), "pull_off_force", interaction="bodies")

    class Steeper(LennardJones):
        pass

    refused("Steeper", interaction_of, PowerPunch(1.0, 1.0), Steeper(), "body")
    refused("scheme of the paper", StieltjesScheme, Problem(2.0, 0.0, 1.0, punch=Ball(50.0), interaction="body"))
    refused("k = 1", Problem, 2.0, 1.0, 1.0, punch=Ball(50.0), interaction="body")
