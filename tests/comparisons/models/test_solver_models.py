"""The adapters to the two references: results, units, exceptions."""

import pytest

import fem_reference
import fscm
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.fem_model import FiniteElements
from comparisons.models.stieltjes_model import StieltjesModel
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.tasks import evaluate


def test_a_jump_below_the_critical_tabor_number_is_not_applicable():
    row = evaluate(create("fscm"), "jump_in_gap", Problem.dimensionless(2, 0, 0.3))
    assert row.status == "not-applicable"
    assert "critical Tabor number" in row.reason


@pytest.mark.parametrize(("name", "segments"), [("fscm-stieltjes", 2500), ("fscm-stieltjes-400", 400)])
def test_the_stieltjes_scheme_states_its_own_segments(name, segments):
    model = create(name)
    assert model._segments == segments
    assert f"wider than the {segments} segments" in model.domain


def test_the_curve_of_the_reference_holds_its_own_pull_off():
    curve = create("fscm").curve(Problem.dimensionless(2, 0.4, 1))
    assert -curve.load.min() == pytest.approx(1.78848171, rel=1e-3)
    assert len(curve.load) == len(curve.displacement) == len(curve.columns["central_gap"])


@pytest.mark.parametrize("solver", ["fscm", "fem"])
def test_a_solver_that_does_not_converge_has_failed(monkeypatch, solver):
    package = {"fscm": fscm, "fem": fem_reference}[solver]

    def stuck(*_, **__):
        raise package.NotConverged("50 iterations were not enough")

    monkeypatch.setattr(package, "solve", stuck)
    monkeypatch.setattr(package, "trace", stuck)
    with pytest.raises(ComputationFailed, match="50 iterations"):
        create(solver).evaluate(Problem.dimensionless(2, 0, 1), "pull_off_force")
    with pytest.raises(ComputationFailed, match="50 iterations"):
        create(solver).curve(Problem.dimensionless(2, 0, 1))


@pytest.mark.parametrize("quantity", fem_reference.QUANTITIES)
def test_the_finite_elements_get_the_same_tabor_number_and_return_the_same_unit(monkeypatch, quantity):
    seen = {}

    def one_unit(body, quantity_name):
        solid, punch, law = body.solid, body.punch, body.law
        physical = fscm.Problem(
            fscm.PowerLaw(solid.E0, solid.c0, solid.k, solid.nu),
            fscm.PowerPunch(punch.n, punch.Q),
            fscm.LennardJones(law.work_of_adhesion, law.z0),
        )
        seen.update(mu=physical.mu, nu=solid.nu, quantity=quantity_name)
        unit = physical.units[QUANTITIES[quantity_name].scale]
        return fem_reference.Solution(2.5 * unit, 0.5 * unit, 9, 8, 7e-16, 0.6, (4, 6, 7), (2.5 * unit,) * 3)

    monkeypatch.setattr(fem_reference, "solve", one_unit)
    result = FiniteElements(0.2).evaluate(Problem.dimensionless(1.5, 0.4, 0.8), quantity)
    assert seen == {"mu": pytest.approx(0.8, rel=1e-13), "nu": 0.2, "quantity": quantity}
    assert (result.value, result.u_num) == (pytest.approx(2.5), pytest.approx(0.5))
    assert (result.size, result.iterations, result.residual) == (9, 8, 7e-16)


@pytest.mark.parametrize(
    ("problem", "quantity", "reason"),
    [
        (Problem.dimensionless(0.9, 0, 1), "pull_off_force", "n >= 1"),
        (Problem.dimensionless(2, 1, 1), "pull_off_force", "k <= 0.9, not k = 1"),
        (Problem.dimensionless(2, 0.95, 1), "pull_off_force", "k <= 0.9, not k = 0.95"),
        (Problem.dimensionless(2, 0, 1), "contact_radius", "do not compute"),
    ],
)
def test_what_the_finite_elements_do_not_do(problem, quantity, reason):
    with pytest.raises(NotApplicable, match=reason):
        FiniteElements().evaluate(problem, quantity)


def test_the_stieltjes_scheme_is_within_its_bound():
    model = StieltjesModel(segments=200)
    row = evaluate(model, "pull_off_force", Problem.dimensionless(2, 0.4, 0.5))
    assert abs(row.value - 1.86628026) < row.u_num < 1e-2
    assert evaluate(model, "hysteresis_energy", Problem.dimensionless(2, 0.4, 0.5)).status == "not-applicable"
    assert evaluate(model, "pull_off_force", Problem.dimensionless(2, 1, 0.5)).status == "not-applicable"


@pytest.mark.heavy
@pytest.mark.parametrize(
    "case", [Problem.dimensionless(2, 0, 0.1), Problem.dimensionless(1.5, 0.4, 0.6)], ids=lambda case: case.label
)
def test_the_two_references_agree_within_their_uncertainties(case):
    """As the stored results do, which the gates of both references compare in every case."""
    first, second = (evaluate(create(name, 0.2), "pull_off_force", case) for name in ("fscm", "fem"))
    assert abs(first.value - second.value) <= first.u_num + second.u_num
    assert second.u_num < 1e-6
