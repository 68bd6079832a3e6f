"""Figs. 8 and 9: two branches that begin as a cusp at the critical Tabor number, and their asymptotes."""

import math

import pytest

from comparisons.model import NotApplicable
from comparisons.paper.figures.fig08_jumps import jumps, near_critical
from comparisons.paper.figures.fig09_jump_asymptotes import asymptotes, coefficients
from comparisons.registry import create
from fscm.problem import Problem


@pytest.fixture(scope="module")
def critical():
    return near_critical(2.0, 0.4)


@pytest.mark.heavy
def test_the_branches_part_as_at_a_cusp(critical):
    assert round(critical["mu"], 2) == 0.78
    first, later = critical["jumps"][0], critical["jumps"][3]
    ratio = (later["mu"] - critical["mu"]) / (first["mu"] - critical["mu"])
    assert ratio == pytest.approx(100, rel=1e-5)
    gaps, displacements = (
        [row[f"jump_in_{kind}"] - row[f"jump_out_{kind}"] for row in (first, later)] for kind in ("gap", "displacement")
    )
    # Two roots of a square part like its root, and their values like the power 3/2.
    assert gaps[1] / gaps[0] == pytest.approx(ratio**0.5, rel=0.02)
    assert displacements[1] / displacements[0] == pytest.approx(ratio**1.5, rel=0.05)


def test_the_difference_is_above_its_uncertainty(critical):
    for row in critical["jumps"]:
        u = row["u_jump_in_displacement"] + row["u_jump_out_displacement"]
        assert row["jump_in_displacement"] - row["jump_out_displacement"] > 10 * u


def test_jumps_are_the_quantities_of_the_model():
    found, model = jumps(2.0, 0.0, 1.5), create("fscm")
    for name in ("jump_in_displacement", "jump_out_gap"):
        result = model.evaluate(Problem(2, 0, 1.5), name)
        assert found[name] == pytest.approx(result.value, abs=result.u_num + found[f"u_{name}"])


def test_there_is_no_jump_below_the_critical_tabor_number():
    with pytest.raises(NotApplicable, match="monotonically"):
        jumps(2.0, 0.4, 0.7)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 5.0])
def test_coefficients_of_the_asymptotes(n):
    rows = coefficients(n)
    assert [row["k"] for row in rows] == pytest.approx([i / 100 for i in range(101)])
    # Sec. 3.3: 8/3 and 2 as k -> 1, whatever n.
    assert rows[-1]["C_in"] == pytest.approx(8 / 3, rel=1e-12)
    assert rows[-1]["C_out"] == pytest.approx(2, rel=1e-12)
    if n == 2.0:
        # Eq. 49, and JKR's (3/4) (pi^2)^(1/3) of a sphere in our units.
        assert rows[0]["C_in"] == pytest.approx(1.4 * (5 * math.pi / math.sqrt(2)) ** (2 / 7), rel=1e-13)
        assert rows[0]["C_out"] == pytest.approx(0.75 * math.pi ** (2 / 3), rel=1e-13)


def test_coefficients_grow_with_the_shape_index():
    tables = [coefficients(n) for n in (1.0, 1.5, 2.0, 5.0)]
    for name in ("C_in", "C_out"):
        for rows in zip(*tables, strict=True):
            if rows[0]["k"] < 1:
                values = [row[name] for row in rows]
                assert values == sorted(values)


def test_the_asymptotes_beside_the_model():
    closed = {round(row["mu"], 9): row for row in asymptotes(2.0, 0.4)}
    found, row = jumps(2.0, 0.4, 5.0), closed[5.0]
    # Measured at mu = 5: Eq. 54 is off by 0.25 %, Eq. 47 by 6 %.
    assert row["jump_out_displacement"] == pytest.approx(found["jump_out_displacement"], rel=3e-3)
    assert 1.04 < row["jump_in_displacement"] / found["jump_in_displacement"] < 1.08
    # Eq. 46 gives no jump-in at a small Tabor number.
    assert closed[0.05]["jump_in_displacement"] is None
    assert closed[0.05]["jump_out_displacement"] < 0
