"""Studies beyond the paper: where the errors of geometry and of strain cancel."""

import math

import numpy as np
import pandas as pd
import pytest

from comparisons.paper.figures import studies


def test_geometry_and_strain_cancel_where_their_parts_are_equal():
    """kappa = 2 x^2 - 0.1 x of the root x vanishes at 0.05; the bound 1e-3 x moves it by 5e-4."""
    x = np.linspace(0.01, 0.2, 8)
    line = pd.DataFrame({"elasto_adhesion_number": x**3, "kappa": 2 * x**2 - 0.1 * x, "u_kappa": 1e-3 * x})
    with_error = line.assign(nu=0.3, kappa=line["kappa"] + 0.2 * x)
    table = pd.concat([line.assign(nu=0.5), with_error]).assign(model="fscm", mu=1.0)
    never, once = studies.meeting_points(table).itertuples()
    roots = np.cbrt([once.elasto_adhesion_number, once.lowest, once.highest])
    assert roots == pytest.approx([0.05, 0.0495, 0.0505])
    assert math.isnan(never.elasto_adhesion_number)


def test_jkr_finds_the_values_of_soft_spheres(monkeypatch):
    monkeypatch.setattr(studies, "_POINTS", 100)
    assert list(studies.fitted_by_jkr(0.0, 1.0, 10.0).values()) == pytest.approx([1.00632, 0.99938], abs=1e-4)
