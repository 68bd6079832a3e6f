"""The limit k = 1: closed forms of the paraboloid, and the events of the solver."""

import numpy as np
import pytest

from comparisons.models.gibson_limit import gibson_curve, gibson_profile
from fscm.gibson import GibsonSolid
from fscm.problem import Problem


@pytest.mark.parametrize(("n", "mu"), [(1, 1.0), (2, 0.3), pytest.param(5, 1.0, marks=pytest.mark.heavy)])
def test_the_curve_has_the_events_of_the_solid(n, mu):
    problem = Problem(n, 1, mu)
    solid, curve = GibsonSolid(problem), gibson_curve(problem)
    force = solid.solution("pull_off_force").value
    assert -curve.load.min() == pytest.approx(force, rel=1e-3)
    assert -curve.load.min() <= force * (1 + 1e-12)
    assert curve.load[-1] == pytest.approx(force, rel=1e-12)
    falling = np.flatnonzero(np.diff(curve.displacement) < 0)
    # Under a prescribed load the contact is stable behind pull-off, under a displacement outside of the jump.
    held, under_load = curve.columns["stable_under_displacement"], curve.columns["stable_under_load"]
    assert np.any(held == 0) == bool(len(falling)) == (mu > 0.64)
    inside = (held[1:] > 0) & (held[:-1] > 0)
    assert np.all(np.diff(curve.displacement)[inside] >= 0)
    start = int(np.argmax(under_load))
    assert abs(start - int(np.argmin(curve.load))) <= 1
    assert np.all(under_load[start:] == 1)
    assert not under_load[:start].any()
    if mu > 0.64:
        fold = solid.solution("jump_in_displacement").value
        assert curve.displacement[falling[0]] == pytest.approx(fold, abs=1e-12)
        out = solid.solution("jump_out_displacement").value
        assert curve.displacement[falling[-1] + 1] == pytest.approx(out, abs=1e-12)


@pytest.mark.parametrize(("n", "mu"), [(1, 0.3), (2, 0.3), (2, 1.0), pytest.param(5, 1.0, marks=pytest.mark.heavy)])
def test_the_surface_balances_and_carries_the_pull_off_force(n, mu):
    problem = Problem(n, 1, mu)
    solid = GibsonSolid(problem)
    surface = gibson_profile(problem)
    # Eq. 28 with w = M p.
    delta = solid.solution("pull_off_displacement").value
    deformation = problem.compliance * surface.pressure
    assert surface.gap == pytest.approx(surface.radius**n / n - delta + deformation, abs=1e-9)
    assert np.diff(surface.radius).min() >= 0
    # p = -(8/3) f^-3 beyond the last point.
    f, area = 10.5 + delta, (n * (10.5 + delta)) ** (2 / n)
    tail = 8 / 3 * f**-3 * area * 2 / n / (3 - 2 / n)
    load = np.trapezoid(surface.pressure, surface.radius**2)
    if (n, mu) == (2, 1.0):
        # The front is a jump of the gap at one radius.
        jump = np.diff(surface.gap).argmax()
        assert np.diff(surface.radius)[jump] == pytest.approx(0.0, abs=1e-14)
        assert np.diff(surface.gap)[jump] > 0.5
    assert -load + tail == pytest.approx(solid.solution("pull_off_force").value, rel=0.02)
