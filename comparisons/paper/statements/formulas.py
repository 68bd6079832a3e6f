"""Tests of formulas and of the numerical scheme: kernel, Tabor number, coefficients, eta, chi, mesh and domain."""

from __future__ import annotations

from itertools import product

import numpy as np
from scipy.special import beta

import fscm
from comparisons.data.paper_statements import PaperStatement
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.closed_form import EPS
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.fem_model import FiniteElements
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.paper.cache import CachedCall
from comparisons.paper.figures.fig11_gradient_effect import largest_chi
from comparisons.paper.paper_figure import results_by
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.numbers import (
    Comparisons,
    both,
    case_label,
    grid,
    lacking,
    number,
    numbers,
    reading,
    tasks_of,
    witnesses,
)
from comparisons.paper.statements.trends import one_way, vanishes
from comparisons.paper.values.scheme_ingredients import SEGMENTS, exact_force, scheme_force
from comparisons.problem import Problem
from fscm import LennardJones, PowerLaw, PowerPunch
from fscm import Problem as PhysicalProblem

__all__ = ["TESTS", "force_at"]

#: Relative rounding of a closed form: a few Gamma functions at 2e-15 each.
_ROUNDING = 64.0 * EPS
#: Rounding of the kernel functions, which are of order one: hypergeometric series near their singular point.
_KERNEL_ROUNDING = 1e-10
_FORMULA, _FORCE = "formula", "pull_off_force"


def _closed(value: float, what: str) -> Number:
    return Number(value, _ROUNDING * abs(value), what)


def kernel_continuous(statement: PaperStatement) -> Comparisons:
    """The step of Phi_k across s = 1 shrinks with its width; the derivative grows towards s = 1."""
    yield ()
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


def kernel_sharper(statement: PaperStatement) -> Comparisons:
    """The derivative near s = 1 over that farther away rises with k."""
    yield ()
    near, far = statement.numbers("steps")
    ratios = []
    for k in statement.numbers("k"):
        values = fscm.ring_response(k, np.ones(2), np.array([1.0 + near, 1.0 + far]))
        ratio = float(values[0] / values[1])
        what = f"derivative of Phi_k at s = 1 + {near:g} over that at 1 + {far:g}, k = {k:g}"
        ratios.append(Number(ratio, _KERNEL_ROUNDING * ratio, what))
    return one_way("0 <= k < 1", _FORMULA, ratios, ">")


def kernel_bounded(statement: PaperStatement) -> Comparisons:
    """Psi_k is smaller far away than near s = 1, over five decades of s."""
    yield ()
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


def tabor_numbers_equal(statement: PaperStatement) -> Comparisons:
    """The ratio of both Tabor numbers is 1 in the two limits and not 1 between them."""
    yield ()
    equal, apart = Number(1e-9, 0.0, "rounding"), reading(statement)
    rows = []
    for n in statement.numbers("n"):
        for k, nu, relation, limit in ((0.0, 0.3, "<", equal), (1.0, 0.5, "<", equal), (0.4, 0.3, ">", apart)):
            solid, law = PowerLaw(E0=2.0, c0=3.0, k=k, nu=nu), LennardJones(work_of_adhesion=0.7, z0=0.25)
            problem = PhysicalProblem(solid, PowerPunch(n, Q=1.5), law)
            ratio = problem.mu / problem.tabor_number_jin
            what = f"|mu / mu_Jin - 1|, n = {n:g}, k = {k:g}, nu = {nu:g}"
            clause = f"{'equal' if relation == '<' else 'different'}, n = {n:g}, k = {k:g}"
            rows.append(Evidence(clause, _FORMULA, Number(abs(ratio - 1.0), _ROUNDING, what), relation, limit))
    return rows


def _coefficient(name: str, n: float, k: float) -> Number:
    if name == "C_in":
        value = jump_in_coefficient(n, k)
    else:
        value = -JKR().evaluate(Problem.dimensionless(n, k, 1.0), "jump_out_displacement").value
    return _closed(value, f"{name}, n = {n:g}, k = {k:g}")


def coefficients_rise(statement: PaperStatement) -> Comparisons:
    """Both coefficients rise with n at every k."""
    yield ()
    rows = []
    for name, k in product(("C_in", "C_out"), statement.numbers("k")):
        values = [_coefficient(name, n, k) for n in statement.numbers("n")]
        rows += one_way(f"{name}, k = {k:g}", _FORMULA, values, ">")
    return rows


def eta_rises(statement: PaperStatement) -> Comparisons:
    """Eta rises with n, stays below the strength, and tends to it."""
    yield ()
    etas = [_closed(eta(n), f"eta, n = {n:g}") for n in statement.numbers("n")]
    strength = _closed(THEORETICAL_STRENGTH, "theoretical strength")
    gaps = [
        Number(THEORETICAL_STRENGTH - eta(n), _ROUNDING, f"strength minus eta, n = {n:g}")
        for n in statement.numbers("far")
    ]
    return [
        *one_way("rises with n", _FORMULA, etas, ">"),
        *(Evidence("below the strength", _FORMULA, value, "<", strength) for value in etas),
        *vanishes("tends to the strength", gaps, reading(statement), _FORMULA),
    ]


