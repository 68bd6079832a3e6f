"""Declared domains: their form, and that models keep them."""

import math

import numpy as np
import pandas as pd
import pytest

from comparisons.domain import Domain, skip
from comparisons.judging.gates import load_gates
from comparisons.judging.judge import judge
from comparisons.judging.summary import summarise
from comparisons.models import transition_formulas
from comparisons.models.dmt import DMT
from comparisons.pipeline.inputs import load_cases, read_gates
from comparisons.problem import Problem
from comparisons.problem.evaluation import SOLVERS
from comparisons.quantities import QUANTITIES
from comparisons.registry import MODELS, ExternalIdentity, create
from comparisons.runs.cases import load_grids
from comparisons.runs.frames import frame
from comparisons.runs.tasks import Task, evaluate, evaluate_task
from tests.comparisons.conftest import GATES, with_entries
from tests.comparisons.grid_text import grid_text
from tests.comparisons.problems import on_solid

FORCE = {"quantities": ["pull_off_force"]}
EXPONENTIAL = {"E_surface": 1e9, "E_depth": 3e9, "length": 1e-8, "nu": 0.3}


@pytest.mark.parametrize(
    ("declared", "sentence"),
    [
        ("n = 2", "applies_to is str and not a table"),
        ([], "applies_to has 0 tables, outside 1 to 20"),
        ([FORCE] * 21, "applies_to has 21 tables"),
        ({"n": [2, 2]}, "quantities = None is not a list of at least one quantity"),
        ({"quantities": ["pull_of_force"]}, "unknown quantity 'pull_of_force': did you mean pull_off_force"),
        ({**FORCE, "N": [2, 2]}, "unknown key 'N'; known are quantities, n, k, mu, nu"),
        *[({**FORCE, "n": ends}, "is not .low, high.") for ends in (2, [3, 2], [math.nan, 2], [True, 2], ["1", 2])],
    ],
)
def test_what_is_no_domain_is_refused_with_its_place(declared, sentence):
    with pytest.raises(ValueError, match=sentence):
        Domain.of(declared)


def test_both_ends_belong_to_a_range_and_what_is_not_named_is_free():
    domain = Domain.of([{**FORCE, "n": [2, 2], "mu": [0.1, None]}, {"quantities": ["jump_in_gap"], "nu": [0, 0.3]}])
    case = {"n": 2.0, "k": 0.7, "mu": 0.1}
    assert domain.contains("pull_off_force", case)
    assert domain.contains("pull_off_force", {**case, "mu": 1e9})
    assert not domain.contains("pull_off_force", {**case, "mu": 0.0999})
    assert not domain.contains("pull_off_force", {**case, "n": 2.0001})
    assert domain.contains("jump_in_gap", {**case, "nu": None})
    assert not domain.contains("jump_in_gap", {**case, "nu": 0.31})
    assert not domain.contains("jump_out_gap", case)
    assert Domain.of(domain.as_json()) == domain


#: Where our models are tried: wider than the standing cases.
BOX = {"n": [0.7, 10], "k": [0, 1], "mu": [0.005, 20]}
#: The event may be missing below the critical Tabor number; the reference then has no value either.
MAY_BE_MISSING = {name for name in QUANTITIES if name.startswith("jump_") or name == "hysteresis_energy"}


def random_cases(name):
    """Cases even in n, k and the logarithm of mu; for the formulas of n = 2 and k = 0 all of these."""
    rng = np.random.default_rng(5)
    only = isinstance(create(name), transition_formulas._HomogeneousSphere)
    for _ in range(8):
        n, k, log_mu = (rng.uniform(*ends) for ends in (BOX["n"], BOX["k"], np.log(BOX["mu"])))
        yield Problem.dimensionless(*((2.0, 0.0) if only else (n, k)), math.exp(log_mu))


@pytest.mark.parametrize("name", [name for name in MODELS if name not in SOLVERS])
def test_a_model_has_a_value_for_all_that_it_does_not_skip(name):
    model, taken = create(name), set()
    for case in random_cases(name):
        for quantity in QUANTITIES:
            row, reason = evaluate(model, quantity, case), model.skip(case, quantity)
            if reason is None:
                taken.add(quantity)
                expected = {"ok", "not-applicable"} if quantity in MAY_BE_MISSING else {"ok"}
                assert row.status in expected, (quantity, case.label, row.reason)
            else:
                assert (row.status, row.reason) == ("not-applicable", reason)
    of_files = {"jkr-profile", "jkr-sphere", "jkr-sphere-projected", "jkr-surface-tension", "md-profile"}
    assert bool(taken) == (name not in of_files)


class External:
    """A model of the contract: n, k and mu, numbers alone."""

    name, version, citation, domain = "external", "1", "none", "all"

    def __init__(self, declared=None):
        self.applies_to = declared

    def evaluate(self, problem, quantity):
        raise NotImplementedError


