"""Figs. 5 and 7: gap, pressure and deformation at pull-off, for k < 1 and in the Gibson limit."""

import math

import numpy as np
import pytest

from comparisons.paper.figures.fig05_07_pull_off_surfaces import surface
from comparisons.registry import create
from fscm.problem import Problem

STRENGTH = 16 * math.sqrt(3) / 27


def arrays(n, k, mu):
    found = surface(n, k, mu)
    delta = found.pop("displacement")
    return delta, {name: np.array(values) for name, values in found.items()}


@pytest.mark.parametrize(("n", "k", "mu"), [(2, 0.4, 0.1), (2, 0.4, 1.0), (2, 0.0, 1.0), (2, 1.0, 1.0), (1, 1.0, 0.5)])
def test_the_surface_is_in_equilibrium(n, k, mu):
    delta, found = arrays(n, k, mu)
    # Eq. 4 between the nodes too, where gap and deformation are interpolated each by itself.
    residual = found["gap"] - (found["radius"] ** n / n - delta + found["deformation"])
    assert np.abs(residual).max() < 1e-6
    # Eq. 27.
    q = 1 / (found["gap"] + 1)
    assert found["pressure"] == pytest.approx(8 / 3 * (q**9 - q**3), abs=1e-12)
    for name in ("gap", "pressure", "deformation"):
        assert found[f"u_{name}"].min() > 0
        assert found[f"u_{name}"].max() < 1e-5


def test_the_pressure_carries_the_pull_off_force():
    delta, found = arrays(2, 0.4, 1.0)
    load = np.trapezoid(found["pressure"], found["radius"] ** 2)
    # p = -(8/3) (f + 1)^-3 beyond r = 6, where f is 18.
    tail = 8 / 3 / (18 + 1 - delta) ** 2
    force = create("fscm").evaluate(Problem(2, 0.4, 1.0), "pull_off_force").value
    assert -load + tail == pytest.approx(force, abs=2e-3)


@pytest.mark.parametrize("mu", [0.1, 1.0])
def test_the_strength_of_the_law_is_reached_at_the_edge(mu):
    _, found = arrays(2, 0.4, mu)
    assert found["pressure"].min() == pytest.approx(-STRENGTH, abs=1e-6)


def test_the_surface_follows_the_punch_only_at_large_tabor_numbers():
    # Sec. 3.2.1: the gap inside is almost zero for mu >= 1 and not for 0.1.
    (_, soft), (_, rigid) = (arrays(2, 0.4, mu) for mu in (1.0, 0.1))
    assert np.abs(soft["gap"][soft["radius"] < 1]).max() < 0.08
    assert np.abs(rigid["gap"][rigid["radius"] < 1]).max() > 0.3
    # The pile-up.
    assert -soft["deformation"].min() > 10 * -rigid["deformation"].min()


def test_the_center_yields_less_the_larger_the_gradient():
    # Sec. 3.2.2, on to the Gibson limit, where p(0) = 0 for a paraboloid.
    found = [arrays(2, k, 1.0)[1] for k in (0.0, 0.4, 1.0)]
    assert found[0]["pressure"][0] > found[1]["pressure"][0] > found[2]["pressure"][0]
    assert -found[0]["deformation"][0] > -found[1]["deformation"][0] > -found[2]["deformation"][0] - 1e-9
    assert found[2]["pressure"][0] == pytest.approx(0, abs=1e-9)
