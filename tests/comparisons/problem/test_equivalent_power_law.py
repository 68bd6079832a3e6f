"""Equivalent power law of a solid that is none."""

import math
from pathlib import Path

import mpmath
import numpy as np
import pytest

import fscm
from comparisons.description.equivalent_power_law import equivalent_power_law
from comparisons.description.overview import overview
from comparisons.description.text import description_text
from comparisons.problem import equivalent_solid
from comparisons.problem.equivalent_solid import (
    LARGEST_K,
    energy_spectrum,
    equivalent_solids,
    least_wrong,
    power_law_of,
)
from comparisons.problem.reading import load_problem
from comparisons.runs.tasks import evaluate
from tests.comparisons.problems import on_solid
from tests.comparisons.rows import row

COATED = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "coated_solid.toml"

#: The nodes of a field, joined by straight lines, give its energy to this accuracy (measured: 1e-3).
_TRAPEZOIDS = 3e-3

#: The functions of SciPy in the transform of a pressure have this accuracy (measured: 1e-12 with SciPy 1.13.0).
_FUNCTIONS = 1e-11


@pytest.mark.parametrize("x", [1e-6, 1e-3, 1.0, 19.0, 29.9, 30.1, 300.0, 2e4])
def test_the_transform_of_a_straight_line_is_accurate_at_small_and_large_arguments(x):
    with mpmath.workdps(40):
        integral = x * mpmath.hyp1f2(0.5, 1, 1.5, -(mpmath.mpf(x) ** 2) / 4)
        exact = integral - x * mpmath.j0(x)
    # It begins as x^3/6, and goes on as waves of the size of sqrt(x).
    assert abs(equivalent_solid._linear_part(np.array([x]))[0] - float(exact)) < _FUNCTIONS * min(x**3, math.sqrt(x))


@pytest.fixture(scope="module")
def coated():
    """The example, and its equivalent with the force of the example."""
    problem = load_problem(COATED)
    force = evaluate("fscm", "pull_off_force", problem)
    return problem, equivalent_power_law(problem, force) | {"force": force.value}


def test_a_compliance_has_the_modulus_of_its_power_law():
    problem = on_solid("offset-power-law", {"E0": 2e9, "c0": 1e-8, "k": 0.4, "z_s": 1e-12, "nu": 0.3})
    xi = np.geomspace(1e7, 1e8, 3)
    values = fscm._surface.response.compliance.compliance(problem.posed.graded, xi * problem.units["radius"])
    spectrum = equivalent_solid.EnergySpectrum(xi, values, np.full(3, 1.0 / 3.0))
    assert power_law_of(problem, spectrum).solid["E0"] == pytest.approx(2e9, rel=3e-3)


def test_a_fit_beyond_the_largest_exponent_stops_there():
    xi = np.geomspace(1e6, 1e8, 9)
    k, free_k, deviation, compliance = least_wrong(equivalent_solid.EnergySpectrum(xi, xi**1.5, np.full(9, 1.0 / 9.0)))
    assert (k, free_k) == (LARGEST_K, pytest.approx(1.5))
    assert compliance == pytest.approx(1e7**1.5)
    assert deviation == pytest.approx(np.std(np.log(xi)) * (1.5 - LARGEST_K))


def test_the_error_is_that_of_both_solids_in_the_solver(coated):
    """The problem of the equivalent is posed anew, from the numbers that are reported."""
    _, power_law = coated
    solid = fscm.PowerLaw(*(power_law[name] for name in ("E0", "c0", "k", "nu")))
    similar = fscm.Problem(solid, fscm.PowerPunch(2, 1e-7), fscm.LennardJones(0.05, 4e-10))
    loads = fscm.solve(similar, "pull_off_force").value, power_law["force"]
    of_law = power_law["pull_off_force"]
    assert abs(loads[0] / loads[1] - 1.0 - of_law["error"]) <= of_law["error_u_num"] < 1e-5
    # Forces that need no model: of rigid spheres 2 pi R w for every solid, and of soft ones (3 + k)/2 pi R w.
    errors = {row["model"]: row for row in power_law["closed_forms"]}
    pull = math.pi * 1e-7 * 0.05
    for model, factor in (("bradley", 2.0), ("jkr", (3.0 + power_law["k"]) / 2.0)):
        assert abs(factor * pull / loads[1] - 1.0 - errors[model]["error"]) <= errors[model]["u_num"] < 1e-7
    sizes = [abs(row["error"]) for row in power_law["closed_forms"]]
    assert sizes == sorted(sizes)
    assert not {"fscm", "fem", "atlas"} & set(errors)
    # JKR is within 1 % here only because its error, -4 %, and that of the power law, 4 %, cancel.
    assert abs(errors["jkr"]["error"]) < 0.01
    assert power_law["closed_form_within"] == {"1 %": None, "5 %": "md-improved"}


