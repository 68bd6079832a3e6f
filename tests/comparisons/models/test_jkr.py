"""JKR against the printed curve and digits, of a paraboloid and of a ball; the energy of the asymptotic cycle."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import mpmath as mp
import numpy as np
import pytest

from comparisons import create
from comparisons.description.strain_errors import ball_on
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.models.jump_asymptotes import JumpAsymptotes
from comparisons.models.semi_rigid import SemiRigid
from comparisons.problem import Problem, Section
from comparisons.problem.evaluation import evaluated
from tests.marks import heavy

contact = Problem.dimensionless
CASES = pytest.mark.parametrize(
    ("n", "k", "mu"),
    [(1.0, 0.0, 0.3), (1.5, 0.2, 2.0), (2.0, 0.4, 3.0), (5.0, 0.6, 0.1), (0.8, 0.0, 1.0), (10.0, 0.95, 7.0)],
)


def value(n: float, k: float, mu: float, quantity: str = "pull_off_force") -> float:
    return JKR().evaluate(contact(n, k, mu), quantity).value


def printed_curve(n: float, k: float, mu: float, a: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Eqs. 50-51 with Q = z0 = dgamma = 1, where b c0^k / E* = (1 - k) mu^((2n+k-1)/n) by Eq. 29."""
    n, k, mu = mp.mpf(n), mp.mpf(k), mp.mpf(mu)
    # cos(k pi / 2) E* / (b c0^k) with its limit at k = 1.
    modulus = (mp.cos(k * mp.pi / 2) / (1 - k) if k < 1 else mp.pi / 2) / mu ** ((2 * n + k - 1) / n)
    delta = mp.beta(n / 2, (1 + k) / 2) * a**n / 2 - mp.sqrt(2 * mp.pi / modulus) * a ** ((1 - k) / 2)
    P = modulus / (1 + k) * mp.beta(1 + n / 2, (1 + k) / 2) * a ** (n + k + 1)
    P -= mp.sqrt(8 * mp.pi * modulus) / (1 + k) * a ** ((3 + k) / 2)
    return delta, P / mp.pi


@CASES
def test_events_and_curve_are_those_of_the_printed_curve(n: float, k: float, mu: float) -> None:
    log_a = np.linspace(-12.0, 8.0, 401)
    sample = np.array([printed_curve(n, k, mu, mp.exp(x)) for x in log_a], float)

    def extreme(which: int) -> mp.mpf:
        start = float(log_a[int(np.argmin(sample[:, which]))])
        return mp.exp(mp.findroot(lambda x: mp.diff(lambda y: printed_curve(n, k, mu, mp.exp(y))[which], x), start))

    with mp.workdps(30):
        fold, lowest = extreme(0), extreme(1)
        zero = mp.exp(mp.findroot(lambda x: printed_curve(n, k, mu, mp.exp(x))[1], mp.log(1.5 * lowest)))
    delta, P = printed_curve(n, k, mu, lowest)
    assert value(n, k, mu) == pytest.approx(float(-P), rel=1e-13)
    assert value(n, k, mu, "pull_off_displacement") == pytest.approx(float(delta), rel=1e-12, abs=1e-13)
    for quantity, a in (("jump_out_displacement", fold), ("zero_load_displacement", zero)):
        assert value(n, k, mu, quantity) == pytest.approx(float(printed_curve(n, k, mu, a)[0]), rel=1e-13)
    curve = JKR().curve(contact(n, k, mu))
    for i in (0, 1, 100, 400):
        expected = printed_curve(n, k, mu, mp.mpf(curve.columns["contact_radius"][i]))
        assert (curve.displacement[i], curve.load[i]) == pytest.approx([*map(float, expected)], rel=1e-11, abs=1e-12)


@pytest.mark.parametrize("n", [1.0, 1.5, 5.0])
def test_gibson_limit(n: float) -> None:
    """k = 1: Eq. 51 is P = a^(n+2) / (2 (n+2)) - a^2, least at a^n = 4; C_out is 2; both are continuous."""
    assert value(n, 1.0, 1.0) == pytest.approx(n / (n + 2) * 4 ** (2 / n), rel=1e-14)
    assert value(n, 1.0, 3.0, "jump_out_displacement") == pytest.approx(-6.0, rel=1e-14)
    for quantity in ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement"):
        assert value(n, 1 - 1e-9, 2.0, quantity) == pytest.approx(value(n, 1.0, 2.0, quantity), rel=1e-7)


