"""Critical modulus: derivatives, value and bound, what it means for the path, and what is refused."""

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import pytest

import fem_reference
from fem_reference import Exponential, LennardJones, NoSuchEvent, OffsetPowerLaw, PowerLaw, PowerPunch, Problem, solve
from fem_reference._contact import critical
from fem_reference._contact.critical import stiffer_than_critical
from fem_reference._contact.cusp import cusp_from, displacement_rates, slowest
from fem_reference._contact.event_kinds import CUSP
from fem_reference._contact.events import PathEvents
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.path import traced
from fem_reference._contact.states import point_at
from fem_reference.accuracy import level_for
from tests.refusals import refused

LAW = LennardJones(work_of_adhesion=1.0, z0=1.0)
FLAT = Problem(PowerLaw(E0=1.0, c0=1.0, k=0.0, nu=0.0), PowerPunch(n=5.0, Q=1.0), LAW)
GRADED = Problem(PowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.3), PowerPunch(n=5.0, Q=1.0), LAW)

#: Critical Tabor number at n = 5 and k = 0 from the integral equation, to 1e-12.
TABOR = 0.6499664115
#: With unit scales and nu = 0, Eq. 29 is mu = E0^(-n / (2n - 1)).
MODULUS = TABOR ** (-9.0 / 5.0)


@cache
def near(problem):
    """The modulus of a slightly stiffer problem, and its contact on a coarse mesh."""
    stiffer = stiffer_than_critical(problem, "quick")
    return stiffer.E0, Meshes(stiffer.problem, level_for("quick")).contact(*stiffer.start)


def at(problem, ratio):
    """The contact at another modulus."""
    contact = near(problem)[1]
    return replace(contact, compliance=contact.compliance.stiffened(ratio))


@cache
def solved():
    return solve(FLAT, "critical_modulus", "quick")


def test_the_derivatives_are_those_of_neighbours():
    contact = at(GRADED, 0.97)
    point = slowest(traced(contact))
    rates = displacement_rates(point)
    h = 1e-4
    after, before = (point_at(point, point.parameter + sign * h).state.displacement_rate for sign in (1, -1))
    assert rates.value == pytest.approx(point.state.displacement_rate, rel=1e-12)
    assert rates.along == pytest.approx((after - before) / (2 * h), rel=1e-5)
    states = []
    for sign in (1, -1):
        changed = replace(contact, compliance=contact.compliance.stiffened(math.exp(sign * h)))
        states.append(replace(point.branch, contact=changed).solve(point.parameter, point.state.y).state)
    assert rates.modulus == pytest.approx(
        (states[0].displacement_rate - states[1].displacement_rate) / (2 * h), rel=1e-5
    )
    assert rates.change == pytest.approx((states[0].y - states[1].y) / (2 * h), rel=1e-5, abs=1e-7)


def test_both_equations_hold_at_the_cusp():
    cusp = cusp_from(slowest(traced(at(GRADED, 1.0))))
    rates = displacement_rates(cusp)
    assert abs(rates.value) < 1e-10
    assert abs(rates.along) < 1e-4
    assert cusp.branch.contact.compliance.stiffness == pytest.approx(1.0 / critical.MARGIN, rel=1e-6)


def test_the_value_is_that_of_the_integral_equation():
    solution = solved()
    assert abs(solution.value - MODULUS) <= solution.u_num < 1e-5 * solution.value
    assert solution.u_num == pytest.approx(sum(solution.parts.values()))
    # The whole system and the condensed one have the same cusp.
    assert solution.parts["rounding"] < 1e-9 * solution.value
    assert solution.value == pytest.approx(solution.values[-1], rel=1e-9)


def test_the_modulus_of_the_problem_is_not_used():
    again = solve(replace(FLAT, solid=replace(FLAT.solid, E0=77.0)), "critical_modulus", "quick")
    assert (again.value, again.u_num) == (solved().value, solved().u_num)


def test_it_is_in_the_units_of_the_input():
    """In other units of length and traction the modulus is multiplied by the latter."""
    length, traction = 1e-9, 1e9
    solid = PowerLaw(E0=1.0, c0=length, k=0.4, nu=0.3)
    punch = PowerPunch(n=5.0, Q=length**4)
    scaled = Problem(solid, punch, LennardJones(work_of_adhesion=traction * length, z0=length))
    in_units, modulus = (near(problem)[0] for problem in (scaled, GRADED))
    assert in_units == pytest.approx(traction * modulus, rel=1e-8)


def test_softer_it_jumps_and_stiffer_it_does_not():
    cusp = 1.0 / critical.MARGIN
    soft = PathEvents(traced(at(GRADED, 0.99 * cusp)))
    assert soft.jump_in.state.displacement > soft.jump_out.state.displacement
    refused("too stiff for jumps", PathEvents(traced(at(GRADED, 1.005 * cusp))).at, "jump_in", error=NoSuchEvent)


def test_a_path_with_folds_is_not_taken_for_one_without():
    refused("has a fold near", PathEvents(traced(at(GRADED, 0.95))).at, CUSP, error=fem_reference.NotConverged)


@pytest.mark.heavy
def test_a_solid_whose_compliance_does_not_scale():
    """With a large offset of its surface the solid is homogeneous but for a / z_s = 1e-6."""
    offset = 1e6
    solid = OffsetPowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.0, z_s=offset)
    modulus, contact = near(replace(FLAT, solid=solid))
    assert not contact.compliance.scales
    assert modulus / critical.MARGIN * offset**0.4 == pytest.approx(MODULUS, rel=2e-5)


def test_a_solid_without_a_reference_modulus_is_refused():
    solid = Exponential(1.0, 1.0, 1.0, 0.3)
    refused(r"has no reference modulus E0.*take a PowerLaw$", solve, replace(FLAT, solid=solid), "critical_modulus")


@pytest.mark.parametrize(("rate", "reason"), [(1.0, "no path has jumps"), (-1.0, "every path has jumps")])
def test_without_a_change_of_sign_there_is_no_such_modulus(rate, reason):
    with pytest.raises(NoSuchEvent, match=reason):
        critical._bracket(lambda log_ratio: SimpleNamespace(log_ratio=log_ratio, rate=rate))
