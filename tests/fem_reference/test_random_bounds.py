"""Bounds of the finite elements on random problems, against a finer mesh: another degree, and every feature finer."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference import (
    LennardJones,
    NotConverged,
    PowerPunch,
    Problem,
    Solid,
    Solution,
    solve_together,
)
from fem_reference._contact.error_parts import events_on_meshes
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference.quantities import TABLE
from fem_reference.verification.reference_solutions import surface_constant

SEED = 20261122
COUNT = 40

LARGEST_RATIO = 1e5
"""Of bound to error: beyond it a bound says nothing."""

ROUNDING = 1e-11
"""Relative error below which the ratio is that of rounding."""

NAMES = ("zero_load_displacement", *(name for name in TABLE if name != "zero_load_displacement"))
"""All quantities; the first gives a mesh that is fine enough for the others."""


def _problems():
    """n in [1, 10], k in [0, 0.9], mu in [0.05, 10] with their limits: a cone, a homogeneous solid, a weak gradient."""
    rng = np.random.default_rng(SEED)
    found = []
    for i in range(COUNT):
        n = 10 ** rng.uniform(0.0, 1.0)
        k = rng.uniform(0.0, 0.9)
        mu = 10 ** rng.uniform(np.log10(0.05), 1.0)
        nu = rng.uniform(0.0, 0.45)
        if i % 10 == 5:
            n = 1.0
        if i % 7 == 0:
            k = 0.0
        if i % 7 == 1:
            k = rng.uniform(0.0, 0.1)
        found.append((float(n), float(k), float(mu), float(nu)))
    return found


def _problem(n, k, mu, nu):
    E_star = surface_constant(k, nu) / (1 - k) / mu ** ((2 * n + k - 1) / n)
    return Problem(Solid(E_star * (1 - nu**2), 1.0, k, nu), PowerPunch(n, 1.0), LennardJones(1.0, 1.0))


def ratios(parameters, accuracy="quick"):
    """Bound over error by quantity; rounding limits the error from below."""
    problem = _problem(*parameters)
    found = solve_together(problem, NAMES, accuracy)
    choice, spec, size = chosen(problem, ("zero_load",), accuracy)
    finer = replace(
        spec,
        order=spec.order + 1,
        density=0.95 * choice.level.densities[-1],
        surface_depth=spec.surface_depth / 4.0,
        extent=2.0 * spec.extent,
        apex_width=spec.apex_width / 4.0,
    )
    reference = ResolvedEvents(events_on_meshes(choice, spec, size).path, choice.contact(finer, size))
    outcome = {}
    for name, solution in found.items():
        if isinstance(solution, Solution):
            error = abs(TABLE[name].functional(reference) - solution.value)
            outcome[name] = solution.u_num / max(error, ROUNDING * (1.0 + abs(solution.value)))
    return outcome


@pytest.mark.heavy
@pytest.mark.parametrize("parameters", _problems(), ids=lambda p: "n={:.2f} k={:.2f} mu={:.2f} nu={:.2f}".format(*p))
def test_no_error_is_above_its_bound(parameters):
    try:
        found = ratios(parameters)
    except NotConverged as reason:
        pytest.skip(f"status instead of a number: {reason}")
    assert {name: ratio for name, ratio in found.items() if not 1.0 <= ratio <= LARGEST_RATIO} == {}
