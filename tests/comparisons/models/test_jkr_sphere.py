"""JKR of a ball against its digits, its own curve, the paraboloid, the FSCM and what it refuses."""

from __future__ import annotations

import math

import pytest

from comparisons import create
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.problem import Problem
from comparisons.problem.evaluation import evaluated
from tests.comparisons.problems import on_solid

EVENTS = ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement")
LAW = {"work_of_adhesion": 0.05, "z0": 3e-10}


def problem_of(
    softness: float, mu: float = 2.0, punch: str = "ball", solid: str = "power-law", k: float = 0
) -> Problem:
    """A problem with w/(E* R) = softness in SI; the Tabor number is that of k = 0."""
    radius = mu * LAW["z0"] / softness ** (2.0 / 3.0)
    modulus = LAW["work_of_adhesion"] / (softness * radius) * 0.75
    values = {
        "power-law": {"E0": modulus, "c0": 1e-9, "k": k, "nu": 0.5},
        "homogeneous": {"E": modulus, "nu": 0.5},
        "exponential": {"E_surface": modulus, "E_depth": 2.0 * modulus, "length": 1e-7, "nu": 0.3},
    }
    return on_solid(solid, values[solid], R=radius, punch=punch, work=LAW["work_of_adhesion"], z0=LAW["z0"])


def result_of(problem: Problem, model: str, quantity: str = "pull_off_force") -> Result:
    result = evaluated(problem, create(model), quantity)
    assert isinstance(result, Result)
    return result


@pytest.mark.parametrize(("softness", "share"), [(1e-4, 0.998005), (1e-3, 0.99081882), (5e-3, 0.973699)])
def test_pull_off(softness: float, share: float) -> None:
    problem = problem_of(softness)
    unit = 1.5 * math.pi * problem.punch["R"] * LAW["work_of_adhesion"]
    result = result_of(problem, "jkr-sphere")
    assert result.value / unit == pytest.approx(share, rel=6e-7 if softness != 1e-3 else 6e-9)
    assert 0.0 < result.u_num < 1e-12 * result.value


@pytest.mark.parametrize("quantity", EVENTS)
def test_a_large_ball_is_the_paraboloid(quantity: str) -> None:
    """The difference falls as (a/R)^2, with the power 2/3 of w/(E* R)."""
    differences = []
    for softness in (8e-6, 1e-6):
        paraboloid = result_of(problem_of(softness, punch="sphere"), "jkr", quantity).value
        differences.append(abs(result_of(problem_of(softness), "jkr-sphere", quantity).value / paraboloid - 1.0))
    assert 0.0 < differences[1] < 1e-3
    assert differences[0] / differences[1] == pytest.approx(4.0, rel=0.02)


def test_the_curve_ends_as_far_in_compression_as_its_pull_off_is_in_tension() -> None:
    load = create("jkr-sphere").force_curve(problem_of(1e-3)).load
    assert 1.0 <= load[-1] / -load.min() < 1.2


def test_it_is_the_limit_of_the_fscm() -> None:
    """At a large Tabor number the law acts on the edge alone."""
    errors = []
    for mu in (10.0, 40.0):
        problem = problem_of(1e-3, mu)
        force, limit = (result_of(problem, model).value for model in ("fscm", "jkr-sphere"))
        errors.append(abs(force / limit - 1.0))
    assert errors[1] < 0.2 * errors[0]
    assert errors[1] < 1e-3  # that of the paraboloid is 1e-2


def test_the_fscm_refuses_a_ball_smaller_than_its_contact_before_it_traces_a_path(monkeypatch) -> None:
    """At such a Tabor number the path takes a minute, and the contact is that of JKR."""
    monkeypatch.setattr("fscm.solve", None)
    with pytest.raises(ComputationFailed, match="the ball is smaller than the contact"):
        result_of(problem_of(20.0, 200.0), "fscm")


@pytest.mark.parametrize(
    ("problem", "model", "reason"),
    [
        (Problem.dimensionless(2, 0, 1), "jkr-sphere", "is for the punch of the kind ball, not for power-law"),
        (problem_of(1e-3, k=0.4), "jkr-sphere", "is for a homogeneous solid, not for the power-law solid"),
        (problem_of(1e-3, solid="exponential"), "jkr-sphere", "not for the exponential solid"),
        (problem_of(20.0), "jkr-sphere", "the ball is smaller than the contact"),
        (problem_of(1e-3), "jkr", "a ball punch"),
    ],
)
def test_refusals(problem: Problem, model: str, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        result_of(problem, model)