def far_branch(problem: Problem, H: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """delta and P over the central gap as printed (Eqs. 43-44 with Q = dgamma = z0 = 1)."""
    n, k, mu = (mp.mpf(float(x)) for x in (problem.n, problem.k, problem.mu))
    b, c = (1 - k) / n, 2 / n
    pull = 16 * mu ** (2 - b) / (3 * n ** (1 - b)) * ((1 - k) * mp.beta(3 - b, b) if k < 1 else n)
    return -H - pull / (H + 1) ** (3 - b), -16 * n ** (c - 1) / (3 * (H + 1) ** (3 - c)) * mp.beta(3 - c, c)


def cycle(problem: Problem) -> mp.mpf:
    """Work on approach less that on retreat, by quadrature of P d delta between the two folds."""
    far = partial(far_branch, problem)
    near = partial(printed_curve, problem.n, problem.k, problem.mu)
    delta_in = SemiRigid().jump_in_displacement(problem).value
    H_in = SemiRigid().jump_in_gap(problem).value
    delta_out = JKR().jump_out_displacement(problem).value
    curve = JKR().curve(problem)
    start = curve.columns["contact_radius"][int(np.argmin(curve.displacement))]
    # The fold is at a = 0 for k = 1.
    a_out = mp.findroot(lambda a: mp.diff(lambda x: near(x)[0], a), start) if start else mp.mpf(0)
    H_out = mp.findroot(lambda H: far(H)[0] - delta_out, mp.mpf(-float(delta_out)))
    a = mp.findroot(
        lambda a: near(a)[0] - delta_in, (2 * GradedPunch.of(problem).scales(problem.mu).radius) * mp.mpf(1.2)
    )
    approach = mp.quad(lambda H: far(H)[1] * mp.diff(lambda x: far(x)[0], H), [H_out, H_in])
    retreat = mp.quad(lambda x: near(x)[1] * mp.diff(lambda y: near(y)[0], x), [a_out, a])
    return approach - retreat


@pytest.mark.parametrize(
    ("n", "k", "mu"),
    [(2.0, 0.0, 3.0), (1.5, 0.4, 5.0), (2.0, 1.0, 4.0), *heavy((5.0, 0.2, 2.0), (0.9, 0.3, 20.0), (3.0, 0.9, 2.0))],
)
def test_energy_is_the_quadrature_of_the_printed_branches(n: float, k: float, mu: float) -> None:
    """The folds are rounded, which is of second order; the quadrature is good to 20 digits."""
    problem = contact(n, k, mu)
    result = JumpAsymptotes().evaluate(problem, "hysteresis_energy")
    with mp.workdps(30):
        expected = cycle(problem)
    assert abs(result.value - float(expected)) <= result.u_num
    assert 0.0 < result.u_num < 1e-11 * max(1.0, result.value)


@pytest.mark.parametrize(("mu", "reason"), [(1, "is not above that of the jump-out, -1.6"), (1e-3, "a positive one")])
def test_a_cycle_without_energy_is_refused(mu: float, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        JumpAsymptotes().evaluate(contact(2, 0, mu), "hysteresis_energy")


EVENTS = ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement")


def ball(softness: float, mu: float = 2.0, **sections: Section) -> Problem:
    """A ball with w/(E* R) = softness on an incompressible solid, with other sections."""
    return replace(ball_on(softness, mu, 0.5), **sections)


def result_of(problem: Problem, model: str, quantity: str = "pull_off_force") -> Result:
    result = evaluated(problem, create(model), quantity)
    assert isinstance(result, Result)
    return result


#: The models of a ball, and the energy that an increase of the projected area of contact sets free, by alpha.
RELEASES = {"jkr-sphere": lambda a: 1 / mp.sqrt(1 - a**2), "jkr-sphere-projected": lambda a: 1}


@pytest.mark.parametrize(("model", "last", "refused"), [("jkr-sphere", 0.18, 0.19), ("jkr-sphere-projected", 8.9, 9.1)])
def test_a_ball_without_a_minimum_of_the_load_is_refused(model: str, last: float, refused: float) -> None:
    """The load has a minimum up to a contact of 0.91 and of 0.95 of the radius."""
    assert result_of(ball(last), model).value > 0.0
    with pytest.raises(NotApplicable, match="smaller than the contact"):
        result_of(ball(refused), model)


@pytest.mark.parametrize("model", RELEASES)
@pytest.mark.parametrize("softness", [1e-6, 1e-3, 1e-2])
def test_events_of_a_ball_are_those_of_the_extremes_of_its_curve(model: str, softness: float) -> None:
    """Sneddon's sphere in 30 digits, the radius and the work of adhesion 1: roots of derivatives, without theta."""
    g = RELEASES[model]

    def load(a: mp.mpf) -> mp.mpf:
        return (1 + a**2) * mp.atanh(a) - a - mp.sqrt(8 * mp.pi * softness * g(a) * a**3)

    def delta(a: mp.mpf) -> mp.mpf:
        return a * mp.atanh(a) - mp.sqrt(2 * mp.pi * softness * g(a) * a)

    slopes = {"pull_off": partial(mp.diff, load), "jump_out": partial(mp.diff, delta), "zero_load": load}
    with mp.workdps(30):
        jkr = mp.cbrt(9 * mp.pi * softness / 8)
        for (event, slope), share in zip(slopes.items(), (1.0, 0.3, 1.6), strict=True):
            exact = delta(mp.findroot(slope, share * jkr))
            result = result_of(ball(softness), model, f"{event}_displacement")
            assert abs(result.value - exact) <= result.u_num < 1e-13
        force, result = -load(mp.findroot(slopes["pull_off"], jkr)) / softness, result_of(ball(softness), model)
        assert abs(result.value - force) <= result.u_num < 1e-12 * force


@pytest.mark.parametrize("model", RELEASES)
@pytest.mark.parametrize("quantity", EVENTS)
def test_a_large_ball_is_the_paraboloid(quantity: str, model: str) -> None:
    """The difference falls as (a/R)^2, with the power 2/3 of w/(E* R); at zero load it cancels with the area."""
    differences = []
    for softness in (8e-6, 1e-6):
        paraboloid = result_of(ball(softness, punch=Section("sphere", {"R": 1.0})), "jkr", quantity).value
        differences.append(abs(result_of(ball(softness), model, quantity).value / paraboloid - 1.0))
    assert 0.0 < differences[1] < 1e-3
    cancels = (model, quantity) == ("jkr-sphere", "zero_load_displacement")
    assert differences[0] / differences[1] == pytest.approx(16.0 if cancels else 4.0, rel=0.02)


def test_the_curve_ends_as_far_in_compression_as_its_pull_off_is_in_tension() -> None:
    load = create("jkr-sphere").force_curve(ball(1e-3)).load
    assert 1.0 <= load[-1] / -load.min() < 1.2


def test_the_fscm_refuses_a_ball_smaller_than_its_contact_before_it_traces_a_path(monkeypatch) -> None:
    """At such a Tabor number the path takes a minute, and the contact is that of JKR."""
    monkeypatch.setattr("fscm.solve", None)
    with pytest.raises(ComputationFailed, match="the ball is smaller than the contact"):
        result_of(ball(20.0, 200.0), "fscm")


GRADED = Section("power-law", {"E0": 1e3, "c0": 1.0, "k": 0.4, "nu": 0.5})
EXPONENTIAL = Section("exponential", {"E_surface": 1e3, "E_depth": 2e3, "length": 1.0, "nu": 0.3})


@pytest.mark.parametrize(
    ("problem", "model", "reason"),
    [
        (Problem.dimensionless(2, 0, 1), "jkr-sphere", "is for the punch of the kind ball, not for power-law"),
        (ball(1e-3, solid=GRADED), "jkr-sphere", "is for a homogeneous solid, not for the power-law solid"),
        (ball(1e-3, solid=EXPONENTIAL), "jkr-sphere", "not for the exponential solid"),
        (ball(20.0), "jkr-sphere", "the ball is smaller than the contact"),
        (ball(1e-3), "jkr", "a ball punch"),
    ],
)
def test_refusals(problem: Problem, model: str, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        result_of(problem, model)


def test_it_is_the_limit_of_the_fscm() -> None:
    """At a large Tabor number the law acts on the edge alone."""
    errors = []
    for mu in (10.0, 40.0):
        force, limit = (result_of(ball(1e-3, mu), model).value for model in ("fscm", "jkr-sphere-projected"))
        errors.append(abs(force / limit - 1.0))
    assert errors[1] < 0.2 * errors[0]
    assert errors[1] < 1e-3  # that of the paraboloid is 1e-2