def chi_ranges(statement: PaperStatement) -> Comparisons:
    """The largest chi over k is below 10 % inside the ranges of n and above it outside."""
    yield ()
    rows = []
    for key, relation in (("inside", "<"), ("outside", ">")):
        for n in statement.numbers(key):
            value = _closed(largest_chi(n)[0], f"largest chi over k, n = {n:g}")
            rows.append(Evidence(f"{key}, n = {n:g}", _FORMULA, value, relation, reading(statement)))
    return rows


def repulsion_negligible(statement: PaperStatement) -> Comparisons:
    """The repulsive term of Eqs. 41 and 42 over the attractive one at the gap at jump-in of each reference."""
    gaps = yield from numbers("jump_in_gap", both(statement))
    rows = []
    for (model, case), gap in gaps.items():
        for equation, b in ((41, (1.0 - case[1]) / case[0]), (42, 2.0 / case[0])):
            share = float(beta(9.0 - b, b) / beta(3.0 - b, b)) / (gap.value + 1.0) ** 6
            what = f"repulsive over attractive term of Eq. {equation} at jump-in, {case_label(case)}"
            u = share * (6.0 * gap.u / (gap.value + 1.0) + _ROUNDING)
            rows.append(Evidence(case_label(case), model, Number(share, u, what), "<", reading(statement)))
    return rows


def force_at(n: float, k: float, mu: float, nu: float) -> dict[str, float]:
    """Return the pull-off force of the finite elements for one Poisson's ratio, ``value`` and ``u_num``.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the finite elements refuse or fail.
    """
    try:
        found = FiniteElements(nu).evaluate(Problem.dimensionless(n, k, mu), _FORCE)
    except NotApplicable as refusal:
        raise ComputationFailed(str(refusal)) from refusal
    return {"value": found.value, "u_num": found.u_num}


def segments_suffice(statement: PaperStatement) -> Comparisons:
    """The segments change the force by less than the limit, compared on the same finite domain."""
    functions = (scheme_force, exact_force)
    calls = {case: [CachedCall.of(function, *case) for function in functions] for case in grid(statement)}
    results = yield [call for of_case in calls.values() for call in of_case]
    rows = []
    for case, of_case in calls.items():
        coarse, full = (results[call] for call in of_case)
        same_domain = full["force"] - full["beyond"][0]
        share = abs(coarse["force"] - same_domain) / full["force"]
        u = (coarse["u_num"] + full["u_num"]) / full["force"]
        what = f"change of the pull-off force by N = {SEGMENTS} segments, {case_label(case)}"
        rows.append(Evidence(case_label(case), "fscm-stieltjes", Number(share, u, what), "<", reading(statement)))
    return rows


def domain_suffices(statement: PaperStatement) -> Comparisons:
    """The force of the scheme, which ends at f = 50, against that of each reference."""
    schemes = {case: CachedCall.of(scheme_force, *case) for case in grid(statement)}
    places = [(model, case) for case in schemes for model in ("fscm", "fem")[: 1 + (case in witnesses(statement))]]
    results = yield [*schemes.values(), *(call for model, case in places for call in tasks_of(model, _FORCE, case))]
    rows = []
    for model, case in places:
        share = lacking(results[schemes[case]], number(results, model, _FORCE, case))
        rows.append(Evidence(case_label(case), model, share, "<", reading(statement)))
    return rows


def no_poisson_ratio(statement: PaperStatement) -> Comparisons:
    """At fixed n, k and mu the force of the finite elements is the same for every Poisson's ratio."""
    ratios = statement.numbers("nu")
    found = yield from results_by(
        {(case, nu): CachedCall.of(force_at, *case, nu) for case in grid(statement) for nu in ratios}
    )
    values = " and ".join(f"{nu:g}" for nu in ratios)
    rows = []
    for case in grid(statement):
        first, second = (found[case, nu] for nu in ratios)
        what = f"difference of the pull-off forces for nu = {values}, {case_label(case)}"
        apart = Number(abs(first["value"] - second["value"]), first["u_num"] + second["u_num"], what)
        rows.append(Evidence(case_label(case), "fem", apart, "<", reading(statement)))
    return rows


#: Tests of statements on formulas, on functions inside the FSCM and on the Stieltjes scheme, by name.
TESTS = {
    "kernel_continuous": kernel_continuous,
    "kernel_sharper": kernel_sharper,
    "kernel_bounded": kernel_bounded,
    "tabor_numbers_equal": tabor_numbers_equal,
    "coefficients_rise": coefficients_rise,
    "eta": eta_rises,
    "chi_ranges": chi_ranges,
    "repulsion_negligible": repulsion_negligible,
    "segments_suffice": segments_suffice,
    "domain_suffices": domain_suffices,
    "no_poisson_ratio": no_poisson_ratio,
}
