"""Tests of formulas: the kernel, the Tabor number, the coefficients of the jumps, eta, and chi."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import beta

import fscm
from comparisons.data.paper_statements import PaperStatement
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig11_gradient_effect import largest_chi
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.limits import vanishes
from comparisons.paper.statements.sources import StatementTest, case_label, grid, number, reading, tasks_of, witnesses
from comparisons.paper.statements.trends import one_way
from comparisons.runs.cases import Case
from fscm import LennardJones, PowerLaw, PowerPunch, Problem

__all__ = ["TESTS"]

#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS
#: Rounding of the kernel functions, which are of order one: hypergeometric series near their singular point.
_KERNEL_ROUNDING = 1e-10
_FORMULA = "formula"
_GAP = "jump_in_gap"


def _formula(evidence: Callable[[PaperStatement], Sequence[Evidence]]) -> StatementTest:
    """Return the test of a closed form, which needs no cached call."""

    def of_results(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
        return evidence(statement)

    return StatementTest(lambda statement: (), of_results)


def _closed(value: float, what: str) -> Number:
    return Number(value, _ROUNDING * abs(value), what)


def _continuous(statement: PaperStatement) -> Sequence[Evidence]:
    """The step of Phi_k across s = 1 shrinks with its width; the derivative grows towards s = 1."""
    steps = statement.numbers("steps")
    rows: list[Evidence] = []
    for k in statement.numbers("k"):
        below, above = (np.array([1.0 + sign * step for step in steps]) for sign in (-1.0, 1.0))
        jump = fscm.Phi(k, above) - fscm.Phi(k, below)
        slope = (1.0 - k) * fscm.ring_response(k, np.ones(len(steps)), above)
        jumps, slopes = (
            [
                Number(float(value), _KERNEL_ROUNDING * scale, f"{title}, k = {k:g}, s = 1 + {step:g}")
                for value, step in zip(values, steps, strict=True)
            ]
            for values, title, scale in (
                (jump, "step of Phi_k across s = 1", 1.0),
                (slope, "derivative of Phi_k", float(np.abs(slope).max())),
            )
        )
        rows += one_way(f"Phi_k is continuous, k = {k:g}", _FORMULA, jumps, "<")
        rows += one_way(f"its derivative is not bounded, k = {k:g}", _FORMULA, slopes, ">")
    return rows


def _sharper_kernel(statement: PaperStatement) -> Sequence[Evidence]:
    """The derivative near s = 1 over that farther away rises with k."""
    near, far = statement.numbers("steps")
    numbers = []
    for k in statement.numbers("k"):
        values = fscm.ring_response(k, np.ones(2), np.array([1.0 + near, 1.0 + far]))
        ratio = float(values[0] / values[1])
        what = f"derivative of Phi_k at s = 1 + {near:g} over that at 1 + {far:g}, k = {k:g}"
        numbers.append(Number(ratio, _KERNEL_ROUNDING * ratio, what))
    return one_way("0 <= k < 1", _FORMULA, numbers, ">")


def _bounded(statement: PaperStatement) -> Sequence[Evidence]:
    """Psi_k is smaller far away than near s = 1, over five decades of s."""
    far = float(statement.arguments["far"])
    rows = []
    for k in statement.numbers("k"):
        near, beyond = (
            Number(float(np.abs(fscm.Psi(k, s)).max()), _KERNEL_ROUNDING, f"largest |Psi_k| for {range_}, k = {k:g}")
            for s, range_ in (
                (np.concatenate([[0.0], np.geomspace(1e-6, far, 2001)]), f"s up to {far:g}"),
                (np.geomspace(far, 1e5 * far, 2001), f"s from {far:g} to {1e5 * far:g}"),
            )
        )
        rows.append(Evidence(f"k = {k:g}", _FORMULA, beyond, "<", near))
    return rows


def _jin(statement: PaperStatement) -> Sequence[Evidence]:
    """The ratio of both Tabor numbers is 1 in the two limits and not 1 between them."""
    equal, apart = Number(1e-9, 0.0, "rounding"), reading(statement)
    rows = []
    for n in statement.numbers("n"):
        for k, nu, relation, limit in ((0.0, 0.3, "<", equal), (1.0, 0.5, "<", equal), (0.4, 0.3, ">", apart)):
            solid, law = PowerLaw(E0=2.0, c0=3.0, k=k, nu=nu), LennardJones(work_of_adhesion=0.7, z0=0.25)
            problem = Problem(solid, PowerPunch(n, Q=1.5), law)
            ratio = problem.mu / problem.tabor_number_jin
            what = f"|mu / mu_Jin - 1|, n = {n:g}, k = {k:g}, nu = {nu:g}"
            clause = f"{'equal' if relation == '<' else 'different'}, n = {n:g}, k = {k:g}"
            rows.append(Evidence(clause, _FORMULA, Number(abs(ratio - 1.0), _ROUNDING, what), relation, limit))
    return rows


def _coefficient(name: str, n: float, k: float) -> Number:
    if name == "C_in":
        value = jump_in_coefficient(n, k)
    else:
        value = -JKR().evaluate(Case(n, k, 1.0).problem(), "jump_out_displacement").value
    return _closed(value, f"{name}, n = {n:g}, k = {k:g}")


def _coefficients_rise(statement: PaperStatement) -> Sequence[Evidence]:
    """Both coefficients rise with n at every k."""
    rows = []
    for name in ("C_in", "C_out"):
        for k in statement.numbers("k"):
            numbers = [_coefficient(name, n, k) for n in statement.numbers("n")]
            rows += one_way(f"{name}, k = {k:g}", _FORMULA, numbers, ">")
    return rows


def _eta(statement: PaperStatement) -> Sequence[Evidence]:
    """Eta rises with n, stays below the strength, and tends to it."""
    numbers = [_closed(eta(n), f"eta, n = {n:g}") for n in statement.numbers("n")]
    strength = _closed(THEORETICAL_STRENGTH, "theoretical strength")
    gaps = [
        Number(THEORETICAL_STRENGTH - eta(n), _ROUNDING, f"strength minus eta, n = {n:g}")
        for n in statement.numbers("far")
    ]
    return [
        *one_way("rises with n", _FORMULA, numbers, ">"),
        *(Evidence("below the strength", _FORMULA, value, "<", strength) for value in numbers),
        *(replace(row, model=_FORMULA) for row in vanishes("tends to the strength", gaps, reading(statement))),
    ]


def _repulsion(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The repulsive term of Eqs. 41 and 42 over the attractive one at the gap at jump-in of each reference."""
    rows = []
    for model, cases in (("fscm", grid(statement)), ("fem", witnesses(statement))):
        for case in cases:
            gap = number(results, model, _GAP, case)
            for equation, b in ((41, (1.0 - case[1]) / case[0]), (42, 2.0 / case[0])):
                share = float(beta(9.0 - b, b) / beta(3.0 - b, b)) / (gap.value + 1.0) ** 6
                what = f"repulsive over attractive term of Eq. {equation} at jump-in, {case_label(case)}"
                u = share * (6.0 * gap.u / (gap.value + 1.0) + _ROUNDING)
                rows.append(Evidence(case_label(case), model, Number(share, u, what), "<", reading(statement)))
    return rows


def _repulsion_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    cases = [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]
    return [call for model, case in cases for call in tasks_of(model, _GAP, case)]


def _chi(statement: PaperStatement) -> Sequence[Evidence]:
    """The largest chi over k is below 10 % inside the ranges of n and above it outside."""
    rows = []
    for key, relation in (("inside", "<"), ("outside", ">")):
        for n in statement.numbers(key):
            value = _closed(largest_chi(n)[0], f"largest chi over k, n = {n:g}")
            rows.append(Evidence(f"{key}, n = {n:g}", _FORMULA, value, relation, reading(statement)))
    return rows


#: Tests of statements on formulas and functions inside the FSCM, by name.
TESTS = {
    "kernel_continuous": _formula(_continuous),
    "kernel_sharper": _formula(_sharper_kernel),
    "kernel_bounded": _formula(_bounded),
    "tabor_numbers_equal": _formula(_jin),
    "coefficients_rise": _formula(_coefficients_rise),
    "eta": _formula(_eta),
    "chi_ranges": _formula(_chi),
    "repulsion_negligible": StatementTest(_repulsion_tasks, _repulsion),
}
