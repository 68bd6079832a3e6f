"""Coated solids at large Tabor numbers approach the limit of JKR that follows from another integral equation."""

import math

import numpy as np
import pytest

import fscm
from fscm import Coating
from tests.solvers.layered_jkr import Stack, minima_with_error

NU = 0.3


def coated(ratio, thickness):
    """A coating on a substrate so many times as stiff; lengths in (w R^2/E*)^(1/3), E* of the coating."""
    return Stack(((1.0 - NU**2, NU, thickness),), ((1.0 - NU**2) * ratio, NU))


def derived(ratio, thickness):
    """The pull-off force of JKR in pi w R."""
    return -min(state.load for state in minima_with_error(coated(ratio, thickness), 1.0, 1.0)) / math.pi


def limit(mu, forces):
    """The constant beside mu^-2 ln mu, mu^-2, mu^-3 ln mu and mu^-3, and the bound that those of the forces give it."""
    log = np.log(mu)
    terms = np.stack([np.ones_like(mu), log / mu**2, 1.0 / mu**2, log / mu**3, 1.0 / mu**3], axis=1)
    weights = np.linalg.inv(terms)[0]
    return weights @ forces[:, 0], np.abs(weights) @ forces[:, 1]


@pytest.mark.heavy
@pytest.mark.parametrize(("ratio", "thickness"), [(1.0, 0.5), (4.0, 0.5), (0.25, 0.5), (100.0, 0.3)])
def test_a_coated_solid_approaches_its_own_limit(ratio, thickness):
    """The cohesive zone is about L mu^(-3/2) wide, and its tension decays so slowly that a logarithm remains."""
    mu = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
    solids = [Coating(1.0, ratio, thickness * x**0.5, 0.0, NU) for x in mu]
    solutions = [
        fscm.solve(fscm.Problem(2.0, 0.0, x, graded=solid), "pull_off_force")
        for x, solid in zip(mu, solids, strict=True)
    ]
    forces = np.array([(solution.value, solution.u_num) for solution in solutions])
    (before, _), (value, u_forces) = limit(mu[:-1], forces[:-1]), limit(mu[1:], forces[1:])
    bound = abs(value - before) + u_forces
    assert abs(value - derived(ratio, thickness)) <= bound < 1e-5
    # A coating that is one in a thousand thicker is told apart.
    assert ratio == 1.0 or abs(value - derived(ratio, 1.001 * thickness)) > bound
