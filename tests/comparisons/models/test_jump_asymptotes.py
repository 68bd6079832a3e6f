"""The energy of the cycle between the two asymptotic branches against quadrature of the load, and its domain."""

from __future__ import annotations

from functools import partial

import mpmath as mp
import numpy as np
import pytest

from comparisons.model import NotApplicable
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.models.jump_asymptotes import JumpAsymptotes
from comparisons.models.semi_rigid import SemiRigid
from comparisons.problem import Problem

from .test_jkr import printed_curve

MODEL = JumpAsymptotes()
CASES = [(2.0, 0.0, 3.0), (1.5, 0.4, 5.0), (5.0, 0.2, 2.0), (0.9, 0.3, 20.0), (3.0, 0.9, 2.0), (2.0, 1.0, 4.0)]


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


@pytest.mark.parametrize(("n", "k", "mu"), CASES)
def test_energy_is_the_quadrature_of_the_printed_branches(n: float, k: float, mu: float) -> None:
    """The folds are rounded, which is of second order; the quadrature is good to 20 digits."""
    problem = Problem.dimensionless(n, k, mu)
    result = MODEL.evaluate(problem, "hysteresis_energy")
    with mp.workdps(30):
        expected = cycle(problem)
    assert abs(result.value - float(expected)) <= result.u_num
    assert 0.0 < result.u_num < 1e-11 * max(1.0, result.value)


@pytest.mark.parametrize(("mu", "reason"), [(1, "is not above that of the jump-out, -1.6"), (1e-3, "a positive one")])
def test_refusals(mu: float, reason: str) -> None:
    with pytest.raises(NotApplicable, match=reason):
        MODEL.evaluate(Problem.dimensionless(2, 0, mu), "hysteresis_energy")