@pytest.mark.parametrize(
    ("problem", "quantity", "reason"),
    [
        (Problem.dimensionless(2, 0, 1), "pull_off_force", None),
        (Problem.dimensionless(1, 0, 1), "pull_off_force", "outside the domain"),
        (Problem.dimensionless(2, 0, 1), "jump_in_gap", "it has no jump_in_gap"),
        (Problem.dimensionless(2, 0, 1), "force_curve", "no force-displacement curve"),
        (Problem.dimensionless(2, 0, 1), "pull_off_gap", "the surface at pull-off"),
        (on_solid("exponential", EXPONENTIAL), "pull_off_force", "this problem has a exponential solid"),
    ],
)
def test_what_an_external_model_takes_follows_from_its_contract(problem, quantity, reason):
    skipped = skip(External({**FORCE, "n": [2, 2]}), problem, quantity)
    assert skipped is None if reason is None else reason in skipped


def test_a_domain_of_n_k_and_mu_says_nothing_of_other_problems():
    assert Domain.of({**FORCE, "n": [2, 2]}).skip(on_solid("exponential", EXPONENTIAL), "pull_off_force") is None


@pytest.mark.parametrize(("quantity", "status"), [("pull_off_force", "ok"), ("jump_in_gap", "not-applicable")])
def test_a_model_is_asked_once_what_it_takes(quantity, status, monkeypatch):
    asked, skips = [], DMT.skip
    monkeypatch.setattr(DMT, "skip", lambda *arguments: asked.append(arguments[1:]) or skips(*arguments))
    problem = Problem.dimensionless(2, 0, 1)
    assert evaluate("dmt", quantity, problem).status == status
    assert asked == [(problem, quantity)]


def test_a_model_is_not_evaluated_outside_its_domain(toys, monkeypatch):
    model = create("ten-percent")
    monkeypatch.setattr(type(model), "applies_to", {**FORCE, "n": [2, 2]}, raising=False)
    assert evaluate_task(Task("ten-percent", "pull_off_force", Problem.dimensionless(2, 0, 1))).value == 2.2
    row = evaluate_task(Task("ten-percent", "pull_off_force", Problem.dimensionless(1, 0, 1)))
    assert (row.status, row.value) == ("not-applicable", None)
    assert row.reason == "outside the domain that the model declares: pull_off_force for n = 2"
    row = evaluate_task(Task("ten-percent", "jump_in_gap", Problem.dimensionless(2, 0, 1)))
    assert row.reason == "outside the domain that the model declares: it has no jump_in_gap"


def test_an_external_model_is_not_started_outside_its_domain_and_has_failed_if_it_has_changed():
    unknown = ExternalIdentity(
        "other", "1", "other.py:Other", "none", "all", applies_to=Domain.of({**FORCE, "n": [1, 1]})
    )
    changed = ExternalIdentity("jkr", "another", "jkr", "none", "all")
    for identity, status in ((unknown, "not-applicable"), (changed, "failed")):
        row = evaluate_task(Task(identity.name, "pull_off_force", Problem.dimensionless(2, 0, 1), identity))
        assert (row.status, row.value, row.model_version) == (status, None, identity.version)


def test_not_applicable_is_a_failure_inside_the_declared_domain_and_outside_it_nothing_counts():
    """Outside, a row counts for nothing even if it has a value."""
    limits = {"lower": -0.5, "upper": 0.5, "min_cases": 1, "not_applicable": "leave-out"}
    gate = with_entries(GATES, candidate="given", reference="bradley", cases="{}", **limits)
    grids = load_grids(grid_text(["jkr"], tier="quick", n=[2], k=[0], mu=[0.1, 0.5, 1, 2]))
    rows = frame([evaluate_task(Task("bradley", "pull_off_force", case)) for case in grids[0].cases])
    candidate = rows.assign(model="jkr", status=["ok", "ok", "not-applicable", "ok"])
    candidate.loc[candidate["status"] != "ok", ["value", "u_num"]] = math.nan
    taken = {"jkr": Domain.of({**FORCE, "mu": [0.1, 1]})}
    table = judge(load_gates(gate), grids, pd.concat([rows, candidate]), None, ["jkr"], taken)
    assert table["verdict"].tolist() == ["PASS", "PASS", "FAIL", "NOT-APPLICABLE"]
    assert table["reason"].iloc[2].endswith("(inside the domain that the model declares)")
    summary = summarise(table).iloc[0]
    counts = summary[["asked", "answered", "not_applicable", "failed", "outside"]].tolist()
    assert (summary["verdict"], counts) == ("FAIL", [3, 2, 1, 0, 1])


def test_a_run_of_a_closed_form_has_no_standing_gate_whose_cases_it_does_not_compute():
    """`fscm-bench run --model jkr` was in error for want of the cases of verification."""
    of_jkr, of_all = (
        {gate.id for gate in read_gates(None, load_cases("quick", names), names).gates} for names in (["jkr"], None)
    )
    assert "JKR-JUMP-OUT" in of_all - of_jkr
    assert "JKR-LIMIT-PULL-OFF" in of_jkr