def test_what_is_recommended_and_the_regime_are_those_of_the_power_law(coated):
    problem, law = coated
    content = overview(problem, row("fscm", value=law["force"], u_num=1e-16), None, law)
    assert content["recommended"] == {"1 %": "fscm", "5 %": law["closed_form_within"]["5 %"]}
    # JKR has 0.8 % by cancellation.
    assert "transition" in content["regime"]
    steep = law | {"compliance_deviation": 0.9}
    assert overview(problem, row("fscm", value=law["force"], u_num=1e-16), None, steep)["recommended"]["5 %"] == "fscm"


def test_a_law_in_a_liquid_has_the_rigid_limit_of_its_work():
    problem = load_problem(COATED.with_name("bead_in_water.toml"))
    rigid = 2.0 * math.pi * problem.punch["R"] * problem.units["energy_per_area"]
    regime = overview(problem, row("fscm", value=0.97 * rigid, u_num=1e-16))["regime"]
    assert "rigid" in regime
    assert "within 5 %" in regime


def force_of_jkr(problem):
    return (3.0 + problem.solid["k"]) / 2.0 * math.pi * 1e-7 * 0.05


def test_a_closed_form_has_the_value_of_the_equivalent_and_the_error_of_the_fit(coated):
    problem, _ = coated
    law = evaluate("jkr", "pull_off_force", problem)
    force, of_coarser = map(force_of_jkr, equivalent_solids(problem))
    assert law.value == pytest.approx(force, rel=1e-12)
    assert 1e-9 * force < abs(force - of_coarser) < law.u_num < 2e-3 * force
    assert "equivalent power law" in law.reason
    # A model that solves the equations of a power law is no reference for another solid.
    assert evaluate("atlas", "pull_off_force", problem).status == "not-applicable"


@pytest.mark.heavy
def test_the_error_of_the_fit_bounds_the_change_by_more_wave_numbers(coated, monkeypatch):
    problem, _ = coated
    force, of_coarser = map(force_of_jkr, equivalent_solids(problem))
    monkeypatch.setattr(equivalent_solid, "_POINTS", 2 * equivalent_solid._POINTS)
    monkeypatch.setattr(equivalent_solid, "energy_spectrum", energy_spectrum.__wrapped__)
    fine, _ = equivalent_solids(problem)
    assert abs(force - force_of_jkr(fine)) < abs(force - of_coarser)


@pytest.mark.parametrize(
    ("of_surface", "of_law", "words"),
    [(0.1, 0.1, "of the surface"), (0.9, 0.1, "equivalent power law"), (0.9, 0.9, "no Tabor number")],
)
def test_a_tabor_number_is_printed_where_its_modulus_is_that_of_the_contact(coated, of_surface, of_law, words):
    problem, law = coated
    law = law | {"surface_compliance_deviation": of_surface, "compliance_deviation": of_law}
    content = overview(problem, row("fscm", value=5e-8, u_num=1e-16))
    assert words in description_text(problem, content, law, [], None).splitlines()[2]


def test_a_solid_that_no_power_law_stands_for(monkeypatch):
    xi = np.geomspace(1e6, 1e8, 9)
    steep = equivalent_solid.EnergySpectrum(xi, xi**-1.5, np.full(9, 1.0 / 9.0))
    monkeypatch.setattr(equivalent_solid, "energy_spectrum", lambda _: steep)
    coating = {"E_coating": 1e10, "E_substrate": 1e7, "thickness": 10e-9, "transition": 0.0, "nu": 0.3}
    law = evaluate("jkr", "pull_off_force", on_solid("coating", coating))
    assert (law.status, law.value) == ("not-applicable", None)
    assert "no power law stands for" in law.reason


def test_the_energy_is_the_work_of_the_pressure(coated):
    problem, _ = coated
    posed, units = problem.posed, problem.units
    field = fscm.profile(posed, "pull_off", "quick")
    work = math.pi * np.trapezoid(field.pressure * field.deformation * field.radius, field.radius)
    work *= units["traction"] * units["displacement"] * units["radius"] ** 2
    spectrum = energy_spectrum(problem)
    xi = spectrum.wave_numbers * units["radius"]
    density = spectrum.compliances * xi * equivalent_solid._transform(field.radius, field.pressure, xi) ** 2
    energy = np.pi * density.sum() * np.log(xi[1] / xi[0]) * units["traction"] ** 2 * units["radius"] ** 3
    assert energy == pytest.approx(work, rel=_TRAPEZOIDS)
    assert spectrum.shares == pytest.approx(density / density.sum(), abs=1e-9)
    assert spectrum.shares.sum() == pytest.approx(1.0)


def test_a_power_law_has_no_equivalent():
    problem = load_problem(COATED.with_name("graded_pad.toml"))
    assert equivalent_power_law(problem, evaluate("atlas", "pull_off_force", problem)) is None
    with pytest.raises(ValueError, match="has a power-law solid"):
        energy_spectrum(problem)
