"""The adapters of the integral equation, the Stieltjes scheme and the atlas, and failures of both references."""

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.models.fscm_model import StieltjesModel
from comparisons.models.solver import result_of
from comparisons.problem import Problem
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import create
from comparisons.runs.tasks import evaluate


def test_a_result_has_the_value_and_the_bound_of_the_solution_in_its_unit():
    solution = Result(value=3.0, u_num=0.5, size=9, iterations=8, residual=7e-16, observed_order=float("nan"))
    result = result_of(solution, unit=2.0)
    assert (result.value, result.u_num, result.observed_order) == (1.5, 0.25, None)
    assert (result.size, result.iterations, result.residual) == (9, 8, 7e-16)


def test_a_jump_below_the_critical_tabor_number_is_not_applicable():
    row = evaluate(create("fscm"), "jump_in_gap", Problem.dimensionless(2, 0, 0.3))
    assert row.status == "not-applicable"
    assert "critical Tabor number" in row.reason


def test_the_curve_of_the_reference_holds_its_own_pull_off():
    curve = create("fscm").curve(Problem.dimensionless(2, 0.4, 1))
    assert -curve.load.min() == pytest.approx(1.78848171, rel=1e-3)
    assert 0.0 < curve.u_distance < 1e-6


def test_both_fields_end_at_the_same_gap_and_have_their_own_bound():
    model, problem = create("fscm"), Problem.dimensionless(n=2, k=0.4, mu=0.5)
    pressure, gap = (CURVES[name].evaluate(model, problem) for name in ("pull_off_pressure", "pull_off_gap"))
    surface = model.pull_off_profile(problem)
    assert pressure.x == gap.x
    assert max(gap.y) <= 10 < max(surface.gap)
    assert (pressure.u_distance, gap.u_distance) == (surface.u_distance, surface.u_gap_distance)
    # The gap determines the pressure (Eq. 9).
    assert pressure.y == pytest.approx(problem.posed.law.traction(np.array(gap.y)).tolist())


@pytest.mark.parametrize("package", [fscm, fem_reference])
def test_a_solver_that_does_not_converge_has_failed(monkeypatch, package):
    def stuck(*_, **__):
        raise package.NotConverged("50 iterations were not enough")

    monkeypatch.setattr(package, "solve", stuck)
    monkeypatch.setattr(package, "trace", stuck)
    model, problem = create({fscm: "fscm", fem_reference: "fem"}[package]), Problem.dimensionless(2, 0, 1)
    for call in (lambda: model.evaluate(problem, "pull_off_force"), lambda: model.curve(problem)):
        with pytest.raises(ComputationFailed, match="50 iterations"):
            call()


def test_the_stieltjes_scheme_ends_in_compression_or_at_its_last_gap_and_refuses_the_rest():
    for n, k, mu, end in ((1, 0.2, 0.1, -0.4), (2, 0.4, 0.5, None)):
        curve = StieltjesModel(segments=60).curve(Problem.dimensionless(n, k, mu))
        gap = curve.columns["central_gap"]
        assert gap[0] == 10.0
        assert gap[-1] == end or (curve.load[-1] > 0.0 >= curve.load[-2] and gap[-1] > -0.4)
    assert [create(name)._segments for name in ("fscm-stieltjes", "fscm-stieltjes-400")] == [2500, 400]
    for quantity, k in (("hysteresis_energy", 0.4), ("pull_off_force", 1)):
        assert evaluate("fscm-stieltjes-400", quantity, Problem.dimensionless(2, k, 0.5)).status == "not-applicable"


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_result_of_the_atlas_is_that_of_the_function(quantity):
    result = create("atlas").evaluate(Problem.dimensionless(n=2.5, k=0.3, mu=2.0), quantity)
    assert (result.value, result.u_num) == fscm.atlas(2.5, 0.3, 2.0, quantity)


@pytest.mark.parametrize(
    ("n", "k", "mu", "quantity", "reason"),
    [
        (2, 0.4, 11, "pull_off_force", r"mu = 11 is outside \[0.01, 10\]"),
        (2, 0, 0.3, "jump_in_gap", "critical Tabor number 0.69"),
        (2, 0, 1, "contact_radius", "does not compute contact_radius"),
    ],
)
def test_outside_its_box_and_its_quantities_the_atlas_is_not_applicable(n, k, mu, quantity, reason):
    with pytest.raises(NotApplicable, match=reason):
        create("atlas").evaluate(Problem.dimensionless(n=n, k=k, mu=mu), quantity)
