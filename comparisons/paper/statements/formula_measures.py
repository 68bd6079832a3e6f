"""Measures of formulas and of the numerical scheme: kernel, Tabor number, coefficients, eta, chi, mesh and domain."""

from __future__ import annotations

import numpy as np

import fscm
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.fem_model import FiniteElements
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.paper.figures.fig11_gradient_effect import largest_chi
from comparisons.paper.paper_figure import result_of, together
from comparisons.paper.statements.measures import ROUNDING, Made, label, measure, of_case, two
from comparisons.paper.values.scheme_forces import SEGMENTS, exact_force, scheme_force
from comparisons.problem import Problem
from fscm import LennardJones, PowerLaw, PowerPunch
from fscm import Problem as PhysicalProblem

__all__ = ["force_at"]

#: Rounding of the kernel functions, which are of order one: hypergeometric series near their singular point.
_KERNEL_ROUNDING = 1e-10


@measure("", "formula")
def phi_step(reference: str, case: dict[str, float]) -> Made:
    """Step of Phi_k across s = 1."""
    yield {}
    k, step = case["k"], case["s"]
    below, above = (fscm.Phi(k, np.array([1.0 + sign * step]))[0] for sign in (-1.0, 1.0))
    return above - below, _KERNEL_ROUNDING, f"step of Phi_k across s = 1, k = {k:g}, s = 1 + {step:g}"


@measure("", "formula")
def phi_slope(reference: str, case: dict[str, float], nearest: str) -> Made:
    """Derivative of Phi_k beyond s = 1; its rounding is that of the largest, at the nearest step."""
    yield {}
    k, s = case["k"], 1.0 + np.array([case["s"], float(nearest)])
    slope, largest = (1.0 - k) * fscm.ring_response(k, np.ones(2), s)
    return slope, _KERNEL_ROUNDING * largest, f"derivative of Phi_k, k = {k:g}, s = 1 + {case['s']:g}"


@measure("derivative of Phi_k at s = 1 + {0} over that at 1 + {1}", "formula")
def phi_sharpness(reference: str, case: dict[str, float], inner: str, far: str) -> Made:
    yield {}
    slopes = fscm.ring_response(case["k"], np.ones(2), 1.0 + np.array([float(inner), float(far)]))
    ratio = slopes[0] / slopes[1]
    return ratio, _KERNEL_ROUNDING * ratio


@measure("largest |Psi_k| for s {0} {1}", "formula")
def largest_psi(reference: str, case: dict[str, float], *where: str) -> Made:
    """Over ``up to 10`` or ``from 10 to 1e+06``."""
    yield {}
    low, high = (1e-6, float(where[2])) if where[0] == "up" else (float(where[1]), float(where[3]))
    s = np.geomspace(low, high, 2001)
    s = s if where[0] == "from" else np.concatenate([[0.0], s])
    what = f"largest |Psi_k| for s {' '.join(where)}, k = {case['k']:g}"
    return np.abs(fscm.Psi(case["k"], s)).max(), _KERNEL_ROUNDING, what


@measure("", "formula")
def tabor_difference(reference: str, case: dict[str, float], nu: str) -> Made:
    """Tabor number (Eq. 29) over that of Jin et al. (2021), less 1."""
    yield {}
    solid, law = PowerLaw(E0=2.0, c0=3.0, k=case["k"], nu=float(nu)), LennardJones(work_of_adhesion=0.7, z0=0.25)
    problem = PhysicalProblem(solid, PowerPunch(case["n"], Q=1.5), law)
    what = f"|mu / mu_Jin - 1|, {label(tuple(case.items()))}, nu = {float(nu):g}"
    return abs(problem.mu / problem.tabor_number_jin - 1.0), ROUNDING, what


def _closed(value: float) -> Made:
    yield {}
    return value, ROUNDING * abs(value)


@measure("C_in", "formula")
def coefficient_in(reference: str, case: dict[str, float]) -> Made:
    return (yield from _closed(jump_in_coefficient(case["n"], case["k"])))


@measure("C_out", "formula")
def coefficient_out(reference: str, case: dict[str, float]) -> Made:
    problem = Problem.dimensionless(case["n"], case["k"], 1.0)
    return (yield from _closed(-JKR().evaluate(problem, "jump_out_displacement").value))


@measure("eta", "formula")
def eta_of(reference: str, case: dict[str, float]) -> Made:
    return (yield from _closed(eta(case["n"])))


@measure("", "formula")
def strength(reference: str, case: dict[str, float]) -> Made:
    return *(yield from _closed(THEORETICAL_STRENGTH)), "theoretical strength"


@measure("strength minus eta", "formula")
def strength_difference(reference: str, case: dict[str, float]) -> Made:
    yield {}
    return THEORETICAL_STRENGTH - eta(case["n"]), ROUNDING


@measure("largest chi over k", "formula")
def chi_of(reference: str, case: dict[str, float]) -> Made:
    return (yield from _closed(largest_chi(case["n"])[0]))


def force_at(n: float, k: float, mu: float, nu: float) -> dict[str, float]:
    """Return the pull-off force of the finite elements for one Poisson's ratio, ``value`` and ``u_num``.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the finite elements refuse or fail.
    """
    try:
        force = FiniteElements(nu).evaluate(Problem.dimensionless(n, k, mu), "pull_off_force")
    except NotApplicable as refusal:
        raise ComputationFailed(str(refusal)) from refusal
    return {"value": force.value, "u_num": force.u_num}


@measure("difference of the pull-off forces for nu = {0} and {1}", "fem")
def poisson_difference(reference: str, case: dict[str, float], *ratios: str) -> Made:
    forces = yield from together({nu: result_of(force_at, *of_case(case), float(nu)) for nu in ratios})
    low, high = forces.values()
    return abs(low["value"] - high["value"]), low["u_num"] + high["u_num"]


@measure(f"change of the pull-off force by N = {SEGMENTS} segments", "fscm-stieltjes")
def segments_change(reference: str, case: dict[str, float]) -> Made:
    """Compared on the same finite domain."""
    functions = (scheme_force, exact_force)
    both = yield from together({function: result_of(function, *of_case(case)) for function in functions})
    coarse, full = both.values()
    same_domain = full["force"] - full["beyond"]
    return abs(coarse["force"] - same_domain) / full["force"], (coarse["u_num"] + full["u_num"]) / full["force"]


@measure("pull-off force of the scheme with f(r_max) = 50")
def stieltjes_force(reference: str, case: dict[str, float]) -> Made:
    scheme = yield from result_of(scheme_force, *of_case(case))
    return scheme["force"], scheme["u_num"]


@measure("share of the pull-off force that the scheme with f(r_max) = 50 lacks")
def scheme_lack(reference: str, case: dict[str, float]) -> Made:
    scheme, exact = yield from two(reference, case, "stieltjes_force", "pull_off_force")
    return abs(1.0 - scheme.value / exact.value), (scheme.u + exact.u) / exact.value
