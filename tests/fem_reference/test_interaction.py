"""Surface forces of a ball: what its potential changes of the pull-off force to first order."""

import math
from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fscm
from fem_reference import Ball, LennardJones, NeoHookean, Problem, solve_large_strain
from tests.solvers.potentials import composite


def energy_of_a_ball(rho, h, z0):
    """Integral of p from h to infinity over a ball of R = 1 under the 9-3 law with w = 1, in the closed form of p."""
    total, vertical = 0.0, 1.0 + z0 + h
    nearest = np.hypot(rho, vertical) - 1.0
    x, w = np.polynomial.legendre.leggauss(24)
    for piece in range(40):
        start, stop = (nearest[:, None] * (2.0 ** (piece + i) - 1.0) for i in (0, 1))
        s = np.hypot(rho[:, None], vertical[:, None] + start + (stop - start) * 0.5 * (1.0 + x))
        q = (s * s - 1.0) / (2.0 * z0)
        p = 8 / (3 * z0) * (q**-9 * (5 + 45 * s**2 + 63 * s**4 + 15 * s**6) / 128 - q**-3)
        total = total + (0.5 * (stop - start)[:, 0]) * (p @ w)
    return total


@cache
def first_order(softness, mu):
    """Relative change of the pull-off force by the potential, to first order, from states of the integral equation.

    At a given displacement the energy changes by its difference for the same surface; the least load changes by the
    slope of that.
    """
    z0 = softness ** (2 / 3) / mu
    problem = fscm.Problem(fscm.Homogeneous(0.91 / softness, 0.3), fscm.Ball(1.0), fscm.LennardJones(1.0, z0))
    force, displacement = (fscm.solve(problem, f"pull_off_{name}").value for name in ("force", "displacement"))
    changes = []
    for sign in (1.0, -1.0):
        states = fscm.equilibria(problem, "displacement", displacement + sign * 0.02 * z0)
        surface = min(states, key=lambda state: state.load).profile
        # The deformation is smooth, so that a spline of it serves the nodes of a fine rule.
        ball, law = problem.punch, problem.law
        deformed = CubicSpline(np.log(surface.radius), surface.gap - ball.height(surface.radius))
        log_r, weight = composite(np.linspace(*np.log(surface.radius[[0, -1]]), 200))
        r, height = np.exp(log_r), deformed(log_r)
        density = energy_of_a_ball(r, height, z0) - law.energy(height + ball.height(r))
        inside = 0.5 * r[0] ** 2 * density[0]
        changes.append(2.0 * math.pi * (float((weight * r**2) @ density) + inside))
    return -(changes[0] - changes[1]) / (0.04 * z0) / force


@pytest.mark.heavy
@pytest.mark.parametrize("mu", [0.3, 0.5, 2.0])
def test_the_change_at_a_stiff_solid_is_that_of_first_order(mu):
    """Energies of the integral equation and finite strain share neither the solver nor the potential's code."""
    softness = 1e-5
    problem = Problem(NeoHookean(0.75 / softness, 0.5), Ball(1.0), LennardJones(1.0, softness ** (2 / 3) / mu))
    forces = [solve_large_strain(problem, "pull_off_force", interaction=name) for name in ("body", "derjaguin")]
    change = forces[0].value / forces[1].value - 1.0
    assert change == pytest.approx(first_order(softness, mu), rel=0.01, abs=sum(f.u_num / f.value for f in forces))


def test_the_first_order_is_below_the_limit_of_the_true_area():
    """(a/R)^2/2 at the pull-off of JKR, times 0.26 at a Tabor number of 0.5 (finite elements: 0.26)."""
    softness = 1e-4
    limit = 0.5 * (9 * math.pi / 8 * softness) ** (2 / 3)
    assert first_order(softness, 0.5) == pytest.approx(0.26 * limit, rel=0.03)
