"""Tests of formulas: the kernel, the Tabor number, the coefficients of the jumps, eta, and chi."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

import fscm
from comparisons.data.paper_statements import PaperStatement
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.paper.cache import Results
from comparisons.paper.figures.fig11_gradient_effect import largest_chi
from comparisons.paper.statements.evidence import Evidence, Number, decisive
from comparisons.paper.statements.sources import StatementTest, shape
from comparisons.paper.statements.trends import one_way
from comparisons.paper.tasks import quantity
from comparisons.runs.cases import Case
from fscm.physical import PhysicalProblem

__all__ = ["TESTS"]

#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS
#: Rounding of the kernel functions, which are of order one: hypergeometric series near their singular point.
_KERNEL_ROUNDING = 1e-10
_FORMULA = "formula"


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
    rows = []
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
        rows.append(decisive(one_way("Phi_k is continuous", _FORMULA, jumps, "<")))
        rows.append(decisive(one_way("its derivative is not bounded", _FORMULA, slopes, ">")))
    return _joined(rows)


def _joined(rows: Sequence[Evidence]) -> list[Evidence]:
    """Return the decisive row of each clause."""
    by_clause: dict[str, list[Evidence]] = {}
    for row in rows:
        by_clause.setdefault(row.clause, []).append(row)
    return [decisive(found) for found in by_clause.values()]


def _sharper_kernel(statement: PaperStatement) -> Sequence[Evidence]:
    """The derivative near s = 1 over that farther away rises with k."""
    near, far = statement.numbers("steps")
    numbers = []
    for k in statement.numbers("k"):
        values = fscm.ring_response(k, np.ones(2), np.array([1.0 + near, 1.0 + far]))
        ratio = float(values[0] / values[1])
        what = f"derivative of Phi_k at s = 1 + {near:g} over that at 1 + {far:g}, k = {k:g}"
        numbers.append(Number(ratio, _KERNEL_ROUNDING * ratio, what))
    return [decisive(one_way("0 <= k < 1", _FORMULA, numbers, ">"))]


def _bounded(statement: PaperStatement) -> Sequence[Evidence]:
    """Psi_k stays between -1 and 0 over twelve decades of s."""
    s = np.concatenate([[0.0], np.geomspace(1e-6, 1e6, 2001)])
    rows = []
    for k in statement.numbers("k"):
        largest = float(np.abs(fscm.Psi(k, s)).max())
        value = Number(largest, _KERNEL_ROUNDING, f"largest size of Psi_k for s up to 1e6, k = {k:g}")
        rows.append(Evidence("0 <= k < 1", _FORMULA, value, "<", Number(1.0, 0.0, "limit")))
    return [decisive(rows)]


def _jin(statement: PaperStatement) -> Sequence[Evidence]:
    """The ratio of both Tabor numbers is 1 in the two limits and not 1 between them."""
    equal, apart = Number(1e-9, 0.0, "limit"), Number(0.01, 0.0, "limit")
    rows = []
    for n in statement.numbers("n"):
        for k, nu, relation, limit in ((0.0, 0.3, "<", equal), (1.0, 0.5, "<", equal), (0.4, 0.3, ">", apart)):
            problem = PhysicalProblem(E0=2.0, c0=3.0, k=k, nu=nu, Q=1.5, n=n, work_of_adhesion=0.7, z0=0.25)
            ratio = problem.tabor_number / problem.tabor_number_jin
            what = f"|mu / mu_Jin - 1|, n = {n:g}, k = {k:g}, nu = {nu:g}"
            clause = "equal at k = 0 and at k = 1, nu = 1/2" if relation == "<" else "different at k = 0.4, nu = 0.3"
            rows.append(Evidence(clause, _FORMULA, Number(abs(ratio - 1.0), _ROUNDING, what), relation, limit))
    return _joined(rows)


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
            rows += one_way(name, _FORMULA, numbers, ">")
    return _joined(rows)


def _coefficient_limits(statement: PaperStatement) -> Sequence[Evidence]:
    """Both coefficients reach one limit, whatever n."""
    limit = Number(1e-9, 0.0, "limit")
    rows = []
    for name, exact in (("C_in", 8.0 / 3.0), ("C_out", 2.0)):
        for n in statement.numbers("n"):
            found = _coefficient(name, n, 1.0)
            value = replace(found, value=abs(found.value - exact), what=f"difference of {found.what} from its limit")
            rows.append(Evidence(name, _FORMULA, value, "<", limit))
    return _joined(rows)


def _eta(statement: PaperStatement) -> Sequence[Evidence]:
    """Eta rises with n, stays below the strength, and reaches it."""
    numbers = [_closed(eta(n), f"eta, n = {n:g}") for n in statement.numbers("n")]
    strength = _closed(THEORETICAL_STRENGTH, "theoretical strength")
    far = float(statement.arguments["far"])
    gap = Number(THEORETICAL_STRENGTH - eta(far), _ROUNDING, f"strength minus eta, n = {far:g}")
    return [
        decisive(one_way("rises with n", _FORMULA, numbers, ">")),
        decisive(Evidence("below the strength", _FORMULA, value, "<", strength) for value in numbers),
        Evidence("reaches the strength", _FORMULA, gap, "<", Number(1e-3, 0.0, "limit")),
    ]


def _chi(statement: PaperStatement) -> Sequence[Evidence]:
    """The largest chi over k is below 10 % inside the ranges of n and above it outside."""
    limit = Number(0.1, 0.0, "10 %")
    rows = []
    for key, relation, clause in (
        ("inside", "<", "at most 10 % inside the two ranges"),
        ("outside", ">", "more than 10 % outside"),
    ):
        for n in statement.numbers(key):
            value = largest_chi(n)[0]
            rows.append(Evidence(clause, _FORMULA, _closed(value, f"largest chi over k, n = {n:g}"), relation, limit))
    return _joined(rows)


def _one_shape(statement: PaperStatement) -> Sequence[Evidence]:
    """A force without k: the Bradley limit has one value for every gradient exponent."""
    rows = []
    for n in statement.numbers("n"):
        values = [quantity("bradley", "pull_off_force", n, k, 1.0)["value"] for k in statement.numbers("k")]
        spread = Number(
            max(values) - min(values), _ROUNDING * max(values), f"spread of the Bradley force over k, n = {n:g}"
        )
        rows.append(Evidence(shape(n), _FORMULA, spread, "<", Number(1e-9, 0.0, "limit")))
    return rows


#: Tests of statements on formulas and functions inside the FSCM, by name.
TESTS = {
    "kernel_continuous": _formula(_continuous),
    "kernel_sharper": _formula(_sharper_kernel),
    "kernel_bounded": _formula(_bounded),
    "tabor_numbers_equal": _formula(_jin),
    "coefficients_rise": _formula(_coefficients_rise),
    "coefficient_limits": _formula(_coefficient_limits),
    "eta": _formula(_eta),
    "chi_ranges": _formula(_chi),
    "bradley_without_k": _formula(_one_shape),
}
