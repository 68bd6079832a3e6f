"""Measures of formulas and of the numerical scheme: kernel, Tabor number, coefficients, eta, chi, mesh and domain."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import quad

import fscm
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.fem_model import FiniteElements
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import SemiRigid, jump_in_coefficient
from comparisons.paper.figures.functions import largest_chi
from comparisons.paper.plan import Plan, together
from comparisons.paper.scheme_forces import SEGMENTS, exact_force, scheme_force
from comparisons.paper.statements.measures import ROUNDING, Measured, Number, Place, call, measure, term
from comparisons.paper.tasks import TRACTION
from comparisons.problem import Problem

__all__ = ["force_at"]

#: Rounding of the kernel functions, which are of order one: hypergeometric series near their singular point.
_KERNEL_ROUNDING = 1e-10

_formula = partial(measure, model="formula")


@_formula("")
def phi_step(at: Place) -> Measured:
    """Step of Phi_k across s = 1."""
    below, above = (fscm.Phi(at.k, np.array([1.0 + sign * at.s]))[0] for sign in (-1.0, 1.0))
    return above - below, _KERNEL_ROUNDING, f"step of Phi_k across s = 1, k = {at.k:g}, s = 1 + {at.s:g}"


@_formula("")
def phi_slope(at: Place) -> Measured:
    """Derivative of Phi_k beyond s = 1; its rounding is that of the largest, at the nearest step."""
    s = 1.0 + np.array([at.s, float(at.arguments[0])])
    slope, largest = (1.0 - at.k) * fscm.ring_response(at.k, np.ones(2), s)
    return slope, _KERNEL_ROUNDING * largest, f"derivative of Phi_k, k = {at.k:g}, s = 1 + {at.s:g}"


@_formula("derivative of Phi_k at s = 1 + {0} over that at 1 + {1}")
def phi_sharpness(at: Place) -> Measured:
    slopes = fscm.ring_response(at.k, np.ones(2), 1.0 + np.array(at.arguments, float))
    ratio = slopes[0] / slopes[1]
    return ratio, _KERNEL_ROUNDING * ratio


@_formula("")
def largest_psi(at: Place) -> Measured:
    """Over ``up to 10`` or ``from 10 to 1e+06``."""
    where = at.arguments
    low, high = (1e-6, float(where[2])) if where[0] == "up" else (float(where[1]), float(where[3]))
    s = np.geomspace(low, high, 2001)
    s = s if where[0] == "from" else np.concatenate([[0.0], s])
    title = f"largest |Psi_k| for s {' '.join(where)}, k = {at.k:g}"
    return np.abs(fscm.Psi(at.k, s)).max(), _KERNEL_ROUNDING, title


@_formula("")
def tabor_difference(at: Place) -> Measured:
    """Tabor number (Eq. 29) over that of Jin et al. (2021), less 1."""
    nu = float(at.arguments[0])
    solid, law = fscm.PowerLaw(E0=2.0, c0=3.0, k=at.k, nu=nu), fscm.LennardJones(work_of_adhesion=0.7, z0=0.25)
    problem = fscm.Problem(solid, fscm.PowerPunch(at.n, Q=1.5), law)
    return abs(problem.mu / problem.tabor_number_jin - 1.0), ROUNDING, f"|mu / mu_Jin - 1|, {at.label}, nu = {nu:g}"


def _closed(value: float) -> tuple[float, float]:
    return value, ROUNDING * abs(value)


@_formula("C_in")
def coefficient_in(at: Place) -> Measured:
    return _closed(jump_in_coefficient(at.n, at.k))


@_formula("C_out")
def coefficient_out(at: Place) -> Measured:
    return _closed(-JKR().evaluate(Problem.dimensionless(at.n, at.k, 1.0), "jump_out_displacement").value)


@_formula("eta")
def eta_of(at: Place) -> Measured:
    return _closed(eta(at.n))


@_formula("")
def strength(at: Place) -> Measured:
    return *_closed(THEORETICAL_STRENGTH), "theoretical strength"


@_formula("largest tension of the 9-3 law")
def largest_tension(at: Place) -> Measured:
    """By the law, and not the constant that the models use."""
    return _closed(-float(TRACTION(np.array(fscm.LennardJones().peak_gap))))


@_formula("slope of log(1 - displacement at jump-in) over log(mu)")
def jump_in_exponent(at: Place) -> Measured:
    """The difference of two logarithms loses a digit."""
    low, high = (
        math.log(1.0 - SemiRigid().evaluate(problem, "jump_in_displacement").value)
        for problem in (Problem.dimensionless(at.n, at.k, mu) for mu in (1.0, math.e**7))
    )
    return _closed((high - low) / 7.0)


@_formula("strength minus eta")
def strength_difference(at: Place) -> Measured:
    return THEORETICAL_STRENGTH - eta(at.n), ROUNDING


@_formula("largest chi over k")
def chi_of(at: Place) -> Measured:
    return _closed(largest_chi(at.n)["chi_max"])


@_formula("")
def law_area(at: Place) -> Measured:
    tension, u = quad(lambda gap: float(TRACTION(np.array(gap))), 0.0, np.inf, epsabs=1e-13, epsrel=1e-13)
    return abs(-tension - 1.0), u, "difference from the work of adhesion: area of the 9-3 law"


def force_at(n: float, k: float, mu: float, nu: float) -> dict[str, float]:
    """Return the pull-off force of the finite elements for one Poisson's ratio, ``value`` and ``u_num``.

    Raises
    ------
    comparisons.model.NotApplicable, comparisons.model.ComputationFailed
        If the finite elements refuse or fail.
    """
    force = FiniteElements(nu).evaluate(Problem.dimensionless(n, k, mu), "pull_off_force")
    return {"value": force.value, "u_num": force.u_num}


def _forces(at: Place) -> Plan[dict[str, dict[str, float]]]:
    return together({nu: call(force_at, nu=float(nu))(at) for nu in at.arguments})


@measure("difference of the pull-off forces for nu = {0} and {1}", _forces, model="fem")
def poisson_difference(at: Place, forces: dict[str, dict[str, float]]) -> Measured:
    low, high = forces.values()
    return abs(low["value"] - high["value"]), low["u_num"] + high["u_num"]


_CHANGE = f"change of the pull-off force by N = {SEGMENTS} segments"


@measure(_CHANGE, call(scheme_force), call(exact_force), model="fscm-stieltjes")
def segments_change(at: Place, coarse: dict[str, float], full: dict[str, float]) -> Measured:
    """Compared on the same finite domain."""
    same_domain = full["force"] - full["beyond"]
    return abs(coarse["force"] - same_domain) / full["force"], (coarse["u_num"] + full["u_num"]) / full["force"]


@measure("pull-off force of the scheme with f(r_max) = 50", call(scheme_force))
def stieltjes_force(at: Place, scheme: dict[str, float]) -> Measured:
    return scheme["force"], scheme["u_num"]


_LACK = "share of the pull-off force that the scheme with f(r_max) = 50 lacks"


@measure(_LACK, term("stieltjes_force"), term("pull_off_force"))
def scheme_lack(at: Place, scheme: Number, exact: Number) -> Measured:
    return abs(1.0 - scheme.value / exact.value), (scheme.u + exact.u) / exact.value
